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
    {"exclusive", 0.20298},
    {"shared", 0.456414},
    {"explained", 8.13212},
    {"noise", -3.08886},
    {"width", 0.102146},
    {"parallax", -0.714166},
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
    {"constant", -3.2417732},
    {"posterior_log_odds", 0.0753069811},
    {"posterior", 2.84251932},
};
inline constexpr FittedProduct kFailureProducts[] = {
    {-0.665881404, true, {"greatest_rival", 1, 0}},
    {-0.0230145088, true, {"log_design_2", 1, 0.746230085}},
    {0.457971487, false, {"log_rotation_sd", 1, -7.55916262}},
    {0.606019821, false, {"log_rotation_sd", 1, -7.55916262}, true, {"wrong_coherence", 1, 0}},
    {0.517655567, false, {"rank_dependence", -1, 1.25567201}},
    {0.147096437, false, {"low_depth", -1, 3}},
    {0.805925775, false, {"neighbour_root_z", 1, 1.10473031}},
    {0.377760963, false, {"rank_dependence", 1, 10.3634808}},
    {0.780999389, false, {"log_parallax_share", -1, -1.11480376}},
    {1.28687947, false, {"log_parallax_share", -1, -1.11480376}, true, {"greatest_leverage", -1, 0.822636293}},
    {-0.0636664502, true, {"mean_gain", -1, 4.21871305}},
    {3.58373252, false, {"spread_in_matches", -1, 0.0200918648}},
    {-15.896195, false, {"greatest_rival", -1, 0.0917596857}},
    {1.82532016, false, {"rank_dependence", 1, 10.3634808}, true, {"low_depth", -1, -0.999623784}},
    {-0.561845089, false, {"log_design_4", -1, 0.743809479}},
    {12.2887633, false, {"greatest_rival", -1, 0.0917596857}, true, {"log_noise_ratio", 1, -0.0227569275}},
    {0.779045135, false, {"log_noise_ratio", -1, -0.0227569275}},
    {7.51227669, false, {"planar_share", 1, 0.906250003}},
    {26.4904064, false, {"mean_probability", -1, 0.958828698}},
    {-4.84824175, false, {"spread_in_matches", -1, 0.0200918648}, true, {"planar_share", 1, 0.153846154}},
    {2.30169261, false, {"log_noise_ratio", -1, -0.0227569275}, true, {"log_num_right", -1, 3.91202301}},
    {0.0319098531, true, {"log_num_right", -1, 6.61204103}},
    {-0.31878177, false, {"log_parallax_share", -1, -1.11480376}, true, {"log_design_4", 1, 1.58859333}},
    {0.153522002, false, {"log_design_2", 1, 0.152948707}},
    {0.451887298, false, {"log_design_2", 1, 0.152948707}, true, {"greatest_leverage", -1, 0.822636293}},
    {-0.389715277, false, {"log_design_2", 1, 0.152948707}, true, {"planar_share", -1, 0.906250003}},
    {1.47517899, false, {"rank_dependence", -1, 1.25567201}, true, {"log_num_right", -1, 3.91202301}},
    {10.4208787, false, {"greatest_rival", -1, 0.0917596857}, true, {"wrong_coherence", 1, 0}},
    {17.9957124, false, {"planar_share", 1, 0.906250003}, true, {"low_depth", -1, -0.999623784}},
    {-0.367414791, false, {"neighbour_root_z", 1, 1.10473031}, true, {"log_rotation_sd", -1, -5.71351686}},
};
inline constexpr FittedRange kSignRanges[] = {
    {"posterior_log_odds", -11.5, 5.89135411},
    {"log_noise_ratio", -1.47201455, 1.77117664},
    {"neighbour_root_z", -2.05367727, 3.11792151},
    {"log_design_2", -2.08854305, 5.95410192},
    {"log_design_4", -0.740797343, 5.53365552},
    {"planar_share", 0.0234375, 1},
    {"log_parallax_share", -2.76666922, -0.0335684467},
    {"low_depth", -3, 3},
    {"spread_in_matches", -1.11458183, 0.152762869},
    {"log_num_right", 2.07944154, 7.46474987},
    {"wrong_coherence", 0, 1},
    {"rank_dependence", -1.08287058, 13.2672058},
    {"mean_probability", 0.887677352, 0.999983545},
    {"mean_gain", 2.45702907, 7.80822189},
    {"greatest_leverage", 0.0225802583, 1},
    {"log_rotation_sd", -10.2403195, -2.31920284},
    {"greatest_rival", 0, 0.449186522},
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
    {"constant", 0.0640147522},
    {"neighbour_root_z_above", 0.764468186},
    {"log_design_4_above", 0.758333559},
};

}  // namespace rcme
