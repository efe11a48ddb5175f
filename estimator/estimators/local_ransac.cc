#include "estimator/estimators/local_ransac.h"

#include "estimator/estimators/inlier_count.h"
#include "estimator/estimators/ransac_model.h"
#include "estimator/optimising_search.h"
#include "estimator/ransac_estimate.h"
#include "estimator/solvers/solver_table.h"

namespace rcme {
namespace {

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
                               "samples of the inliers of a hypothesis that is better than all before it"),
            Parameter::Integer("inner_refits", &o.num_refits, {0, 100},
                               "refits of each such sample to the matches within a falling threshold"),
            Parameter::Real("inner_first_threshold", &o.first_threshold, {1.0, 100.0}, "",
                            "threshold of the first refit, in thresholds of the inlier test")};
  }
  static std::vector<Parameter> OwnParameters(ByUncertainty& optimise) {
    return {Parameter::Integer("progressive_refits", &optimise.num_refits, {0, 100},
                               "most refits to the matches within the threshold that the motion's covariance "
                               "widens, of a hypothesis that is better than all before it")};
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
