// Constants of the check of rcme_calibrated's model (checked_probability.h), made by scripts/fit_calibrated
// from
//   studies/right_calibration.yaml, seed 51, 2400 draws, 4 trials of each condition
//   studies/any_condition.yaml, seed 52, 600 draws, 4 trials of each condition, weight 0.3, not for the
//   covariance studies/calibrated/indoor.yaml, seed 53, 20 trials of each condition, weight 0.3
//   studies/calibrated/outdoor.yaml, seed 53, 20 trials of each condition, weight 0.3
//   studies/calibrated/low_parallax.yaml, seed 53, 20 trials of each condition, weight 0.3
//   studies/calibrated/planarity.yaml, seed 53, 20 trials of each condition, weight 0.3
//   studies/calibrated/moving_object.yaml, seed 53, 20 trials of each condition, weight 0.3
//   studies/calibrated/hard.yaml, seed 53, 20 trials of each condition, weight 0.3
//   studies/calibrated/few_matches.yaml, seed 53, 20 trials of each condition, weight 0.3
//   studies/calibrated/noise_laws.yaml, seed 53, 20 trials of each condition, weight 0.3
//   studies/calibrated/outlier_laws.yaml, seed 53, 20 trials of each condition, weight 0.3
//   studies/calibrated/uniform.yaml, seed 53, 20 trials of each condition, weight 0.3
//   studies/calibrated/forward.yaml, seed 53, 20 trials of each condition, weight 0.3
//   studies/calibrated/parallax.yaml, seed 53, 20 trials of each condition, weight 0.3
//   studies/calibrated/clustered_inliers.yaml, seed 53, 20 trials of each condition, weight 0.3
#pragma once

namespace rcme {

struct FittedTerm {
  const char* name;
  double weight;
  double least, most;  // of the trials, but for half a per cent on either side
};

inline constexpr FittedTerm kFailureTerms[] = {
    {"constant", 1.11287, 1, 1},
    {"posterior_log_odds", 0.244795, -11.5, 5.685},
    {"posterior", 1.32588, 0, 0.9966},
    {"log_odds_by_neighbour_correlation", -0.106972, -7.783, 5.192},
    {"log_odds_by_spread_in_matches", 0.226076, -1.412, 7.515},
    {"log_odds_by_planar_share", -0.13957, -11.5, 4.963},
    {"log_odds_by_log_parallax_share", 0.0600825, -9.138, 29.5},
    {"log_odds_by_wrong_share", 0.165836, -8.853, 2.197},
    {"log_parallax_share", -0.216377, -2.768, -0.0318},
    {"noise_above", 0.981214, 0, 1.813},
    {"noise_below", 0.704079, 0, 1.472},
    {"neighbour_root_z", 0.15144, -2.041, 3.194},
    {"log_design_2", 0.211061, -2.113, 6.02},
    {"log_design_4", -0.0621567, -0.7283, 5.55},
    {"num_rivals", 0.1769, 0, 6},
    {"greatest_rival", 2.46414, 0, 0.4495},
    {"log_rotation_sd", 0.406278, -10.24, -2.175},
    {"wrong_coherence", 1.10773, 0, 1},
    {"spread_in_image", -0.364614, -1.891, 0.04076},
    {"direction_mass", -0.712774, 0.006027, 1},
    {"low_depth", -0.111582, -2.893, 3},
};

inline constexpr FittedTerm kSpreadTerms[] = {
    {"constant", -0.0515208, 1, 1},
    {"neighbour_root_z_above", 0.216456, 0, 3.194},
    {"log_design_4", 0.328409, -0.7283, 5.55},
};

}  // namespace rcme
