// The minimal solvers that the option `solver` offers: one line each in VisitSolver, one in SolverNames.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "estimator/ransac_options.h"
#include "estimator/solvers/eight_point.h"
#include "estimator/solvers/five_point.h"
#include "estimator/solvers/one_point.h"
#include "estimator/solvers/seven_point.h"

namespace rcme {

// visit(std::type_identity<Solver>()) of the solver that is chosen; from there on it is a type.
template <typename Visit>
decltype(auto) VisitSolver(MinimalSolver solver, Visit&& visit) {
  switch (solver) {
    case MinimalSolver::kSevenPoint:
      return visit(std::type_identity<SevenPoint>());
    case MinimalSolver::kFivePoint:
      return visit(std::type_identity<FivePoint>());
    case MinimalSolver::kOnePoint:
      return visit(std::type_identity<OnePoint>());
    case MinimalSolver::kEightPoint:
      break;
  }
  return visit(std::type_identity<EightPoint>());
}

// Whether the solver has a fast implementation: a BlockSource (kernels/block_source.h).
template <typename Solver>
inline constexpr bool kHasFast = std::is_same_v<Solver, EightPoint> || std::is_same_v<Solver, FivePoint>;

// The names of the solvers in options, in the order in which they are listed.
inline const std::vector<std::pair<std::string, MinimalSolver>>& SolverNames() {
  static const std::vector<std::pair<std::string, MinimalSolver>> names = {
      {"eight_point", MinimalSolver::kEightPoint},
      {"seven_point", MinimalSolver::kSevenPoint},
      {"five_point", MinimalSolver::kFivePoint},
      {"one_point", MinimalSolver::kOnePoint}};
  return names;
}

// Greatest number of models of a sample.
inline int FindMaxModels(MinimalSolver solver) {
  return VisitSolver(solver, []<typename Solver>(std::type_identity<Solver>) { return Solver::kMaxModels; });
}

}  // namespace rcme
