// The solver and the scorer of the loop in their simplest form, one sample and one match at a time: the
// oracle of kernels/block_search.h.
#pragma once

#include <algorithm>
#include <concepts>
#include <optional>
#include <vector>

#include "estimator/hypothesis.h"
#include "estimator/point_consistency.h"
#include "estimator/ransac_loop.h"
#include "estimator/thresholds.h"

namespace rcme {

// Whether the score leaves out the matches of the sample, "the rest of the inputs" (Sec. Find inliers). It
// does so if the model fits them by construction and the score of an exact fit is meaningless.
template <typename Solver, typename PointTest>
inline constexpr bool kScoresTheRest = Solver::kSampleTestDof == 0 && !PointTest::kScoresExactFits;

// Inliers and their scores over all matches except `left_out` (eq::find-inlier, eq::score-inliers).
template <typename PointTest>
InlierScore ScoreInliers(const MotionProblem& problem, const PointTest& test, const Thresholds& thresholds,
                         const Sample& left_out = {}) {
  InlierScore score;
  for (size_t i = 0; i < problem.matches.size(); ++i) {
    if (std::find(left_out.begin(), left_out.end(), static_cast<int>(i)) != left_out.end()) continue;
    PointResidual residual;
    double cost = thresholds.outlier_cost;
    const double d2 = test.Distance(problem.matches[i], &residual);
    if (d2 <= thresholds.point) score.AddInlier(test.Entropy(residual));
    if (d2 < 2.0 * cost) cost = std::min(cost, test.NegativeLogLikelihood(residual));
    score.negative_log_likelihood += cost;
  }
  return score;
}

// A decision may define `RobustScore`, which scores all squared distances of a hypothesis together
// (robust_scores.h). Its cost takes the place of the negative log-likelihood.
template <typename T>
concept HasRobustScore = requires {
  typename T::RobustScore;
};

// Inliers, and the robust score of all squared distances. `distances` is scratch memory.
template <HasRobustScore Decision>
InlierScore ScoreDistances(const MotionProblem& problem, const typename Decision::PointTest& test,
                           const Thresholds& thresholds, std::vector<double>* distances) {
  InlierScore score;
  distances->clear();
  for (const Correspondence& match : problem.matches) {
    PointResidual residual;
    distances->push_back(test.Distance(match, &residual));
    if (distances->back() <= thresholds.point) score.AddInlier(test.Entropy(residual));
  }
  score.negative_log_likelihood = Decision::RobustScore::Cost(*distances, thresholds);
  return score;
}

// What a search needs from a decision beside the loop's LoopDecision: the point test that finds inliers and
// their entropies (point_consistency.h), and whether to test the sample (eq::sample-p-test) if the solver's
// kSampleTestDof > 0. If it does, the reference calls
//
//   static bool SampleIsConsistent(problem, hypothesis, point_test, thresholds);
template <typename T>
concept RansacDecision =
    LoopDecision<T> && std::constructible_from<T, const RansacOptions&, const Thresholds&> && requires {
  typename T::PointTest;
  { T::kTestsSample } -> std::convertible_to<bool>;
};

template <RansacDecision Decision, typename Solver>
class ReferenceSearch {
 public:
  using PointTest = typename Decision::PointTest;
  static constexpr bool kTestsSample = Decision::kTestsSample && Solver::kSampleTestDof > 0;

  ReferenceSearch(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng)
      : problem_(problem),
        thresholds_(Thresholds::For(problem, options, PointTest::kDegreesOfFreedom,
                                    PointTest::SampleTestDof(Solver::kSampleTestDof))),
        rng_(rng) {}

  const Thresholds& thresholds() const { return thresholds_; }

  Proposal Next() {
    if (++model_ >= hypotheses_.count) {
      const auto num_matches = static_cast<int>(problem_.matches.size());
      const Sample sample = DrawSample(Solver::kSampleSize, num_matches, rng_);
      hypotheses_ = InstantiateModels<Solver>(problem_, sample);
      model_ = 0;
      if (hypotheses_.count == 0) return {{sample}};
    }
    Hypothesis<Solver>& hypothesis = hypotheses_.models[static_cast<size_t>(model_)];
    Proposal proposal{hypothesis.id, SampleVerdict::kDegenerate, model_ + 1 == hypotheses_.count};
    test_ = MakePointTest(&hypothesis);
    if (!test_) return proposal;
    bool agrees = true;
    if constexpr (kTestsSample) {
      agrees = Decision::SampleIsConsistent(problem_, hypothesis, *test_, thresholds_);
    }
    proposal.verdict = agrees ? SampleVerdict::kConsistent : SampleVerdict::kInconsistent;
    return proposal;
  }

  InlierScore Score() {
    if constexpr (HasRobustScore<Decision>)
      return ScoreDistances<Decision>(problem_, *test_, thresholds_, &distances_);
    if constexpr (kScoresTheRest<Solver, PointTest>) {
      return ScoreInliers(problem_, *test_, thresholds_, hypotheses_.models[0].id.sample);
    }
    return ScoreInliers(problem_, *test_, thresholds_);
  }

  // The hypothesis of the last proposal, which must not be degenerate.
  const Hypothesis<Solver>& LastHypothesis() const { return hypotheses_.models[static_cast<size_t>(model_)]; }

  std::optional<Hypothesis<Solver>> FindHypothesis(const HypothesisId& id) const {
    return InstantiateModel<Solver>(problem_, id);
  }

  // The inliers of a hypothesis, ascending.
  std::vector<int> FindSupport(const HypothesisId& id) const {
    Hypothesis<Solver> hypothesis = FindHypothesis(id).value();
    const PointTest test = MakePointTest(&hypothesis).value();
    std::vector<int> inliers;
    for (size_t i = 0; i < problem_.matches.size(); ++i) {
      PointResidual residual;
      if (test.Distance(problem_.matches[i], &residual) <= thresholds_.point)
        inliers.push_back(static_cast<int>(i));
    }
    return inliers;
  }

 private:
  // Propagates Sigma_p and builds the point test on it; nullopt if the covariance is not finite.
  std::optional<PointTest> MakePointTest(Hypothesis<Solver>* hypothesis) const {
    if constexpr (!PointTest::kNeedsCovariance) {
      return PointTest(hypothesis->F, problem_.sigma_px);
    } else {
      PropagateCovariance(problem_, hypothesis);
      const std::optional<UncertainFundamental> model = ComputeUncertainFundamental(problem_, *hypothesis);
      if (!model) return std::nullopt;
      return PointTest(*model, problem_.sigma_px);
    }
  }

  const MotionProblem& problem_;
  Thresholds thresholds_;
  RandomStream& rng_;
  ModelList<Hypothesis<Solver>, Solver::kMaxModels> hypotheses_;  // of the last sample
  int model_ = 0;                                                 // of the last proposal
  std::optional<PointTest> test_;
  std::vector<double> distances_;  // scratch memory of ScoreDistances
};

}  // namespace rcme
