// Indicators, computed without the truth, of how well the assumptions behind the modes' probabilities hold:
// the noise is independent and of the assumed size, outliers are unrelated to each other, and the scene is
// deep.
#pragma once

#include "estimator/calibrated/intrinsics_check.h"
#include "estimator/calibrated/partner_dependence.h"
#include "estimator/calibrated/weigh_modes.h"

namespace rcme {

// Indicators of the answer. "Right" matches are those that it explains, "wrong" ones the others. Residuals r
// are in units of the mode's scale s, depths z in standard deviations of a match's parallax.
struct ModelCheck {
  double log_noise_ratio = 0.0;  // ln(estimated sigma / assumed sigma)
  // Correlation of neighbours: the mean product of the residuals (clipped to +-3) of a right match and its
  // nearest right neighbour in image 1, times the square root of the number of pairs. For independent
  // residuals its mean is 0 and its standard deviation 1.4 to 1.7, because two matches that are each other's
  // nearest count twice and s is a little less than their standard deviation.
  double neighbour_z = 0.0;
  // The share of right matches whose second point lies within four standard deviations of the first point
  // mapped by the homography of one plane (twisted_pair.h).
  double planar_share = 0.0;
  // ln of a ratio of lengths: a quarter of the log of det(scatter of the right matches in image 1) over that
  // of all matches.
  double spread_in_matches = 0.0;
  // Of the matches within three standard deviations of their epipolar lines: ln((b + 1/2) / (a + 1/2)), where
  // a have a point in front of the cameras, b one behind them, and both a parallax above three standard
  // deviations. The points of a scene are in front; wrong matches are on either side, whether they lie on
  // their lines by chance or are other repetitions of a texture.
  double log_behind = 0.0;
  // The spread of the right matches with such a parallax in front, in that of all right matches, as
  // spread_in_matches; parallax_spread weights each by z^2. A moving object in front of a scene without
  // parallax is a small group.
  double near_in_right = 0.0, parallax_spread = 0.0;
  // How much of the image holds the parallax: ln of (sum b)^2 / (n sum b^2), where b is the sum of z^2, z >
  // 0, in a block and n the number of those of the 4x4 blocks of image 1 with right matches (Kish 1965).
  double log_parallax_share = 0.0;
  // ln of the design effect of 2x2 and of 4x4 blocks, in units of the information: the squared change of the
  // motion if a block is left out, summed over the blocks, over the sum of the squared scores of single
  // matches. For independent residuals some tenths above 0.
  double log_design_2 = 0.0, log_design_4 = 0.0;
  double log_num_right = 0.0;    // ln(max(number of right matches, 1))
  double wrong_share = 0.0;      // wrong matches over all matches
  double wrong_coherence = 0.0;  // ComputeCoherence (neighbour_matches.h) of the wrong matches
  // Over the right matches: the mean probability of being right, the mean of ln(density of the residual / q)
  // (mixture_parameters.h), and the greatest leverage (explanation.h).
  double mean_probability = 1.0, mean_gain = 0.0, greatest_leverage = 0.0;
  double log_rotation_sd = 0.0;      // ln of the rotation's standard deviation by the likelihood, rad
  double greatest_rival = 0.0;       // greatest weight of a mode beyond the bounds around the answer
  double low_depth = 0.0;            // 0.05 quantile of z / s of the right matches, within [-3, 3]
  double usual_depth = 0.0;          // 0.8 quantile of their z (direction_posterior.h)
  IntrinsicsCheck calibration = {};  // whether errors of the calibration could move the answer
  PartnerDependence partner_dependence = {};  // of the right matches
};

// Checks the answer. Only the first 128 matches of a kind are compared with each other; their order must be
// random.
ModelCheck CheckModel(const MotionProblem& problem, const std::vector<ExplainedMode>& modes,
                      const ModeWeights& weights);

}  // namespace rcme
