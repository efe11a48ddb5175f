#pragma once

#include "simulator/camera_model.h"
#include "simulator/registry.h"

namespace rcme {

using CameraEntry = RegistryEntry<CameraModel>;
const std::vector<CameraEntry>& CameraRegistry();

}  // namespace rcme
