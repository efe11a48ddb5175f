// The part of a rule that is promised: factors, log odds and threshold, set by answers that its models have
// not seen (fit_rule.h).
#pragma once

#include <optional>
#include <vector>

#include "estimator/conform/conform_rule.h"
#include "experiments/conform/answer_row.h"

namespace rcme {

struct ConformPromise {
  double level = 0.95;               // of the regions
  double wrong_and_accepted = 0.02;  // at most, of the problems
  double risk = 0.05;                // probability that the accept rule breaks its promise
};

// The conformal bound of a score at the level, by answers that count by their shares.
double ComputeBound(const std::vector<AnswerRow>& rows, double level, double AnswerRow::*score);

// What makes the ellipsoid of the covariance at this level hold normalised errors up to `bound`.
double ComputeFactor(double bound, double level);

// A factor for each of the rule's strata of difficulty.
void SetFactors(const std::vector<AnswerRow>& rows, ConformRule* rule);

// The slope and the intercept of the rule's log odds of a wrong motion.
void CorrectLogOdds(const std::vector<AnswerRow>& rows, ConformRule* rule);

// The laxest certified threshold of `scores`, the greater the worse; nothing: none is. What is tested at each
// is "P(a problem is answered wrongly, at most the threshold) exceeds what is promised".
std::optional<double> CertifyThreshold(const AnswerRows& answers, const std::vector<double>& scores,
                                       const ConformPromise& promise);

// For CertifyThreshold, the fewer agreeing matches the worse.
std::vector<double> ScoreByAgreeing(const std::vector<AnswerRow>& rows);

}  // namespace rcme
