// Judges a motion that no sample made; see RansacEstimator::ScoreMotion.
#pragma once

#include <optional>
#include <type_traits>
#include <vector>

#include "estimator/ransac_estimator.h"
#include "estimator/reference_search.h"
#include "estimator/run_pipeline.h"

namespace rcme {

// The point test of a motion with its covariance, as of a hypothesis. Nothing if the covariance is not finite
// and positive semi-definite.
template <typename PointTest>
std::optional<PointTest> PointTestOf(const MotionProblem& problem, const RelativePose& pose,
                                     const Matrix5d& pose_cov) {
  if constexpr (PointTest::kNeedsCovariance) {
    const auto model = UncertainFundamental::From(pose, pose_cov, problem.camera1, problem.camera2);
    if (!model) return std::nullopt;
    return PointTest(*model, problem.sigma_px);
  } else {
    return PointTest(FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2),
                     problem.sigma_px);
  }
}

// The score of a motion over all matches.
template <typename Pipeline>
InlierScore ScoreOf(const MotionProblem& problem, const typename Pipeline::PointTest& test,
                    const Thresholds& thresholds) {
  if constexpr (HasRobustScore<Pipeline>) {
    std::vector<double> distances;
    return ScoreDistances<Pipeline>(problem, test, thresholds, &distances);
  } else {
    return ScoreInliers(problem, test, thresholds);
  }
}

// What the pipeline's IsBetter looks at.
template <typename Pipeline>
DecidingScore DecidingScoreOf(const RansacOptions& options) {
  if constexpr (HasRobustScore<Pipeline>) return DecidingScore::kCost;
  if constexpr (std::is_same_v<typename Pipeline::PointTest, KnownPoseTest>)
    return DecidingScore::kNumInliers;
  return options.selection == Selection::kMeanEntropy ? DecidingScore::kMeanEntropy : DecidingScore::kCost;
}

template <typename Pipeline, typename Engine>
ScoredMotion ScoreMotionOf(const MotionProblem& problem, const RansacOptions& options,
                           const RelativePose& start) {
  ScoredMotion scored;
  if (std::optional<MotionEstimate> refusal = RefuseBeforeLoop<Engine>(problem)) {
    scored.estimate = *refusal;
    return scored;
  }
  RandomStream no_samples({0, 0, 0, 0});
  Engine engine(problem, options, no_samples);
  scored.thresholds = engine.search.thresholds();
  RansacOptions without_tests = options;
  if (options.refinement == Refinement::kNone) without_tests.refinement = Refinement::kRobust;
  without_tests.observability_significance_level = without_tests.chance_significance_level = 1.0;
  Hypothesis<typename Engine::Solver> hypothesis;
  hypothesis.pose = start;
  hypothesis.projection = ProjectToEssential(EssentialFromPose(start));
  const auto support = engine.matches.FindConsistent(start, ConsistencyThreshold(options.significance_level));
  RefineWinner(engine.matches, without_tests, std::optional(hypothesis), support, &scored.estimate);
  if (scored.estimate.status != MotionStatus::kOk) return scored;
  const RelativePose pose = scored.estimate.cam2_from_cam1;
  const Matrix5d pose_cov = scored.estimate.pose_cov;
  RefuseByMotionTests(engine.matches, options, &scored.estimate);
  CheckExplainedShare(options, static_cast<int>(problem.matches.size()), &scored.estimate);
  const auto test = PointTestOf<typename Pipeline::PointTest>(problem, pose, pose_cov);
  if (!test) return scored;
  scored.refined = {true, pose, pose_cov, 0};
  scored.decides = DecidingScoreOf<Pipeline>(options);
  scored.score = ScoreOf<Pipeline>(problem, *test, scored.thresholds);
  return scored;
}

}  // namespace rcme
