// The terms of the check of rcme_calibrated's model, in the order that the fit and its tables have them in.
// To leave one out, take its line away here; then scripts/fit_calibrated fits the others again.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "estimator/calibrated/model_check.h"

namespace rcme {

struct CheckTerm {
  const char* name;  // as fitted_constants.h has it
  double (*value)(const ModelCheck& check);
};

// c_k: each tempers the posterior's log-odds l; the fit has l c_k.
inline constexpr auto kSlopeTerms = std::to_array<CheckTerm>({
    {"log_odds_by_neighbour_correlation",
     [](const ModelCheck& c) { return std::clamp(c.neighbour_correlation, -1.0, 1.0); }},
    {"log_odds_by_spread_in_matches", [](const ModelCheck& c) { return c.spread_in_matches; }},
    {"log_odds_by_planar_share", [](const ModelCheck& c) { return c.planar_share; }},
    {"log_odds_by_wrong_share", [](const ModelCheck& c) { return c.wrong_share; }},
});

// c_m: each is added to the log-odds.
inline constexpr auto kAddedTerms = std::to_array<CheckTerm>({
    {"log_parallax_share", [](const ModelCheck& c) { return c.log_parallax_share; }},
    {"noise_above", [](const ModelCheck& c) { return std::clamp(c.log_noise_ratio, 0.0, 2.0); }},
    {"noise_below", [](const ModelCheck& c) { return std::clamp(-c.log_noise_ratio, 0.0, 2.0); }},
    {"neighbour_root_z",
     [](const ModelCheck& c) { return std::copysign(std::sqrt(std::abs(c.neighbour_z)), c.neighbour_z); }},
    {"log_design_2", [](const ModelCheck& c) { return c.log_design_2; }},
    {"num_rivals", [](const ModelCheck& c) { return c.num_rivals; }},
    {"greatest_rival", [](const ModelCheck& c) { return c.greatest_rival; }},
    {"log_rotation_sd", [](const ModelCheck& c) { return c.log_rotation_sd; }},
    {"wrong_coherence", [](const ModelCheck& c) { return c.wrong_coherence; }},
    {"spread_in_image", [](const ModelCheck& c) { return c.spread_in_image; }},
    {"direction_mass", [](const ModelCheck& c) { return c.direction_mass; }},
    {"low_depth", [](const ModelCheck& c) { return c.low_depth; }},
    {"partner_dependence", [](const ModelCheck& c) { return std::clamp(c.partner_dependence, 0.0, 5.0); }},
});

// y: of the covariance.
inline constexpr auto kCovarianceTerms = std::to_array<CheckTerm>({
    {"constant", [](const ModelCheck&) { return 1.0; }},
    {"neighbour_root_z_above", [](const ModelCheck& c) { return std::sqrt(std::max(c.neighbour_z, 0.0)); }},
    {"log_design_4", [](const ModelCheck& c) { return c.log_design_4; }},
});

}  // namespace rcme
