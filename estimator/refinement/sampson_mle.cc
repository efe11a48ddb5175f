#include "estimator/refinement/sampson_mle.h"

#include <numeric>
#include <vector>

#include "estimator/refinement/sampson_equations.h"

namespace rcme {

RefinedMotion RefineBySampson(const SampsonEquations& equations, const RelativePose& start, Loss loss) {
  if (equations.num_matches < 5) return {.cam2_from_cam1 = start};
  return MinimizeOverMotion(start, {[&](const RelativePose& pose) { return equations.linearize(pose, loss); },
                                    equations.information, loss == Loss::kSquared ? 1e-6 : 1e-3});
}

RefinedMotion RefineBySampson(const MotionProblem& problem, std::span<const int> indices,
                              const RelativePose& start, Loss loss) {
  const SampsonEquations equations{
      static_cast<int>(indices.size()),
      [&](const RelativePose& pose, Loss rho) { return LinearizeSampson(problem, indices, pose, rho); },
      [&](const RelativePose& pose) { return SampsonInformation(problem, indices, pose); }};
  return RefineBySampson(equations, start, loss);
}

RefinedMotion RefineAllBySampson(const MotionProblem& problem, const RelativePose& start) {
  std::vector<int> all(problem.matches.size());
  std::iota(all.begin(), all.end(), 0);
  return RefineBySampson(problem, all, start, Loss::kSquared);
}

}  // namespace rcme
