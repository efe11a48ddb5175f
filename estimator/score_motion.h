// Scores a given motion that does not come from a sample; see LoopInspection::ScoreMotion.
#pragma once

#include <optional>
#include <vector>

#include "estimator/loop_inspection.h"
#include "estimator/ransac_estimate.h"
#include "estimator/reference_search.h"

namespace rcme {

// The point test of a motion with its covariance, as for a hypothesis. nullopt if the covariance is not
// finite and positive semi-definite.
template <typename PointTest>
std::optional<PointTest> MakePointTest(const MotionProblem& problem, const RelativePose& pose,
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
template <RansacDecision Decision>
InlierScore ScoreMatches(const MotionProblem& problem, const typename Decision::PointTest& test,
                         const Thresholds& thresholds) {
  if constexpr (HasRobustScore<Decision>) {
    std::vector<double> distances;
    return ScoreDistances<Decision>(problem, test, thresholds, &distances);
  } else {
    return ScoreInliers(problem, test, thresholds);
  }
}

template <RansacDecision Decision, RansacEngine Engine>
ScoredMotion ScoreGivenMotion(const MotionProblem& problem, const RansacOptions& options,
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
  const auto test = MakePointTest<typename Decision::PointTest>(problem, pose, pose_cov);
  if (!test) return scored;
  scored.refined = {true, pose, pose_cov, 0};
  scored.decides = Decision(options, scored.thresholds).deciding_score();
  scored.score = ScoreMatches<Decision>(problem, *test, scored.thresholds);
  return scored;
}

}  // namespace rcme
