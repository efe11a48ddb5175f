#include "estimator/calibrated/checked_probability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string_view>

#include "estimator/calibrated/check_terms.h"
#include "estimator/calibrated/fitted_constants.h"

namespace rcme {
namespace {

constexpr double kMostLogOdds = 11.5;  // of the posterior: what lies beyond is not told apart
constexpr double kLeastSlope = 0.02;

// At compile time: a term without a constant is an error there.
constexpr FittedTerm FindConstant(std::span<const FittedTerm> constants, std::string_view name) {
  for (const FittedTerm& constant : constants) {
    if (constant.name == name) return constant;
  }
  throw std::logic_error("a term has no constant; run scripts/fit_calibrated");
}
template <size_t N>
constexpr std::array<FittedTerm, N> FindConstants(std::span<const FittedTerm> constants,
                                                  const std::array<CheckTerm, N>& terms) {
  std::array<FittedTerm, N> found;
  for (size_t k = 0; k < N; ++k) found[k] = FindConstant(constants, terms[k].name);
  return found;
}

constexpr FittedTerm kConstant = FindConstant(kFailureTerms, "constant");
constexpr FittedTerm kOfLogOdds = FindConstant(kFailureTerms, "posterior_log_odds");
constexpr FittedTerm kOfPosterior = FindConstant(kFailureTerms, "posterior");
constexpr auto kOfSlopeTerms = FindConstants(kFailureTerms, kSlopeTerms);
constexpr auto kOfAddedTerms = FindConstants(kFailureTerms, kAddedTerms);
constexpr auto kOfCovarianceTerms = FindConstants(kSpreadTerms, kCovarianceTerms);
static_assert(kOfPosterior.weight >= 0.0, "P falls with the posterior");

double LogOdds(double p) {
  if (!(p > 0.0)) return -kMostLogOdds;
  if (!(p < 1.0)) return kMostLogOdds;
  return std::clamp(std::log(p / (1.0 - p)), -kMostLogOdds, kMostLogOdds);
}

// c_k as the fit has it, l c_k over l.
double Tempering(double l, double c) { return l != 0.0 ? l * c / l : 0.0; }

}  // namespace

std::vector<FitTerm> ListFailureTerms(double posterior, const ModelCheck& check) {
  const double l = LogOdds(posterior);
  std::vector<FitTerm> terms = {{kConstant.name, 1.0}, {kOfLogOdds.name, l}, {kOfPosterior.name, posterior}};
  for (const CheckTerm& term : kSlopeTerms) terms.push_back({term.name, l * term.value(check)});
  for (const CheckTerm& term : kAddedTerms) terms.push_back({term.name, term.value(check)});
  return terms;
}

std::vector<FitTerm> ListSpreadTerms(const ModelCheck& check) {
  std::vector<FitTerm> terms;
  for (const CheckTerm& term : kCovarianceTerms) terms.push_back({term.name, term.value(check)});
  return terms;
}

double CheckedFailureProbability(double posterior, const ModelCheck& check) {
  const double l = LogOdds(posterior);
  double slope = kOfLogOdds.weight;
  for (size_t k = 0; k < kSlopeTerms.size(); ++k)
    slope += kOfSlopeTerms[k].weight * Tempering(l, kSlopeTerms[k].value(check));
  double log_odds = std::max(slope, kLeastSlope) * l + kConstant.weight + kOfPosterior.weight * posterior;
  for (size_t k = 0; k < kAddedTerms.size(); ++k)
    log_odds += kOfAddedTerms[k].weight * kAddedTerms[k].value(check);
  return 1.0 / (1.0 + std::exp(-log_odds));
}

bool IsInDomain(double posterior, const ModelCheck& check) {
  return std::ranges::all_of(ListFailureTerms(posterior, check), [](const FitTerm& term) {
    const FittedTerm constant = FindConstant(kFailureTerms, term.name);
    return term.value >= constant.least && term.value <= constant.most;
  });
}

double CovarianceFactor(const ModelCheck& check) {
  double log_factor = 0.0;
  for (size_t k = 0; k < kCovarianceTerms.size(); ++k)
    log_factor += kOfCovarianceTerms[k].weight * kCovarianceTerms[k].value(check);
  return std::max(1.0, std::exp(log_factor));
}

}  // namespace rcme
