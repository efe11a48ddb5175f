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
    {"constant", -3.43755102},
    {"posterior_log_odds", 0.0320294763},
    {"posterior", 3.25461364},
};
inline constexpr FittedProduct kFailureProducts[] = {
    {-0.0291846521, true, {"log_design_2", 1, 1.38592389}},
    {-0.308895175, true, {"greatest_rival", 1, 0.00166215065}},
    {4.87220768, false, {"spread_in_matches", -1, 0.0199396092}},
    {-0.0750901716, true, {"mean_gain", -1, 4.20909103}},
    {0.639301818, false, {"log_parallax_share", -1, -1.1541006}},
    {0.422981233, false, {"log_rotation_sd", 1, -8.38308576}},
    {0.314222283, false, {"log_rotation_sd", 1, -8.38308576}, true, {"wrong_coherence", 1, 0.0866429766}},
    {1.1984544, false, {"low_depth", -1, -0.991951037}},
    {0.419456958, false, {"neighbour_root_z", 1, 0.0432098295}},
    {-22.0021457, false, {"greatest_rival", -1, 0.0747393376}},
    {1.00821546, false, {"rank_dependence", -1, 1.34727546}},
    {0.249329267, false, {"rank_dependence", 1, 7.48793686}},
    {1.09906841, false, {"log_parallax_share", -1, -1.1541006}, true, {"greatest_leverage", -1, 0.842826971}},
    {-0.257961372, false, {"neighbour_root_z", 1, 0.0432098295}, true, {"log_design_2", -1, 2.2345947}},
    {-0.98332871, false, {"rank_dependence", 1, 7.48793686}, true, {"spread_in_matches", -1, 0.00323454312}},
    {0.19702655, false, {"log_parallax_share", -1, -1.1541006}, true, {"rank_dependence", -1, 10.3289133}},
    {22.0214835, false, {"rank_dependence", -1, 1.34727546}, true, {"greatest_leverage", 1, 0.842826971}},
    {-4.02107843, false, {"low_depth", -1, -0.991951037}, true, {"planar_share", -1, 0.513513514}},
    {0.551761063, false, {"log_num_right", 1, 5.98393628}},
    {12.1800692, false, {"greatest_rival", -1, 0.0747393376}, true, {"log_noise_ratio", 1, -0.0221614}},
    {0.78717335, false, {"log_noise_ratio", -1, -0.0221614}},
    {53.7664236, false, {"mean_probability", -1, 0.958409817}},
    {146.564836, false, {"log_rotation_sd", 1, -8.38308576}, true, {"mean_probability", 1, 0.998705435}},
    {-0.785463465, false, {"log_design_4", -1, 1.47653263}},
    {-0.220954317, false, {"log_parallax_share", -1, -1.1541006}, true, {"log_design_4", 1, 0.235643703}},
    {-20.2756958, false, {"mean_probability", -1, 0.958409817}, true, {"low_depth", 1, 0.817467826}},
    {-0.582974513, false, {"rank_dependence", -1, 1.34727546}, true, {"neighbour_root_z", 1, 0.0432098295}},
    {1.89270565, false, {"rank_dependence", 1, 7.48793686}, true, {"planar_share", 1, 0.907692308}},
    {-25.7415056, false, {"spread_in_matches", -1, 0.0199396092}, true, {"wrong_coherence", -1, 0.0866429766}},
    {0.343933164, false, {"log_design_4", -1, 1.47653263}, true, {"log_num_right", -1, 5.20400669}},
    {1.66011537, false, {"low_depth", -1, -0.991951037}, true, {"rank_dependence", 1, 10.3289133}},
    {0.119150014, true, {"planar_share", -1, 0.907692308}},
    {0.313530324, false, {"log_rotation_sd", 1, -8.38308576}, true, {"greatest_leverage", -1, 0.842826971}},
    {-4.81643871, false, {"spread_in_matches", -1, 0.0199396092}, true, {"log_parallax_share", 1, -0.613846993}},
    {-24.9676195, false, {"mean_probability", -1, 0.958409817}, true, {"log_parallax_share", -1, -0.340174203}},
    {11.6231267, false, {"greatest_rival", -1, 0.0747393376}, true, {"wrong_coherence", 1, 0}},
};
inline constexpr FittedRange kSignRanges[] = {
    {"posterior_log_odds", -11.5, 7.22409774},
    {"log_noise_ratio", -1.45896687, 1.71664918},
    {"neighbour_root_z", -2.0319635, 3.11306969},
    {"log_design_2", -2.1934681, 5.71169999},
    {"log_design_4", -0.764169207, 5.30866266},
    {"planar_share", 0.0234375, 1},
    {"log_parallax_share", -2.76558926, -0.0336446588},
    {"low_depth", -3, 3},
    {"spread_in_matches", -1.09764708, 0.155015043},
    {"log_num_right", 2.07944154, 7.46291529},
    {"wrong_coherence", 0, 1},
    {"rank_dependence", -1.00291253, 13.254167},
    {"mean_probability", 0.882029848, 0.999983376},
    {"mean_gain", 2.43416807, 7.79399055},
    {"greatest_leverage", 0.0227614795, 1},
    {"log_rotation_sd", -10.2561183, -2.67611397},
    {"greatest_rival", 0, 0.431233648},
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
    {"constant", 0.0655146832},
    {"neighbour_root_z_above", 0.68054944},
    {"log_design_4_above", 0.81368296},
};

}  // namespace rcme
