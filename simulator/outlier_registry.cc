#include "simulator/outlier_registry.h"

#include "simulator/outliers/outlier_laws.h"

namespace rcme {

const std::vector<OutlierEntry>& OutlierRegistry() {
  static const std::vector<OutlierEntry> registry = {
      {"uniform", "the point in image 2 is anywhere", MakeUniformOutliers},
  };
  return registry;
}

}  // namespace rcme
