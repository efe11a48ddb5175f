#pragma once

#include "estimator/kernels/fast_engine.h"
#include "estimator/ransac_estimator.h"
#include "estimator/run_pipeline.h"
#include "estimator/score_motion.h"
#include "estimator/solvers/solver_table.h"

namespace rcme {

// The estimator of a pipeline (ransac_loop.h) with one minimal solver in one implementation.
template <typename Pipeline, typename Engine>
class PipelineEstimator : public RansacEstimator {
 public:
  explicit PipelineEstimator(const RansacOptions& options) : options_(options) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return RunPipeline<Pipeline, Engine>(problem, options_, rng);
  }
  HypothesisTrace Trace(const MotionProblem& problem, RandomStream& rng) const override {
    return TracePipeline<Engine>(problem, options_, rng);
  }
  LoopResult Decide(const HypothesisTrace& trace) const override {
    if (trace.hypotheses.empty()) return {};
    TraceSearch search(trace);
    return RunRansacLoop<Pipeline>(options_, trace.num_matches, search);
  }
  MotionEstimate Finish(const MotionProblem& problem, const LoopResult& loop,
                        Refinements* refinements) const override {
    return FinishPipeline<Engine>(problem, options_, loop, refinements);
  }
  ScoredMotion ScoreMotion(const MotionProblem& problem, const RelativePose& start) const override {
    return ScoreMotionOf<Pipeline, Engine>(problem, options_, start);
  }
  const RansacOptions& options() const override { return options_; }
  std::unique_ptr<RansacEstimator> With(const RansacOptions& options) const override {
    return std::make_unique<PipelineEstimator>(options);
  }

 private:
  RansacOptions options_;
};

// The estimator of a pipeline with the solver and the implementation of the options. Throws InputError if the
// options contradict each other.
template <typename Pipeline>
std::unique_ptr<RansacEstimator> MakePipelineEstimator(const RansacOptions& options) {
  Validate(options);
  return VisitSolver(options.solver, [&]<typename Solver>(std::type_identity<Solver>) {
    std::unique_ptr<RansacEstimator> estimator;
    if constexpr (kHasFast<Solver> && !HasRobustScore<Pipeline>) {
      using Engine = FastEngine<Pipeline, Solver>;
      if (options.IsFast()) estimator = std::make_unique<PipelineEstimator<Pipeline, Engine>>(options);
    }
    using Engine = ReferenceEngine<Pipeline, Solver>;
    if (!estimator) estimator = std::make_unique<PipelineEstimator<Pipeline, Engine>>(options);
    return estimator;
  });
}

}  // namespace rcme
