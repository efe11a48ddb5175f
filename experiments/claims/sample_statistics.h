// Statistics of one minimal sample's model, as several claims measure them. Infinite where the sample is
// degenerate or a covariance is singular: such a trial is not covered, never dropped.
#pragma once

#include "estimator/hypothesis.h"
#include "estimator/point_consistency.h"
#include "estimator/solvers/eight_point.h"
#include "experiments/claims/case.h"

namespace rcme {

// The model of the first eight matches (they are in random order) with its covariances. Its motion is any of
// the four of its essential matrix: no point test depends on which.
std::optional<Hypothesis<EightPoint>> FitSample(const MotionProblem& problem);

// NEES of f in the complement of f, 8 dof.
double NeesOfF(const Hypothesis<EightPoint>& hypothesis, const RelativePose& pose_true);

// Squared Mahalanobis distance of a match from an uncertain motion, in one reading.
using PointDistance = double (*)(const UncertainFundamental& model, double sigma_px,
                                 const Correspondence& match);
double AsPrintedDistance(const UncertainFundamental& model, double sigma_px, const Correspondence& match);
double RankAwareDistance(const UncertainFundamental& model, double sigma_px, const Correspondence& match);

// Distance of the first match from the true motion.
Statistic TruePoseStatistic(PointDistance distance);
// Distance of the ninth match from the motion of the first eight.
Statistic FreshPointStatistic(PointDistance distance);
// Distance of the first match from the motion that it helped to find.
Statistic OwnPointStatistic(PointDistance distance);

}  // namespace rcme
