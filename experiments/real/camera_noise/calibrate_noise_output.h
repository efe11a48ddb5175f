#pragma once

#include <string>

#include "experiments/core/table/command_result.h"
#include "experiments/real/camera_noise/calibrate_noise.h"

namespace rcme {

// `name`: of the set of pairs. A row per quantity; in JSON also the variance of the field by its reach.
CommandResult MakeNoiseCalibrationResult(const NoiseCalibration& calibration, const std::string& name);

}  // namespace rcme
