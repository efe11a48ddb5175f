#include "estimator/calibrated/checked_probability.h"

#include <algorithm>
#include <cmath>

#include "estimator/calibrated/fitted_constants.h"

namespace rcme {
namespace {

constexpr double kMostLogOdds = 11.5;  // of the posterior: what lies beyond is not told apart
constexpr size_t kFirstSlope = 3, kEndOfSlopes = 8;
constexpr double kLeastSlope = 0.02;
static_assert(kFailureTerms[2].weight >= 0.0, "P falls with the posterior");

double LogOdds(double p) {
  if (!(p > 0.0)) return -kMostLogOdds;
  if (!(p < 1.0)) return kMostLogOdds;
  return std::clamp(std::log(p / (1.0 - p)), -kMostLogOdds, kMostLogOdds);
}

}  // namespace

const std::array<const char*, kNumFailureTerms> kFailureTermNames = {
    "constant",
    "posterior_log_odds",
    "posterior",
    "log_odds_by_neighbour_correlation",
    "log_odds_by_spread_in_matches",
    "log_odds_by_planar_share",
    "log_odds_by_log_parallax_share",
    "log_odds_by_wrong_share",
    "log_parallax_share",
    "noise_above",
    "noise_below",
    "neighbour_root_z",
    "log_design_2",
    "log_design_4",
    "num_rivals",
    "greatest_rival",
    "log_rotation_sd",
    "wrong_coherence",
    "spread_in_image",
    "direction_mass",
    "low_depth",
};
const std::array<const char*, kNumSpreadTerms> kSpreadTermNames = {"constant", "neighbour_root_z_above",
                                                                   "log_design_4"};

std::array<double, kNumFailureTerms> FailureTerms(double posterior, const ModelCheck& c) {
  const double l = LogOdds(posterior);
  const double root_z = std::copysign(std::sqrt(std::abs(c.neighbour_z)), c.neighbour_z);
  return {1.0,
          l,
          posterior,
          l * std::clamp(c.neighbour_correlation, -1.0, 1.0),
          l * c.spread_in_matches,
          l * c.planar_share,
          l * c.log_parallax_share,
          l * c.wrong_share,
          c.log_parallax_share,
          std::clamp(c.log_noise_ratio, 0.0, 2.0),
          std::clamp(-c.log_noise_ratio, 0.0, 2.0),
          root_z,
          c.log_design_2,
          c.log_design_4,
          c.num_rivals,
          c.greatest_rival,
          c.log_rotation_sd,
          c.wrong_coherence,
          c.spread_in_image,
          c.direction_mass,
          c.low_depth};
}

std::array<double, kNumSpreadTerms> SpreadTerms(const ModelCheck& check) {
  return {1.0, std::sqrt(std::max(check.neighbour_z, 0.0)), check.log_design_4};
}

double CheckedFailureProbability(double posterior, const ModelCheck& check) {
  const std::array<double, kNumFailureTerms> terms = FailureTerms(posterior, check);
  double slope = kFailureTerms[1].weight, log_odds = 0.0;
  for (size_t k = kFirstSlope; k < kEndOfSlopes; ++k)
    slope += kFailureTerms[k].weight * (terms[1] != 0.0 ? terms[k] / terms[1] : 0.0);
  log_odds = std::max(slope, kLeastSlope) * terms[1];
  for (const size_t k : {size_t{0}, size_t{2}}) log_odds += kFailureTerms[k].weight * terms[k];
  for (size_t k = kEndOfSlopes; k < kNumFailureTerms; ++k) log_odds += kFailureTerms[k].weight * terms[k];
  return 1.0 / (1.0 + std::exp(-log_odds));
}

bool IsInDomain(double posterior, const ModelCheck& check) {
  const std::array<double, kNumFailureTerms> terms = FailureTerms(posterior, check);
  for (size_t k = 0; k < kNumFailureTerms; ++k) {
    const bool is_within = terms[k] >= kFailureTerms[k].least && terms[k] <= kFailureTerms[k].most;
    if (!is_within) return false;
  }
  return true;
}

double CovarianceFactor(const ModelCheck& check) {
  const std::array<double, kNumSpreadTerms> terms = SpreadTerms(check);
  double log_factor = 0.0;
  for (size_t k = 0; k < kNumSpreadTerms; ++k) log_factor += kSpreadTerms[k].weight * terms[k];
  return std::max(1.0, std::exp(log_factor));
}

}  // namespace rcme
