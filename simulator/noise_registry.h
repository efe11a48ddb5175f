#pragma once

#include "simulator/noise_model.h"
#include "simulator/registry.h"

namespace rcme {

using NoiseEntry = RegistryEntry<NoiseModel>;
const std::vector<NoiseEntry>& NoiseRegistry();

}  // namespace rcme
