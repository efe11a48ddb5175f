#include "experiments/real/truth_free/twin_source.h"

#include <algorithm>
#include <tuple>

#include "estimator/geometry/sampson.h"
#include "estimator/geometry/triangulation.h"
#include "estimator/noise_scale.h"
#include "experiments/real/truth_free/kept_answers.h"
#include "experiments/real/truth_free/twin.h"
#include "experiments/trial/answer_check.h"
#include "experiments/trial/trial.h"
#include "stats/fnv1a.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

bool IsWrong(const MotionEstimate& estimate, const TrialData& pair) {
  return HasFailed(Score(estimate, pair, 0.0), FailureBounds());
}

std::optional<TrialData> MakeExactTrial(const TrialData& pair, const MotionEstimate& estimate) {
  const bool takes_answer = estimate.status == MotionStatus::kOk && !IsWrong(estimate, pair);
  if (!takes_answer && !pair.truth.cam2_from_cam1_true) return std::nullopt;
  TrialData exact = pair;
  exact.truth = Truth();
  exact.truth.cam2_from_cam1_true = takes_answer ? estimate.cam2_from_cam1 : *pair.truth.cam2_from_cam1_true;
  const RelativePose& pose = *exact.truth.cam2_from_cam1_true;
  const double sigma_px = takes_answer ? EstimateNoise(pair.problem, estimate) : pair.problem.sigma_px;
  const Eigen::Matrix3d F = ComputeFundamental(pair.problem, pose);
  // Inliers are accepted even behind a camera, where noise can put far points.
  std::vector<bool> is_accepted(exact.problem.matches.size());
  for (const int i : estimate.inliers) is_accepted[static_cast<size_t>(i)] = takes_answer;
  size_t num_right = 0;
  for (size_t i = 0; i < is_accepted.size(); ++i) {
    Correspondence& match = exact.problem.matches[i];
    const double squared = SquaredSampsonDistance(F, match);
    const double own_px = sigma_px * NoiseScaleAt(pair.problem, i);
    if (!is_accepted[i] && (squared > kRightWithin * own_px * kRightWithin * own_px ||
                            !IsInFrontOfBothCameras(pose, pair.problem.camera1.Ray(match.x1_px),
                                                    pair.problem.camera2.Ray(match.x2_px))))
      continue;
    match = Snapped(F, match);
    num_right += SquaredSampsonDistance(F, match) < kExactPx * kExactPx;
  }
  if (num_right < kLeastRight) return std::nullopt;
  Redraw::Label(&exact);
  return exact;
}

// Sets the noise of templates whose reference is the estimate, in units of their median; the others keep 1.
void SetNoiseLevels(TwinSource* source) {
  std::vector<double> sigmas;
  for (const AnsweredTrial& one : source->pairs) {
    if (one.HasAnsweredTemplate()) sigmas.push_back(EstimateNoise(one.pair.problem, one.estimate));
  }
  const double median = ComputeMedian(std::move(sigmas));
  for (AnsweredTrial& one : source->pairs) {
    if (one.HasAnsweredTemplate() && median > 0.0)
      one.noise_level = std::max(EstimateNoise(one.pair.problem, one.estimate) / median, 1e-3);
  }
}

}  // namespace

bool AnsweredTrial::HasAnsweredTemplate() const {
  return exact && estimate.status == MotionStatus::kOk && !IsWrong(estimate, pair);
}

MotionEstimate AnswerTo(const MotionProblem& problem, const MotionEstimator& estimator,
                        const StreamName& name) {
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  return Judged(estimator.Estimate(problem, rng), problem.matches.size());
}

TwinSource AnswerScene(const std::string& scene, const DataSource& data, const ImageNames& images,
                       const MotionEstimator& estimator, std::uint64_t seed, KeptSteps* steps) {
  TwinSource source{scene, {}};
  const auto num_pairs = static_cast<std::uint32_t>(data.NumTrials(1));
  for (std::uint32_t number = 0; number < num_pairs; ++number) {
    AnsweredTrial answered;
    answered.pair = data.Make({seed, 0, number, 0});
    const auto named = images.find(answered.pair.origin);
    if (named != images.end()) std::tie(answered.image1, answered.image2) = named->second;
    answered.estimate = TakeAnswer(answered.pair.problem, estimator,
                                   {seed, HashToStreamKey(answered.pair.origin), 0, 0}, steps);
    answered.exact = MakeExactTrial(answered.pair, answered.estimate);
    source.pairs.push_back(std::move(answered));
  }
  SetNoiseLevels(&source);
  return source;
}

}  // namespace rcme
