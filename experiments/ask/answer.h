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
#include "experiments/statistics/stated_sharpness.h"
#include "experiments/study/study.h"
#include "stats/constants.h"

namespace rcme {

struct AskedEstimator {
  std::string label;
  Estimate success;                // of all trials; the intervals of all estimators hold together
  double time_ms = 0.0;            // mean of a call
  double median_error_deg = kNaN;  // of the greater of rotation and direction error; NaN: not known
  std::string inlier_threshold;    // in words; empty: not known
};

// How often two estimators end otherwise in the same trials.
struct AskedDifference {
  Estimate difference;              // of the rates of success, best minus next
  double p_value = 1.0;             // McNemar's, adjusted for all estimators that the best was chosen among
  std::int64_t trials_to_tell = 0;  // about so many tell them apart with probability 0.8
  // The same for a difference of kPlainDifference, where the two end otherwise as often as here.
  std::int64_t trials_of_plain_difference = 0;
};
inline constexpr double kPlainDifference = 0.01;

// Intervals hold for the best although the same trials chose it: those of all estimators hold together with
// probability 0.95 (Bonferroni).
struct Answer {
  std::int64_t num_trials = 0;
  int num_estimators = 0;
  FailureBounds failure;
  AskedEstimator best;
  std::vector<AskedEstimator> alike;   // the others whose success these trials cannot tell from its own
  std::optional<AskedEstimator> next;  // the second
  std::optional<AskedDifference> difference;
  double at_most = 0.0;  // the rate of failure that is asked for
  // The label of the estimator of which the next three are: the best, or, if that states no probability of
  // failure, the first alike that does. Empty: none does.
  std::string stating;
  std::optional<AcceptRule> rule;  // certified; nothing: none is
  Estimate stated, failed;         // mean stated probability, and rate of failure of the same answers
  Estimate coverage;               // of the 95 % region
  CoverageVerdict coverage_verdict;
  StatedSharpness sharpness;
};

// The best first: by success, then by the median error in two digits (not known: last), then by the time of
// a call.
void RankEstimators(std::vector<AskedEstimator>* estimators);

// To two digits: 0.1234 -> 0.12, 2994 -> 3000.
double RoundToTwoDigits(double value);

// Throws InputError for a run of several conditions, and for a trial that is not sound.
Answer AnswerQuestion(const ResultStore& run, double at_most, double sigma_px);

}  // namespace rcme
