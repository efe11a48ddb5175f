// The noise laws that noise_registry lists, one file each.
#pragma once

#include <memory>

#include "simulator/noise_model.h"

namespace rcme {

// Independent normal noise of one standard deviation (assumption a.2); sigma 0 is allowed here: exact images.
std::unique_ptr<NoiseModel> MakeGaussianNoise(double sigma_px = 0.5);

}  // namespace rcme
