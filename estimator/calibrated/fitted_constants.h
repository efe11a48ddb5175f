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
    {"exclusive", 0.168938139},
    {"shared", 0.437320825},
    {"explained", 5.19515438},
    {"noise", -2.28459974},
    {"width", 0.478917376},
    {"forward", -1.44136011},
    {"axial", 2.01619338},
    {"turn", -1.92496907},
};

// Fitted to
//
//   studies/right_calibration.yaml, seed 74, 4000 draws, 4 trials of each condition
inline constexpr FittedTerm kSecondMotionTerms[] = {
    {"number", 2.04282006},
    {"extent", 5.16928383},
};

// Fitted to
//
//   studies/right_calibration.yaml, seed 51, 6000 draws, 4 trials of each condition
//   studies/any_condition.yaml, seed 55, 3000 draws, 4 trials of each condition, for P alone
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
    {"constant", -2.38038712},
    {"posterior_log_odds", 0.0531083748},
    {"posterior", 2.03078858},
};
inline constexpr FittedProduct kFailureProducts[] = {
    {-0.0388099327, true, {"calibration_log_shift", 1, -4.44836594}},
    {-0.0331888408, true, {"log_behind", 1, -3.49650756}},
    {-0.882709298, false, {"near_in_right", 1, -0.108433637}},
    {0.212886215, false, {"log_rotation_sd", 1, -7.6361585}},
    {-0.123543127, false, {"calibration_root_gain", -1, 4.27836816}},
    {-92.2262995, false, {"near_in_right", 1, -0.108433637}, true, {"greatest_rival", -1, 0.0790855162}},
    {0.335911017, false, {"log_behind", 1, -3.49650756}},
    {-0.0401455777, true, {"parallax_spread", -1, -0.314476784}},
    {0.257010298, false, {"calibration_log_shift", 1, -6.74888669}},
    {0.0455490304, false, {"neighbour_root_z", 1, 1.1779455}},
    {0.343339561, false, {"parallax_spread", -1, -0.314476784}},
    {0.053250801, false, {"rank_dependence", -1, 2.48118515}},
    {0.315665514, false, {"rank_dependence", 1, 10.81331}},
    {0.75020997, false, {"log_noise_ratio", -1, -0.0297778589}},
    {0.845382912, false, {"parallax_spread", -1, -0.314476784}, true, {"greatest_leverage", -1, 0.977890436}},
    {0.0135667262, true, {"log_design_2", -1, 4.01574459}},
    {0.140106943, false, {"parallax_spread", -1, -0.314476784}, true, {"rank_dependence", -1, 10.81331}},
    {-0.357933397, false, {"log_behind", 1, -3.49650756}, true, {"parallax_spread", -1, -0.0947408754}},
    {-0.39571326, false, {"calibration_log_shift", 1, -6.74888669}, true, {"planar_share", -1, 0.6796875}},
    {6.39477212, false, {"near_in_right", 1, -0.108433637}, true, {"log_noise_ratio", 1, -0.0297778589}},
    {13.9608652, false, {"near_in_right", 1, -0.108433637}, true, {"spread_in_matches", -1, 0.0240336827}},
    {-0.337803945, false, {"log_design_4", -1, 1.6724931}},
    {0.0420244348, false, {"log_rotation_sd", 1, -7.6361585}, true, {"rank_dependence", 1, 2.48118515}},
    {0.349615878, false, {"log_design_4", -1, 1.6724931}, true, {"log_num_right", -1, 5.0937502}},
    {0.104860347, false, {"log_rotation_sd", 1, -7.6361585}, true, {"greatest_leverage", -1, 0.803811507}},
    {0.501512502, false, {"near_in_right", -1, -0.108433637}},
    {-11.3650376, false, {"near_in_right", 1, -0.00774022602}},
    {4.79240196, false, {"near_in_right", 1, -0.108433637}, true, {"log_behind", 1, -1.94591015}},
    {0.274464313, false, {"log_behind", 1, -3.49650756}, true, {"mean_gain", 1, 4.17726235}},
    {-8.06570673, false, {"near_in_right", 1, -0.108433637}, true, {"planar_share", -1, 0.9921875}},
    {1.08538729, false, {"rank_dependence", -1, 2.48118515}, true, {"planar_share", -1, 0.6796875}},
    {3.55172614, false, {"near_in_right", 1, -0.108433637}, true, {"log_rotation_sd", 1, -5.73191646}},
    {-4.78670228, false, {"log_design_4", -1, 1.6724931}, true, {"greatest_rival", -1, 0.0790855162}},
    {0.0230768348, true, {"mean_gain", 1, 3.5476006}},
    {0.675427639, false, {"near_in_right", -1, -0.108433637}, true, {"log_behind", -1, -1.94591015}},
    {-3.12870978, false, {"parallax_spread", 1, -0.010880385}},
    {1998.17162, false, {"near_in_right", 1, -0.00774022602}, true, {"mean_probability", 1, 0.995344753}},
    {0.917992636, false, {"rank_dependence", -1, 2.48118515}, true, {"greatest_leverage", 1, 0.444560948}},
    {0.0640323404, false, {"log_rotation_sd", 1, -7.6361585}, true, {"neighbour_root_z", 1, -0.974336033}},
    {0.65543751, false, {"log_rotation_sd", 1, -7.6361585}, true, {"wrong_coherence", 1, 0.75}},
    {-0.247012496, false, {"parallax_spread", -1, -0.314476784}, true, {"calibration_log_shift", 1, -4.44836594}},
    {-0.39230817, false, {"log_design_4", -1, 1.6724931}, true, {"log_noise_ratio", 1, -0.185177777}},
    {0.154626021, false, {"neighbour_root_z", 1, 1.1779455}, true, {"rank_dependence", 1, 8.13209124}},
    {0.266954372, false, {"log_behind", 1, -3.49650756}, true, {"log_noise_ratio", 1, -0.185177777}},
    {0.411988799, false, {"log_design_4", -1, 1.6724931}, true, {"log_behind", 1, -1.94591015}},
    {0.130434208, false, {"low_depth", -1, -1.05915401}},
    {0.248566619, false, {"low_depth", -1, -1.05915401}, true, {"rank_dependence", 1, 8.13209124}},
    {-0.202613623, false, {"rank_dependence", 1, 10.81331}, true, {"log_design_4", 1, 2.96169211}},
    {5.40865043, false, {"rank_dependence", 1, 10.81331}, true, {"planar_share", 1, 0.934782609}},
    {0.0434894623, false, {"log_design_2", 1, 0.21804399}},
    {0.279432576, false, {"log_design_2", 1, 0.21804399}, true, {"greatest_leverage", -1, 0.803811507}},
    {-0.444745293, false, {"parallax_spread", -1, -0.314476784}, true, {"calibration_log_shift", -1, -7.87512719}},
    {0.0807831093, false, {"calibration_root_gain", -1, 4.27836816}, true, {"calibration_log_reach", -1, -4.2926227}},
    {-2.56183265, false, {"log_noise_ratio", -1, -0.0297778589}, true, {"log_num_right", 1, 6.71259146}},
    {0.364171795, false, {"rank_dependence", 1, 10.81331}, true, {"log_noise_ratio", -1, -0.0297778589}},
    {-30.0120109, false, {"near_in_right", 1, -0.108433637}, true, {"spread_in_matches", 1, -0.000540024863}},
    {2.93894176, false, {"log_behind", 1, -3.49650756}, true, {"mean_probability", -1, 0.995344753}},
    {-0.499655416, false, {"calibration_root_gain", -1, 4.27836816}, true, {"wrong_coherence", -1, 0.135135135}},
    {-0.800925065, true, {"spread_in_matches", 1, 0.0240336827}},
    {0.303511599, false, {"neighbour_root_z", 1, 1.1779455}, true, {"log_parallax_share", -1, -0.678983117}},
};
inline constexpr FittedRange kSignRanges[] = {
    {"posterior_log_odds", -11.5, 6.26904267},
    {"log_noise_ratio", -1.66084599, 1.83855718},
    {"neighbour_root_z", -2.05741997, 3.46284684},
    {"log_design_2", -2.30258509, 6.04542144},
    {"log_design_4", -0.718976018, 5.51597149},
    {"planar_share", 0.0234375, 1},
    {"log_parallax_share", -2.7648751, -0.031242401},
    {"low_depth", -3, 3},
    {"spread_in_matches", -0.901586566, 0.271917613},
    {"log_num_right", 2.30258509, 7.50052949},
    {"wrong_coherence", 0, 1},
    {"rank_dependence", -0.988958094, 13.275532},
    {"mean_probability", 0.876674872, 0.999985541},
    {"mean_gain", 2.37050318, 7.7915482},
    {"greatest_leverage", 0.0224339275, 1},
    {"log_rotation_sd", -10.2970031, -2.46868586},
    {"greatest_rival", 0, 0.434678378},
    {"log_behind", -8.06683531, 0.0526437335},
    {"near_in_right", -2, 0.182120265},
    {"parallax_spread", -2, 0.286183508},
    {"calibration_log_reach", -6.3388716, 1.09861229},
    {"calibration_root_gain", 0.0267481397, 18.1393951},
    {"calibration_log_shift", -10.6865881, -0.945474748},
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
    {"constant", 0.0752114343},
    {"neighbour_root_z_above", 0.728480801},
    {"log_design_4_above", 0.784393297},
};

}  // namespace rcme
