#include "estimator/calibrated/checked_probability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string_view>

#include "estimator/calibrated/fitted_constants.h"
#include "estimator/calibrated/model_check.h"

namespace rcme {
namespace {

// The indicators from which the model check of rcme_calibrated computes its corrections. The fit selects
// among them. To leave one out, delete its line here and run scripts/fit_calibrated.
struct CheckSign {
  const char* name;  // as in fitted_constants.h
  double (*value)(const ModelCheck& check);
};

// x_j, for the probability of failure.
constexpr auto kCheckSigns = std::to_array<CheckSign>({
    {"log_noise_ratio", [](const ModelCheck& c) { return c.log_noise_ratio; }},
    {"neighbour_root_z",
     [](const ModelCheck& c) { return std::copysign(std::sqrt(std::abs(c.neighbour_z)), c.neighbour_z); }},
    {"log_design_2", [](const ModelCheck& c) { return c.log_design_2; }},
    {"log_design_4", [](const ModelCheck& c) { return c.log_design_4; }},
    {"planar_share", [](const ModelCheck& c) { return c.planar_share; }},
    {"log_parallax_share", [](const ModelCheck& c) { return c.log_parallax_share; }},
    {"low_depth", [](const ModelCheck& c) { return c.low_depth; }},
    {"spread_in_matches", [](const ModelCheck& c) { return c.spread_in_matches; }},
    {"log_num_right", [](const ModelCheck& c) { return c.log_num_right; }},
    {"wrong_coherence", [](const ModelCheck& c) { return c.wrong_coherence; }},
    {"rank_dependence", [](const ModelCheck& c) { return c.partner_dependence.rank_z; }},
    {"mean_probability", [](const ModelCheck& c) { return c.mean_probability; }},
    {"mean_gain", [](const ModelCheck& c) { return c.mean_gain; }},
    {"greatest_leverage", [](const ModelCheck& c) { return c.greatest_leverage; }},
    {"log_rotation_sd", [](const ModelCheck& c) { return c.log_rotation_sd; }},
    {"greatest_rival", [](const ModelCheck& c) { return c.greatest_rival; }},
    {"log_behind", [](const ModelCheck& c) { return c.log_behind; }},
    {"near_in_right", [](const ModelCheck& c) { return c.near_in_right; }},
    {"parallax_spread", [](const ModelCheck& c) { return c.parallax_spread; }},
    {"calibration_log_reach", [](const ModelCheck& c) { return std::log(c.calibration.reach_rad); }},
    {"calibration_root_gain", [](const ModelCheck& c) { return c.calibration.root_gain; }},
    {"calibration_log_shift", [](const ModelCheck& c) { return std::log(c.calibration.shift_rad); }},
});

// y_k, for the covariance. The subtracted values, 1.1 and 0.6, are usual for independent noise.
constexpr auto kCovarianceSigns = std::to_array<CheckSign>({
    {"constant", [](const ModelCheck&) { return 1.0; }},
    {"neighbour_root_z_above",
     [](const ModelCheck& c) { return std::max(std::sqrt(std::max(c.neighbour_z, 0.0)) - 1.1, 0.0); }},
    {"log_design_4_above", [](const ModelCheck& c) { return std::max(c.log_design_4 - 0.6, 0.0); }},
});

constexpr double kMostLogOdds = 11.5;  // the posterior's log-odds are clipped to +-this
constexpr double kLeastSlope = 0.02;
constexpr size_t kNumSigns = kCheckSigns.size();
using Signs = std::array<double, kNumSigns>;

// Evaluated at compile time, so that a missing name is a compile error.
template <typename Named>
constexpr const Named& FindByName(std::span<const Named> all, std::string_view name) {
  for (const Named& one : all) {
    if (one.name == name) return one;
  }
  throw std::logic_error("signs and constants differ; run scripts/fit_calibrated");
}
constexpr size_t FindSign(std::string_view name) {
  return static_cast<size_t>(&FindByName<CheckSign>(kCheckSigns, name) - kCheckSigns.data());
}

// The range of each indicator, in the order of kCheckSigns.
constexpr std::array<FittedRange, kNumSigns> FindRanges() {
  std::array<FittedRange, kNumSigns> ranges;
  for (size_t j = 0; j < kNumSigns; ++j)
    ranges[j] = FindByName<FittedRange>(kSignRanges, kCheckSigns[j].name);
  return ranges;
}
constexpr auto kRanges = FindRanges();
constexpr FittedRange kPosteriorRange = FindByName<FittedRange>(kSignRanges, "posterior_log_odds");

// The indices of a product's signs in kCheckSigns.
struct Product {
  size_t first = 0, second = 0;
};
constexpr std::array<Product, std::size(kFailureProducts)> FindProducts() {
  std::array<Product, std::size(kFailureProducts)> products;
  for (size_t k = 0; k < products.size(); ++k) {
    const FittedProduct& fitted = kFailureProducts[k];
    products[k].first = FindSign(fitted.first.sign);
    products[k].second = fitted.has_second ? FindSign(fitted.second.sign) : kNumSigns;
  }
  return products;
}
constexpr auto kProducts = FindProducts();

constexpr double FindWeight(std::span<const FittedTerm> terms, std::string_view name) {
  return FindByName<FittedTerm>(terms, name).weight;
}
constexpr double kConstant = FindWeight(kFailureTerms, "constant");
constexpr double kOfLogOdds = FindWeight(kFailureTerms, "posterior_log_odds");
constexpr double kOfPosterior = FindWeight(kFailureTerms, "posterior");
static_assert(kOfPosterior >= 0.0, "P falls with the posterior");

constexpr std::array<double, kCovarianceSigns.size()> FindCovarianceWeights() {
  std::array<double, kCovarianceSigns.size()> weights{};
  for (size_t k = 0; k < weights.size(); ++k) weights[k] = FindWeight(kSpreadTerms, kCovarianceSigns[k].name);
  return weights;
}
constexpr auto kCovarianceWeights = FindCovarianceWeights();

double LogOdds(double p) {
  if (!(p > 0.0)) return -kMostLogOdds;
  if (!(p < 1.0)) return kMostLogOdds;
  return std::clamp(std::log(p / (1.0 - p)), -kMostLogOdds, kMostLogOdds);
}

Signs CutSigns(const ModelCheck& check) {
  Signs x;
  for (size_t j = 0; j < kNumSigns; ++j)
    x[j] = std::clamp(kCheckSigns[j].value(check), kRanges[j].least, kRanges[j].most);
  return x;
}

double Evaluate(const FittedHinge& hinge, double x) {
  return std::max(hinge.direction * (x - hinge.knot), 0.0);
}

std::vector<FitTerm> ListValues(std::span<const CheckSign> signs, const ModelCheck& check) {
  std::vector<FitTerm> values;
  for (const CheckSign& sign : signs) values.push_back({sign.name, sign.value(check)});
  return values;
}

}  // namespace

std::vector<FitTerm> ListCheckSigns(const ModelCheck& check) { return ListValues(kCheckSigns, check); }
std::vector<FitTerm> ListCovarianceSigns(const ModelCheck& check) {
  return ListValues(kCovarianceSigns, check);
}

double CheckedFailureProbability(double posterior, const ModelCheck& check) {
  const Signs x = CutSigns(check);
  double slope = kOfLogOdds, rest = kConstant + kOfPosterior * posterior;
  for (size_t k = 0; k < kProducts.size(); ++k) {
    const FittedProduct& fitted = kFailureProducts[k];
    double part = fitted.weight * Evaluate(fitted.first, x[kProducts[k].first]);
    if (fitted.has_second) part *= Evaluate(fitted.second, x[kProducts[k].second]);
    (fitted.tempers ? slope : rest) += part;
  }
  const double log_odds = std::max(slope, kLeastSlope) * LogOdds(posterior) + rest;
  return 1.0 / (1.0 + std::exp(-log_odds));
}

bool IsInDomain(double posterior, const ModelCheck& check) {
  const auto holds = [](const FittedRange& range, double x) { return x >= range.least && x <= range.most; };
  if (!holds(kPosteriorRange, LogOdds(posterior))) return false;
  for (size_t j = 0; j < kNumSigns; ++j) {
    if (!holds(kRanges[j], kCheckSigns[j].value(check))) return false;
  }
  return true;
}

double CovarianceFactor(const ModelCheck& check) {
  double log_factor = 0.0;
  for (size_t k = 0; k < kCovarianceSigns.size(); ++k)
    log_factor += kCovarianceWeights[k] * kCovarianceSigns[k].value(check);
  return std::max(1.0, std::exp(log_factor));
}

}  // namespace rcme
