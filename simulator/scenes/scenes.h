// The scenes that scene_registry lists, one file each.
#pragma once

#include <memory>

#include "simulator/scene_model.h"

namespace rcme {

std::unique_ptr<SceneModel> MakeUniformVolume();

}  // namespace rcme
