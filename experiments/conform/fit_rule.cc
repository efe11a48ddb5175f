#include "experiments/conform/fit_rule.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <vector>

#include "estimator/conform/conform_rule.h"
#include "experiments/conform/answer_row.h"
#include "parameters/input_error.h"
#include "stats/conformal.h"
#include "stats/logistic_regression.h"
#include "stats/moments.h"
#include "stats/risk_control.h"

namespace rcme {
namespace {

using Rows = std::vector<AnswerRow>;

constexpr double kHardShare = 0.2;
constexpr double kPenalty = 2.0;  // on the weights of standardised features
constexpr size_t kMostStrata = 10;
constexpr size_t kStatedOdds = static_cast<size_t>(VisibleFeature::kStatedOdds),
                 kAgreeing = static_cast<size_t>(VisibleFeature::kAgreeing);

// Whether at most one in twenty answers lacks the feature.
bool HasFeature(const std::vector<AnswerRow>& rows, size_t feature) {
  constexpr double kMostMissing = 0.05;
  const auto missing =
      std::ranges::count_if(rows, [&](const AnswerRow& row) { return std::isnan(row.features[feature]); });
  return static_cast<double>(missing) <= kMostMissing * static_cast<double>(rows.size());
}

// Terms with the mean and standard deviation of each feature's known values as centre and scale. Constant
// features get no term.
std::vector<FeatureModel::Term> StandardTerms(const Rows& rows) {
  std::vector<FeatureModel::Term> terms;
  for (size_t feature = 0; feature < kNumVisibleFeatures; ++feature) {
    if (!HasFeature(rows, feature)) continue;
    Moments moments;
    for (const AnswerRow& row : rows)
      if (!std::isnan(row.features[feature])) moments.Add(row.features[feature]);
    const double scale = std::sqrt(moments.variance());
    constexpr double kLeastScale = 1e-6;
    if (!(scale > kLeastScale)) continue;
    terms.push_back({feature, moments.mean(), scale, 0.0, 0.0});
  }
  return terms;
}

// Fits the log odds of an event to all features. `has_prior`: the prior takes the stated odds as right.
FeatureModel FitModel(const Rows& rows, const std::vector<bool>& happened, bool has_prior) {
  FeatureModel model{0.0, StandardTerms(rows)};
  std::vector<double> prior;
  for (const FeatureModel::Term& term : model.terms) {
    prior.push_back(has_prior && term.feature == kStatedOdds ? term.scale : 0.0);
    prior.push_back(0.0);
  }
  std::vector<double> features;
  for (const AnswerRow& row : rows) {
    for (const FeatureModel::Term& term : model.terms) {
      const double z = ScoreOfFeature(term, row.features[term.feature]);
      features.push_back(z);
      features.push_back(std::isnan(row.features[term.feature]) ? 0.0 : z * z - 1.0);
    }
  }
  const LogisticFit fit = FitLogistic(features, happened, prior, kPenalty);
  model.intercept = fit.intercept;
  for (size_t i = 0; i < model.terms.size(); ++i) {
    model.terms[i].linear = fit.weights[2 * i];
    model.terms[i].square = fit.weights[2 * i + 1];
  }
  return model;
}

// The log odds are sign * x of one feature x, up to the limits of ScoreOfFeature.
FeatureModel OneFeature(size_t feature, double sign) {
  constexpr double kScale = 4.0;
  return {0.0, {{feature, 0.0, kScale, sign * kScale, 0.0}}};
}

// The model's log odds for each row.
std::vector<double> ComputeLogOdds(const FeatureModel& model, const std::vector<AnswerRow>& rows) {
  std::vector<double> difficulties;
  for (const AnswerRow& row : rows) difficulties.push_back(model.At(row.features));
  return difficulties;
}

// Trains the rule's models, which predict difficulty and failure from the visible features of an answer.
// These answers must not set promises (fit_rule.h).
void TrainModels(const std::vector<AnswerRow>& rows, ConformRule* rule) {
  std::vector<double> nees;
  for (const AnswerRow& row : rows) nees.push_back(row.nees);
  const auto hard =
      nees.begin() + static_cast<std::ptrdiff_t>((1.0 - kHardShare) * static_cast<double>(nees.size()));
  std::ranges::nth_element(nees, hard);
  std::vector<bool> is_hard, is_wrong;
  for (const AnswerRow& row : rows) {
    is_hard.push_back(row.nees >= *hard);
    is_wrong.push_back(row.is_wrong);
  }
  rule->difficulty = FitModel(rows, is_hard, /*has_prior=*/false);
  rule->failure = FitModel(rows, is_wrong, /*has_prior=*/true);
}

// Sets untrained models: none of difficulty; failure by the stated odds or, if the estimator states none, by
// the number of agreeing matches.
void UseNoModel(const std::vector<AnswerRow>& rows, ConformRule* rule) {
  rule->difficulty = {};
  rule->failure = HasFeature(rows, kStatedOdds) ? OneFeature(kStatedOdds, 1.0) : OneFeature(kAgreeing, -1.0);
}

// Edges between strata of difficulty that have equally many of `rows` each. Chooses the most strata, at most
// ten, for which each has enough groups to set its factor, counted by the shares of its answers. The factors
// are set by `factor` times as many groups as `rows` have.
std::vector<double> ChooseEdges(const FeatureModel& difficulty, const std::vector<AnswerRow>& rows,
                                double factor, double level) {
  const std::vector<double> difficulties = ComputeLogOdds(difficulty, rows);
  std::vector<double> sorted = difficulties;
  std::ranges::sort(sorted);
  const double needed = 3.0 * static_cast<double>(FewestGroupsForBound(level)) / factor;
  for (size_t num_strata = kMostStrata; num_strata > 1; --num_strata) {
    std::vector<double> edges;
    for (size_t k = 1; k < num_strata; ++k) {
      const size_t i = k * sorted.size() / num_strata;
      if (i > 0) edges.push_back(0.5 * (sorted[i - 1] + sorted[i]));
    }
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::vector<double> groups(edges.size() + 1, 0.0);
    for (size_t i = 0; i < rows.size(); ++i) {
      const auto k = std::ranges::upper_bound(edges, difficulties[i]) - edges.begin();
      groups[static_cast<size_t>(k)] += rows[i].share;
    }
    if (std::ranges::all_of(groups, [&](double count) { return count >= needed; })) return edges;
  }
  return {};
}

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
