// The parts of the hypothesis loop in their simplest form: one sample, one match at a time. The oracle of
// kernels/block_search.h.
#pragma once

#include "estimator/hypothesis.h"
#include "estimator/point_consistency.h"
#include "estimator/ransac_loop.h"

namespace rcme {

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

template <typename Pipeline>
class ReferenceSearch {
 public:
  using PointTest = typename Pipeline::PointTest;

  ReferenceSearch(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng)
      : problem_(problem),
        thresholds_(Thresholds::For(problem, options, PointTest::kDegreesOfFreedom)),
        rng_(rng) {}

  const Thresholds& thresholds() const { return thresholds_; }

  Proposal Next() {
    Proposal proposal{DrawSample(static_cast<int>(problem_.matches.size()), rng_)};
    hypothesis_ = InstantiateModel(problem_, proposal.sample);
    if (!hypothesis_) return proposal;
    test_ = MakePointTest(&*hypothesis_);
    if (!test_) return proposal;
    const bool agrees = Pipeline::SampleIsConsistent(problem_, *hypothesis_, *test_, thresholds_);
    proposal.verdict = agrees ? SampleVerdict::kConsistent : SampleVerdict::kInconsistent;
    return proposal;
  }

  InlierScore Score() { return ScoreInliers(problem_, *test_, thresholds_); }

  // The inliers of a sample's hypothesis, ascending.
  std::vector<int> FindSupport(const Sample& sample) const {
    Hypothesis hypothesis = InstantiateModel(problem_, sample).value();
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
  // Sigma_p propagated and the point test built on it; nothing if the covariance is not finite.
  std::optional<PointTest> MakePointTest(Hypothesis* hypothesis) const {
    if constexpr (!PointTest::kNeedsCovariance) {
      return PointTest(hypothesis->F, problem_.sigma_px);
    } else {
      PropagateCovariance(problem_, hypothesis);
      const std::optional<UncertainFundamental> model = UncertainFundamental::From(
          hypothesis->pose, hypothesis->pose_cov, problem_.camera1, problem_.camera2);
      if (!model) return std::nullopt;
      return PointTest(*model, problem_.sigma_px);
    }
  }

  const MotionProblem& problem_;
  Thresholds thresholds_;
  RandomStream& rng_;
  std::optional<Hypothesis> hypothesis_;  // of the last proposal
  std::optional<PointTest> test_;
};

}  // namespace rcme
