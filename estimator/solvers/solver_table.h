// The minimal solvers that the option `solver` offers (solver_list.h), as types.
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "estimator/ransac_options.h"
#include "estimator/solvers/eight_point.h"
#include "estimator/solvers/five_point.h"
#include "estimator/solvers/one_point.h"
#include "estimator/solvers/seven_point.h"
#include "estimator/solvers/solver_list.h"

namespace rcme {

// Calls visit(std::type_identity<Solver>()) with the chosen solver's type.
template <typename Visit>
decltype(auto) VisitSolver(MinimalSolver solver, Visit&& visit) {
  switch (solver) {
#define RCME_VISIT(Solver, name) \
  case MinimalSolver::k##Solver: \
    return visit(std::type_identity<Solver>());
    RCME_FOR_EACH_SOLVER(RCME_VISIT)
#undef RCME_VISIT
  }
  throw std::logic_error("no minimal solver");
}

// Whether the solver has a fast implementation: a BlockSource (kernels/block_source.h).
template <typename Solver>
inline constexpr bool kHasFast = std::is_same_v<Solver, EightPoint> || std::is_same_v<Solver, FivePoint>;

// The names of the solvers in the option, in the order of the list.
inline const std::vector<std::pair<std::string, MinimalSolver>>& SolverNames() {
  static const std::vector<std::pair<std::string, MinimalSolver>> names = {
#define RCME_NAME(Solver, name) {name, MinimalSolver::k##Solver},
      RCME_FOR_EACH_SOLVER(RCME_NAME)
#undef RCME_NAME
  };
  return names;
}

// Greatest number of models of a sample.
inline int FindMaxModels(MinimalSolver solver) {
  return VisitSolver(solver, []<typename Solver>(std::type_identity<Solver>) { return Solver::kMaxModels; });
}

}  // namespace rcme
