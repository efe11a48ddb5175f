// How well a rule does on answers that it has not seen.
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/conform/conform_rule.h"
#include "experiments/conform/answer_row.h"
#include "experiments/conform/set_promises.h"

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
};

inline constexpr size_t kNumFolds = 10, kMostGroupsOneByOne = 20;

// Ten folds of whole groups; with at most twenty groups each is a fold. Each is judged by the rule of the
// others (fit_rule.h).
std::vector<JudgedAnswer> CrossValidate(const AnswerRows& answers, const ConformPromise& promise,
                                        const ConformRule* models = nullptr);

// New answers, judged by a rule that is there.
std::vector<JudgedAnswer> JudgeAnswers(const ConformRule& rule, const std::vector<AnswerRow>& rows);

}  // namespace rcme
