// What a run of the study of a question (question.h) says: which estimator, from which stated probability on,
// how far it can be trusted, how many trials.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/core/table/table.h"
#include "experiments/run/store/result_store.h"
#include "experiments/statistics/coverage_verdict.h"
#include "stats/risk_control.h"

namespace rcme {

struct AskedEstimator {
  std::string label;
  Estimate success;      // of all trials
  double time_ms = 0.0;  // mean of a call
};

// The accept rule: answers that state at most this probability of failure.
struct AcceptRule {
  double greatest_probability = 0.0;
  ErrorCount accepted;          // failures among the accepted answers
  std::int64_t num_trials = 0;  // of which those are accepted
};

// How often two estimators end otherwise in the same trials.
struct AskedDifference {
  Estimate difference;              // of the rates of success, best minus next
  double p_value = 1.0;             // McNemar's, adjusted for all estimators that the best was chosen among
  std::int64_t trials_to_tell = 0;  // about so many tell them apart with probability 0.8
};

struct Answer {
  std::int64_t num_trials = 0;
  AskedEstimator best;
  std::optional<AskedEstimator> next;  // the second in success
  std::optional<AskedDifference> difference;
  double at_most = 0.0;             // the rate of failure that is asked for
  bool states_probability = false;  // the best does
  std::optional<AcceptRule> rule;   // certified at 95 %; nothing: none is
  Estimate stated, failed;          // mean stated probability, and rate of failure of the same answers
  Estimate coverage;                // of the 95 % region
};

// The accept rule with the greatest probability of a fixed list, whose accepted answers fail in at most
// `at_most`, except with probability 0.05 for the whole list (Bonferroni, ExcessPValue); `answers` are stated
// probabilities with what became of them, of `num_trials` trials. Nothing: no rule is certified.
struct StatedAnswer {
  double failure_probability = 0.0;
  bool has_failed = false;
};
std::optional<AcceptRule> CertifyAcceptRule(const std::vector<StatedAnswer>& answers, std::int64_t num_trials,
                                            double at_most);

// Throws InputError for a run of several conditions, and for a trial that is not sound.
Answer AnswerQuestion(const ResultStore& run, double at_most);

// For people: a line per part of the answer; `folder` holds study.yaml and run.sqlite.
std::string AnswerAsText(const Answer& answer, const std::string& question, const std::string& folder);
std::string AnswerAsJson(const Answer& answer, const std::string& question);

}  // namespace rcme
