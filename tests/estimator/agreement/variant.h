// The variants of estimators whose implementations are compared, and the problems.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimator/solvers/solver_list.h"
#include "simulator/noise/noise_laws.h"
#include "simulator/observe.h"
#include "simulator/scene_generator.h"
#include "simulator/scene_registry.h"
#include "tests/test_support/make_ransac.h"

namespace rcme::agreement {

struct Variant {
  std::string label, estimator;
  Reading reading;
  MinimalSolver solver;

  RansacOptions Options() const {
    RansacOptions options;
    options.reading = reading;
    options.solver = solver;
    if (solver != MinimalSolver::kEightPoint) options.num_iterations = 16;  // 75 hypotheses, one by one
    return options;
  }
};

inline std::vector<Variant> ListVariants(MinimalSolver solver) {
  return {{"standard", "standard", Reading::kAsPrinted, solver},
          {"prcme_as_printed", "prcme", Reading::kAsPrinted, solver},
          {"rcme_as_printed", "rcme", Reading::kAsPrinted, solver},
          {"prcme_rank_aware", "prcme", Reading::kRankAware, solver},
          {"rcme_rank_aware", "rcme", Reading::kRankAware, solver}};
}

// Five points have no sample test, so that rcme is prcme.
inline const std::vector<Variant>& Variants() {
  static const std::vector<Variant> variants = [] {
    std::vector<Variant> all = ListVariants(MinimalSolver::kEightPoint);
    for (Variant variant : ListVariants(MinimalSolver::kFivePoint)) {
      if (variant.estimator == "prcme") continue;
      variant.label = "five_point_" + variant.label;
      all.push_back(variant);
    }
    return all;
  }();
  return variants;
}

// All combinations of scene, outlier ratio, noise and number of matches, in turn.
inline MotionProblem MakeProblem(std::uint32_t trial) {
  constexpr double kOutlierRatios[] = {0.0, 0.2, 0.4, 0.6}, kSigmasPx[] = {0.1, 0.5, 1.0};
  constexpr int kNumMatches[] = {50, 150, 500};
  size_t turn = trial;
  const auto next = [&turn](size_t n) {
    const size_t index = turn % n;
    turn /= n;
    return index;
  };
  const double outlier_ratio = kOutlierRatios[next(4)], sigma_px = kSigmasPx[next(3)];
  const int num_matches = kNumMatches[next(3)];
  SceneGenerator model(SceneRegistry()[next(SceneRegistry().size())].name);
  FindParameter(model.Parameters(), "num_matches").SetFromText(std::to_string(num_matches));
  RandomStream scene_rng({1, 7, trial, 1}), noise_rng({1, 7, trial, 2}), outlier_rng({1, 7, trial, 3});
  const Scene scene = model.Generate(scene_rng);
  return {Observe(scene, *MakeGaussianNoise(sigma_px), OutlierModel(outlier_ratio), noise_rng, outlier_rng)
              .matches,
          scene.camera1, scene.camera2, sigma_px};
}

inline RandomStream SamplingStream(std::uint32_t trial) { return RandomStream({1, 7, trial, 4}); }

inline MotionEstimate Estimate(const Variant& variant, RansacOptions options, Implementation implementation,
                               const MotionProblem& problem, std::uint32_t trial) {
  options.reading = variant.reading;
  options.solver = variant.solver;
  options.num_iterations = variant.Options().num_iterations;
  options.implementation = implementation;
  RandomStream rng = SamplingStream(trial);
  return MakeRansac(variant.estimator, options)->Estimate(problem, rng);
}

}  // namespace rcme::agreement
