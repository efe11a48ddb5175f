// Constants of the check of rcme_calibrated's model (checked_probability.h), made by scripts/fit_calibrated
// from
//
//   studies/right_calibration.yaml, seed 51, 2400 draws, 4 trials of each condition
//   studies/any_condition.yaml, seed 52, 600 draws, 4 trials of each condition, weight 0.3, for P alone
//   studies/calibrated/indoor.yaml, seed 53, 20 trials of each condition, weight 0.3
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
//   studies/calibrated/assumed_sigma.yaml, seed 53, 20 trials of each condition, weight 0.3
//
#pragma once

namespace rcme {

struct FittedTerm {
  const char* name;
  double weight;
  double least, most;  // of the trials, but for half a per cent on either side
};

inline constexpr FittedTerm kFailureTerms[] = {
    {"constant", 1.11539, 1, 1},
    {"posterior_log_odds", 0.245548, -11.5, 5.66172},
    {"posterior", 1.32484, 0, 0.996534},
    {"log_odds_by_neighbour_correlation", -0.107196, -7.77566, 5.1901},
    {"log_odds_by_spread_in_matches", 0.226545, -1.40726, 7.47449},
    {"log_odds_by_planar_share", -0.140248, -11.5, 4.93934},
    {"log_odds_by_log_parallax_share", 0.0602812, -9.12439, 29.4806},
    {"log_odds_by_wrong_share", 0.166311, -8.83994, 2.19462},
    {"log_parallax_share", -0.21623, -2.76805, -0.0319606},
    {"noise_above", 0.978091, 0, 1.80899},
    {"noise_below", 0.701395, 0, 1.47108},
    {"neighbour_root_z", 0.15133, -2.04013, 3.19015},
    {"log_design_2", 0.211292, -2.08854, 6.01257},
    {"log_design_4", -0.0622039, -0.724003, 5.54113},
    {"num_rivals", 0.176931, 0, 6},
    {"greatest_rival", 2.46397, 0, 0.448741},
    {"log_rotation_sd", 0.406499, -10.2403, -2.18094},
    {"wrong_coherence", 1.10899, 0, 1},
    {"spread_in_image", -0.365361, -1.88874, 0.0406212},
    {"direction_mass", -0.713271, 0.00605857, 1},
    {"low_depth", -0.111746, -2.88291, 3},
};

inline constexpr FittedTerm kSpreadTerms[] = {
    {"constant", 0.00767938, 1, 1},
    {"neighbour_root_z_above", 0.18115, 0, 3.19015},
    {"log_design_4", 0.585672, -0.724003, 5.54113},
};

}  // namespace rcme
