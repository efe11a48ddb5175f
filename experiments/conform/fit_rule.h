// From answers with truth to a rule (estimator/conform/conform_rule.h), and how well such rules do on answers
// that they have not seen.
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
#include <span>
#include <vector>

#include "estimator/conform/conform_rule.h"
#include "experiments/conform/answer_row.h"
#include "stats/random.h"

namespace rcme {

struct ConformPromise {
  double level = 0.95;               // of the regions
  double wrong_and_accepted = 0.02;  // at most, of the problems
  double risk = 0.05;                // probability that the accept rule breaks its promise
};

// Everything but what it was made for (estimator, options, origin, bounds). With `models` nothing is trained:
// difficulty and odds are those of that rule, of other answers, and all of these set promises. Throws
// InputError without answers.
ConformRule FitConformRule(const AnswerRows& answers, const ConformPromise& promise,
                           const ConformRule* models = nullptr);

// One answer, judged by a rule that has not seen it or any of its group.
struct JudgedAnswer {
  AnswerRow row;
  ConformVerdict verdict;
  double difficulty = 0.0;
  double level = 0.95;
  double one_factor = 1.0;            // plain conformal: a single factor for all answers
  double ball_deg = 0.0;              // plain conformal without a covariance: a bound of the greater error
  bool is_accepted_by_count = false;  // by the accept rule on the number of agreeing matches alone
};

inline constexpr size_t kNumFolds = 10, kMostGroupsOneByOne = 20;
inline constexpr double kTrainedShare = 0.3;
inline constexpr size_t kLeastAnswers = 150;  // to train a model
inline constexpr std::int64_t kLeastGroups = 40;

// Ten folds of whole groups; with at most twenty groups each is a fold. Each is judged by the rule of the
// others.
std::vector<JudgedAnswer> CrossValidate(const AnswerRows& answers, const ConformPromise& promise,
                                        const ConformRule* models = nullptr);

// New answers, judged by a rule that is there.
std::vector<JudgedAnswer> JudgeAnswers(const ConformRule& rule, const std::vector<AnswerRow>& rows);

}  // namespace rcme
