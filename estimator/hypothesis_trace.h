// All hypotheses of a call with their verdicts and scores. The loop's decisions can be repeated on them under
// other thresholds without a new search.
#pragma once

#include <iterator>
#include <vector>

#include "estimator/ransac_loop.h"
#include "estimator/thresholds.h"

namespace rcme {

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

}  // namespace rcme
