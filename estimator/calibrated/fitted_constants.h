// Constants of rcme_calibrated, made by scripts/fit_calibrated: of the modes' weights (mode_weights.h), of the
// probability of failure and of the covariance (checked_probability.h).
#pragma once

namespace rcme {

struct FittedTerm {
  const char* name;
  double weight;
  double least, most;  // of the trials, but for half a per cent on either side
};

// Fitted to
//
//   studies/right_calibration.yaml, seed 71, 2000 draws, 4 trials of each condition
//   studies/calibrated/indoor.yaml, seed 73, 20 trials of each condition, weight 2.0
//   studies/calibrated/outdoor.yaml, seed 73, 20 trials of each condition, weight 2.0
//   studies/calibrated/planarity.yaml, seed 73, 20 trials of each condition, weight 2.0
//   studies/calibrated/hard.yaml, seed 73, 20 trials of each condition, weight 2.0
//   studies/calibrated/few_matches.yaml, seed 73, 20 trials of each condition, weight 2.0
inline constexpr FittedTerm kModeTerms[] = {
    {"exclusive", 0.20298, -13.9866, 28.2557},
    {"shared", 0.456414, -6.896, 22.2796},
    {"explained", 8.13212, -0.445417, 0.665748},
    {"noise", -3.08886, -2.11821, 0.739601},
    {"width", 0.102146, -10, 10},
    {"parallax", -0.714166, -3.55673, 4.05925},
};

// Fitted to
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
inline constexpr FittedTerm kFailureTerms[] = {
    {"constant", 0.546415, 1, 1},
    {"posterior_log_odds", 0.144804, -11.5, 5.89135},
    {"posterior", 1.86878, 0, 0.99724},
    {"log_odds_by_neighbour_correlation", -0.0773793, -6.99354, 4.93136},
    {"log_odds_by_spread_in_matches", 0.243764, -1.43053, 6.68048},
    {"log_odds_by_planar_share", -0.121301, -11.3203, 5.38786},
    {"log_odds_by_log_parallax_share", 0.056979, -9.45824, 28.3083},
    {"log_odds_by_wrong_share", 0.198265, -8.76409, 2.25739},
    {"log_parallax_share", -0.263437, -2.76667, -0.0335684},
    {"noise_above", 0.897655, 0, 1.77118},
    {"noise_below", 0.939132, 0, 1.47201},
    {"neighbour_root_z", 0.172865, -2.05368, 3.11792},
    {"log_design_2", 0.215548, -2.08854, 5.9541},
    {"log_design_4", -0.0619783, -0.740797, 5.53366},
    {"num_rivals", 0.175664, 0, 6},
    {"greatest_rival", 4.48194, 0, 0.449187},
    {"log_rotation_sd", 0.412455, -10.2403, -2.3192},
    {"wrong_coherence", 1.24773, 0, 1},
    {"spread_in_image", -0.478945, -1.94585, 0.0395944},
    {"direction_mass", -1.21671, 0.00411187, 1},
    {"low_depth", -0.136897, -3, 3},
};

// Fitted to
//
//   studies/right_calibration.yaml, seed 51, 2400 draws, 4 trials of each condition
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
inline constexpr FittedTerm kSpreadTerms[] = {
    {"constant", -0.0286286, 1, 1},
    {"neighbour_root_z_above", 0.282662, 0, 3.11792},
    {"log_design_4", 0.498165, -0.740797, 5.53366},
};

}  // namespace rcme
