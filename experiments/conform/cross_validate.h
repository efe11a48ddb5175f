// How well a rule does on answers that it has not seen.
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/conform/conform_rule.h"
#include "experiments/conform/answer_row.h"
#include "experiments/conform/set_promises.h"
#include "stats/constants.h"

namespace rcme {

// One answer, judged by a rule that has not seen it or any of its group.
struct JudgedAnswer {
  AnswerRow row;
  ConformVerdict verdict;
  double difficulty = 0.0;
  double level = 0.95;
  double one_factor = 1.0;            // plain conformal: a single factor for all answers
  double ball_deg = 0.0;              // plain conformal without a covariance: a bound of the greater error
  bool is_accepted_by_count = false;  // by the accept rule on the number of agreeing matches alone
  double rule_accepts = kNaN;         // of cross-validation: the share of all answers that its rule accepts
};

inline constexpr size_t kNumFolds = 10, kMostGroupsOneByOne = 20;

// Ten folds of whole groups; with at most twenty groups each is a fold. Each is judged by the rule of the
// others (fit_rule.h).
//
// What an interval by groups of these verdicts is of: the mean of the folds' rules, each on new problems.
// About that mean, given the rules, the sum over folds is nearly that of independent trials (Bayle et al.
// 2020). It is not of the mean over calibrations, nor of the rule of all answers: both thresholds move with
// the few wrong answers, and the share that is accepted with them. In a simulation (scores of right and wrong
// answers normal, 5 % wrong, 1,000 answers, promise 2 % at risk 5 %) 95 % intervals of the accepted share
// lacked the mean of the rules in 3 % of calibrations, the mean over calibrations in 69 %, the rule of all in
// 29 %; those of wrong and accepted answers in 4, 0 and 4 %.
std::vector<JudgedAnswer> CrossValidate(const AnswerRows& answers, const ConformPromise& promise,
                                        const ConformRule* models = nullptr);

// New answers, judged by a rule that is there.
std::vector<JudgedAnswer> JudgeAnswers(const ConformRule& rule, const std::vector<AnswerRow>& rows);

}  // namespace rcme
