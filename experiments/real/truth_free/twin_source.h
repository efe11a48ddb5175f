// Real pairs with an estimator's answers and the exact geometry from which their twins are made.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/core/work/kept_steps.h"
#include "experiments/data/data_source.h"
#include "experiments/data/match_folder.h"

namespace rcme {

// A real pair, its estimate and, if its geometry is known well enough, its exact template. In the template
// the right matches (inliers of the estimate, or near the reference motion) are moved onto the reference
// motion, which is the template's truth; wrong matches stay as they are. The reference is the estimate. If
// there is none, or if it fails by the given truth, the reference is the given truth.
struct AnsweredTrial {
  TrialData pair;
  std::string image1, image2;  // empty: not known
  MotionEstimate estimate;
  std::optional<TrialData> exact;
  double noise_level = 1.0;  // noise of the pair over the median of the scene

  bool HasAnsweredTemplate() const;  // has a template whose reference is the estimate
};
// Matches within this many standard deviations of the reference count as right.
inline constexpr double kRightWithin = 4.0;
inline constexpr size_t kLeastRight = 20;  // right matches of a template

struct TwinSource {
  std::string scene;
  std::vector<AnsweredTrial> pairs;
};
// Estimates every pair of a real scene; each estimate is a step. The random stream of a pair depends only on
// the seed and the pair's name.
TwinSource AnswerScene(const std::string& scene, const DataSource& data, const ImageNames& images,
                       const MotionEstimator& estimator, std::uint64_t seed, KeptSteps* steps = nullptr);

// Runs the estimator with the random stream of `name` and checks its answer (Judged in answer_check.h).
MotionEstimate AnswerTo(const MotionProblem& problem, const MotionEstimator& estimator,
                        const StreamName& name);

}  // namespace rcme
