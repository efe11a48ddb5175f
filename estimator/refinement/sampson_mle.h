// Maximum likelihood over the motion alone, without points: least squares of the Sampson distance. If the
// noise is small against the parallax, g / |J| is the distance of a match from the epipolar variety up to
// second order, and the optimum is that of RefineByReprojection in a fraction of the time.
#pragma once

#include <functional>
#include <span>

#include "estimator/motion_problem.h"
#include "estimator/refinement/motion_search.h"

namespace rcme {

// The equations of a set of matches, summed by sampson_equations.h or kernels/sampson_equations.h.
struct SampsonEquations {
  int num_matches = 0;
  std::function<NormalEquations(const RelativePose&, Loss)> linearize;
  std::function<Matrix5d(const RelativePose&)> information;
};

// pose_cov = (sum_k g_p' g_p / var g_k)^-1 at the optimum, 5x5, [rotation, direction], rad^2. Does not
// converge with fewer than five matches. The last step is at most 0.0014 standard deviations long, and the
// remaining error is of second order in it; with Cauchy's loss, which only serves to find the wrong matches,
// 0.045.
RefinedMotion RefineBySampson(const SampsonEquations& equations, const RelativePose& start, Loss loss);

// One match at a time; `indices` names the matches to use.
RefinedMotion RefineBySampson(const MotionProblem& problem, std::span<const int> indices,
                              const RelativePose& start, Loss loss);

// All matches with squared loss: maximum likelihood if there are no outliers.
RefinedMotion RefineAllBySampson(const MotionProblem& problem, const RelativePose& start);

}  // namespace rcme
