// Equal time: the effort at which an estimator takes a stated time on this machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/study/study_plan.h"
#include "stats/intervals.h"
#include "stats/moments.h"

namespace rcme {

// A problem with the name of its trial, which names the random stream of the call.
struct TimedProblem {
  MotionProblem problem;
  StreamName name;
};

// `per_condition` trials of every condition, from `first` on; of draws those that can be simulated. Throws
// InputError if there is none.
std::vector<TimedProblem> TimedProblems(const StudyPlan& plan, std::uint32_t first,
                                        std::uint32_t per_condition);

// The processor times of a call on each problem, ms, by one thread.
Moments TimeCalls(const EstimatorSpec& spec, const std::vector<TimedProblem>& problems);

enum class EffortEnd {
  kReached,     // within kTimeTolerance of the time
  kNoEffort,    // no option sets how much work a call does
  kTooSlow,     // the least effort takes longer
  kOwnRule,     // more effort does not take longer: the estimator stops by its own rule
  kAtTheLimit,  // the greatest effort that its option allows takes less
};
inline constexpr double kTimeTolerance = 0.03;

struct FoundEffort {
  EffortEnd end = EffortEnd::kNoEffort;
  EstimatorSpec spec;  // with the effort set; its budget_ms is set where the time is reached
  std::int64_t effort = 0;
};

// Searches the effort whose mean time over the problems is `time_ms`, to a few percent: by the secant in
// logarithms within a bracket. Times differ from run to run, and so may the effort in its last digits.
FoundEffort FindEffort(const EstimatorSpec& spec, const std::vector<TimedProblem>& problems, double time_ms);

}  // namespace rcme
