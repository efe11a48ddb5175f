// The loop of an estimator taken apart, for those who look into it: rcme tune and rcme show. Estimate never
// asks it.
#pragma once

#include <map>
#include <memory>
#include <utility>

#include "estimator/hypothesis_trace.h"
#include "estimator/motion_estimator.h"
#include "estimator/refinement/motion_search.h"

namespace rcme {

// Of the hypotheses of one problem: the estimate from each, whatever the others are.
using Refinements = std::map<HypothesisId, MotionEstimate>;

// A motion that is handed to an estimator, as it would be judged had the search found it.
struct ScoredMotion {
  RefinedMotion refined;  // not converged: no optimum is reached from there, and there is no score
  InlierScore score;      // of the refined motion, its covariance included, over all matches
  DecidingScore decides = DecidingScore::kNumInliers;
  Thresholds thresholds;    // of the tests
  MotionEstimate estimate;  // what would be returned, refused perhaps by the tests of the refined motion
};

// Make and score the hypotheses, decide, finish. Whatever the options, the estimator's Estimate(problem, rng)
// is Finish(problem, Decide(Trace(problem, rng)), &refinements).
//
// Decide is the cheap part. The trace of one estimator may be decided by another whose options differ in
// those of kDecisionOptions alone, as long as the trace has at least num_iterations samples and, where
// likelihood selects, was made by an estimator that selects by likelihood too. They may share the refinements
// of a problem as well.
class LoopInspection {
 public:
  virtual ~LoopInspection() = default;
  virtual HypothesisTrace Trace(const MotionProblem& problem, RandomStream& rng) const = 0;
  virtual LoopResult Decide(const HypothesisTrace& trace) const = 0;
  // Takes from `refinements` what is there already, and adds what is not.
  virtual MotionEstimate Finish(const MotionProblem& problem, const LoopResult& loop,
                                Refinements* refinements) const = 0;
  // The motion refined from `start` and the matches that agree with it, and scored as a hypothesis is. Where
  // the estimator refines nothing, refined robustly all the same.
  virtual ScoredMotion ScoreMotion(const MotionProblem& problem, const RelativePose& start) const = 0;
  virtual const RansacOptions& options() const = 0;
  // That of the same estimator with options that differ in those of kDecisionOptions and the levels of the
  // tests of the refined motion alone.
  virtual std::unique_ptr<LoopInspection> With(const RansacOptions& options) const = 0;
};

// The options that act on scores and on what refinements explain alone.
inline constexpr const char* kDecisionOptions[] = {"mu",
                                                   "quality_test",
                                                   "lambda",
                                                   "inlier_ratio",
                                                   "selection",
                                                   "early_stop_entropy",
                                                   "num_iterations",
                                                   "num_refined",
                                                   "least_explained_share"};

// An estimator whose loop can be inspected.
class InspectableEstimator : public MotionEstimator {
 public:
  const LoopInspection& inspection() const { return *inspection_; }

 protected:
  explicit InspectableEstimator(std::unique_ptr<const LoopInspection> inspection)
      : inspection_(std::move(inspection)) {}

 private:
  std::unique_ptr<const LoopInspection> inspection_;
};

// The inspection of the estimator's loop, which lives as long as the estimator; null if there is none.
inline const LoopInspection* FindInspection(const MotionEstimator& estimator) {
  const auto* const inspectable = dynamic_cast<const InspectableEstimator*>(&estimator);
  return inspectable ? &inspectable->inspection() : nullptr;
}

}  // namespace rcme
