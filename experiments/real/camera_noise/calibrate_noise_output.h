#pragma once

#include <string>

#include "experiments/real/camera_noise/calibrate_noise.h"

namespace rcme {

std::string NoiseCalibrationAsText(const NoiseCalibration& calibration, const std::string& name);
// A row per quantity.
std::string NoiseCalibrationAsCsv(const NoiseCalibration& calibration);
std::string NoiseCalibrationAsJson(const NoiseCalibration& calibration, const std::string& name);

}  // namespace rcme
