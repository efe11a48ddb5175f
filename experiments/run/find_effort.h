// Finds the effort at which an estimator takes a given time on this machine, to compare estimators at equal
// time.
#pragma once

#include <cstdint>
#include <vector>

#include "experiments/study/study_plan.h"
#include "stats/moments.h"

namespace rcme {

// A problem and the name of its trial, which names the random stream of the call.
struct TimedProblem {
  MotionProblem problem;
  StreamName name;
};

// Makes trials first, ..., first + per_condition - 1 of every condition; trials of draws that cannot be
// simulated are left out. Throws InputError if none is left.
std::vector<TimedProblem> TimedProblems(const StudyPlan& plan, std::uint32_t first,
                                        std::uint32_t per_condition);

// Measures the processor time (ms) of one call on each problem, in one thread.
Moments TimeCalls(const EstimatorSpec& spec, const std::vector<TimedProblem>& problems);

enum class EffortEnd {
  kReached,     // within 3 % of the time, or no other effort lies between the two nearest
  kNoEffort,    // no option sets how much work a call does
  kTooSlow,     // even the least effort takes longer
  kOwnRule,     // more effort does not take longer, because the estimator stops by its own rule
  kAtTheLimit,  // the greatest effort that the option allows takes less time
};

struct FoundEffort {
  EffortEnd end = EffortEnd::kNoEffort;
  EstimatorSpec spec;  // with the effort set; kReached also sets budget_ms
  std::int64_t effort = 0;
};

// Searches the effort whose mean time over the problems is `time_ms`, within 3 %, by the secant
// method in logarithms within a bracket. Times vary from run to run, so the last digits of the effort may
// vary too.
FoundEffort FindEffort(const EstimatorSpec& spec, const std::vector<TimedProblem>& problems, double time_ms);

}  // namespace rcme
