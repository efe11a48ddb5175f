// Warnings that matter before the tables of a run are read: an estimator gave no valid answer in any trial,
// which suggests that it or its set-up is broken; answers from outside the program are missing; trials could
// not be simulated.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

// Add may be called from any thread.
class OutcomeWatch {
 public:
  void Add(const TrialResult& result);
  // Prints to standard error: a warning for each estimator of the plan whose answers are all refusals or
  // invalid or of which some are missing, with commands that explain the first and run the missing ones
  // again; and one with the number of trials that were not simulated, the most frequent reasons, and the
  // message of the first.
  // `run_file`: the result file with the trials; empty: there is none, and no command is named.
  void Warn(const StudyPlan& plan, const std::string& run_file) const;

 private:
  // The trials of one estimator with a status.
  struct TrialsWith {
    std::int64_t count = 0;
    std::pair<std::uint32_t, std::uint32_t> first;  // condition, trial
  };

  // Sums the estimator's trials with a counted status, and adds "no_answer 3" and "no_answer" to the lists.
  TrialsWith SumTrials(size_t estimator, bool (*is_counted)(MotionStatus), std::vector<std::string>* counts,
                       std::vector<std::string>* names) const;
  void WarnOfNoAnswers(const StudyPlan& plan, const std::string& run_file) const;
  void WarnOfNotSimulated(const StudyPlan& plan) const;
  std::string ListReasons() const;

  // The trials of one condition that were not simulated.
  struct NotSimulatedTrials {
    std::int64_t count = 0;
    std::uint32_t first = 0;
    std::string why;  // reason of the first
  };

  mutable std::mutex mutex_;
  std::int64_t num_simulated_ = 0, num_not_simulated_ = 0;
  // By estimator: the trials of each status except ok.
  std::vector<std::map<MotionStatus, TrialsWith>> no_answers_;
  std::map<std::uint32_t, NotSimulatedTrials> not_simulated_;  // by condition
  // Number of trials by the reason: the message up to its first colon, such as "parallax_deg".
  std::map<std::string, std::int64_t> reasons_;
};

}  // namespace rcme
