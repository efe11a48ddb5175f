#pragma once

#include "estimator/motion_problem.h"
#include "estimator/ransac_options.h"

namespace rcme {

// Thresholds of the tests, computed once per call.
struct Thresholds {
  double point = 0.0;         // F_dof^-1(1 - alpha) of the point test
  double sample = 0.0;        // chi2 quantile of the sample test (joint or per point); infinite without
                              // degrees of freedom
  double normal = 0.0;        // Phi^-1(1 - alpha)
  double outlier_cost = 0.0;  // negative log-likelihood of an outlier: uniform over the image diagonal in
                              // units of sigma

  static Thresholds For(const MotionProblem& problem, const RansacOptions& options, int point_dof,
                        int sample_dof = 3);
};

}  // namespace rcme
