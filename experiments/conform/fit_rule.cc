#include "experiments/conform/fit_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "parameters/input_error.h"
#include "stats/conformal.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/logistic_regression.h"
#include "stats/risk_control.h"

namespace rcme {
namespace {

using Rows = std::vector<AnswerRow>;

constexpr double kHardShare = 0.2;
constexpr double kPenalty = 2.0;       // of weights of standardised features
constexpr double kSlopePenalty = 5.0;  // of the slope of the log odds, from 1
constexpr size_t kMostStrata = 10, kMostFamiliar = 500;
constexpr size_t kStatedOdds = static_cast<size_t>(VisibleFeature::kStatedOdds),
                 kAgreeing = static_cast<size_t>(VisibleFeature::kAgreeing);
constexpr double kEverything = 1e9;  // log odds that every answer keeps

// A number for each group, in an order that says nothing of them: the same for the same groups.
std::map<std::int64_t, size_t> ShuffleGroups(const AnswerRows& answers) {
  std::set<std::int64_t> names;
  for (const AskedProblem& problem : answers.problems) names.insert(problem.group);
  std::vector<std::int64_t> order(names.begin(), names.end());
  RandomStream rng({.seed = 1, .condition = 0, .trial = 0, .purpose = 1});
  rng.Shuffle(std::span(order));
  std::map<std::int64_t, size_t> places;
  for (size_t i = 0; i < order.size(); ++i) places[order[i]] = i;
  return places;
}

bool HasFeature(const Rows& rows, size_t feature) {
  constexpr double kMostMissing = 0.05;
  const auto missing =
      std::ranges::count_if(rows, [&](const AnswerRow& row) { return std::isnan(row.features[feature]); });
  return static_cast<double>(missing) <= kMostMissing * static_cast<double>(rows.size());
}

// Centre and scale: mean and standard deviation of what is there; no term for a feature that is always the
// same.
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

// Log odds of an event by all features; `has_prior`: the stated odds are right unless the answers say
// otherwise.
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

// Of log odds x themselves, over the whole range that a probability has.
FeatureModel OneFeature(size_t feature, double sign) {
  constexpr double kScale = 4.0;
  return {0.0, {{feature, 0.0, kScale, sign * kScale, 0.0}}};
}

std::vector<double> Difficulties(const FeatureModel& model, const Rows& rows) {
  std::vector<double> difficulties;
  for (const AnswerRow& row : rows) difficulties.push_back(model.At(row.features));
  return difficulties;
}

// What may be chosen freely, by answers that set no promise.
void TrainModels(const Rows& rows, ConformRule* rule) {
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

void UseNoModel(const Rows& rows, ConformRule* rule) {
  rule->difficulty = {};
  rule->failure = HasFeature(rows, kStatedOdds) ? OneFeature(kStatedOdds, 1.0) : OneFeature(kAgreeing, -1.0);
}

// Equally many of these answers between two edges; as many strata as leave each of them groups enough,
// counted by the shares of its answers, once `factor` times as many answers set its factor.
std::vector<double> ChooseEdges(const FeatureModel& difficulty, const Rows& rows, double factor,
                                double level) {
  const std::vector<double> difficulties = Difficulties(difficulty, rows);
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

// What makes the ellipsoid of the covariance at this level hold scores up to `bound`.
double FactorFor(double bound, double level) { return bound / ChiSquareQuantile(5, level); }

double ComputeBound(const Rows& rows, double level, double AnswerRow::*score) {
  std::vector<double> scores, shares;
  for (const AnswerRow& row : rows) {
    scores.push_back(row.*score);
    shares.push_back(row.share);
  }
  return ConformalBound(scores, shares, level);
}

void SetFactors(const Rows& rows, ConformRule* rule) {
  std::vector<Rows> strata(rule->edges.size() + 1);
  for (const AnswerRow& row : rows) {
    const double difficulty = rule->difficulty.At(row.features);
    const auto k = std::ranges::upper_bound(rule->edges, difficulty) - rule->edges.begin();
    strata[static_cast<size_t>(k)].push_back(row);
  }
  for (const Rows& stratum : strata)
    rule->factors.push_back(FactorFor(ComputeBound(stratum, rule->level, &AnswerRow::nees), rule->level));
}

void CorrectLogOdds(const Rows& rows, ConformRule* rule) {
  std::vector<double> log_odds;
  std::vector<bool> is_wrong;
  for (const AnswerRow& row : rows) {
    log_odds.push_back(rule->failure.At(row.features));
    is_wrong.push_back(row.is_wrong);
  }
  const double one = 1.0;
  const LogisticFit fit = FitLogistic(log_odds, is_wrong, {&one, 1}, kSlopePenalty);
  rule->log_odds_slope = std::max(fit.weights.front(), 0.0);
  rule->log_odds_intercept =
      fit.weights.front() > 0.0
          ? fit.intercept
          : FitLogistic({}, is_wrong, {}, kSlopePenalty).intercept;  // the odds say nothing
}

// From strict to lax, fixed beforehand, whatever the answers are.
std::vector<double> Thresholds() {
  std::vector<double> thresholds;
  for (int k = -120; k <= 120; ++k) thresholds.push_back(0.1 * k);
  thresholds.push_back(kEverything);
  return thresholds;
}

// The laxest certified threshold of `scores`, the greater the worse; nothing: none is. What is tested at each
// is "P(a problem is answered wrongly, at most the threshold) exceeds what is promised".
std::optional<double> CertifyThreshold(const AnswerRows& answers, const std::vector<double>& scores,
                                       const ConformPromise& promise) {
  const bool shares_groups = answers.HasSharedGroups();
  const std::int64_t n = answers.CountGroups();
  std::vector<std::pair<double, double>> losses;  // score and loss of the wrong answers, rising
  for (size_t i = 0; i < scores.size(); ++i)
    if (answers.rows[i].is_wrong) losses.emplace_back(scores[i], answers.rows[i].share);
  std::ranges::sort(losses);
  const std::vector<double> thresholds = Thresholds();
  std::vector<double> p_values;
  double loss = 0.0;
  size_t num_wrong = 0;
  for (const double threshold : thresholds) {
    while (num_wrong < losses.size() && losses[num_wrong].first <= threshold)
      loss += losses[num_wrong++].second;
    p_values.push_back(
        shares_groups ? MeanLossPValue(loss / static_cast<double>(n), n, promise.wrong_and_accepted)
                      : ExcessPValue({static_cast<std::int64_t>(num_wrong), n}, promise.wrong_and_accepted));
    if (p_values.back() > promise.risk) break;
  }
  const size_t num_certified = CountCertified(p_values, promise.risk);
  if (num_certified == 0) return std::nullopt;
  return thresholds[num_certified - 1];
}

std::vector<double> FewAgreeing(const Rows& rows) {
  std::vector<double> scores;
  for (const AnswerRow& row : rows) {
    const double agreeing = row.features[kAgreeing];
    scores.push_back(std::isnan(agreeing) ? kEverything : -agreeing);
  }
  return scores;
}

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
      CertifyThreshold(split.calibrated, Difficulties(rule.failure, calibrated), promise);
  SetFamiliar(answers.rows, &rule);
  return rule;
}

std::vector<JudgedAnswer> JudgeAnswers(const ConformRule& rule, const Rows& rows) {
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
        FactorFor(ComputeBound(others.rows, promise.level, &AnswerRow::nees), promise.level);
    const double ball_deg = ComputeBound(others.rows, promise.level, &AnswerRow::max_error_deg);
    const std::optional<double> by_count = CertifyThreshold(others, FewAgreeing(others.rows), promise);
    for (JudgedAnswer& answer : JudgeAnswers(rule, held_out.rows)) {
      answer.one_factor = one_factor;
      answer.ball_deg = ball_deg;
      answer.is_accepted_by_count = by_count && FewAgreeing({answer.row}).front() <= *by_count;
      judged.push_back(std::move(answer));
    }
  }
  return judged;
}

}  // namespace rcme
