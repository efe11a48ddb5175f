#pragma once

#include <span>
#include <vector>

#include "parameters/parameter.h"
#include "stats/random.h"

namespace rcme {

// Gaussian, independent, equal in both coordinates of both images (assumption a.2).
struct NoiseModel {
  double sigma_px = 0.5;  // standard deviation per coordinate

  void Fill(std::span<double> noise_px, RandomStream& rng) const {
    rng.FillNormal(noise_px);
    for (double& e : noise_px) e *= sigma_px;
  }
};
std::vector<Parameter> Parameters(NoiseModel& noise);

}  // namespace rcme
