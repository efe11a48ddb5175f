// The stages of an estimator's loop, one call each, for `rcme tune` and `rcme show`. Estimate does not use
// this.
#pragma once

#include <iterator>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "estimator/motion_estimator.h"
#include "estimator/ransac_loop.h"
#include "estimator/refinement/motion_search.h"
#include "estimator/thresholds.h"

namespace rcme {

// All hypotheses of a call with their verdicts and scores. The loop's decisions can be repeated on them under
// other thresholds without a new search.
struct ScoredHypothesis {
  Proposal proposal;
  InlierScore score;  // over all matches; only if the sample is consistent
};

struct HypothesisTrace {
  int num_matches = 0;
  Thresholds thresholds;
  std::vector<ScoredHypothesis> hypotheses;  // in the loop's order; empty: refused before the loop
};

// All hypotheses that `search` makes from `num_iterations` samples; the loop's decisions have no influence.
template <typename Search>
requires HypothesisSolver<Search> && HypothesisScorer<Search> HypothesisTrace
TraceHypotheses(int num_iterations, int num_matches, Search& search) {
  HypothesisTrace trace{num_matches, search.thresholds(), {}};
  trace.hypotheses.reserve(static_cast<size_t>(num_iterations));
  for (int j = 0; j < num_iterations;) {
    ScoredHypothesis hypothesis{search.Next(), {}};
    if (hypothesis.proposal.verdict == SampleVerdict::kConsistent) hypothesis.score = search.Score();
    trace.hypotheses.push_back(hypothesis);
    j += hypothesis.proposal.is_last;
  }
  return trace;
}

// Solver and scorer (ransac_loop.h) that replay the hypotheses of a trace.
class TraceSearch {
 public:
  explicit TraceSearch(const HypothesisTrace& trace)
      : thresholds_(trace.thresholds), next_(trace.hypotheses.begin()) {}

  const Thresholds& thresholds() const { return thresholds_; }
  Proposal Next() { return (next_++)->proposal; }
  InlierScore Score() const { return std::prev(next_)->score; }

 private:
  const Thresholds& thresholds_;
  std::vector<ScoredHypothesis>::const_iterator next_;
};

// The estimate refined from each hypothesis of one problem; it does not depend on the other hypotheses.
using Refinements = std::map<HypothesisId, MotionEstimate>;

// The score and the estimate that a given motion would get, had the estimator's search found it.
struct ScoredMotion {
  RefinedMotion refined;  // not converged: the refinement failed, and there is no score
  InlierScore score;      // of the refined motion with its covariance, over all matches
  DecidingScore decides = DecidingScore::kNumInliers;
  Thresholds thresholds;    // of the tests
  MotionEstimate estimate;  // as returned; the tests of the refined motion may refuse it
};

// Trace makes and scores the hypotheses, Decide chooses the winner, Finish refines it. The estimator's
// Estimate(problem, rng) equals Finish(problem, Decide(Trace(problem, rng)), &refinements), whatever the
// options.
//
// Decide is cheap. The trace of one estimator may be decided by another if their options differ in
// kDecisionOptions alone and the trace has at least num_iterations samples. If the deciding estimator selects
// by likelihood, the estimator that made the trace must do so too. Such estimators may also share the
// refinements of a problem.
class LoopInspection {
 public:
  virtual ~LoopInspection() = default;
  virtual HypothesisTrace Trace(const MotionProblem& problem, RandomStream& rng) const = 0;
  virtual LoopResult Decide(const HypothesisTrace& trace) const = 0;
  // Reuses the estimates in `refinements` and adds those that it makes.
  virtual MotionEstimate Finish(const MotionProblem& problem, const LoopResult& loop,
                                Refinements* refinements) const = 0;
  // Refines `start` over the matches that agree with it, and scores the result like a hypothesis. An
  // estimator without refinement uses the robust one here.
  virtual ScoredMotion ScoreMotion(const MotionProblem& problem, const RelativePose& start) const = 0;
  virtual const RansacOptions& options() const = 0;
  // The inspection of the same estimator with other options. These may differ only in kDecisionOptions and in
  // the levels of the tests of the refined motion.
  virtual std::unique_ptr<LoopInspection> With(const RansacOptions& options) const = 0;
};

// The options that act only on scores and on the number of matches that refined motions explain.
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

// The inspection of the estimator's loop, valid as long as the estimator lives; null if there is none.
inline const LoopInspection* FindInspection(const MotionEstimator& estimator) {
  const auto* const inspectable = dynamic_cast<const InspectableEstimator*>(&estimator);
  return inspectable ? &inspectable->inspection() : nullptr;
}

}  // namespace rcme
