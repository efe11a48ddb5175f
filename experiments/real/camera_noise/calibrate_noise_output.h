#pragma once

#include <string>

#include "experiments/core/table/command_result.h"
#include "experiments/real/camera_noise/calibrate_noise.h"

namespace rcme {

// One row for each quantity; JSON also has the variance of the field by its reach. `name`: of the set of
// pairs.
CommandResult MakeNoiseCalibrationResult(const NoiseCalibration& calibration, const std::string& name);

}  // namespace rcme
