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
    {"exclusive", 0.167033572},
    {"shared", 0.44334997},
    {"explained", 5.66994305},
    {"noise", -2.51796388},
    {"width", 0.509813831},
    {"forward", -1.34001046},
    {"axial", 2.03604679},
    {"turn", -1.94411532},
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
    {"constant", -2.12997015},
    {"posterior_log_odds", 0.0277098837},
    {"posterior", 2.16013664},
};
inline constexpr FittedProduct kFailureProducts[] = {
    {-0.0403016039, true, {"calibration_log_shift", 1, -4.41479962}},
    {-0.00834856422, true, {"log_behind", 1, -3.49650756}},
    {1.37540574, false, {"spread_in_matches", -1, 0.0205126212}},
    {-0.732814675, false, {"near_in_right", 1, -0.103386376}},
    {0.374439981, false, {"neighbour_root_z", 1, 1.17608711}},
    {-57.430671, false, {"near_in_right", 1, -0.103386376}, true, {"greatest_rival", -1, 0.0880375647}},
    {2.68464417, false, {"near_in_right", 1, -0.103386376}, true, {"log_rotation_sd", 1, -7.60692589}},
    {-0.165704859, false, {"calibration_root_gain", -1, 4.36175041}},
    {0.34123788, false, {"log_behind", 1, -3.49650756}},
    {0.271467281, false, {"parallax_spread", -1, -0.316033772}},
    {0.146583843, false, {"calibration_log_shift", 1, -7.84956508}},
    {0.6002041, false, {"rank_dependence", -1, 2.33734244}},
    {0.865237574, false, {"near_in_right", 1, -0.103386376}, true, {"rank_dependence", 1, 8.0643278}},
    {2.3170976, false, {"near_in_right", 1, -0.103386376}, true, {"log_noise_ratio", -1, -0.185187336}},
    {1.27478455, false, {"parallax_spread", -1, -0.316033772}, true, {"greatest_leverage", -1, 0.984385319}},
    {-0.212189418, false, {"log_design_4", -1, 1.6585}},
    {-12.1053328, false, {"spread_in_matches", -1, 0.0205126212}, true, {"wrong_coherence", -1, 0.142857143}},
    {0.101502775, true, {"planar_share", -1, 0.9375}},
    {2.80576875, false, {"spread_in_matches", -1, 0.0205126212}, true, {"planar_share", -1, 0.679245283}},
    {0.147323445, false, {"parallax_spread", -1, -0.316033772}, true, {"rank_dependence", -1, 10.7739351}},
    {-0.29332436, false, {"log_behind", 1, -3.49650756}, true, {"parallax_spread", -1, -0.0936067864}},
    {1.1921545, false, {"planar_share", 1, 0.0727272727}},
    {-0.172947311, false, {"log_design_4", -1, 1.6585}, true, {"log_num_right", 1, 3.97029191}},
    {0.319101554, false, {"neighbour_root_z", 1, 1.17608711}, true, {"log_rotation_sd", 1, -7.60692589}},
    {-10.7619454, false, {"near_in_right", 1, -0.00755272719}},
    {-9.65109831, false, {"planar_share", 1, 0.0727272727}, true, {"greatest_rival", -1, 0.0880375647}},
    {3.86013265, false, {"near_in_right", 1, -0.103386376}, true, {"log_behind", 1, -1.90423745}},
    {-0.0781202308, true, {"mean_gain", -1, 4.17979392}},
    {1.15043355, false, {"spread_in_matches", -1, 0.0205126212}, true, {"log_behind", -1, -4.63472899}},
    {2.50335473, false, {"log_design_4", -1, 1.6585}, true, {"greatest_leverage", 1, 0.816119811}},
    {-0.20304245, false, {"planar_share", 1, 0.0727272727}, true, {"rank_dependence", -1, 8.0643278}},
    {0.754545288, false, {"planar_share", 1, 0.0727272727}, true, {"log_rotation_sd", 1, -5.69761932}},
    {0.443074758, false, {"planar_share", 1, 0.0727272727}, true, {"rank_dependence", 1, 10.7739351}},
    {0.811400725, false, {"planar_share", 1, 0.0727272727}, true, {"low_depth", -1, -1.04159759}},
    {-0.0759438032, false, {"calibration_root_gain", -1, 4.36175041}, true, {"log_rotation_sd", -1, -5.69761932}},
    {-0.294118099, false, {"parallax_spread", -1, -0.316033772}, true, {"calibration_log_shift", 1, -4.41479962}},
    {0.407779911, false, {"log_behind", 1, -3.49650756}, true, {"mean_gain", 1, 5.06223605}},
    {-0.460957045, true, {"greatest_rival", 1, 0.0880375647}},
    {0.0451700332, false, {"log_noise_ratio", 1, -0.0286520811}},
    {0.305587555, false, {"log_noise_ratio", 1, -0.0286520811}, true, {"log_design_2", 1, 0.808994607}},
    {-27.8156767, false, {"near_in_right", 1, -0.103386376}, true, {"spread_in_matches", 1, -0.164609356}},
    {-0.319105226, false, {"spread_in_matches", -1, 0.0205126212}, true, {"rank_dependence", 1, 5.14257643}},
    {0.567680273, false, {"log_behind", 1, -3.49650756}, true, {"planar_share", -1, 0.9375}},
    {1.71659289, false, {"planar_share", 1, 0.0727272727}, true, {"log_noise_ratio", -1, -0.0286520811}},
    {-83.0744338, false, {"spread_in_matches", -1, 0.0205126212}, true, {"greatest_leverage", -1, 0.0747329198}},
    {0.362773818, false, {"near_in_right", -1, 0.023417122}},
    {0.663374582, false, {"near_in_right", -1, 0.023417122}, true, {"log_behind", -1, -1.90423745}},
    {0.316166177, true, {"wrong_coherence", -1, 0.142857143}},
    {0.314550146, false, {"log_design_4", -1, 1.6585}, true, {"log_behind", 1, -1.90423745}},
    {2.36998922, false, {"near_in_right", 1, -0.103386376}, true, {"calibration_log_shift", 1, -3.06498092}},
    {-7.2503025, false, {"planar_share", 1, 0.0727272727}, true, {"parallax_spread", 1, -0.0104013544}},
    {71.9268644, false, {"near_in_right", 1, -0.00755272719}, true, {"parallax_spread", 1, 0.079635204}},
    {-2.28941279, false, {"planar_share", 1, 0.0727272727}, true, {"log_noise_ratio", -1, -0.557273551}},
    {7.07257891, false, {"spread_in_matches", -1, 0.0205126212}, true, {"parallax_spread", 1, -0.0936067864}},
    {-0.0784200435, true, {"log_noise_ratio", -1, -0.185187336}},
    {634.027699, false, {"near_in_right", 1, -0.103386376}, true, {"mean_probability", 1, 0.9952605}},
    {0.0472313368, true, {"log_parallax_share", 1, -1.2314256}},
    {0.0862127938, false, {"log_behind", 1, -3.49650756}, true, {"rank_dependence", 1, 8.0643278}},
    {-0.954758216, false, {"near_in_right", -1, 0.023417122}, true, {"rank_dependence", 1, 10.7739351}},
    {-1.99192368, false, {"near_in_right", 1, -0.103386376}, true, {"log_rotation_sd", -1, -6.64657017}},
};
inline constexpr FittedRange kSignRanges[] = {
    {"posterior_log_odds", -11.5, 8.95074409},
    {"log_noise_ratio", -1.67053754, 1.82332543},
    {"neighbour_root_z", -2.05427829, 3.27400983},
    {"log_design_2", -2.30258509, 5.91171263},
    {"log_design_4", -0.744015233, 5.45696012},
    {"planar_share", 0.0234375, 1},
    {"log_parallax_share", -2.76485011, -0.0273437075},
    {"low_depth", -3, 3},
    {"spread_in_matches", -1.28806268, 0.156809236},
    {"log_num_right", 2.30258509, 7.4977617},
    {"wrong_coherence", 0, 1},
    {"rank_dependence", -1.30144061, 13.2671586},
    {"mean_probability", 0.877481448, 0.999984494},
    {"mean_gain", 2.38557045, 7.77237393},
    {"greatest_leverage", 0.0223341752, 1},
    {"log_rotation_sd", -10.2983405, -2.32199107},
    {"greatest_rival", 0, 0.443513117},
    {"log_behind", -8.07049889, 0.113498054},
    {"near_in_right", -2, 0.175735188},
    {"parallax_spread", -2, 0.294033463},
    {"calibration_log_reach", -6.33885735, 1.09861229},
    {"calibration_root_gain", 0.0265385545, 18.1253961},
    {"calibration_log_shift", -10.6687698, -0.930106176},
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
    {"constant", 0.018651711},
    {"neighbour_root_z_above", 0.66566796},
    {"log_design_4_above", 0.96629826},
};

}  // namespace rcme
