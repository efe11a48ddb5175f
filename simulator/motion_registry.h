#pragma once

#include "simulator/motion_model.h"
#include "simulator/registry.h"

namespace rcme {

using MotionEntry = RegistryEntry<MotionModel>;
const std::vector<MotionEntry>& MotionRegistry();

}  // namespace rcme
