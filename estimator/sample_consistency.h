// Does the minimal sample agree with the motion it instantiated? Only an overdetermined model can disagree:
// an 8-point null vector has 8 degrees of freedom, an essential matrix 5. Decided before any other match is
// looked at.
#pragma once

#include "estimator/hypothesis.h"
#include "estimator/point_consistency.h"

namespace rcme {

// As printed (eq::sample-p-test): every sample point must pass the point test on its own, d2 within its
// threshold (eq. 12), as if it had not been used.
template <typename PointTest>
bool EverySamplePointFits(const MotionProblem& problem, const Hypothesis& hypothesis, const PointTest& test,
                          double threshold) {
  for (const int index : hypothesis.sample) {
    PointResidual residual;
    if (!(test.Distance(problem.matches[static_cast<size_t>(index)], &residual) <= threshold)) return false;
  }
  return true;
}

// Rank-aware: the sample constrains the motion in three directions at once. With N (9x3) spanning what is
// normal to the essential matrices at the projected E, T = (N'f)' (N' Sigma_f N)^-1 (N'f) ~ chi2_3 as sigma
// -> 0. Infinite if N' Sigma_f N is singular.
double JointSampleStatistic(const Hypothesis& hypothesis);

}  // namespace rcme
