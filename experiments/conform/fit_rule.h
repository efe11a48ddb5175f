// From answers with truth to a rule (estimator/conform/conform_rule.h).
//
// Of n groups (answers that depend on each other are of one), three tenths train what may be chosen freely:
// the difficulty, a logistic model of "the normalised error is among the greatest fifth", and the odds of a
// wrong motion, a logistic model of "the motion is wrong"; both of what can be seen of an answer. On the
// others, which the models have not seen, everything that is promised is set:
//
//   factors      in each stratum of difficulty the conformal bound of the normalised errors
//                (stats/conformal.h); as many strata, at most ten, as have three times the groups each that a
//                bound needs
//   log odds     their correction a + b x, by logistic regression with a prior at (0, 1)
//   accept rule  thresholds of the odds, from strict to lax and fixed beforehand, certified one by one until
//                one is not (stats/risk_control.h): of P(a problem is answered wrongly and accepted), the
//                exact binomial test, or, where problems share groups, the bound for the groups' mean losses
//
// Nothing is trained with fewer than 150 answers or 40 groups, nor where the groups would be enough for the
// accept rule but seven tenths of them are not: one stratum, the stated odds or, where the estimator states
// none, the fewer agreeing matches the worse.
#pragma once

#include <cstdint>

#include "estimator/conform/conform_rule.h"
#include "experiments/conform/answer_row.h"
#include "experiments/conform/set_promises.h"

namespace rcme {

inline constexpr double kTrainedShare = 0.3;
inline constexpr size_t kLeastAnswers = 150;  // to train a model
inline constexpr std::int64_t kLeastGroups = 40;

// Everything but what it was made for (estimator, options, origin, bounds). With `models` nothing is trained:
// difficulty and odds are those of that rule, of other answers, and all of these set promises. Throws
// InputError without answers.
ConformRule FitConformRule(const AnswerRows& answers, const ConformPromise& promise,
                           const ConformRule* models = nullptr);

}  // namespace rcme
