// The hypothesis loop of the paper's Algorithm 1, one template for standard, pRCME and RCME.
//
// A pipeline names its parts:
//
//   struct Pipeline {
//     using PointTest = ...;                           // point_consistency.h: is a match an inlier, with
//     what entropy static bool SampleIsConsistent(problem, hypothesis, point_test, thresholds);   //
//     eq::sample-p-test static bool InlierSetIsGood(z, options, thresholds);                           //
//     eq::inlier-quality-test static bool IsBetter(score_a, score_b, options); // eq::model_select_entropy
//   };
//
// estimators/standard.cc and estimators/rcme.cc are the worked examples. No heap allocation inside the loop.
#pragma once

#include <optional>

#include "estimator/candidate_set.h"
#include "estimator/motion_estimate.h"
#include "estimator/point_consistency.h"
#include "stats/random.h"

namespace rcme {

// Quantiles of the tests, computed once per call.
struct Thresholds {
  double point = 0.0;   // F_dof^-1(1 - alpha) of the point test
  double sample = 0.0;  // chi2_3 quantile of the joint sample test
  double normal = 0.0;  // Phi^-1(1 - alpha)
  double outlier_cost =
      0.0;  // negative log-likelihood of an outlier: uniform over the image diagonal, units of sigma

  static Thresholds For(const MotionProblem& problem, const RansacOptions& options, int point_dof);
};

// Eight distinct indices below n, every set equally likely; n >= 8.
Sample DrawSample(int n, RandomStream& rng);

// Sigma_p propagated and the point test built on it; nothing if the covariance is not finite.
template <typename PointTest>
std::optional<PointTest> MakePointTest(const MotionProblem& problem, Hypothesis* hypothesis) {
  if constexpr (!PointTest::kNeedsCovariance) {
    return PointTest(hypothesis->F, problem.sigma_px);
  } else {
    PropagateCovariance(problem, hypothesis);
    const std::optional<UncertainFundamental> model =
        UncertainFundamental::From(hypothesis->pose, hypothesis->pose_cov, problem.camera1, problem.camera2);
    if (!model) return std::nullopt;
    return PointTest(*model, problem.sigma_px);
  }
}

// Inliers and their scores, all matches (eq::find-inlier, eq::score-inliers).
template <typename PointTest>
InlierScore ScoreInliers(const MotionProblem& problem, const PointTest& test, const Thresholds& thresholds) {
  InlierScore score;
  for (const Correspondence& match : problem.matches) {
    PointResidual residual;
    double cost = thresholds.outlier_cost;
    const double d2 = test.Distance(match, &residual);
    if (d2 <= thresholds.point) score.AddInlier(test.Entropy(residual));
    if (d2 < 2.0 * cost) cost = std::min(cost, test.NegativeLogLikelihood(residual));
    score.negative_log_likelihood += cost;
  }
  return score;
}

// The inliers of a hypothesis, ascending.
template <typename PointTest>
std::vector<int> FindInliers(const MotionProblem& problem, const PointTest& test, double threshold) {
  std::vector<int> inliers;
  for (size_t i = 0; i < problem.matches.size(); ++i) {
    PointResidual residual;
    if (test.Distance(problem.matches[i], &residual) <= threshold) inliers.push_back(static_cast<int>(i));
  }
  return inliers;
}

struct LoopResult {
  std::optional<Candidate> winner;  // nothing: the paper's "Fail"
  LoopCounts counts;
};

template <typename Pipeline>
LoopResult RunRansacLoop(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng) {
  using PointTest = typename Pipeline::PointTest;
  const int n = static_cast<int>(problem.matches.size());
  const Thresholds thresholds = Thresholds::For(problem, options, PointTest::kDegreesOfFreedom);
  const double mu = options.MuOrDefault();

  LoopResult result;
  LoopCounts& counts = result.counts;
  CandidateSet candidates(options, n);                // C = {}
  for (int j = 0; j < options.num_iterations; ++j) {  // for j = 1 to N
    ++counts.num_hypotheses;
    const Sample sample = DrawSample(n, rng);  // S_j (eq::minimal_sample_set)
    std::optional<Hypothesis> hypothesis =
        InstantiateModel(problem, sample);  // f_j, p_j (eq::model_instantiate,
    if (!hypothesis) {                      //           eq::motion_estimate)
      ++counts.num_degenerate_samples;
      continue;
    }
    const std::optional<PointTest> test =
        MakePointTest<PointTest>(problem, &*hypothesis);  // Sigma_p (eq::cov_p)
    if (!test) {
      ++counts.num_degenerate_samples;
      continue;
    }
    if (!Pipeline::SampleIsConsistent(problem, *hypothesis, *test, thresholds)) {  // S_j and p_j agree?
      ++counts.num_inconsistent_samples;                                           // (eq::sample-p-test)
      continue;
    }
    Candidate candidate{sample, ScoreInliers(problem, *test, thresholds), 0.0};  // h_j (eq::find-inlier,
    candidate.z_statistic = ZStatistic(candidate.score, mu);                     //      eq::score-inliers)
    if (!Pipeline::InlierSetIsGood(candidate.z_statistic, options,
                                   thresholds)) {  // (eq::inlier-quality-test)
      ++counts.num_poor_inlier_sets;
      continue;
    }
    candidates.Add(candidate);  // update C (eq::candidate-set)
    const bool may_stop =
        candidate.score.mean_entropy <= options.early_stop_entropy;   // never true where NaN: off
    if (may_stop && candidates.MeetsSizeCondition(candidate)) break;  // Sec. early-terminate
  }
  counts.num_candidates = candidates.CountMembers();
  counts.num_too_small_inlier_sets = counts.num_hypotheses - counts.num_degenerate_samples -
                                     counts.num_inconsistent_samples - counts.num_poor_inlier_sets -
                                     counts.num_candidates;
  result.winner =
      candidates.Select([&](const InlierScore& a, const InlierScore& b) {  // (eq::model_select_entropy)
        return Pipeline::IsBetter(a, b, options);
      });
  return result;
}

}  // namespace rcme
