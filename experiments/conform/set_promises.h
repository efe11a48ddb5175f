// Sets the promised part of a rule: factors, log odds and threshold. The answers must be new to the rule's
// models (fit_rule.h).
#pragma once

#include <optional>
#include <vector>

#include "estimator/conform/conform_rule.h"
#include "experiments/conform/answer_row.h"

namespace rcme {

struct ConformPromise {
  double level = 0.95;               // coverage of the regions
  double wrong_and_accepted = 0.02;  // greatest share of problems answered wrongly and accepted
  double risk = 0.05;                // probability that the accept rule breaks its promise
};

// The conformal bound of a score at the level; answers are weighted by their shares.
double ComputeBound(const std::vector<AnswerRow>& rows, double level, double AnswerRow::*score);

// The factor of the covariance with which its ellipsoid at this level contains normalised errors up to
// `bound`.
double ComputeFactor(double bound, double level);

// Appends a factor for each of the rule's strata of difficulty.
void SetFactors(const std::vector<AnswerRow>& rows, ConformRule* rule);

// Sets slope and intercept of the rule's log odds of a wrong motion.
void CorrectLogOdds(const std::vector<AnswerRow>& rows, ConformRule* rule);

// The laxest certified threshold of `scores`, one per answer, greater is worse; std::nullopt if none is
// certified. The hypothesis tested at a threshold is "P(a problem is answered wrongly with a score up to the
// threshold) exceeds promise.wrong_and_accepted".
std::optional<double> CertifyThreshold(const AnswerRows& answers, const std::vector<double>& scores,
                                       const ConformPromise& promise);

// Scores for CertifyThreshold: minus the number of agreeing matches.
std::vector<double> ScoreByAgreeing(const std::vector<AnswerRow>& rows);

}  // namespace rcme
