#include "experiments/run/store/column_meaning.h"

#include <map>
#include <stdexcept>

namespace rcme {

const ColumnMeaning& MeaningOf(const std::string& column) {
  static const std::map<std::string, ColumnMeaning> meanings = {
      {"condition", {"", "number of the condition, from 0"}},
      {"trial", {"", "number of the trial within its condition, from 0"}},
      {"estimator", {"", "number of the estimator, from 0"}},
      // What a problem is like.
      {"weight",
       {"", "of the trial: 1, unless its number of outliers was drawn by importance (`tilted_to`)"}},
      {"num_inliers_true", {"matches", "true matches; NULL for real pairs"}},
      {"image_coverage", {"share", "of image 1 within the convex hull of the true matches"}},
      {"inlier_clark_evans",
       {"", "Clark-Evans index of the true matches in image 1: 1 random, below 1 clustered"}},
      {"outlier1_clark_evans", {"", "the same of the wrong matches in image 1"}},
      {"outlier2_clark_evans", {"", "the same of the wrong matches in image 2"}},
      {"parallax_median_deg", {"deg", "angle at a point between the rays to the two centres: median"}},
      {"parallax_p10_deg", {"deg", "the same, 10th percentile"}},
      {"planarity",
       {"", "rms distance of the points from their plane over that from their centroid: 0 for a plane"}},
      {"homography_share", {"share", "of the true matches that one homography explains"}},
      {"log10_condition",
       {"", "log10 of the condition number of the motion's information matrix (5x5, rad)"}},
      {"crb_rotation_deg", {"deg", "Cramer-Rao bound of the rotation: least rms error without bias"}},
      {"crb_direction_deg", {"deg", "the same of the direction of translation"}},
      {"chance_inlier_share",
       {"share", "of uniform wrong matches that the true motion would accept at 95 %"}},
      {"undetectable_share", {"share", "of all matches: wrong, but on the true epipolar line"}},
      // What became of a call.
      {"status", {"", "`ok`, the reason of a refusal, or what is not valid about the answer"}},
      {"rotation_error_deg", {"deg", "error of the rotation; NULL without a rotation or its truth"}},
      {"direction_error_deg", {"deg", "error of the direction of translation; NULL likewise"}},
      {"nees",
       {"", "normalised estimation error squared, 5 degrees of freedom; infinite: nothing is covered"}},
      {"num_matches", {"matches", "matches of the problem"}},
      {"num_inliers", {"matches", "final inliers"}},
      {"inlier_precision",
       {"share", "true ones among the final inliers, undetectable wrong ones left aside"}},
      {"inlier_recall", {"share", "final inliers among the true matches"}},
      {"num_support", {"matches", "n_j of the selected hypothesis"}},
      {"mean_entropy", {"nats", "psi_j of the selected hypothesis; NULL without one"}},
      {"z_statistic", {"", "Z_j of the selected hypothesis; NULL without one"}},
      {"num_consistent_before", {"matches", "n_I: consistent with the motion before its refinement"}},
      {"num_consistent_after", {"matches", "n*_I: the same after it"}},
      {"failed_by_kappa", {"0 or 1", "the paper's failure flag: n*_I / n_I <= kappa"}},
      {"num_explained", {"matches", "matches that agree with the refined motion"}},
      {"num_hypotheses", {"", "minimal samples drawn"}},
      {"num_degenerate_samples", {"", "of these without a motion"}},
      {"num_inconsistent_samples", {"", "of these refused by the sample test"}},
      {"num_poor_inlier_sets", {"", "hypotheses whose mean entropy exceeded mu"}},
      {"num_too_small_inlier_sets", {"", "hypotheses with too few inliers"}},
      {"num_candidates", {"", "hypotheses that passed every test"}},
      {"failure_probability",
       {"",
        "probability that the motion is beyond the bounds, as the estimator states it; NULL: it states "
        "none"}},
      {"sigma_estimated_px", {"px", "noise per coordinate, estimated from the residuals; NULL likewise"}},
      {"sigma_estimated_sd_px", {"px", "its standard deviation, as the estimator states it; NULL likewise"}},
      {"inlier_brier",
       {"", "mean squared error of the inlier probabilities, undetectable wrong matches left aside"}},
      {"doubt",
       {"",
        "what makes the motion uncertain: 0 nothing, 1 another motion, 2 a plane, 3 few influential matches, "
        "4 the opposite direction, 5 low parallax, 6 few matches"}},
      {"seconds",
       {"s",
        "processor time of the call, of the thread that makes it; the only number that another run does not "
        "repeat"}},
  };
  const auto found = meanings.find(column);
  if (found == meanings.end()) throw std::logic_error("no meaning is written down for the column " + column);
  return found->second;
}

}  // namespace rcme
