// Statistics of one minimal sample's model that several claims share. Infinite if the sample is degenerate or
// a covariance is singular: such a trial counts as not covered and is never dropped.
#pragma once

#include "estimator/hypothesis.h"
#include "estimator/point_consistency.h"
#include "estimator/ransac_options.h"
#include "estimator/solvers/eight_point.h"
#include "experiments/audit/claims/case.h"

namespace rcme {

// The model of the first eight matches (their order is random) with its covariances. Its motion is any of the
// four of its essential matrix, because no point test depends on the choice.
std::optional<Hypothesis<EightPoint>> FitEightPoints(const MotionProblem& problem);

// NEES of f = vec(E) / |E| in the range of its covariance, which has `degrees_of_freedom` dimensions: the
// tangent space of the solver's models. The error outside of it is of second order.
double NeesOfF(const Vector9d& f, const Matrix9d& f_cov, const RelativePose& pose_true,
               int degrees_of_freedom);

// The same for the model nearest to the truth among those of a solver's first matches. A sample of m matches
// determines m coordinates of f.
double NeesOfNearestF(MinimalSolver solver, const MotionProblem& problem, const RelativePose& pose_true);

// Squared Mahalanobis distance of a match from an uncertain motion, in one reading of the paper.
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
