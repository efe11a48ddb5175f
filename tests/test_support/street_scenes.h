// A car on a street at a parallax of 1.5 times the noise, which has heavy tails: travel along the axis,
// depths that depend on the place in the image.
#pragma once

#include <cstdint>
#include <utility>

#include "estimator/motion_problem.h"
#include "simulator/noise/noise_laws.h"
#include "simulator/observe.h"
#include "simulator/scene_generator.h"

namespace rcme {

class StreetScenes {
 public:
  struct Case {
    MotionProblem problem;
    RelativePose pose_true;
  };
  StreetScenes() : scenes_("street", "pinhole", "vehicle") {
    for (const auto& [key, value] : {std::pair{"num_matches", "1500"},
                                     {"focal_px", "1560"},
                                     {"image_width", "1280"},
                                     {"image_height", "720"},
                                     {"street_length_m", "28"},
                                     {"road_share", "0.27"},
                                     {"facade_share", "0.55"},
                                     {"parallax_deg", "0.1"}})
      FindParameter(scenes_.Parameters(), key).SetFromText(value);
    scenes_.FixBaseline({.seed = 1, .purpose = 2801});
  }
  Case Make(std::uint32_t trial) const {
    RandomStream scene_rng({.seed = 1, .trial = trial, .purpose = 2798});
    RandomStream noise_rng({.seed = 1, .trial = trial, .purpose = 2799});
    RandomStream outlier_rng({.seed = 1, .trial = trial, .purpose = 2800});
    const Scene scene = scenes_.Generate(scene_rng);
    const auto noise = MakeStudentNoise();
    FindParameter(noise->Parameters(), "sigma_px").SetFromText("2.4");
    FindParameter(noise->Parameters(), "student_dof").SetFromText("2.3");
    return {{Observe(scene, *noise, OutlierModel(0.4), noise_rng, outlier_rng).matches, scene.camera1,
             scene.camera2, 2.4},
            scene.cam2_from_cam1_true};
  }

 private:
  SceneGenerator scenes_;
};

}  // namespace rcme
