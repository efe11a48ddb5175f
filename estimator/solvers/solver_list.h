// The minimal solvers, one line each: the class, and its name in the option `solver`. The enumeration, the
// option's values, the dispatch at run time and the instantiations in hypothesis.cc are generated from these
// lines. solver_table.h includes the header of each.
#pragma once

#define RCME_FOR_EACH_SOLVER(USE) \
  USE(EightPoint, "eight_point")  \
  USE(SevenPoint, "seven_point")  \
  USE(FivePoint, "five_point")    \
  USE(OnePoint, "one_point")

namespace rcme {

// kEightPoint, kSevenPoint, ... The first is the default, as in the paper.
enum class MinimalSolver : int {
#define RCME_ENUMERATOR(Solver, name) k##Solver,
  RCME_FOR_EACH_SOLVER(RCME_ENUMERATOR)
#undef RCME_ENUMERATOR
};

}  // namespace rcme
