// The search of reference_search.h with local optimisation (local_optimisation.h). It optimises each
// hypothesis that has more inliers than all before it: as in LO-RANSAC, about log k of k hypotheses.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "estimator/local_optimisation.h"
#include "estimator/reference_matches.h"
#include "estimator/reference_search.h"

namespace rcme {

// `Optimise`: Supported(problem, Hypothesis<Solver>, Supported start, threshold, rng).
template <RansacDecision Decision, typename Solver, typename Optimise>
class OptimisingSearch {
 public:
  OptimisingSearch(const MotionProblem& problem, const RansacOptions& options, const Optimise& optimise,
                   RandomStream& rng)
      : problem_(problem), search_(problem, options, rng), optimise_(optimise), rng_(rng) {}

  const Thresholds& thresholds() const { return search_.thresholds(); }
  Proposal Next() { return search_.Next(); }

  InlierScore Score() {
    InlierScore score = search_.Score();
    if (score.num_inliers <= most_inliers_) return score;
    most_inliers_ = score.num_inliers;
    const Hypothesis<Solver>& hypothesis = search_.LastHypothesis();
    const Supported start{hypothesis.pose, search_.FindSupport(hypothesis.id)};
    Supported optimum = optimise_(problem_, hypothesis, start, thresholds().point, rng_);
    const auto num_inliers = static_cast<int>(optimum.inliers.size());
    if (num_inliers <= score.num_inliers) return score;
    optima_[hypothesis.id] = std::move(optimum);
    score.num_inliers = num_inliers;
    return score;
  }

  // Returns the optimised motion if the hypothesis was optimised, else that of the sample.
  std::optional<Hypothesis<Solver>> FindHypothesis(const HypothesisId& id) const {
    std::optional<Hypothesis<Solver>> hypothesis = search_.FindHypothesis(id);
    const auto found = optima_.find(id);
    if (!hypothesis || found == optima_.end()) return hypothesis;
    const Eigen::Matrix3d E = EssentialFromPose(found->second.pose);
    hypothesis->pose = found->second.pose;
    hypothesis->projection = ProjectToEssential(E);
    hypothesis->F = FundamentalFromEssential(E, problem_.camera1, problem_.camera2);
    return hypothesis;
  }

  std::vector<int> FindSupport(const HypothesisId& id) const {
    const auto found = optima_.find(id);
    return found == optima_.end() ? search_.FindSupport(id) : found->second.inliers;
  }

 private:
  const MotionProblem& problem_;
  ReferenceSearch<Decision, Solver> search_;
  Optimise optimise_;
  RandomStream& rng_;
  int most_inliers_ = 0;  // of any hypothesis before optimisation
  std::map<HypothesisId, Supported> optima_;
};

template <RansacDecision Decision, typename SolverT, typename Optimise>
struct OptimisingEngine {
  using Solver = SolverT;
  OptimisingEngine(const MotionProblem& problem, const RansacOptions& options, const Optimise& optimise,
                   RandomStream& rng)
      : search(problem, options, optimise, rng), matches(problem, options.refinement_error) {}
  OptimisingSearch<Decision, Solver, Optimise> search;
  ReferenceMatches matches;
};

}  // namespace rcme
