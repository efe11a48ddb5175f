#include "experiments/conform/cross_validate.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "experiments/conform/fit_rule.h"

namespace rcme {
namespace {

double ComputeAcceptedShare(const ConformRule& rule, const std::vector<AnswerRow>& rows) {
  const auto num_accepted = std::ranges::count_if(rows, [&](const AnswerRow& row) {
    return rule.greatest_log_odds && rule.failure.At(row.features) <= *rule.greatest_log_odds;
  });
  return static_cast<double>(num_accepted) / static_cast<double>(rows.size());
}

}  // namespace

std::vector<JudgedAnswer> JudgeAnswers(const ConformRule& rule, const std::vector<AnswerRow>& rows) {
  const ConformJudge judge(rule);
  std::vector<JudgedAnswer> judged;
  for (const AnswerRow& row : rows) {
    JudgedAnswer& answer = judged.emplace_back();
    answer.row = row;
    answer.verdict = judge.Judge(row.features);
    answer.difficulty = rule.difficulty.At(row.features);
    answer.level = rule.level;
  }
  return judged;
}

std::vector<JudgedAnswer> CrossValidate(const AnswerRows& answers, const ConformPromise& promise,
                                        const ConformRule* models) {
  const std::map<std::int64_t, size_t> places = ShuffleGroups(answers);
  const size_t num_folds = places.size() <= kMostGroupsOneByOne ? places.size() : kNumFolds;
  std::vector<JudgedAnswer> judged;
  for (size_t fold = 0; num_folds > 1 && fold < num_folds; ++fold) {
    const auto is_held_out = [&](std::int64_t group) { return places.at(group) % num_folds == fold; };
    const AnswerRows held_out = answers.Part(is_held_out),
                     others = answers.Part([&](std::int64_t group) { return !is_held_out(group); });
    if (others.rows.empty()) continue;
    const ConformRule rule = FitConformRule(others, promise, models);
    const double one_factor =
        ComputeFactor(ComputeBound(others.rows, promise.level, &AnswerRow::nees), promise.level);
    const double ball_deg = ComputeBound(others.rows, promise.level, &AnswerRow::max_error_deg);
    const std::optional<double> by_count = CertifyThreshold(others, ScoreByAgreeing(others.rows), promise);
    const double rule_accepts = ComputeAcceptedShare(rule, answers.rows);
    for (JudgedAnswer& answer : JudgeAnswers(rule, held_out.rows)) {
      answer.rule_accepts = rule_accepts;
      answer.one_factor = one_factor;
      answer.ball_deg = ball_deg;
      answer.is_accepted_by_count = by_count && ScoreByAgreeing({answer.row}).front() <= *by_count;
      judged.push_back(std::move(answer));
    }
  }
  return judged;
}

}  // namespace rcme
