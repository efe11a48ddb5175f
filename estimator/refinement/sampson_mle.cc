#include "estimator/refinement/sampson_mle.h"

#include "estimator/kernels/sampson_equations.h"

namespace rcme {

RefinedMotion RefineBySampson(const MotionProblem& problem, std::span<const int> indices,
                              const RelativePose& start, Loss loss) {
  const MatchBlocks matches(problem);
  return RefineBySampson(matches, MaskOf(indices, matches), start, loss);
}

RefinedMotion RefineBySampson(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& start,
                              Loss loss) {
  if (CountIn(mask) < 5) return {.cam2_from_cam1 = start};
  return MinimizeOverMotion(
      start, {[&](const RelativePose& pose) { return LinearizeSampson(matches, mask, pose, loss); },
              [&](const RelativePose& pose) { return SampsonInformation(matches, mask, pose); },
              loss == Loss::kSquared ? 1e-6 : 1e-3});
}

RefinedMotion RefineAllBySampson(const MotionProblem& problem, const RelativePose& start) {
  const MatchBlocks matches(problem);
  return RefineBySampson(matches, matches.All(), start, Loss::kSquared);
}

}  // namespace rcme
