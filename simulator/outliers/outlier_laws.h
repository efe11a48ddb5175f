// The outlier laws that outlier_registry lists, one file each.
#pragma once

#include <memory>

#include "simulator/outlier_law.h"

namespace rcme {

std::unique_ptr<OutlierLaw> MakeUniformOutliers();

}  // namespace rcme
