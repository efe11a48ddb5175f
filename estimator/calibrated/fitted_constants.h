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
//   studies/right_calibration.yaml, seed 51, 6000 draws, 4 trials of each condition
//   studies/any_condition.yaml, seed 52, 1200 draws, 4 trials of each condition, for P alone
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
    {"constant", -1.81761699},
    {"posterior_log_odds", 0.0456954141},
    {"posterior", 2.33583493},
};
inline constexpr FittedProduct kFailureProducts[] = {
    {-0.0379507266, true, {"log_design_2", 1, 1.42285407}},
    {0.4757004, false, {"log_behind", 1, -3.45946629}},
    {-0.122184626, true, {"near_in_right", -1, 0.0243385762}},
    {0.0978445052, false, {"log_rotation_sd", 1, -7.63638963}},
    {-4.58897957, false, {"near_in_right", 1, -0.101787449}},
    {0.524881436, false, {"neighbour_root_z", 1, 0.24068485}},
    {0.69231029, false, {"spread_in_matches", -1, 0.0206139248}},
    {-11.056184, false, {"greatest_rival", -1, 0.0889427965}},
    {0.407241813, false, {"parallax_spread", -1, -0.335406053}},
    {0.512216833, false, {"rank_dependence", 1, 10.6525388}},
    {0.0948926008, false, {"log_rotation_sd", 1, -7.63638963}, true, {"log_behind", -1, -3.45946629}},
    {7.97725936, false, {"greatest_rival", -1, 0.0889427965}, true, {"wrong_coherence", 1, 0}},
    {0.971250944, false, {"log_noise_ratio", -1, -0.172716214}},
    {1.65587731, false, {"log_behind", 1, -3.45946629}, true, {"parallax_spread", 1, -0.335406053}},
    {-0.622181135, false, {"log_design_4", -1, 1.49342363}},
    {0.115326298, true, {"planar_share", -1, 0.984375}},
    {3.90625463, false, {"spread_in_matches", -1, 0.0206139248}, true, {"planar_share", -1, 0.658227848}},
    {0.81477202, false, {"parallax_spread", -1, -0.335406053}, true, {"greatest_leverage", -1, 0.98907374}},
    {0.116504139, false, {"parallax_spread", -1, -0.335406053}, true, {"rank_dependence", -1, 12.1597748}},
    {0.584023869, false, {"neighbour_root_z", 1, 0.24068485}, true, {"log_noise_ratio", 1, -0.0291931925}},
    {0.358559264, false, {"rank_dependence", -1, 2.17439188}},
    {0.039162016, false, {"log_rotation_sd", 1, -7.63638963}, true, {"rank_dependence", 1, 2.17439188}},
    {-0.247634562, false, {"neighbour_root_z", 1, 0.24068485}, true, {"log_design_2", -1, 2.30095768}},
    {4.88893699, false, {"planar_share", 1, 0.9296875}},
    {0.802666591, false, {"spread_in_matches", -1, 0.0206139248}, true, {"log_behind", -1, -3.45946629}},
    {0.265838611, false, {"log_design_4", -1, 1.49342363}, true, {"log_num_right", -1, 5.11198779}},
    {36.1676858, false, {"greatest_rival", -1, 0.0889427965}, true, {"near_in_right", -1, -0.101787449}},
    {1.87723385, false, {"rank_dependence", 1, 10.6525388}, true, {"low_depth", -1, -1.0650367}},
    {12.1599332, false, {"greatest_rival", -1, 0.0889427965}, true, {"log_behind", 1, -1.84582669}},
    {1.67269804, false, {"log_rotation_sd", 1, -7.63638963}, true, {"wrong_coherence", 1, 0.7890625}},
    {-0.146228892, false, {"parallax_spread", -1, -0.335406053}, true, {"log_design_4", 1, 0.272688653}},
    {-0.39593548, false, {"parallax_spread", 1, -0.0106093667}},
    {4.01976597, false, {"rank_dependence", -1, 2.17439188}, true, {"greatest_leverage", 1, 0.838635556}},
    {-7.9475887, false, {"greatest_rival", -1, 0.0889427965}, true, {"greatest_leverage", 1, 0.0757395674}},
    {-0.738647861, false, {"neighbour_root_z", 1, 0.24068485}, true, {"planar_share", -1, 0.658227848}},
    {4.23105766, false, {"near_in_right", 1, -0.101787449}, true, {"log_rotation_sd", 1, -5.74737328}},
    {-34.1093732, false, {"parallax_spread", 1, -0.0106093667}, true, {"spread_in_matches", 1, -0.165301111}},
    {-3.29590461, false, {"greatest_rival", -1, 0.0889427965}, true, {"log_rotation_sd", -1, -5.74737328}},
    {-3.22309624, false, {"spread_in_matches", -1, 0.0206139248}, true, {"log_parallax_share", 1, -0.687648894}},
    {-9.64384558, false, {"near_in_right", 1, 0}},
    {57.3679892, false, {"parallax_spread", 1, -0.0106093667}, true, {"near_in_right", 1, 0.0243385762}},
    {0.321189442, false, {"rank_dependence", -1, 2.17439188}, true, {"mean_gain", 1, 5.08368636}},
    {10427.5592, false, {"planar_share", 1, 0.9296875}, true, {"mean_probability", 1, 0.999043833}},
    {-0.0471180821, true, {"log_num_right", 1, 5.99396143}},
    {-0.112048935, true, {"log_noise_ratio", -1, -0.172716214}},
    {-1.50840553, false, {"log_noise_ratio", -1, -0.172716214}, true, {"planar_share", -1, 0.9296875}},
    {-1.3040999, false, {"rank_dependence", 1, 10.6525388}, true, {"spread_in_matches", -1, -0.0013754743}},
    {-1.98157941, false, {"rank_dependence", -1, 2.17439188}, true, {"planar_share", 1, 0.658227848}},
};
inline constexpr FittedRange kSignRanges[] = {
    {"posterior_log_odds", -11.5, 7.62993062},
    {"log_noise_ratio", -1.46590691, 1.75208993},
    {"neighbour_root_z", -2.03853183, 3.21180001},
    {"log_design_2", -2.30258509, 5.81559651},
    {"log_design_4", -0.755697602, 5.35650593},
    {"planar_share", 0.0234375, 1},
    {"log_parallax_share", -2.76591267, -0.0311225039},
    {"low_depth", -3, 3},
    {"spread_in_matches", -1.21237704, 0.159830308},
    {"log_num_right", 2.30258509, 7.48268183},
    {"wrong_coherence", 0, 1},
    {"rank_dependence", -1.27858649, 13.2662112},
    {"mean_probability", 0.884169114, 0.999984514},
    {"mean_gain", 2.43161471, 7.79780979},
    {"greatest_leverage", 0.0223491119, 1},
    {"log_rotation_sd", -10.2875373, -2.62397941},
    {"greatest_rival", 0, 0.439524867},
    {"log_behind", -8.06131962, 0.126114561},
    {"near_in_right", -2, 0.171719591},
    {"parallax_spread", -2, 0.301625418},
};

// Fitted to
//
//   studies/right_calibration.yaml, seed 51, 6000 draws, 4 trials of each condition
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
    {"constant", 0.0163595136},
    {"neighbour_root_z_above", 0.591128865},
    {"log_design_4_above", 1.18023065},
};

}  // namespace rcme
