// The hypothesis loop of the paper's Algorithm 1, one template for standard, pRCME and RCME.
//
// A pipeline names the decisions (estimators/standard.cc and estimators/rcme.cc are the worked examples):
//
//   struct Pipeline {
//     // point_consistency.h: is a match an inlier, with what entropy
//     using PointTest = ...;
//     // eq::sample-p-test: whether there is one, and what it is; asked where the solver's kSampleTestDof > 0
//     static constexpr bool kTestsSample;
//     static bool SampleIsConsistent(problem, hypothesis, point_test, thresholds);  // only where
//     kTestsSample
//     // eq::inlier-quality-test
//     static bool InlierSetIsGood(z, options, thresholds);
//     // eq::model_select_entropy
//     static bool IsBetter(score_a, score_b, options);
//   };
//
// A search makes the hypotheses and scores them: reference_search.h one by one, kernels/block_search.h eight
// at a time. No heap allocation inside the loop, as long as at most 4096 hypotheses pass the tests.
//
//   struct Search {
//     const Thresholds& thresholds() const;
//     Proposal Next();      // the next hypothesis and what became of it
//     InlierScore Score();  // of the last proposal, all matches
//   };
#pragma once

#include <optional>

#include "estimator/candidate_set.h"
#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"
#include "estimator/sample.h"
#include "stats/random.h"

namespace rcme {

// Quantiles of the tests, computed once per call.
struct Thresholds {
  double point = 0.0;   // F_dof^-1(1 - alpha) of the point test
  double sample = 0.0;  // chi2 quantile of the sample test, of all points jointly or of each; without dof
                        // infinite
  double normal = 0.0;  // Phi^-1(1 - alpha)
  double outlier_cost =
      0.0;  // negative log-likelihood of an outlier: uniform over the image diagonal, units of sigma

  static Thresholds For(const MotionProblem& problem, const RansacOptions& options, int point_dof,
                        int sample_dof = 3);
};

// `size` distinct indices below n, every set equally likely; n >= size.
Sample DrawSample(int size, int n, RandomStream& rng);

enum class SampleVerdict {
  kDegenerate,    // the sample determines no motion, or no covariance of it
  kInconsistent,  // it does not agree with the motion it made (eq::sample-p-test)
  kConsistent,
};
// One model of a sample, or, degenerate, a sample without one.
struct Proposal {
  HypothesisId id;
  SampleVerdict verdict = SampleVerdict::kDegenerate;
  bool is_last = true;  // of the sample's models
};

struct LoopResult {
  std::optional<Candidate> winner;    // nothing: the paper's "Fail"
  std::vector<Candidate> runners_up;  // the next best, num_refined - 1 at most
  LoopCounts counts;
};

// What becomes of one model: f_j, p_j and Sigma_p are made. Returns whether the loop may stop.
template <typename Pipeline, typename Search>
bool ConsiderHypothesis(const RansacOptions& options, double mu, const Proposal& proposal, Search& search,
                        LoopCounts& counts, CandidateSet& candidates) {
  ++counts.num_hypotheses;
  if (proposal.verdict == SampleVerdict::kDegenerate) {
    ++counts.num_degenerate_samples;
    return false;
  }
  if (proposal.verdict == SampleVerdict::kInconsistent) {  // S_j and p_j agree? (eq::sample-p-test)
    ++counts.num_inconsistent_samples;
    return false;
  }
  Candidate candidate{proposal.id, search.Score(), 0.0};  // h_j (eq::find-inlier, eq::score-inliers)
  candidate.z_statistic = ZStatistic(candidate.score, mu);
  if (!Pipeline::InlierSetIsGood(candidate.z_statistic, options, search.thresholds())) {
    ++counts.num_poor_inlier_sets;  // (eq::inlier-quality-test)
    return false;
  }
  candidates.Add(candidate);  // update C (eq::candidate-set)
  const bool may_stop =
      candidate.score.mean_entropy <= options.early_stop_entropy;  // never true where NaN: off
  return may_stop && candidates.MeetsSizeCondition(candidate);     // Sec. early-terminate
}

template <typename Pipeline, typename Search>
LoopResult RunRansacLoop(const RansacOptions& options, int num_matches, Search& search) {
  const double mu = options.MuOrDefault();
  LoopResult result;
  LoopCounts& counts = result.counts;
  CandidateSet candidates(options, num_matches);  // C = {}
  bool may_stop = false;
  for (int j = 0; j < options.num_iterations && !may_stop; ++j) {  // for j = 1 to N
    Proposal proposal{{}, SampleVerdict::kDegenerate, false};
    while (!proposal.is_last && !may_stop) {
      proposal = search.Next();  // S_j, f_j, p_j, Sigma_p (eq::minimal_sample_set, eq::model_instantiate,
                                 // eq::motion_estimate, eq::cov_p), one model after the other
      may_stop = ConsiderHypothesis<Pipeline>(options, mu, proposal, search, counts, candidates);
    }
  }
  counts.num_candidates = candidates.CountMembers();
  counts.num_too_small_inlier_sets = counts.num_hypotheses - counts.num_degenerate_samples -
                                     counts.num_inconsistent_samples - counts.num_poor_inlier_sets -
                                     counts.num_candidates;
  result.runners_up = candidates.SelectBest(
      options.num_refined, [&](const InlierScore& a, const InlierScore& b) {  // (eq::model_select_entropy)
        return Pipeline::IsBetter(a, b, options);
      });
  if (result.runners_up.empty()) return result;
  result.winner = result.runners_up.front();
  result.runners_up.erase(result.runners_up.begin());
  return result;
}

}  // namespace rcme
