// Whether an estimator has refused all that a run asked it: then something is wrong with it or its set-up,
// and a table of rates would be of nothing.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

// Any thread may add.
class RefusalWatch {
 public:
  // The records of a whole trial, one per estimator.
  void Add(const std::vector<TrialRecord>& records);
  // A warning on standard error for each estimator that has refused every trial; `estimators` in the order of
  // the records.
  void WarnOfRefusals(const std::vector<EstimatorSpec>& estimators) const;

 private:
  mutable std::mutex mutex_;
  std::int64_t num_trials_ = 0;
  std::vector<std::map<MotionStatus, std::int64_t>> refusals_;  // by estimator: how many of each status
};

}  // namespace rcme
