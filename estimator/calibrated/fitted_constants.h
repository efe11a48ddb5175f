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
    {"constant", -1.82865328},
    {"posterior_log_odds", 0.0155876323},
    {"posterior", 3.63125686},
};
inline constexpr FittedProduct kFailureProducts[] = {
    {-0.512474249, true, {"greatest_rival", 1, 0}},
    {-0.0210667936, true, {"log_design_2", 1, 1.40365456}},
    {3.27659196, false, {"spread_in_matches", -1, 0.0200141104}},
    {0.408721751, false, {"mean_gain", -1, 5.10513309}},
    {0.644241383, false, {"log_parallax_share", -1, -1.14933084}},
    {0.294961906, false, {"rank_dependence", -1, 4.72763437}},
    {1.50241213, false, {"wrong_coherence", 1, 0.0859375}},
    {-0.76209093, false, {"log_design_4", -1, 1.50271444}},
    {-17.4745978, false, {"greatest_rival", -1, 0.0820970007}},
    {0.906179351, false, {"low_depth", -1, -0.975676651}},
    {-0.742573417, false, {"log_rotation_sd", -1, -4.71295521}},
    {0.333547466, false, {"rank_dependence", 1, 7.48698032}},
    {-1.15935107, false, {"rank_dependence", 1, 7.48698032}, true, {"spread_in_matches", -1, 0.00319293127}},
    {0.604406277, false, {"log_parallax_share", -1, -1.14933084}, true, {"greatest_leverage", -1, 0.842372504}},
    {-0.276937588, false, {"log_parallax_share", -1, -1.14933084}, true, {"log_design_4", 1, 0.719413004}},
    {-0.0759146576, true, {"log_num_right", 1, 5.98393628}},
    {-1.04450292, false, {"rank_dependence", -1, 4.72763437}, true, {"planar_share", 1, 0.5078125}},
    {0.990826363, false, {"log_parallax_share", -1, -1.14933084}, true, {"neighbour_root_z", 1, 1.10232307}},
    {1.21835987, false, {"log_noise_ratio", -1, -0.148018949}},
    {-0.602193606, false, {"mean_gain", -1, 5.10513309}, true, {"log_noise_ratio", -1, 0.337350741}},
    {4.683558, false, {"log_rotation_sd", -1, -4.71295521}, true, {"planar_share", 1, 0.90625}},
    {0.405322003, false, {"log_rotation_sd", -1, -4.71295521}, true, {"log_num_right", -1, 3.91202301}},
    {15.6972864, false, {"log_rotation_sd", -1, -4.71295521}, true, {"mean_probability", -1, 0.958931146}},
    {-17.2540471, false, {"wrong_coherence", 1, 0.0859375}, true, {"planar_share", 1, 0.90625}},
    {1.82393445, false, {"greatest_leverage", -1, 0.842372504}},
    {-0.513044397, false, {"greatest_leverage", -1, 0.842372504}, true, {"log_design_2", -1, 3.52750729}},
    {-30.1716328, false, {"spread_in_matches", -1, 0.0200141104}, true, {"wrong_coherence", -1, 0.0859375}},
    {0.174765937, true, {"planar_share", -1, 0.90625}},
    {-168.256477, false, {"spread_in_matches", -1, 0.0200141104}, true, {"greatest_leverage", -1, 0.075416396}},
    {0.332082463, false, {"log_design_4", -1, 1.50271444}, true, {"log_num_right", -1, 5.20400669}},
    {1.32999717, false, {"spread_in_matches", -1, 0.0200141104}, true, {"log_num_right", 1, 3.91202301}},
    {10.7980779, false, {"greatest_rival", -1, 0.0820970007}, true, {"log_noise_ratio", 1, -0.0220285031}},
    {0.357346595, false, {"rank_dependence", -1, 4.72763437}, true, {"mean_gain", 1, 5.82993957}},
    {0.141624436, false, {"log_parallax_share", -1, -1.14933084}, true, {"rank_dependence", -1, 10.3526334}},
    {1.32258925, false, {"low_depth", -1, -0.975676651}, true, {"rank_dependence", 1, 10.3526334}},
    {-0.595679835, false, {"wrong_coherence", 1, 0.0859375}, true, {"mean_gain", 1, 5.10513309}},
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
    {"constant", 0.0499743892},
    {"neighbour_root_z_above", 0.770612713},
    {"log_design_4_above", 0.989839096},
};

}  // namespace rcme
