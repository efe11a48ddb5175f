// Constants of rcme_calibrated, made by scripts/fit_calibrated: of the modes' weights (mode_weights.h), of the
// probability of failure and of the covariance (checked_probability.h).
// clang-format off: one constant a line, as the script writes and reads them
#pragma once

namespace rcme {

struct FittedTerm {
  const char* name;
  double weight;
};
struct FittedRange {
  const char* name;
  double least, most;  // of the trials, but for half a per cent on either side
};

// max(direction (x - knot), 0) of a sign x; direction 1 or -1.
struct FittedHinge {
  const char* sign;
  double direction, knot;
};
// A hinge, or the product of two. Where it tempers, its weight is one of the log-odds of the posterior.
struct FittedProduct {
  double weight;
  bool tempers;
  FittedHinge first;
  bool has_second = false;
  FittedHinge second = {};
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
    {"exclusive", 0.147567705},
    {"shared", 0.373521064},
    {"explained", 4.04939426},
    {"noise", -2.80095088},
    {"forward", -1.68703671},
    {"axial", 1.94577336},
    {"turn", -1.91162847},
};

// Fitted to
//
//   studies/right_calibration.yaml, seed 51, 2400 draws, 4 trials of each condition
//   studies/any_condition.yaml, seed 52, 600 draws, 4 trials of each condition, for P alone
//   studies/calibrated/indoor.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/outdoor.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/low_parallax.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/planarity.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/moving_object.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/hard.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/few_matches.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/noise_laws.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/outlier_laws.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/uniform.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/forward.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/parallax.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/clustered_inliers.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/assumed_sigma.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/right_calibration.yaml, seed 54, 300 draws, 4 trials of each condition, weight 0.3, partners permuted, for P alone
inline constexpr FittedTerm kFailureTerms[] = {
    {"constant", -1.87766542},
    {"posterior_log_odds", 0.0156724707},
    {"posterior", 3.61398121},
};
inline constexpr FittedProduct kFailureProducts[] = {
    {-0.504189911, true, {"greatest_rival", 1, 0}},
    {-0.0239645117, true, {"log_design_2", 1, 1.40365456}},
    {4.42186763, false, {"spread_in_matches", -1, 0.0200141104}},
    {0.492814172, false, {"mean_gain", -1, 5.10513309}},
    {0.853862401, false, {"log_parallax_share", -1, -1.14933084}},
    {0.342440977, false, {"rank_dependence", -1, 4.72763437}},
    {1.22418267, false, {"wrong_coherence", 1, 0.0859375}},
    {-0.716481848, false, {"log_design_4", -1, 1.50271444}},
    {-16.2176078, false, {"greatest_rival", -1, 0.0820970007}},
    {1.14087943, false, {"low_depth", -1, -0.975676651}},
    {-0.748976088, false, {"log_rotation_sd", -1, -4.71295521}},
    {0.317310834, false, {"rank_dependence", 1, 7.48698032}},
    {-0.965779794, false, {"rank_dependence", 1, 7.48698032}, true, {"spread_in_matches", -1, 0.00319293127}},
    {0.795593866, false, {"log_parallax_share", -1, -1.14933084}, true, {"greatest_leverage", -1, 0.842372504}},
    {-0.278471008, false, {"log_parallax_share", -1, -1.14933084}, true, {"log_design_4", 1, 0.719413004}},
    {-0.0844502429, true, {"log_num_right", 1, 5.98393628}},
    {-1.0502833, false, {"rank_dependence", -1, 4.72763437}, true, {"planar_share", 1, 0.5078125}},
    {0.99166647, false, {"log_parallax_share", -1, -1.14933084}, true, {"neighbour_root_z", 1, 1.10232307}},
    {1.17663038, false, {"log_noise_ratio", -1, -0.148018949}},
    {-0.681304266, false, {"mean_gain", -1, 5.10513309}, true, {"log_noise_ratio", -1, 0.337350741}},
    {4.65893067, false, {"log_rotation_sd", -1, -4.71295521}, true, {"planar_share", 1, 0.90625}},
    {0.515535675, false, {"log_rotation_sd", -1, -4.71295521}, true, {"log_num_right", -1, 3.91202301}},
    {14.9086229, false, {"log_rotation_sd", -1, -4.71295521}, true, {"mean_probability", -1, 0.958931146}},
    {-18.9972824, false, {"wrong_coherence", 1, 0.0859375}, true, {"planar_share", 1, 0.90625}},
    {1.9802797, false, {"greatest_leverage", -1, 0.842372504}},
    {-0.522184664, false, {"greatest_leverage", -1, 0.842372504}, true, {"log_design_2", -1, 3.52750729}},
    {-35.8196487, false, {"spread_in_matches", -1, 0.0200141104}, true, {"wrong_coherence", -1, 0.0859375}},
    {0.150893139, true, {"planar_share", -1, 0.90625}},
    {-116.996686, false, {"spread_in_matches", -1, 0.0200141104}, true, {"greatest_leverage", -1, 0.075416396}},
    {0.282795728, false, {"log_design_4", -1, 1.50271444}, true, {"log_num_right", -1, 5.20400669}},
};
inline constexpr FittedRange kSignRanges[] = {
    {"posterior_log_odds", -11.5, 5.98101835},
    {"log_noise_ratio", -1.46933893, 1.71845895},
    {"neighbour_root_z", -2.02781422, 3.12233583},
    {"log_design_2", -1.81990789, 5.91051406},
    {"log_design_4", -0.733757515, 5.41131348},
    {"planar_share", 0.0234375, 1},
    {"log_parallax_share", -2.76407854, -0.0327963792},
    {"low_depth", -3, 3},
    {"spread_in_matches", -1.07529062, 0.155789526},
    {"log_num_right", 2.07944154, 7.46291529},
    {"wrong_coherence", 0, 1},
    {"rank_dependence", -1.07934334, 13.2566021},
    {"mean_probability", 0.883884847, 0.999983546},
    {"mean_gain", 2.46563779, 7.80822895},
    {"greatest_leverage", 0.0226701995, 1},
    {"log_rotation_sd", -10.2511694, -2.51021588},
    {"greatest_rival", 0, 0.429304815},
};

// Fitted to
//
//   studies/right_calibration.yaml, seed 51, 2400 draws, 4 trials of each condition
//   studies/calibrated/indoor.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/outdoor.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/low_parallax.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/planarity.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/moving_object.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/hard.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/few_matches.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/noise_laws.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/outlier_laws.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/uniform.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/forward.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/parallax.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/clustered_inliers.yaml, seed 53, 20 trials of each condition, weight 0.6
//   studies/calibrated/assumed_sigma.yaml, seed 53, 20 trials of each condition, weight 0.6
inline constexpr FittedTerm kSpreadTerms[] = {
    {"constant", 0.0426735706},
    {"neighbour_root_z_above", 0.946375202},
    {"log_design_4_above", 0.978805164},
};

}  // namespace rcme
