#include "estimator/conform/conform_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "stats/conformal.h"
#include "stats/constants.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

void Require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

bool IsRule(const FeatureModel& model) {
  return std::isfinite(model.intercept) && std::ranges::all_of(model.terms, [](const FeatureModel::Term& t) {
           return t.feature < kNumVisibleFeatures && std::isfinite(t.centre) && t.scale > 0.0 &&
                  std::isfinite(t.linear) && std::isfinite(t.square);
         });
}

void RequireRule(const ConformRule& rule) {
  Require(rule.level > 0.5 && rule.level < 1.0, "level is not between .5 and 1");
  Require(IsRule(rule.difficulty), "difficulty is no model of features");
  Require(IsRule(rule.failure), "failure is no model of features");
  Require(rule.factors.size() == rule.edges.size() + 1, "there is not one factor more than edges");
  Require(std::ranges::is_sorted(rule.edges) &&
              std::ranges::all_of(rule.edges, [](double x) { return std::isfinite(x); }),
          "edges are not rising");
  Require(std::ranges::all_of(rule.factors, [](double x) { return x >= 0.0; }), "a factor is below 0");
  Require(std::isfinite(rule.log_odds_intercept) && std::isfinite(rule.log_odds_slope),
          "the correction of the log odds is not finite");
  Require(!rule.greatest_log_odds || !std::isnan(*rule.greatest_log_odds), "the accept rule is not a number");
  const size_t width = rule.familiar_features.size();
  Require(std::ranges::all_of(rule.familiar_features, [](size_t j) { return j < kNumVisibleFeatures; }),
          "an unknown feature");
  Require(width == 0 ? rule.familiar.empty() : rule.familiar.size() % width == 0 && !rule.familiar.empty(),
          "familiar answers are not whole");
  Require(std::ranges::all_of(rule.familiar, [](double x) { return !std::isinf(x); }),
          "a familiar feature is not finite");
}

}  // namespace

double ScoreOfFeature(const FeatureModel::Term& term, double feature) {
  if (std::isnan(feature)) return 0.0;
  return std::clamp((feature - term.centre) / term.scale, -FeatureModel::kMostZ, FeatureModel::kMostZ);
}

double FeatureModel::At(const VisibleFeatures& features) const {
  double sum = intercept;
  for (const Term& term : terms) {
    if (std::isnan(features[term.feature])) continue;
    const double z = ScoreOfFeature(term, features[term.feature]);
    sum += term.linear * z + term.square * (z * z - 1.0);
  }
  return sum;
}

ConformJudge::ConformJudge(ConformRule rule) : rule_(std::move(rule)) {
  RequireRule(rule_);
  const size_t width = rule_.familiar_features.size();
  if (width == 0) return;
  const size_t n = rule_.familiar.size() / width;
  for (size_t j = 0; j < width; ++j) {
    std::vector<double> values, distances;
    for (size_t i = 0; i < n; ++i) {
      const double x = rule_.familiar[i * width + j];
      if (!std::isnan(x)) values.push_back(x);
    }
    const double median = values.empty() ? 0.0 : ComputeMedian(values);
    for (const double x : values) distances.push_back(std::abs(x - median));
    constexpr double kLeastScale = 1e-6;  // if all values are equal
    usual_.push_back({median, std::fmax(ComputeMedian(std::move(distances)), kLeastScale)});
  }
  for (size_t i = 0; i < n; ++i) {
    VisibleFeatures features;
    features.fill(kNaN);
    for (size_t j = 0; j < width; ++j) features[rule_.familiar_features[j]] = rule_.familiar[i * width + j];
    size_t ignored = 0;
    strangeness_.push_back(Strangeness(features, &ignored));
  }
  std::ranges::sort(strangeness_);
}

