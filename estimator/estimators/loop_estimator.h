#pragma once

#include <memory>
#include <type_traits>

#include "estimator/estimators/ransac_inspection.h"
#include "estimator/kernels/fast_engine.h"
#include "estimator/ransac_estimate.h"
#include "estimator/solvers/solver_table.h"

namespace rcme {

// The estimator of a decision (ransac_loop.h) with one minimal solver in one implementation.
template <RansacDecision Decision, RansacEngine Engine>
class LoopEstimator : public InspectableEstimator {
 public:
  explicit LoopEstimator(const RansacOptions& options)
      : InspectableEstimator(std::make_unique<RansacInspection<Decision, Engine>>(options)),
        options_(options) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return EstimateByRansac<Decision, Engine>(problem, options_, rng);
  }

 private:
  RansacOptions options_;
};

// The estimator of a decision with the solver and the implementation of the options. Throws InputError if the
// options contradict each other.
template <RansacDecision Decision>
std::unique_ptr<MotionEstimator> MakeLoopEstimator(const RansacOptions& options) {
  Validate(options);
  return VisitSolver(options.solver, [&]<typename Solver>(std::type_identity<Solver>) {
    std::unique_ptr<MotionEstimator> estimator;
    if constexpr (kHasFast<Solver> && !HasRobustScore<Decision>) {
      using Engine = FastEngine<Decision, Solver>;
      if (options.IsFast()) estimator = std::make_unique<LoopEstimator<Decision, Engine>>(options);
    }
    using Engine = ReferenceEngine<Decision, Solver>;
    if (!estimator) estimator = std::make_unique<LoopEstimator<Decision, Engine>>(options);
    return estimator;
  });
}

}  // namespace rcme
