// Fits a rule (estimator/conform/conform_rule.h) to answers with known truth.
//
// Answers that depend on each other form a group. Three tenths of the groups train two logistic models of the
// visible features: the difficulty, P(the normalised error is among the greatest fifth), and the odds of a
// wrong motion. The models may be chosen freely. The other groups set everything that is promised:
//
//   factors      for each stratum of difficulty, the conformal bound of its normalised errors
//                (stats/conformal.h). There are at most ten strata, so few that each should have three times
//                the groups that a bound needs.
//   log odds     the correction a + b x of the log odds x, by logistic regression with a prior at (0, 1)
//   accept rule  thresholds of the odds in a fixed order, from strict to lax, are certified one by one until
//                one fails (stats/risk_control.h). The certified quantity is P(a problem is answered wrongly
//                and accepted); the test is the exact binomial one or, if problems share groups, the bound
//                for the groups' mean losses.
//
// No model is trained with fewer than 150 answers or 40 groups, or if all groups suffice for the accept rule
// but seven tenths of them do not. The rule then has one stratum. Its odds are those that the estimator
// states; if it states none, more agreeing matches mean lower odds.
#pragma once

#include <cstdint>

#include "estimator/conform/conform_rule.h"
#include "experiments/conform/answer_row.h"
#include "experiments/conform/set_promises.h"

namespace rcme {

inline constexpr double kTrainedShare = 0.3;
inline constexpr size_t kLeastAnswers = 150;  // to train models, as is kLeastGroups
inline constexpr std::int64_t kLeastGroups = 40;

// Sets every field of the rule except estimator, options, origin and failure bounds. With `models`,
// difficulty and odds are taken from that rule, which was fitted to other answers, and all of `answers` set
// the promises. Throws InputError if there are no answers.
ConformRule FitConformRule(const AnswerRows& answers, const ConformPromise& promise,
                           const ConformRule* models = nullptr);

}  // namespace rcme
