// What a run of the study of a question (question.h) says: which estimator, from which stated probability on,
// how far it can be trusted, how many trials.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/ask/accept_rule.h"
#include "experiments/core/table/table.h"
#include "experiments/run/store/result_store.h"
#include "experiments/statistics/coverage_verdict.h"
#include "experiments/study/study.h"
#include "stats/constants.h"

namespace rcme {

struct AskedEstimator {
  std::string label;
  Estimate success;                // of all trials; the intervals of all estimators hold together
  double time_ms = 0.0;            // mean of a call
  double median_error_deg = kNaN;  // of the greater of rotation and direction error; NaN: not known
  std::string inlier_threshold;    // in words; empty: its options do not say
};

// How often two estimators end otherwise in the same trials.
struct AskedDifference {
  Estimate difference;              // of the rates of success, best minus next
  double p_value = 1.0;             // McNemar's, adjusted for all estimators that the best was chosen among
  std::int64_t trials_to_tell = 0;  // about so many tell them apart with probability 0.8
};

// Intervals hold for the best although the same trials chose it: those of all estimators hold together with
// probability 0.95 (Bonferroni).
struct Answer {
  std::int64_t num_trials = 0;
  int num_estimators = 0;
  int num_alike = 1;  // estimators of as many successes as the best, itself included
  FailureBounds failure;
  AskedEstimator best;
  std::optional<AskedEstimator> next;  // the second
  std::optional<AskedDifference> difference;
  double at_most = 0.0;             // the rate of failure that is asked for
  bool states_probability = false;  // the best does
  std::optional<AcceptRule> rule;   // certified; nothing: none is
  Estimate stated, failed;          // mean stated probability, and rate of failure of the same answers
  Estimate coverage;                // of the 95 % region
  // Medians of what the covariances state, without intervals; NaN: not known.
  double sd_over_crb = kNaN, rotation_sd_deg = kNaN, direction_sd_deg = kNaN;
};

// The best first: by success, then by the median error (not known: last), then by the time of a call.
void RankEstimators(std::vector<AskedEstimator>* estimators);

// From the options of an estimator: "none: it weighs every match, sigma = 0.7 px is where it begins",
// "2 sigma = 1.4 px". Empty: they do not say.
std::string DescribeInlierThreshold(const Settings& options, double sigma_px);

// Throws InputError for a run of several conditions, and for a trial that is not sound.
Answer AnswerQuestion(const ResultStore& run, double at_most, double sigma_px);

}  // namespace rcme
