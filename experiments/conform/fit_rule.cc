#include "experiments/conform/fit_rule.h"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "experiments/conform/train_models.h"
#include "parameters/input_error.h"
#include "stats/risk_control.h"

namespace rcme {
namespace {

using Rows = std::vector<AnswerRow>;

constexpr size_t kMostFamiliar = 500;

// One answer of each group, spread evenly over all.
void SetFamiliar(const Rows& rows, ConformRule* rule) {
  for (size_t feature = 0; feature < kNumVisibleFeatures; ++feature)
    if (HasFeature(rows, feature)) rule->familiar_features.push_back(feature);
  Rows first;
  std::set<std::int64_t> groups;
  for (const AnswerRow& row : rows)
    if (groups.insert(row.group).second) first.push_back(row);
  const size_t step = std::max<size_t>(1, (first.size() + kMostFamiliar - 1) / kMostFamiliar);
  for (size_t i = 0; i < first.size(); i += step)
    for (const size_t feature : rule->familiar_features) rule->familiar.push_back(first[i].features[feature]);
}

struct SplitByGroup {
  AnswerRows trained, calibrated;
};
SplitByGroup SplitAnswers(const AnswerRows& answers, const ConformPromise& promise) {
  const std::map<std::int64_t, size_t> places = ShuffleGroups(answers);
  const auto num_groups = std::ssize(places);
  const auto num_trained = static_cast<std::int64_t>(kTrainedShare * static_cast<double>(num_groups));
  const std::int64_t for_rule = FewestCertifyingTrials(promise.wrong_and_accepted, promise.risk);
  const bool costs_the_rule = num_groups >= for_rule && num_groups - num_trained < for_rule;
  const bool trains = answers.rows.size() >= kLeastAnswers && num_groups >= kLeastGroups && !costs_the_rule;
  const auto is_trained = [&](std::int64_t group) {
    return trains && static_cast<std::int64_t>(places.at(group)) < num_trained;
  };
  return {answers.Part(is_trained), answers.Part([&](std::int64_t group) { return !is_trained(group); })};
}

}  // namespace

ConformRule FitConformRule(const AnswerRows& answers, const ConformPromise& promise,
                           const ConformRule* models) {
  if (answers.rows.empty()) throw InputError("conform: no answer has a truth to compare with");
  const SplitByGroup split = models != nullptr ? SplitByGroup{{}, answers} : SplitAnswers(answers, promise);
  const Rows &trained = split.trained.rows, &calibrated = split.calibrated.rows;
  ConformRule rule;
  rule.level = promise.level;
  rule.wrong_and_accepted = promise.wrong_and_accepted;
  rule.risk = promise.risk;
  if (models != nullptr) {
    rule.difficulty = models->difficulty;
    rule.failure = models->failure;
    rule.edges = ChooseEdges(rule.difficulty, calibrated, 1.0, rule.level);
  } else if (trained.empty()) {
    UseNoModel(calibrated, &rule);
  } else {
    TrainModels(trained, &rule);
    const auto factor = static_cast<double>(split.calibrated.CountGroups()) /
                        static_cast<double>(split.trained.CountGroups());
    rule.edges = ChooseEdges(rule.difficulty, trained, factor, rule.level);
  }
  SetFactors(calibrated, &rule);
  CorrectLogOdds(calibrated, &rule);
  rule.greatest_log_odds =
      CertifyThreshold(split.calibrated, ComputeLogOdds(rule.failure, calibrated), promise);
  SetFamiliar(answers.rows, &rule);
  return rule;
}

}  // namespace rcme
