// Runs the trials of a check until its verdict is decided.
#pragma once

#include "experiments/claims/claim_verdict.h"

namespace rcme {

struct CheckRun {
  std::uint64_t seed = 1;
  std::uint32_t condition = 0;  // names the check's random streams
  Budget budget = Budget::kQuick;
  double confidence = 0.95;  // of each target's interval, at all sample sizes at once
  int num_threads = 0;       // 0: one per core
};

// Trials run in batches whose ends do not depend on the number of threads and are counted in their order: the
// result is a pure function of the check and the run. After each batch rates and bounded means are looked at
// through confidence sequences, so that looking often does not inflate errors; other means are looked at
// once, after the last trial of the budget, and a check that claims one runs to there.
// A check that is not possible has no trials and no results.
CheckResult DecideCheck(const Check& check, const CheckRun& run);

}  // namespace rcme
