// The law of displacements at one axis of the translation: what PosteriorOfDirection sums over the sphere.
// Its formulas are in calibrated/direction_posterior.h.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "estimator/calibrated/explain_matches.h"

namespace rcme {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct Displacement {
  size_t match;  // index of the match
  // unit ray of camera 1 in camera 2's frame; (b - a) projected onto the plane normal to a
  Eigen::Vector3d a, d;
  // Of this match, with its noise_scale, divided by the weight of its residual: s^2, and how much more the
  // variance is along a unit vector u, u' excess u (zero if the pixels are square). rad^2
  double noise_variance;
  Eigen::Matrix3d noise_excess;
};

struct DisplacementSet {
  std::vector<Displacement> matches;
  double all_over_used = 1.0;  // explained matches per match in `matches`
  double image_rad = 1.0;      // extent of image 2, over which the displacement of an outlier is uniform
  Eigen::Vector3d mean_ray = Eigen::Vector3d::UnitZ();  // unit
  double size_rad = 1.0;                                // root mean square of |d|
  // The prior of w, if there is one: cost |r + J w|^2 / 2, with r and J at the mode's rotation. And the prior
  // of the direction.
  std::optional<PriorResiduals> of_rotation = {};
  std::optional<DirectionPrior> of_direction = {};
};

// The first 256 matches that the mode explains, and the problem's prior linearised at the mode.
DisplacementSet CollectDisplacements(const MotionProblem& problem, const ExplainedMode& mode);

// The fit of the law at one axis.
struct AxisFit {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  Vector6d x = Vector6d::Zero();  // w, n: the inverse depth of a ray a is n'a
  double variance = 0.0;          // v
  double near = 0.0;              // share of matches with a parallax of any size
  double log_likelihood = -std::numeric_limits<double>::infinity();
  // The inverse depth of the plane n, in standard deviations: at the mean ray, and the extremes over the
  // matches.
  double mean = 0.0, least = 0.0, greatest = 0.0;
  Matrix6d information = Matrix6d::Zero();  // of x, from the matches in the set
};

// Fits the law by three steps of expectation-maximisation. `direction` is a unit vector.
AxisFit FitAxis(const DisplacementSet& set, const Eigen::Vector3d& direction);

// Whether a displacement is more likely that of an outlier than of an inlier of any depth.
bool IsOutlier(const DisplacementSet& set, const Displacement& match, const AxisFit& fit);

}  // namespace rcme
