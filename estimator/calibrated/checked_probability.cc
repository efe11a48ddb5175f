#include "estimator/calibrated/checked_probability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string_view>

#include "estimator/calibrated/check_signs.h"
#include "estimator/calibrated/fitted_constants.h"

namespace rcme {
namespace {

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
