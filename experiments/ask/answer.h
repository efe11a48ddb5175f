// Answers a question (question.h) from the run of its study: the best estimator, the stated probability above
// which to refuse its answers, how far it can be trusted, and how many trials were and would be needed.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/ask/question.h"
#include "experiments/core/table/table.h"
#include "experiments/run/store/result_store.h"
#include "experiments/statistics/coverage_verdict.h"
#include "experiments/statistics/stated_sharpness.h"
#include "experiments/study/study.h"
#include "parameters/settings.h"
#include "stats/constants.h"
#include "stats/risk_control.h"

namespace rcme {

// The stated probability of failure above which an answer is refused, so that accepted answers rarely fail:
// accepts the answers that state at most greatest_probability.
struct AcceptRule {
  double greatest_probability = 0.0;
  ErrorCount accepted;          // failures among the accepted answers
  std::int64_t num_trials = 0;  // all trials, with and without an accepted answer
};

struct StatedAnswer {
  double failure_probability = 0.0;
  bool has_failed = false;
};

// Tries the rules of a fixed list of probabilities and returns the certified one with the greatest. A rule is
// certified if ExcessPValue rejects "its accepted answers fail at a rate above at_most". The probability of
// any wrong certificate is at most 0.05 over all rules of the list and all `num_estimators` together
// (Bonferroni). The estimator of `answers` may therefore be chosen by the same `num_trials` trials. Returns
// std::nullopt if no rule is certified.
std::optional<AcceptRule> CertifyAcceptRule(const std::vector<StatedAnswer>& answers, std::int64_t num_trials,
                                            double at_most, int num_estimators);

// The least number of accepted answers that certifies a rule if none of them failed.
std::int64_t FewestCertifyingAnswers(double at_most, int num_estimators);

// Which matches an estimator takes for inliers.
struct InlierThreshold {
  double px = kNaN;   // NaN: it has none in px
  std::string words;  // with units, the distance that it bounds, and as its library takes it; empty: unknown
};

struct AskedEstimator {
  std::string label;
  Estimate success;                // share of all trials; the intervals of all estimators hold jointly
  double time_ms = 0.0;            // mean of a call
  double median_error_deg = kNaN;  // median of max(rotation error, direction error); NaN: unknown
  bool states_p = false;           // the probability of failure of its answers
  InlierThreshold inlier_threshold;
  double coverage = kNaN;  // of its 95 % region; NaN: unknown
};

// The difference between the two best estimators, from the same trials.
struct AskedDifference {
  // Success rate of the best minus that of the next. The interval contains 0 unless p_value < 0.05.
  Estimate difference;
  // McNemar's, adjusted for all pairs of estimators, as the best was chosen by the same trials.
  double p_value = 1.0;
  std::int64_t trials_to_tell = 0;  // about so many trials tell the two apart with probability 0.8
  // The same if the success rates differed by kPlainDifference and the outcomes disagreed as often as here.
  std::int64_t trials_of_plain_difference = 0;
};
inline constexpr double kPlainDifference = 0.01;

// An estimator works if its success rate can be at least this.
inline constexpr double kLeastSuccess = 0.5;

// The intervals of all estimators hold jointly with probability 0.95 (Bonferroni). They therefore hold for
// the best estimator although the same trials chose it.
struct Answer {
  std::int64_t num_trials = 0;
  int num_estimators = 0;
  FailureBounds failure;
  // False: success is that of the rotation, whether or not the answer has a direction; P is not judged, as it
  // is the probability that rotation or direction is wrong.
  bool has_direction = true;
  double focal_error = 0.0;  // from the question
  AskedEstimator best;
  bool works = true;  // false: the success interval of the best, and so of all, lies below kLeastSuccess
  std::vector<AskedEstimator> alike;   // others whose success is not significantly below that of the best
  std::optional<AskedEstimator> next;  // the second in rank
  std::optional<AskedDifference> difference;
  Estimate error_difference;  // median difference of the errors of `next` from those of the best, deg
  double at_most = 0.0;       // the greatest failure rate of accepted answers, from the question
  // The label of the estimator that `rule`, `stated` and `failed` describe: the best if it states a
  // probability of failure, else the first in `alike` that does; empty if none does.
  std::string stating;
  std::optional<AcceptRule> rule;  // std::nullopt: no rule is certified
  Estimate stated, failed;         // mean stated probability of failure; failure rate of the same answers
  Estimate coverage;               // of the best estimator's 95 % region, as the next two
  RegionVerdict coverage_verdict = RegionVerdict::kUndecided;
  // About how many trials would show that the region covers as stated, if its coverage is the nominal one. It
  // does not depend on the measured coverage, whose chance errors would make it vary by orders of magnitude.
  double trials_to_confirm_coverage = 0.0;
  StatedSharpness sharpness;
};

// Whether the errors of the first are greater than those of the second, on the same trials and by more than
// chance.
using HasGreaterError = std::function<bool(const AskedEstimator&, const AskedEstimator&)>;

// Sorts the best first: by success; of those that succeed equally often an estimator comes before those with
// greater errors; then by the time of a call; of those that are about as fast one that states P comes first.
void RankEstimators(std::vector<AskedEstimator>* estimators, const HasGreaterError& has_greater_error);

// Throws InputError if the run has several conditions or a damaged trial.
Answer AnswerQuestion(const ResultStore& run, const Question& question, double at_most);

// Describes which matches the built-in estimator `name` takes for inliers with these options, for the noise
// and focal length of the question: "1.37 px of Sampson distance (1.96 sigma: ...)", "none in px: ...".
InlierThreshold DescribeInlierThreshold(const std::string& name, const Settings& options,
                                        const Question& question);

}  // namespace rcme
