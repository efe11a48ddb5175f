// Cameras from a file, for simulated pairs: the choice `cameras: from_file` and the key `calibration`.
#pragma once

#include "experiments/data/settings.h"

namespace rcme {

inline constexpr const char* kCamerasFromFile = "from_file";
inline constexpr const char* kCalibrationKey = "calibration";
// Describes the key for people.
SettingHelp CalibrationHelp();

// Replaces `cameras: from_file` by `cameras: own_intrinsics` with the intrinsics in the file of
// `calibration`, so the study is identified by these and not by the path. Other settings are returned
// unchanged. The file is a match file, of which only # size1, # size2, # K1_fx_fy_cx_cy and # K2_fx_fy_cx_cy
// are used; its path is relative to the working directory. Throws InputError that names file, line and key.
Settings WithCalibration(const Settings& settings);

}  // namespace rcme
