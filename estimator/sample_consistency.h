// Does the minimal sample agree with the motion it instantiated? Only a sample with more equations than the
// motion has degrees of freedom, 5, can disagree. Decided before any other match is looked at.
//
// The degrees of freedom left are the solver's kSampleTestDof: three for eight points, two for seven (F fits
// them all, its motion does not), none for five and one, whose motion fits its sample perfectly. There is
// then no test, in either reading: "Of course, this does not apply to the exact case" (Sec. p_comp_tests).
#pragma once

#include "estimator/hypothesis.h"
#include "estimator/point_consistency.h"

namespace rcme {

// As printed (eq::sample-p-test): every sample point must pass the point test on its own, d2 within its
// threshold (eq. 12), as if it had not been used.
template <typename Solver, typename PointTest>
bool EverySamplePointFits(const MotionProblem& problem, const Hypothesis<Solver>& hypothesis,
                          const PointTest& test, double threshold) {
  for (const int index : hypothesis.id.sample) {
    PointResidual residual;
    if (!(test.Distance(problem.matches[static_cast<size_t>(index)], &residual) <= threshold)) return false;
  }
  return true;
}

// Of f with covariance f_cov, in the first `dof` (2 or 3) directions that are normal to the essential
// matrices at the projection E = U diag(1, 1, 0) V' of f, N = U [e11 - e22, e12 + e21, e33] V': T = (N'f)'
// (N' Sigma_f N)^-1 (N'f) ~ chi2_dof as sigma -> 0. Infinite if N' Sigma_f N is singular.
template <int dof>
double MisfitStatistic(const EssentialProjection& projection, const Vector9d& f, const Matrix9d& f_cov);

// Rank-aware: the sample constrains the motion in several directions at once. Eight points in all three of N;
// a matrix of seven has rank 2, so that it has no part in e33.
template <typename Solver>
double JointSampleStatistic(const Hypothesis<Solver>& hypothesis) {
  return MisfitStatistic<Solver::kSampleTestDof>(hypothesis.projection, hypothesis.model.f, hypothesis.f_cov);
}

}  // namespace rcme
