// From which stated probability of failure on to refuse an answer, so that accepted answers fail rarely.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "stats/risk_control.h"

namespace rcme {

// The accept rule: answers that state at most this probability of failure.
struct AcceptRule {
  double greatest_probability = 0.0;
  ErrorCount accepted;          // failures among the accepted answers
  std::int64_t num_trials = 0;  // of which those are accepted
};

struct StatedAnswer {
  double failure_probability = 0.0;
  bool has_failed = false;
};

// The rule with the greatest probability of a fixed list whose accepted answers fail in at most `at_most`.
// That is wrong with probability 0.05 at most for all rules of the list and all `num_estimators` together
// (Bonferroni, ExcessPValue): the estimator of `answers` may be chosen among them by the same `num_trials`
// trials. Nothing: no rule is certified.
std::optional<AcceptRule> CertifyAcceptRule(const std::vector<StatedAnswer>& answers, std::int64_t num_trials,
                                            double at_most, int num_estimators);

// The fewest accepted answers, all of them right, that certify a rule.
std::int64_t FewestCertifyingAnswers(double at_most, int num_estimators);

}  // namespace rcme
