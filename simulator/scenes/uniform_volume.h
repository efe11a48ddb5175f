#pragma once

#include "simulator/camera_motion.h"
#include "simulator/camera_pair.h"
#include "simulator/scene.h"

namespace rcme {

// Points whose first image is uniform over image 1 and whose depth is uniform in a range, given that image 2
// sees them.
class UniformVolume : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override;
  Scene Generate(RandomStream& rng) const override;

 private:
  CameraPair cameras_;
  GeneralMotion motion_;
  int num_matches_ = 500;
  double min_depth_m_ = 2.0, max_depth_m_ = 8.0;
};

}  // namespace rcme
