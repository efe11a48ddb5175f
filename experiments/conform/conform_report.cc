#include "experiments/conform/conform_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <span>

#include "estimator/conform/conform_file.h"
#include "experiments/conform/fit_rule.h"
#include "parameters/input_error.h"
#include "stats/exchangeability.h"
#include "stats/fnv1a.h"
#include "stats/random.h"

namespace rcme {
namespace {

constexpr double kShiftLevel = 0.05;
constexpr size_t kMostRefusals = 2000;  // a longer reference is thinned to about so many

// Shuffled: the test would take the order by conditions for a shift.
template <typename T>
std::vector<T> Mixed(std::vector<T> items) {
  RandomStream order({.seed = 1, .condition = 0, .trial = 0, .purpose = 3});
  order.Shuffle(std::span(items));
  return items;
}

// The first of each group.
template <typename T>
std::vector<T> FirstOfGroups(const std::vector<T>& items) {
  std::vector<T> first;
  std::set<std::int64_t> groups;
  for (const T& item : items)
    if (groups.insert(item.group).second) first.push_back(item);
  return first;
}

void LookForStrangeAnswers(const ConformRule& rule, const std::vector<AnswerRow>& rows,
                           ShiftFinding* finding) {
  const size_t width = rule.familiar_features.size();
  if (width == 0) return;
  ExchangeabilityTest test(rule.familiar, width,
                           RandomStream({.seed = 1, .condition = 0, .trial = 0, .purpose = 2}));
  for (const AnswerRow& row : Mixed(FirstOfGroups(rows))) {
    std::vector<double> features;
    for (const size_t feature : rule.familiar_features) features.push_back(row.features[feature]);
    test.Add(features);
    if (!finding->noticed_after && test.PValue() <= kShiftLevel / 2.0)
      finding->noticed_after = static_cast<std::int64_t>(test.n());
  }
  finding->num_looked_at = static_cast<std::int64_t>(test.n());
  finding->p_value = std::min(1.0, 2.0 * test.PValue());
  finding->feature = VisibleFeatureNames()[rule.familiar_features[test.StrongestFeature()]];
  // An answer hardly multiplies a feature's capital by more than sqrt(n) / 2, n: familiar answers and itself.
  const double num_familiar = static_cast<double>(rule.familiar.size() / width);
  const double greatest = std::pow(0.5 * std::sqrt(num_familiar + 1.0), finding->num_looked_at);
  finding->could_notice = greatest >= 2.0 * static_cast<double>(width) / kShiftLevel;
}

void LookForRefusals(const ConformRule& rule, const std::vector<AskedProblem>& problems,
                     ShiftFinding* finding) {
  const auto num_groups = static_cast<size_t>(rule.origin.num_groups);
  const size_t step = std::max<size_t>(1, num_groups / kMostRefusals);
  std::vector<double> reference;
  for (size_t i = 0; i < num_groups; i += step)
    reference.push_back(i < static_cast<size_t>(rule.origin.num_refused_groups) ? 1.0 : 0.0);
  ExchangeabilityTest test(reference, 1, RandomStream({.seed = 1, .condition = 0, .trial = 0, .purpose = 4}));
  std::optional<std::int64_t> noticed_after;
  for (const AskedProblem& problem : Mixed(FirstOfGroups(problems))) {
    const double refused = problem.is_refused ? 1.0 : 0.0;
    test.Add({&refused, 1});
    if (!noticed_after && test.PValue() <= kShiftLevel / 2.0)
      noticed_after = static_cast<std::int64_t>(test.n());
  }
  const double p_value = std::min(1.0, 2.0 * test.PValue());
  if (p_value >= finding->p_value) return;
  finding->p_value = p_value;
  finding->feature = "refusals";
  if (noticed_after) finding->noticed_after = noticed_after;
}

std::vector<std::uint64_t> NamesOfProblems(const StudyPlan& plan, const Condition& condition) {
  std::vector<std::uint64_t> names = condition.source->ProblemNames();
  if (!names.empty()) return names;
  Fnv1a hash;
  hash.Add(fmt::format("seed {} stream {}", plan.study.seed, condition.stream_key));
  return {hash.value()};
}

// Names the problems of a plan: a simulated condition by its random streams, a real pair by its matches.
// Ascending. Trials begin at 0, so that plans with a name in common have problems in common.
std::vector<std::string> ConformProblems(const StudyPlan& plan) {
  std::set<std::string> names;
  for (const Condition& condition : plan.conditions)
    for (const std::uint64_t name : NamesOfProblems(plan, condition))
      names.insert(fmt::format("{:016x}", name));
  return {names.begin(), names.end()};
}

}  // namespace

ShiftFinding LookForShift(const ConformRule& rule, const AnswerRows& answers) {
  ShiftFinding finding;
  LookForStrangeAnswers(rule, answers.rows, &finding);
  LookForRefusals(rule, answers.problems, &finding);
  const ConformJudge judge(rule);
  const auto num_strange = std::ranges::count_if(answers.rows, [&](const AnswerRow& row) {
    return judge.Judge(row.features).familiarity <= kStrangeLevel;
  });
  if (!answers.rows.empty())
    finding.strange_share = static_cast<double>(num_strange) / static_cast<double>(answers.rows.size());
  return finding;
}

ConformRule LoadToCheck(const StudyPlan& plan, const std::string& path) {
  ConformRule rule = ReadConformFile(path).rule;
  const std::vector<std::string> problems = ConformProblems(plan);
  std::vector<std::string> both;
  std::ranges::set_intersection(rule.origin.problems, problems, std::back_inserter(both));
  if (both.empty()) return rule;
  const bool is_real = HasRealScenes(plan);
  throw InputError(
      fmt::format("conform: {} is of these very problems in {} of {} {}, so that they are not new; give {}",
                  path, both.size(), problems.size(), is_real ? "pairs" : "conditions",
                  is_real ? "other pairs" : "another --seed or study"));
}

std::optional<ConformRule> LoadModels(const StudyPlan& plan, const std::string& path) {
  if (path.empty()) return std::nullopt;
  ConformRule rule = LoadToCheck(plan, path);
  if (rule.estimator != plan.study.estimators.front().name)
    throw InputError(fmt::format("conform: {} is of estimator {}, not {}", path, rule.estimator,
                                 plan.study.estimators.front().name));
  return rule;
}

ConformReport CalibrateConform(const StudyPlan& plan, NewProblem new_problem, const ConformPromise& promise,
                               const ConformRule* models, const AnswerRows& answers) {
  const EstimatorSpec& spec = plan.study.estimators.front();
  ConformReport report;
  report.label = spec.label;
  report.rule = FitConformRule(answers, promise, models);
  report.rule.estimator = spec.name;
  report.rule.options = spec.options;
  report.rule.max_rotation_error_deg = plan.study.failure.max_rotation_error_deg;
  report.rule.max_direction_error_deg = plan.study.failure.max_direction_error_deg;
  const std::vector<AskedProblem> first = FirstOfGroups(answers.problems);
  report.rule.origin = {plan.study.name,
                        ConformProblems(plan),
                        std::ssize(answers.rows),
                        answers.CountRefusals(),
                        std::ssize(first),
                        std::ranges::count(first, true, &AskedProblem::is_refused),
                        new_problem == NewProblem::kCondition};
  report.judged = CrossValidate(answers, promise, models);
  report.problems = answers.problems;
  report.has_real_truth = HasRealScenes(plan);
  report.num_unscored = answers.num_unscored;
  report.shares_images = new_problem == NewProblem::kTrial && HasRealScenes(plan);
  return report;
}

ConformReport CheckConform(const StudyPlan& plan, const ConformRule& rule, const AnswerRows& answers) {
  ConformReport report;
  report.is_check = true;
  report.label = plan.study.estimators.front().label;
  report.rule = rule;
  report.judged = JudgeAnswers(rule, answers.rows);
  report.shift = LookForShift(rule, answers);
  report.kept = TestPromises(rule, answers, report.judged);
  report.problems = answers.problems;
  report.has_real_truth = HasRealScenes(plan);
  report.num_unscored = answers.num_unscored;
  return report;
}

}  // namespace rcme
