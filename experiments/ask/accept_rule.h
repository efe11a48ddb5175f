// The stated probability of failure above which an answer is refused, so that accepted answers rarely fail.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "stats/risk_control.h"

namespace rcme {

// Accepts the answers that state at most greatest_probability.
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

}  // namespace rcme
