// Cameras from a file, for simulated pairs: the choice `cameras: from_file` with the key `calibration`.
#pragma once

#include <string>

#include "experiments/data/settings.h"

namespace rcme {

inline constexpr const char* kCamerasFromFile = "from_file";
inline constexpr const char* kCalibrationKey = "calibration";
// What the key stands for, for people.
SettingHelp CalibrationHelp();

// Where the settings choose `cameras: from_file`: the same with `cameras: own_intrinsics` and the intrinsics
// that the file of `calibration` holds, so that they, not its path, are what a study is known by. Other
// settings as they are. The file is a match file, of which only # size1, # size2, # K1_fx_fy_cx_cy and #
// K2_fx_fy_cx_cy count; its path is seen from the working directory. Throws InputError that names file,
// line and key.
Settings WithCalibration(const Settings& settings);

}  // namespace rcme
