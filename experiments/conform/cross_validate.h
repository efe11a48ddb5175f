// Judges answers by a rule that was fitted without them.
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/conform/conform_rule.h"
#include "experiments/conform/answer_row.h"
#include "experiments/conform/set_promises.h"
#include "stats/constants.h"

namespace rcme {

// One answer, judged by a rule that was fitted without its group.
struct JudgedAnswer {
  AnswerRow row;
  ConformVerdict verdict;
  double difficulty = 0.0;
  double level = 0.95;
  double one_factor = 1.0;            // baseline: plain conformal, one factor for all answers
  double ball_deg = 0.0;              // baseline: plain conformal bound of max_error_deg, no covariance
  bool is_accepted_by_count = false;  // baseline: an accept rule on the number of agreeing matches
  double rule_accepts = kNaN;         // cross-validation: share of all answers that its fold's rule accepts
};

inline constexpr size_t kNumFolds = 10, kMostGroupsOneByOne = 20;

// Uses ten folds of whole groups, or one fold per group if there are at most twenty. The answers of a fold
// are judged by the rule fitted to the other folds (fit_rule.h).
//
// An interval by groups computed from these verdicts estimates the mean performance of the folds' rules on
// new problems: given the rules, the sum over folds varies about that mean nearly as that of independent
// trials (Bayle et al. 2020). It does not estimate the mean over calibrations, nor the performance of the
// rule fitted to all answers: the thresholds of both depend on the few wrong answers, and so do the shares
// they accept. In a simulation, scores of right and wrong answers were normal, 5 % of 1,000 answers were
// wrong, and the promise was 2 % at risk 5 %. The share of calibrations whose 95 % interval missed a target:
//
//                             mean of the folds' rules   mean over calibrations   rule of all answers
//   accepted share                      3 %                      69 %                    29 %
//   wrong and accepted share            4 %                       0 %                     4 %
std::vector<JudgedAnswer> CrossValidate(const AnswerRows& answers, const ConformPromise& promise,
                                        const ConformRule* models = nullptr);

// Judges new answers by an existing rule. Leaves the baselines of JudgedAnswer at their defaults.
std::vector<JudgedAnswer> JudgeAnswers(const ConformRule& rule, const std::vector<AnswerRow>& rows);

}  // namespace rcme