// The greatest distance of a feature from its median, in units of the median absolute deviation; infinite if
// a feature is missing.
double ConformJudge::Strangeness(const VisibleFeatures& features, size_t* strangest) const {
  double most = 0.0;
  for (size_t j = 0; j < usual_.size(); ++j) {
    const size_t feature = rule_.familiar_features[j];
    const double x = features[feature];
    const double distance = std::isnan(x) ? kInfinity : std::abs(x - usual_[j].median) / usual_[j].scale;
    if (distance < most) continue;
    most = distance;
    *strangest = feature;
  }
  return most;
}

ConformVerdict ConformJudge::Judge(const VisibleFeatures& features) const {
  ConformVerdict verdict;
  const double difficulty = rule_.difficulty.At(features);
  verdict.stratum =
      static_cast<size_t>(std::ranges::upper_bound(rule_.edges, difficulty) - rule_.edges.begin());
  verdict.factor = rule_.factors[verdict.stratum];
  verdict.log_odds = rule_.failure.At(features);
  verdict.failure_probability =
      1.0 / (1.0 + std::exp(-(rule_.log_odds_intercept + rule_.log_odds_slope * verdict.log_odds)));
  verdict.is_accepted = rule_.greatest_log_odds && verdict.log_odds <= *rule_.greatest_log_odds;
  if (usual_.empty()) return verdict;
  const double strangeness = Strangeness(features, &verdict.strangest_feature);
  verdict.familiarity = ConformalPValue(strangeness_, strangeness);
  return verdict;
}

Matrix5d CovarianceOfAllMotions() {
  // No tangent is longer than pi sqrt 2; chi2_5 at .5 is 4.35 > 2.
  return std::numbers::pi * std::numbers::pi * Matrix5d::Identity();
}

MotionEstimate ConformJudge::Apply(const MotionProblem& problem, MotionEstimate estimate,
                                   bool refuses) const {
  if (estimate.status != MotionStatus::kOk) return estimate;
  const VisibleFeatures features = MeasureVisibleFeatures(problem, estimate);
  const ConformVerdict verdict = Judge(features);
  const bool is_strange = verdict.familiarity <= kStrangeLevel;
  const bool is_valid = !std::isnan(features[static_cast<size_t>(VisibleFeature::kAgreeing)]);
  if (refuses && (!verdict.is_accepted || is_strange || !is_valid)) {
    const std::string message =
        is_strange ? fmt::format("unlike the problems of the calibration ({}), so that nothing is promised",
                                 VisibleFeatureNames()[verdict.strangest_feature])
                   : fmt::format(
                         "the accept rule refuses it (wrong with a probability of {:.2g}), so that at "
                         "most {:.3g} % of all problems are answered wrongly",
                         verdict.failure_probability, 100.0 * rule_.wrong_and_accepted);
    MotionEstimate refusal = MakeRefusal(MotionStatus::kTooUncertain, message, estimate.counts);
    refusal.seconds_elsewhere = estimate.seconds_elsewhere;
    return refusal;
  }
  const bool has_region = std::isfinite(verdict.factor);
  const auto conform = [&](Matrix5d* covariance) {
    *covariance = has_region ? verdict.factor * *covariance : CovarianceOfAllMotions();
  };
  for (Matrix5d* each :
       {&estimate.pose_cov, &estimate.pose_cov_without_errors, &estimate.pose_cov_with_errors})
    conform(each);
  for (MotionMode& mode : estimate.other_modes) conform(&mode.pose_cov);
  estimate.failure_probability = verdict.failure_probability;
  estimate.probability_domain = is_strange       ? ProbabilityDomain::kExtrapolated
                                : KnowsStrange() ? ProbabilityDomain::kVerified
                                                 : ProbabilityDomain::kNotStated;
  if (!estimate.message.empty()) estimate.message += "; ";
  estimate.message += fmt::format(
      "conformed: {}, wrong with a probability of {:.2g}{}",
      has_region ? fmt::format("covariance times {:.3g}", verdict.factor) : "no region keeps the promise",
      verdict.failure_probability,
      is_strange ? fmt::format("; unlike the problems of the calibration ({}), so that neither is promised",
                               VisibleFeatureNames()[verdict.strangest_feature])
                 : "");
  return estimate;
}

}  // namespace rcme
