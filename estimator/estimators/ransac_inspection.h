#pragma once

#include <memory>
#include <optional>

#include "estimator/loop_inspection.h"
#include "estimator/ransac_estimate.h"
#include "estimator/score_motion.h"

namespace rcme {

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

}  // namespace rcme
