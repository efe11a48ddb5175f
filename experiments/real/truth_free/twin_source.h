// Real pairs with the answers to them and the exact geometry that their twins get.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/core/work/kept_steps.h"
#include "experiments/data/data_source.h"
#include "experiments/data/match_folder.h"

namespace rcme {

// A real pair with an answer to it and, where its geometry is known well enough, its exact template: the
// right matches (those that the answer accepts, or that are near) moved onto the reference motion, which is
// the template's truth; the wrong ones as they are. The reference is the answer, or, where that fails by the
// given truth or there is none, the given truth.
struct AnsweredTrial {
  TrialData pair;
  std::string image1, image2;  // empty: not known
  MotionEstimate estimate;
  std::optional<TrialData> exact;
  double noise_level = 1.0;  // of the template: the noise of its pair over the median of the scene

  bool HasAnsweredTemplate() const;  // whose reference is the answer
};
// Matches within this many standard deviations of the reference count as right.
inline constexpr double kRightWithin = 4.0;
inline constexpr size_t kLeastRight = 20;  // of a template

struct TwinSource {
  std::string scene;
  std::vector<AnsweredTrial> pairs;
};
// Of every pair of a real scene, each answer a step. Pure in the seed and the pairs' names.
TwinSource AnswerScene(const std::string& scene, const DataSource& data, const ImageNames& images,
                       const MotionEstimator& estimator, std::uint64_t seed, KeptSteps* steps = nullptr);

// The answer of an estimator to a problem, judged; its samples are of that stream.
MotionEstimate AnswerTo(const MotionProblem& problem, const MotionEstimator& estimator,
                        const StreamName& name);

}  // namespace rcme
