// Tests whether a minimal sample agrees with its own motion, before any other match is looked at. Only a
// sample with more equations than the five degrees of freedom of the motion can disagree.
//
// The test has the solver's kSampleTestDof degrees of freedom: three for eight points, two for seven (F fits
// them all, its motion does not), none for five and one, whose motion fits its sample exactly. Without
// degrees of freedom neither reading tests: "Of course, this does not apply to the exact case" (Sec.
// p_comp_tests).
#pragma once

#include "estimator/hypothesis.h"
#include "estimator/point_consistency.h"

namespace rcme {

// As printed (eq::sample-p-test): every sample point must pass the point test, d2 within its threshold
// (eq. 12), as if the motion had not been computed from it.
template <typename Solver, typename PointTest>
bool EverySamplePointFits(const MotionProblem& problem, const Hypothesis<Solver>& hypothesis,
                          const PointTest& test, double threshold) {
  for (const int index : hypothesis.id.sample) {
    PointResidual residual;
    if (!(test.Distance(problem.matches[static_cast<size_t>(index)], &residual) <= threshold)) return false;
  }
  return true;
}

// The misfit of f, with covariance f_cov, from the essential matrices. N holds the first `dof` (2 or 3)
// directions normal to them at the projection E = U diag(1, 1, 0) V' of f, N = U [e11 - e22, e12 + e21, e33]
// V'. T = (N'f)' (N' Sigma_f N)^-1 (N'f) ~ chi2_dof as sigma -> 0. Infinite if N' Sigma_f N is singular.
template <int dof>
double MisfitStatistic(const EssentialProjection& projection, const Vector9d& f, const Matrix9d& f_cov);

// Rank-aware: a joint test of the sample. Eight points test all three directions of N. A matrix from seven
// points has rank 2 and hence no component along e33.
template <typename Solver>
double JointSampleStatistic(const Hypothesis<Solver>& hypothesis) {
  return MisfitStatistic<Solver::kSampleTestDof>(hypothesis.projection, hypothesis.model.f, hypothesis.f_cov);
}

}  // namespace rcme
