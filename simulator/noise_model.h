#pragma once

#include <vector>

#include "parameters/parameter.h"
#include "stats/random.h"

namespace rcme {

// Gaussian, independent, equal in both coordinates of both images (assumption a.2).
struct NoiseModel {
  double sigma_px = 0.5;  // standard deviation per coordinate

  double Draw(RandomStream& rng) const { return sigma_px * rng.Normal(); }
};
std::vector<Parameter> Parameters(NoiseModel& noise);

}  // namespace rcme
