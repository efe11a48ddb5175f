// Problems of the scene families of the simulator, by name.
#pragma once

#include <memory>
#include <string>

#include "estimator/motion_problem.h"
#include "parameters/settings.h"
#include "simulator/noise/noise_laws.h"
#include "simulator/observe.h"
#include "simulator/scene_generator.h"

namespace rcme {

inline constexpr double kFamilySigmaPx = 0.5;

class ProblemFamily {
 public:
  ProblemFamily(const std::string& scene, const std::string& motion, int num_matches, double outlier_ratio,
                const Settings& settings = {})
      : scenes_(scene, "", motion), outlier_ratio_(outlier_ratio) {
    FindParameter(scenes_.Parameters(), "num_matches").SetFromText(std::to_string(num_matches));
    for (const auto& [key, value] : settings) FindParameter(scenes_.Parameters(), key).SetFromText(value);
    scenes_.FixBaseline({.purpose = 94});
  }

  MotionProblem Make(std::uint32_t trial) const {
    RandomStream scene_rng({.seed = 1, .trial = trial, .purpose = 95});
    RandomStream noise_rng({.seed = 1, .trial = trial, .purpose = 96});
    RandomStream outlier_rng({.seed = 1, .trial = trial, .purpose = 97});
    const Scene scene = scenes_.Generate(scene_rng);
    Observation observed = Observe(scene, *MakeGaussianNoise(kFamilySigmaPx), OutlierModel(outlier_ratio_),
                                   noise_rng, outlier_rng);
    return {std::move(observed.matches), scene.camera1, scene.camera2, kFamilySigmaPx};
  }

 private:
  SceneGenerator scenes_;
  double outlier_ratio_;
};

}  // namespace rcme
