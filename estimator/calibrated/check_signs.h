// The indicators from which the model check of rcme_calibrated computes its corrections. The fit selects
// among them. To leave one out, delete its line here and run scripts/fit_calibrated.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "estimator/calibrated/model_check.h"

namespace rcme {

struct CheckSign {
  const char* name;  // as in fitted_constants.h
  double (*value)(const ModelCheck& check);
};

// x_j, for the probability of failure.
inline constexpr auto kCheckSigns = std::to_array<CheckSign>({
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
inline constexpr auto kCovarianceSigns = std::to_array<CheckSign>({
    {"constant", [](const ModelCheck&) { return 1.0; }},
    {"neighbour_root_z_above",
     [](const ModelCheck& c) { return std::max(std::sqrt(std::max(c.neighbour_z, 0.0)) - 1.1, 0.0); }},
    {"log_design_4_above", [](const ModelCheck& c) { return std::max(c.log_design_4 - 0.6, 0.0); }},
});

}  // namespace rcme
