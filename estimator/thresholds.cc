#include "estimator/thresholds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/distributions.h"

namespace rcme {

// The bounds of the point test (eq::find-inlier), of the sample test (eq. 12) and of Z_j (eq. 19).
Thresholds Thresholds::For(const MotionProblem& problem, const RansacOptions& options, int point_dof,
                           int sample_dof) {
  const double confidence = 1.0 - options.significance_level;
  const double diagonal_px = std::hypot(problem.camera2.width, problem.camera2.height);
  const double sample_level = options.SampleLevelOrDefault();
  const double sample = sample_dof == 0 ? std::numeric_limits<double>::infinity()
                                        : ChiSquareQuantile(sample_dof, 1.0 - sample_level);
  const bool is_same = point_dof == sample_dof && sample_level == options.significance_level;
  return {is_same ? sample : ChiSquareQuantile(point_dof, confidence), sample, NormalQuantile(confidence),
          std::log(std::max(diagonal_px / problem.sigma_px, 1.0))};
}

}  // namespace rcme
