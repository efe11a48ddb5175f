// The posterior of rcme_calibrated as one distribution of the motion: a mixture of the modes and of "none of
// these". The stated probability of failure, those for other bounds, the covariance, regions and medians are
// all computed from it.
//
//   the answer    N(mode, its covariance) in the tangent at each mode within the failure bounds, wider with
//                 the probability that the calibration has errors (unstated_errors.h); if the direction is
//                 weak (settle_direction.h), cells of the whole sphere instead, each with a normal law of the
//                 rotation
//   rivals        N(mode, the covariance by its likelihood), with their weights after the check (verdict.h)
//   none          the remaining weight: the check doubts the model itself, so that the motion is unknown. It
//                 lies beyond any bounds. Over a population, 7 in 10 wrong answers are also beyond 10 and 40
//                 deg, so that a wide component would be no better description.
//
// The weight of the answer is chosen so that the mass beyond the bounds equals the stated probability of
// failure. If the answer's own spread leaves more mass beyond the bounds than is stated, it is narrowed until
// they agree (`narrowed` < 1). Its second moment is then less than the stated covariance.
#pragma once

#include <optional>
#include <vector>

#include "estimator/calibrated/failure_probability.h"
#include "stats/random.h"

namespace rcme {

// A component, normal in the tangent at `mean`.
struct MotionComponent {
  RelativePose mean;
  Matrix5d covariance = Matrix5d::Zero();  // 5x5 [rotation, direction], rad^2
  double weight = 0.0;
  bool is_answer = false;  // within the failure bounds around the answer
};

// A cell of the sphere of directions about a centre: between two angles from the centre and two azimuths,
// rad. The azimuth is 0 at u = centre.unitOrthogonal() and pi / 2 at centre x u.
struct DirectionCell {
  double angle_low = 0.0, angle_high = 0.0, azimuth_low = 0.0, azimuth_high = 0.0;
  double weight = 0.0;
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  // mean, relative to the answer's, rad
  Eigen::Matrix3d rotation_cov = Eigen::Matrix3d::Zero();
};

// The weights of components, cells and none sum to one.
struct MotionPosterior {
  RelativePose answer;
  std::vector<MotionComponent> components;
  std::vector<DirectionCell> cells;  // about the answer's direction; empty unless that is weak
  double weight_of_none = 1.0;
  // Factor of the answer's standard deviations, at most 1. With cells, it multiplies the rotations' means and
  // standard deviations and the weights beyond the bound.
  double narrowed = 1.0;
};

// Makes the posterior whose mass beyond `bounds` is `failure_probability`. The weights of rivals are reduced
// only if their mass within or beyond the bounds exceeds what is stated. The weights of the answer's
// components and of the cells matter only relative to each other.
MotionPosterior MakeMotionPosterior(const RelativePose& answer, const MotionBounds& bounds,
                                    double failure_probability, std::vector<MotionComponent> components,
                                    std::vector<DirectionCell> cells);

// The distance between two motions.
struct MotionDistance {
  double rotation_rad, direction_rad;
};
// The distances from a motion to the posterior, as weighted points. The points are the same in every call,
// and reproduce the stated probability at the default bounds to rounding. The answer has 512 evenly spread
// directions by 17 radii, which are quantiles, finest in the tail. Cells have 6,000 points in proportion to
// their weights, and four each. Compared with random draws the points err by some thousandths. `none` has no
// point.
class PosteriorDistances {
 public:
  PosteriorDistances(const MotionPosterior& posterior, const RelativePose& motion);
  // The probability that the motion is off by more than the bounds: 1 at bounds of zero, falling to the
  // weight of none.
  double FailureProbability(const MotionBounds& bounds) const;
  // The total weight of the points beyond the bounds: of the answer alone, or of all others without none.
  double ComputeBeyond(bool is_answer, const MotionBounds& bounds) const;
  // The rotation and the direction error below which the truth lies with this probability, each by itself.
  // Infinite if the weight of none is too great.
  MotionDistance FindQuantile(double level) const;
  // The protection level: the least multiple of `shape` that contains the truth with this probability.
  // Infinite if the weight of none is too great.
  MotionBounds RegionAt(double level, const MotionBounds& shape) const;

 private:
  struct Point {
    MotionDistance distance;
    double weight;
    bool is_answer;
  };
  template <typename Value>
  double Quantile(double level, Value value) const;
  std::vector<Point> points_;
  double weight_of_none_;
};

// The mass beyond the bounds around `answer`.
double FailureProbability(const MotionPosterior& posterior, const RelativePose& answer,
                          const MotionBounds& bounds);

// Second moments about the answer, in its tangent.
struct PosteriorCovariance {
  Matrix5d of_answer = Matrix5d::Zero();  // given that the motion is of the answer's components or cells
  Matrix5d total = Matrix5d::Zero();      // given that it is not none
};
PosteriorCovariance Covariance(const MotionPosterior& posterior);

// The rotation and the direction with the least mean angle to the posterior's, given that it is not none.
// Found by Weiszfeld's iteration from the answer.
RelativePose Median(const MotionPosterior& posterior);

// Draws a motion of the posterior; nullopt: none of these.
std::optional<RelativePose> Draw(const MotionPosterior& posterior, RandomStream& rng);

}  // namespace rcme
