// What rcme_calibrated knows of the motion, as one distribution: a mixture of the modes and of "none of
// these". The stated probability of failure, those for other bounds, the covariance, regions and medians are
// all computed from it.
//
//   the answer    N(mode, its stated covariance) in the tangent at each mode within the failure bounds; where
//                 the direction is weak (settle_direction.h), cells of the whole sphere instead, each with a
//                 normal law of the rotation
//   rivals        N(mode, the spread by its likelihood), with their weights after the check (verdict.h)
//   none          the rest: the check doubts the model itself, so that nothing is known of the motion. It
//                 lies beyond any bounds. Of wrong answers over a population 7 in 10 are beyond 10 and 40 deg
//                 as well, so that a wide component would not be a better description.
//
// The weight of the answer is what makes the mass beyond the bounds equal to the stated probability of
// failure. Where the answer's own spread leaves more beyond the bounds than is stated, it is narrowed until
// they agree (`narrowed` < 1), and then its second moment is less than the stated covariance.
#pragma once

#include <optional>
#include <vector>

#include "estimator/calibrated/failure_probability.h"
#include "stats/random.h"

namespace rcme {

// Normal in the tangent at `mean`.
struct MotionComponent {
  RelativePose mean;
  Matrix5d covariance = Matrix5d::Zero();  // 5x5 [rotation, direction], rad^2
  double weight = 0.0;
  bool is_answer = false;  // within the failure bounds around the answer
};

// A part of the sphere of directions about a centre: between two angles from it, and two azimuths, rad. The
// azimuth counts from u = centre.unitOrthogonal() to centre x u.
struct DirectionCell {
  double angle_low = 0.0, angle_high = 0.0, azimuth_low = 0.0, azimuth_high = 0.0;
  double weight = 0.0;
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  // of the motion against the answer's, mean, rad
  Eigen::Matrix3d rotation_cov = Eigen::Matrix3d::Zero();
};

// Weights of components and cells and that of none sum to one.
struct MotionPosterior {
  RelativePose answer;
  std::vector<MotionComponent> components;
  std::vector<DirectionCell> cells;  // about the answer's direction; empty where that is not weak
  double weight_of_none = 1.0;
  // Factor of the answer's standard deviations (of cells: of the rotation's, and of the weights beyond the
  // bound), at most 1.
  double narrowed = 1.0;
};

// The posterior whose mass beyond `bounds` is `failure_probability`. Weights of `components` that are not the
// answer's are kept as long as they are no more than that; those of the answer, or of the cells where there
// are any, count among each other. A posterior of cells has no components of the answer.
MotionPosterior MakeMotionPosterior(const RelativePose& answer, const MotionBounds& bounds,
                                    double failure_probability, std::vector<MotionComponent> components,
                                    std::vector<DirectionCell> cells);

// How far a motion is from another.
struct MotionDistance {
  double rotation_rad, direction_rad;
};
// The distances from a motion to the posterior's, as points with weights, the same for every call: at the
// default bounds the stated probability comes out to rounding. Of the answer 512 directions, evenly spread,
// by 17 radii, quantiles that are finest in the tail; of cells 6,000 in all by their weights. Against draws
// the points err by some thousandths. `none` has no point.
class PosteriorDistances {
 public:
  PosteriorDistances(const MotionPosterior& posterior, const RelativePose& motion);
  // The probability that the motion is further off than the bounds: 1 at bounds of zero, falls to that of
  // none.
  double FailureProbability(const MotionBounds& bounds) const;
  // The same of the points of the answer alone, and of the others, without none; absolute.
  double ComputeBeyond(bool is_answer, const MotionBounds& bounds) const;
  // The least rotation, and the least direction, within which the truth lies with this probability; infinite
  // where none of these is too likely.
  MotionDistance FindQuantile(double level) const;
  // The protection level: the bounds, a multiple of `shape`, that hold the truth with this probability;
  // infinite likewise.
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

// Of `answer`: the mass beyond the bounds around it.
double FailureProbability(const MotionPosterior& posterior, const RelativePose& answer,
                          const MotionBounds& bounds);

// Second moments about the answer, in its tangent, of a motion that is one of these (no matter which).
struct PosteriorCovariance {
  Matrix5d of_answer = Matrix5d::Zero();  // given that it is the answer's component or cells
  Matrix5d total = Matrix5d::Zero();      // given that it is not none
};
PosteriorCovariance Covariance(const MotionPosterior& posterior);

// The rotation and the direction with the least mean angle to the posterior's, given that it is not none; by
// Weiszfeld's steps from the answer.
RelativePose Median(const MotionPosterior& posterior);

// A motion of the posterior; nothing: none of these.
std::optional<RelativePose> Draw(const MotionPosterior& posterior, RandomStream& rng);

}  // namespace rcme
