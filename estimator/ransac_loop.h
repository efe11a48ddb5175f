// Algorithm 1 of the paper: the loop of standard, prcme, rcme and the variants of RANSAC.
//
// The loop has three parts. A solver draws samples and makes hypotheses from them, a scorer scores each over
// all matches, a decision accepts or refuses it and chooses the winner. Standard RANSAC accepts every inlier
// set and chooses the largest (estimator/estimators/standard.h):
//
//   struct InlierCountDecision {
//     using PointTest = KnownPoseTest;
//     static constexpr bool kTestsSample = false;
//     InlierCountDecision(const RansacOptions&, const Thresholds&) {}
//     bool AcceptsInlierSet(double) const { return true; }
//     DecidingScore deciding_score() const { return DecidingScore::kNumInliers; }
//   };
//
// The call, with a search that is both solver and scorer (estimator/ransac_estimate.h):
//
//   const Decision decision(options, engine.search.thresholds());
//   const LoopResult loop = RunRansacLoop(options, num_matches, engine.search, engine.search, decision);
//
// There are two searches: reference_search.h makes one hypothesis at a time, kernels/block_search.h eight.
// The first two lines of the decision are for the searches (RansacDecision in reference_search.h).
#pragma once

#include <concepts>
#include <optional>
#include <vector>

#include "estimator/candidate_set.h"
#include "estimator/motion_estimate.h"
#include "estimator/sample.h"

namespace rcme {

enum class SampleVerdict {
  kDegenerate,    // the sample determines no motion, or no covariance of it
  kInconsistent,  // the sample does not agree with its own motion (eq::sample-p-test)
  kConsistent,
};

// One model of a sample; or, with verdict kDegenerate, a sample without a model.
struct Proposal {
  HypothesisId id;
  SampleVerdict verdict = SampleVerdict::kDegenerate;
  bool is_last = true;  // the last model of its sample
};

// Makes the next hypothesis and tests its sample against it.
template <typename T>
concept HypothesisSolver = requires(T solver) {
  { solver.Next() } -> std::same_as<Proposal>;
};

// Scores the solver's last hypothesis over all matches; the loop calls it only for consistent ones.
template <typename T>
concept HypothesisScorer = requires(T scorer) {
  { scorer.Score() } -> std::same_as<InlierScore>;
};

// Decides whether an inlier set with this Z is good enough, and which field of a score selects the winner.
template <typename T>
concept LoopDecision = requires(const T decision, double z_statistic) {
  { decision.AcceptsInlierSet(z_statistic) } -> std::same_as<bool>;
  { decision.deciding_score() } -> std::same_as<DecidingScore>;
};

struct LoopResult {
  std::optional<Candidate> winner;    // nothing: the paper's "Fail"
  std::vector<Candidate> runners_up;  // the next best, at most num_refined - 1
  LoopCounts counts;
};

// Chooses the winner and the runners-up, and completes the counts.
LoopResult SelectWinner(const CandidateSet& candidates, const RansacOptions& options, DecidingScore decides,
                        const LoopCounts& counts);

// Runs the loop. No heap allocation per hypothesis or match while at most 4096 hypotheses pass the tests.
template <HypothesisSolver Solver, HypothesisScorer Scorer, LoopDecision Decision>
LoopResult RunRansacLoop(const RansacOptions& options, int num_matches, Solver& solver, Scorer& scorer,
                         const Decision& decision) {
  const double mu = options.MuOrDefault();
  LoopCounts counts;
  CandidateSet candidates(options, num_matches);  // C = {}
  bool may_stop = false;
  for (int j = 0; j < options.num_iterations && !may_stop;) {  // for j = 1 to N
    // S_j, f_j, p_j, Sigma_p (eq::minimal_sample_set, eq::model_instantiate, eq::motion_estimate, eq::cov_p)
    const Proposal proposal = solver.Next();
    j += proposal.is_last;  // a sample may have several models
    ++counts.num_hypotheses;
    if (proposal.verdict == SampleVerdict::kDegenerate) {
      ++counts.num_degenerate_samples;
      continue;
    }
    if (proposal.verdict == SampleVerdict::kInconsistent) {  // S_j and p_j disagree (eq::sample-p-test)
      ++counts.num_inconsistent_samples;
      continue;
    }
    Candidate candidate{proposal.id, scorer.Score(), 0.0};  // h_j (eq::find-inlier, eq::score-inliers)
    candidate.z_statistic = ZStatistic(candidate.score, mu);
    if (!decision.AcceptsInlierSet(candidate.z_statistic)) {  // (eq::inlier-quality-test)
      ++counts.num_poor_inlier_sets;
      continue;
    }
    candidates.Add(candidate);  // update C (eq::candidate-set)
    // Sec. early-terminate; a bound of NaN never stops the loop.
    const bool is_certain = candidate.score.mean_entropy <= options.early_stop_entropy;
    may_stop = is_certain && candidates.MeetsSizeCondition(candidate);
  }
  return SelectWinner(candidates, options, decision.deciding_score(), counts);  // (eq::model_select_entropy)
}

}  // namespace rcme
