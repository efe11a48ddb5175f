#pragma once

#include "simulator/outlier_law.h"
#include "simulator/registry.h"

namespace rcme {

using OutlierEntry = RegistryEntry<OutlierLaw>;
const std::vector<OutlierEntry>& OutlierRegistry();

}  // namespace rcme
