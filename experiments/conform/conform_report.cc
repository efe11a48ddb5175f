#include "experiments/conform/conform_report.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "stats/exchangeability.h"

namespace rcme {

ShiftFinding LookForShift(const ConformRule& rule, const std::vector<AnswerRow>& rows) {
  ShiftFinding finding;
  if (rule.familiar_features.empty()) return finding;
  const RandomStream rng({.seed = 1, .condition = 0, .trial = 0, .purpose = 2});
  ExchangeabilityTest test(rule.familiar, rule.familiar_features.size(), rng);
  const ConformJudge judge(rule);
  std::set<std::int64_t> groups;
  std::int64_t num_strange = 0, num_whole = 0;
  std::vector<AnswerRow> mixed = rows;  // conditions one after the other would be a shift of their own
  RandomStream order({.seed = 1, .condition = 0, .trial = 0, .purpose = 3});
  order.Shuffle(std::span(mixed));
  for (const AnswerRow& row : mixed) {
    std::vector<double> features;
    for (const size_t feature : rule.familiar_features) features.push_back(row.features[feature]);
    if (std::ranges::any_of(features, [](double x) { return std::isnan(x); })) continue;
    ++num_whole;
    num_strange += judge.Judge(row.features).familiarity <= kStrangeLevel;
    if (rule.origin.new_groups && !groups.insert(row.group).second) continue;
    test.Add(features);
    if (!finding.noticed_after && test.PValue() <= kShiftLevel)
      finding.noticed_after = static_cast<std::int64_t>(test.n());
  }
  finding.num_looked_at = static_cast<std::int64_t>(test.n());
  finding.p_value = test.PValue();
  finding.feature = VisibleFeatureNames()[rule.familiar_features[test.StrongestFeature()]];
  if (num_whole > 0)
    finding.strange_share = static_cast<double>(num_strange) / static_cast<double>(num_whole);
  return finding;
}

ConformReport CalibrateConform(const StudyPlan& plan, NewProblem new_problem, const ConformPromise& promise,
                               const ConformRule* models, const AnswerRows& answers) {
  const EstimatorSpec& spec = plan.study.estimators.front();
  ConformReport report;
  report.label = spec.label;
  report.rule = FitConformRule(answers.rows, promise, models);
  report.rule.estimator = spec.name;
  report.rule.options = spec.options;
  report.rule.max_rotation_error_deg = plan.study.failure.max_rotation_error_deg;
  report.rule.max_direction_error_deg = plan.study.failure.max_direction_error_deg;
  report.rule.origin = {plan.study.name, std::ssize(answers.rows), answers.num_refusals,
                        CountGroups(answers.rows), new_problem == NewProblem::kCondition};
  report.judged = CrossValidate(answers.rows, promise, models);
  report.num_refusals = answers.num_refusals;
  report.num_unscored = answers.num_unscored;
  return report;
}

ConformReport CheckConform(const StudyPlan& plan, const ConformRule& rule, const AnswerRows& answers) {
  ConformReport report;
  report.is_check = true;
  report.label = plan.study.estimators.front().label;
  report.rule = rule;
  report.judged = JudgeAnswers(rule, answers.rows);
  report.shift = LookForShift(rule, answers.rows);
  report.num_refusals = answers.num_refusals;
  report.num_unscored = answers.num_unscored;
  return report;
}

}  // namespace rcme
