// Quantities, all visible without the truth, that show how far the model behind the modes' probabilities
// holds: independent noise of the assumed size, wrong matches unrelated to each other, a scene that is deep.
#pragma once

#include "estimator/calibrated/partner_dependence.h"
#include "estimator/calibrated/weigh_modes.h"

namespace rcme {

// Of the answer. "Right" matches are those that it explains, "wrong" the others; residuals r are in units of
// the mode's scale s, depths z in standard deviations of a match's parallax.
struct ModelCheck {
  double log_noise_ratio = 0.0;  // ln(sigma found / sigma assumed)
  // Mean product of the residuals, cut at 3, of a right match and its nearest right neighbour in image 1,
  // times the square root of the number of pairs: of mean 0 and standard deviation 1.4 to 1.7 where residuals
  // are independent, as two matches that are each other's nearest count twice and s is a little less than
  // their standard deviation.
  double neighbour_z = 0.0;
  // Of the right matches: those whose second point lies within four standard deviations of where the
  // homography of one plane (twisted_pair.h) takes the first.
  double planar_share = 0.0;
  // Quarter of the log of det(scatter of the right matches in image 1) over that of all matches: ln of a
  // length.
  double spread_in_matches = 0.0;
  // ln of the share of the 4x4 blocks of image 1 with right matches that hold the parallax: (sum b)^2 / sum
  // b^2 over their number (Kish 1965), b the sum of z^2 in a block, z > 0.
  double log_parallax_share = 0.0;
  // ln of the design effect of 2x2 and of 4x4 blocks, in units of the information: how far the motion moves
  // where a block is left out, squared and summed over the blocks, over the sum of the squared scores of
  // single matches. Some tenths above 0 where residuals are independent.
  double log_design_2 = 0.0, log_design_4 = 0.0;
  double log_num_right = 0.0;  // ln of their number, of at least one
  double wrong_share = 0.0;    // of all matches
  // Of the wrong matches: those that move as their nearest wrong neighbour does, the two displacements no
  // more apart than half the distance of the neighbours and three standard deviations.
  double wrong_coherence = 0.0;
  // Of the right matches, the means of the probability that a match is right and of ln of the density of its
  // residual over q (mixture_parameters.h); the greatest leverage of one (explanation.h).
  double mean_probability = 1.0, mean_gain = 0.0, greatest_leverage = 0.0;
  double log_rotation_sd = 0.0;  // ln of the rotation's standard deviation by the likelihood, rad
  double greatest_rival = 0.0;   // the greatest weight of a mode beyond the bounds around the answer
  double low_depth = 0.0;        // a twentieth of the right matches have a smaller z / s, within [-3, 3]
  double usual_depth = 0.0;      // a fifth have a greater one (direction_posterior.h)
  PartnerDependence partner_dependence = {};  // of the right matches
};

// At most 128 matches of a kind, the first, are compared with each other: the matches are in an order that
// means nothing.
ModelCheck CheckModel(const MotionProblem& problem, const std::vector<ExplainedMode>& modes,
                      const ModeWeights& weights);

}  // namespace rcme
