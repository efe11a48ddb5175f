#include "estimator/estimators/local_ransac.h"

#include <map>
#include <optional>
#include <vector>

#include "estimator/estimators/ransac_model.h"
#include "estimator/estimators/standard.h"
#include "estimator/local_optimisation.h"
#include "estimator/ransac_estimate.h"
#include "estimator/reference_matches.h"
#include "estimator/reference_search.h"
#include "estimator/solvers/solver_table.h"

namespace rcme {
namespace {

// The search of reference_search.h with local optimisation (local_optimisation.h). It optimises each
// hypothesis that has more inliers than all before it: as in LO-RANSAC, about log k of k hypotheses.

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

struct ByInnerRansac {
  InnerRansac options;
  template <typename Solver>
  Supported operator()(const MotionProblem& problem, const Hypothesis<Solver>&, const Supported& start,
                       double threshold, RandomStream& rng) const {
    return OptimiseByInnerRansac(problem, start, threshold, options, rng);
  }
};

struct ByUncertainty {
  int num_refits = 5;
  template <typename Solver>
  Supported operator()(const MotionProblem& problem, const Hypothesis<Solver>& hypothesis,
                       const Supported& start, double threshold, RandomStream&) const {
    Hypothesis<Solver> uncertain = hypothesis;
    PropagateCovariance(problem, &uncertain);
    return OptimiseByUncertainty(problem, start, uncertain.pose_cov, threshold, num_refits);
  }
};

// The loop cannot be inspected: the result of an optimisation depends on the samples drawn before, so a
// hypothesis cannot be reconstructed from its sample alone.
template <typename Optimise>
class LocalRansac : public MotionEstimator {
 public:
  LocalRansac(const RansacOptions& options, const Optimise& optimise)
      : options_(options), optimise_(optimise) {
    Validate(options);
  }
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return VisitSolver(options_.solver, [&]<typename Solver>(std::type_identity<Solver>) {
      using Engine = OptimisingEngine<InlierCountDecision, Solver, Optimise>;
      if (std::optional<MotionEstimate> refusal = RefuseBeforeLoop<Engine>(problem)) return *refusal;
      Engine engine(problem, options_, optimise_, rng);
      return EstimateWith<InlierCountDecision>(problem, options_, engine);
    });
  }

 private:
  RansacOptions options_;
  Optimise optimise_;
};

template <typename Optimise>
class LocalRansacModel : public PlainRansacModel {
 public:
  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = ParametersWithout({"implementation", "refinement"});
    for (Parameter& own : OwnParameters(optimise_)) all.push_back(std::move(own));
    return all;
  }
  std::unique_ptr<MotionEstimator> Make() const override {
    return std::make_unique<LocalRansac<Optimise>>(options_, optimise_);
  }

 private:
  static std::vector<Parameter> OwnParameters(ByInnerRansac& optimise) {
    InnerRansac& o = optimise.options;
    return {Parameter::Integer("inner_samples", &o.num_samples, {0, 1000},
                               "inlier samples per new best hypothesis"),
            Parameter::Integer("inner_refits", &o.num_refits, {0, 100},
                               "refits per inlier sample, with a falling threshold"),
            Parameter::Real("inner_first_threshold", &o.first_threshold, {1.0, 100.0}, "",
                            "threshold of the first refit, in inlier thresholds")};
  }
  static std::vector<Parameter> OwnParameters(ByUncertainty& optimise) {
    return {Parameter::Integer(
        "progressive_refits", &optimise.num_refits, {0, 100},
        "most refits per new best hypothesis, to matches within a threshold widened by its covariance")};
  }

  Optimise optimise_;
};

}  // namespace

std::unique_ptr<EstimatorModel> LoRansacModel() {
  return std::make_unique<LocalRansacModel<ByInnerRansac>>();
}
std::unique_ptr<EstimatorModel> CovRansacModel() {
  return std::make_unique<LocalRansacModel<ByUncertainty>>();
}

}  // namespace rcme
