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
    {"constant", -2.29392101},
    {"posterior_log_odds", 0.0522076975},
    {"posterior", 2.09799896},
};
inline constexpr FittedProduct kFailureProducts[] = {
    {-0.0313230346, true, {"calibration_log_shift", 1, -4.44431534}},
    {-0.0280555171, true, {"log_behind", 1, -3.49650756}},
    {0.178407397, false, {"neighbour_root_z", 1, 1.17272238}},
    {0.783470758, false, {"spread_in_matches", -1, 0.0204193107}},
    {-3.15531685, false, {"near_in_right", 1, -0.108938465}},
    {0.19932542, false, {"log_rotation_sd", 1, -7.6209812}},
    {0.218980408, false, {"calibration_log_shift", 1, -7.88779213}},
    {0.275132561, false, {"log_behind", 1, -3.49650756}},
    {-41.5970658, false, {"near_in_right", 1, -0.108938465}, true, {"greatest_rival", -1, 0.0782332817}},
    {-0.0659308143, true, {"parallax_spread", -1, -0.313405833}},
    {0.0706128743, false, {"rank_dependence", -1, 2.338558}},
    {0.580736243, false, {"rank_dependence", 1, 10.7733912}},
    {1.09215035, false, {"wrong_coherence", 1, 0}},
    {-0.431220234, false, {"log_design_4", -1, 1.68451874}},
    {0.952459426, false, {"log_noise_ratio", -1, -0.0301586498}},
    {0.553132048, false, {"near_in_right", -1, -0.108938465}},
    {-0.146902562, false, {"calibration_root_gain", -1, 4.29230624}},
    {0.823981772, false, {"near_in_right", -1, -0.108938465}, true, {"log_behind", -1, -1.94591015}},
    {0.0140178062, true, {"log_design_2", -1, 4.02348019}},
    {2.84866331, false, {"spread_in_matches", -1, 0.0204193107}, true, {"planar_share", -1, 0.671875}},
    {-0.359449046, false, {"calibration_log_shift", 1, -7.88779213}, true, {"planar_share", -1, 0.671875}},
    {-3.55379803, false, {"wrong_coherence", 1, 0}, true, {"planar_share", 1, 0.671875}},
    {1.57984167, false, {"spread_in_matches", -1, 0.0204193107}, true, {"log_parallax_share", -1, -0.224282261}},
    {0.136738776, false, {"log_rotation_sd", 1, -7.6209812}, true, {"greatest_leverage", -1, 0.802838092}},
    {0.311657572, false, {"log_design_4", -1, 1.68451874}, true, {"log_num_right", -1, 5.10594547}},
    {2.05221588, false, {"near_in_right", 1, -0.108938465}, true, {"log_noise_ratio", 1, -0.0301586498}},
    {1.14914068, false, {"log_behind", 1, -3.49650756}, true, {"parallax_spread", 1, -0.313405833}},
    {-5.2644396, false, {"parallax_spread", 1, -0.00965500804}},
    {10.4108081, false, {"spread_in_matches", -1, 0.0204193107}, true, {"parallax_spread", 1, -0.0935943618}},
    {0.0532183571, false, {"log_rotation_sd", 1, -7.6209812}, true, {"log_behind", -1, -3.49650756}},
    {1.12171292, false, {"rank_dependence", -1, 2.338558}, true, {"greatest_leverage", 1, 0.444787785}},
    {0.06591083, false, {"log_rotation_sd", 1, -7.6209812}, true, {"log_parallax_share", -1, -0.382769069}},
    {-9.10435135, false, {"near_in_right", 1, -0.108938465}, true, {"planar_share", -1, 0.9921875}},
    {0.451752787, false, {"log_behind", 1, -3.49650756}, true, {"planar_share", -1, 0.9921875}},
    {1.03819341, false, {"rank_dependence", -1, 2.338558}, true, {"planar_share", -1, 0.671875}},
    {-10.2645289, false, {"spread_in_matches", -1, 0.0204193107}, true, {"wrong_coherence", -1, 0.139534884}},
    {-9.90826175, false, {"greatest_rival", -1, 0.0782332817}},
    {0.0450341541, true, {"greatest_leverage", 1, 0.169354712}},
    {0.164043309, false, {"log_behind", 1, -3.49650756}, true, {"mean_gain", 1, 4.18739869}},
    {0.458518732, false, {"log_design_4", -1, 1.68451874}, true, {"log_behind", 1, -1.94591015}},
    {0.0701361204, false, {"log_rotation_sd", 1, -7.6209812}, true, {"neighbour_root_z", 1, -0.977047879}},
    {-1.05855217, false, {"near_in_right", -1, -0.108938465}, true, {"low_depth", 1, -1.05870933}},
    {-37.410268, false, {"log_behind", 1, -3.49650756}, true, {"planar_share", 1, 0.9921875}},
    {-12.4796417, false, {"wrong_coherence", 1, 0}, true, {"near_in_right", 1, 0.000272934787}},
    {-0.182839843, false, {"rank_dependence", 1, 10.7733912}, true, {"log_design_4", 1, 2.98435843}},
    {0.0262689884, false, {"log_design_2", 1, 0.823496512}},
    {0.354631797, false, {"log_design_2", 1, 0.823496512}, true, {"greatest_leverage", -1, 0.802838092}},
    {-9.21685567, false, {"wrong_coherence", 1, 0}, true, {"greatest_leverage", -1, 0.169354712}},
    {0.156719596, false, {"neighbour_root_z", 1, 1.17272238}, true, {"rank_dependence", 1, 8.06874289}},
    {-0.810287773, false, {"rank_dependence", 1, 10.7733912}, true, {"planar_share", -1, 0.9921875}},
    {0.910590317, false, {"spread_in_matches", -1, 0.0204193107}, true, {"log_behind", -1, -4.61512052}},
    {-0.0547109559, false, {"parallax_spread", -1, -0.313405833}},
    {1.05822504, false, {"parallax_spread", -1, -0.313405833}, true, {"greatest_leverage", -1, 0.977890436}},
    {-0.439330877, false, {"parallax_spread", -1, -0.313405833}, true, {"mean_gain", -1, 5.0640237}},
    {0.0902509538, false, {"parallax_spread", -1, -0.313405833}, true, {"rank_dependence", -1, 12.1842155}},
    {0.0347825005, false, {"log_rotation_sd", 1, -7.6209812}, true, {"rank_dependence", 1, 2.338558}},
    {3.08193409, false, {"near_in_right", 1, -0.108938465}, true, {"log_rotation_sd", 1, -5.70386548}},
    {-0.284255341, false, {"spread_in_matches", -1, 0.0204193107}, true, {"rank_dependence", 1, 5.13843604}},
    {0.208687144, false, {"log_design_2", 1, 0.823496512}, true, {"log_noise_ratio", 1, -0.0301586498}},
    {0.281600392, false, {"rank_dependence", 1, 10.7733912}, true, {"low_depth", -1, 0.313065602}},
};
inline constexpr FittedRange kSignRanges[] = {
    {"posterior_log_odds", -11.5, 6.65291367},
    {"log_noise_ratio", -1.67056795, 1.8403144},
    {"neighbour_root_z", -2.05315704, 3.29745052},
    {"log_design_2", -2.30258509, 5.99122637},
    {"log_design_4", -0.7293907, 5.54587457},
    {"planar_share", 0.0234375, 1},
    {"log_parallax_share", -2.76427477, -0.0280964924},
    {"low_depth", -3, 3},
    {"spread_in_matches", -1.26802493, 0.156459253},
    {"log_num_right", 2.30258509, 7.50052949},
    {"wrong_coherence", 0, 1},
    {"rank_dependence", -1.3122292, 13.2754194},
    {"mean_probability", 0.87782018, 0.999984899},
    {"mean_gain", 2.37939297, 7.79617734},
    {"greatest_leverage", 0.0225163838, 1},
    {"log_rotation_sd", -10.3008037, -2.33211042},
    {"greatest_rival", 0, 0.432819845},
    {"log_behind", -8.06670348, 0.0523083703},
    {"near_in_right", -2, 0.187296564},
    {"parallax_spread", -2, 0.295879876},
    {"calibration_log_reach", -6.3448554, 1.09861229},
    {"calibration_root_gain", 0.0261368104, 18.4129711},
    {"calibration_log_shift", -10.7028241, -0.955055247},
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
    {"constant", 0.0202271516},
    {"neighbour_root_z_above", 0.694722549},
    {"log_design_4_above", 0.905978956},
};

}  // namespace rcme
