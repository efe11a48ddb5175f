// What somebody who reads a run's tables should know first: an estimator without a valid answer to anything
// that it was asked (something is wrong with it or its set-up, and a table of rates would be of nothing),
// and trials that could not be simulated.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

// Any thread may add.
class OutcomeWatch {
 public:
  void Add(const TrialResult& result);
  // On standard error: a warning for each estimator of the plan whose answers are all refusals or invalid,
  // and one that counts the trials that were not simulated, with the reason of the first of them.
  void Warn(const StudyPlan& plan) const;

 private:
  void WarnOfNoAnswers(const StudyPlan& plan) const;
  void WarnOfNotSimulated(const StudyPlan& plan) const;

  // Of a condition, of trials that were not simulated.
  struct NotSimulatedTrials {
    std::int64_t count = 0;
    std::uint32_t first = 0;
    std::string why;  // of the first
  };

  mutable std::mutex mutex_;
  std::int64_t num_simulated_ = 0, num_not_simulated_ = 0;
  std::vector<std::map<MotionStatus, std::int64_t>> no_answers_;  // by estimator: how many of each status
  std::map<std::uint32_t, NotSimulatedTrials> not_simulated_;     // by condition
};

}  // namespace rcme
