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
//   studies/right_calibration.yaml, seed 54, 300 draws, 4 trials of each condition, weight 0.3, partners permuted, for P alone
inline constexpr FittedTerm kFailureTerms[] = {
    {"constant", 2.11126, 1, 1},
    {"posterior_log_odds", 0.119793, -11.5, 5.89135},
    {"posterior", 2.24781, 0, 0.99724},
    {"log_odds_by_neighbour_correlation", -0.0929766, -6.99354, 4.93136},
    {"log_odds_by_spread_in_matches", 0.235376, -1.43053, 6.68048},
    {"log_odds_by_planar_share", -0.164955, -11.3203, 5.38786},
    {"log_odds_by_wrong_share", 0.175868, -8.76409, 2.25739},
    {"log_parallax_share", -0.335656, -2.76667, -0.0335684},
    {"noise_above", 0.850726, 0, 1.77118},
    {"noise_below", 0.910127, 0, 1.47201},
    {"neighbour_root_z", 0.163517, -2.05368, 3.11792},
    {"log_design_2", 0.177984, -2.08854, 5.9541},
    {"num_rivals", 0.15817, 0, 6},
    {"greatest_rival", 4.20019, 0, 0.449187},
    {"log_rotation_sd", 0.364168, -10.2403, -2.3192},
    {"wrong_coherence", 1.20015, 0, 1},
    {"spread_in_image", -0.419411, -1.94585, 0.0395944},
    {"direction_mass", -0.992866, 0.00411187, 1},
    {"low_depth", -0.13151, -3, 3},
    {"partner_dependence", -0.436011, 0.70653, 5},
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
    {"constant", -0.0211958, 1, 1},
    {"neighbour_root_z_above", 0.274215, 0, 3.11792},
    {"log_design_4", 0.485035, -0.740797, 5.53366},
};

}  // namespace rcme
