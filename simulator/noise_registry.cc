#include "simulator/noise_registry.h"

#include "simulator/noise/noise_laws.h"

namespace rcme {

const std::vector<NoiseEntry>& NoiseRegistry() {
  static const std::vector<NoiseEntry> registry = {
      {"gaussian", "independent and normal, equal in all coordinates (the paper's a.2)",
       [] { return MakeGaussianNoise(); }},
  };
  return registry;
}

}  // namespace rcme
