#pragma once

#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "estimator/kernels/fast_engine.h"
#include "estimator/loop_inspection.h"
#include "estimator/ransac_estimate.h"
#include "estimator/reference_search.h"
#include "estimator/solvers/solver_table.h"

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

// Scores a given motion that does not come from a sample; see LoopInspection::ScoreMotion.
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

// The inspection of EstimateByRansac<Decision, Engine> with these options.
template <RansacDecision Decision, RansacEngine Engine>
class RansacInspection : public LoopInspection {
 public:
  explicit RansacInspection(const RansacOptions& options) : options_(options) {}

  HypothesisTrace Trace(const MotionProblem& problem, RandomStream& rng) const override {
    if (RefuseBeforeLoop<Engine>(problem)) return {};
    Engine engine(problem, options_, rng);
    return TraceHypotheses(options_.num_iterations, static_cast<int>(problem.matches.size()), engine.search);
  }

  LoopResult Decide(const HypothesisTrace& trace) const override {
    if (trace.hypotheses.empty()) return {};
    TraceSearch search(trace);
    return RunRansacLoop(options_, trace.num_matches, search, search, Decision(options_, trace.thresholds));
  }

  MotionEstimate Finish(const MotionProblem& problem, const LoopResult& loop,
                        Refinements* refinements) const override {
    if (!loop.winner) {
      if (std::optional<MotionEstimate> refusal = RefuseBeforeLoop<Engine>(problem)) return *refusal;
    }
    RandomStream no_samples({0, 0, 0, 0});
    std::optional<Engine> engine;  // made when a refinement is missing
    const auto refine = [&](const Candidate& candidate) {
      const auto known = refinements->find(candidate.id);
      if (known == refinements->end()) {
        if (!engine) engine.emplace(problem, options_, no_samples);
        return (*refinements)[candidate.id] = RefineCandidate(*engine, options_, loop.counts, candidate);
      }
      MotionEstimate estimate = known->second;
      estimate.counts = loop.counts;  // these two depend on the loop's decisions
      estimate.z_statistic = candidate.z_statistic;
      return estimate;
    };
    return FinishLoop(options_, static_cast<int>(problem.matches.size()), loop, refine);
  }

  ScoredMotion ScoreMotion(const MotionProblem& problem, const RelativePose& start) const override {
    return ScoreGivenMotion<Decision, Engine>(problem, options_, start);
  }
  const RansacOptions& options() const override { return options_; }
  std::unique_ptr<LoopInspection> With(const RansacOptions& options) const override {
    return std::make_unique<RansacInspection>(options);
  }

 private:
  RansacOptions options_;
};

// The estimator of a decision (ransac_loop.h) with one minimal solver in one implementation.
template <RansacDecision Decision, RansacEngine Engine>
class LoopEstimator : public InspectableEstimator {
 public:
  explicit LoopEstimator(const RansacOptions& options)
      : InspectableEstimator(std::make_unique<RansacInspection<Decision, Engine>>(options)),
        options_(options) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return EstimateByRansac<Decision, Engine>(problem, options_, rng);
  }

 private:
  RansacOptions options_;
};

// The estimator of a decision with the solver and the implementation of the options. Throws InputError if the
// options contradict each other.
template <RansacDecision Decision>
std::unique_ptr<MotionEstimator> MakeLoopEstimator(const RansacOptions& options) {
  Validate(options);
  return VisitSolver(options.solver, [&]<typename Solver>(std::type_identity<Solver>) {
    std::unique_ptr<MotionEstimator> estimator;
    if constexpr (kHasFast<Solver> && !HasRobustScore<Decision>) {
      using Engine = FastEngine<Decision, Solver>;
      if (options.IsFast()) estimator = std::make_unique<LoopEstimator<Decision, Engine>>(options);
    }
    using Engine = ReferenceEngine<Decision, Solver>;
    if (!estimator) estimator = std::make_unique<LoopEstimator<Decision, Engine>>(options);
    return estimator;
  });
}

}  // namespace rcme
