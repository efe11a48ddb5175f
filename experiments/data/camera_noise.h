// What a camera and its front end do to key points, as `rcme calibrate-noise` learns it from pairs, and the
// file that holds it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "estimator/geometry/camera.h"
#include "parameters/settings.h"

namespace rcme {

struct Measured {
  double value = std::numeric_limits<double>::quiet_NaN();  // NaN: not known
  double standard_error = std::numeric_limits<double>::quiet_NaN();
};

// The faults of a camera that a file may correct (CameraFault, in its order; real/truth_free/camera_faults.h
// says what each is).
inline constexpr std::array kCorrectableFaults = {"focal_length",  "principal_point_x", "principal_point_y",
                                                  "distortion",    "readout_time",      "image2_shift_x",
                                                  "image2_shift_y"};

struct CameraCorrection {
  size_t fault = 0;      // of kCorrectableFaults
  Measured estimate;     // of the fault, beside the others
  double removed = 0.0;  // what is taken out
  double uncertainty =
      0.0;  // root mean square of what may be left of it, whether something is taken out or not
};

// A displacement of what is observed that all images of a camera share, px: bilinear between the centres of
// columns x rows cells, constant beyond them.
struct DisplacementCells {
  int columns = 0, rows = 0;         // 0: there is none
  std::vector<double> dx_px, dy_px;  // row by row
  double rms_px = 0.0, p_value = 1.0;
};

struct CameraNoise {
  // What it rests on.
  int num_pairs = 0;
  std::int64_t num_matches = 0;
  double effective_pairs = 0.0;  // pairs of equal weight that would tell sigma as well
  std::string estimator;

  Camera camera;           // as the pairs state it
  Measured sigma_px;       // per coordinate, of a key point of the median size, whatever shares it
  Measured size_exponent;  // sigma grows with this power of the stated size; NaN: no sizes are stated
  // Standard deviation of what the matches of one key point share, and of a field over each image whose
  // correlation is exp(-d / reach); both are part of sigma_px. 0: not more than chance shows.
  double key_point_px = 0.0;
  Measured displacement_px{0.0, 0.0};
  double reach_px = 0.0, reach_factor = 1.0;  // factor: one standard error, upwards and downwards
  // Where no field was found: root of the variance that is to be expected of one that reaches as far as the
  // image, which pairs show badly and motions feel most. Part of sigma_px. 0: a field was found.
  double unseen_px = 0.0, unseen_reach_px = 0.0;
  std::vector<CameraCorrection> corrections;
  std::vector<double> correlations,
      uncertainty_correlations;  // of the estimates, of what is left; row by row
  double seconds_between = std::numeric_limits<double>::quiet_NaN();  // that the readout time is a share of
  DisplacementCells systematic;

  // Of sigma_px^2, what the displacement field has of it.
  double DisplacementShare() const;
};

// The file: YAML whose first key is rcme_camera_noise, its version.
inline constexpr const char *kNoiseVersionKey = "rcme_camera_noise", *kNoiseVersion = "1";
std::string CameraNoiseAsYaml(const CameraNoise& noise);
// Throws InputError that names file, line, key and what is allowed: no such file, a file of another kind or
// version, an unknown, missing or repeated key, a number out of its range, correlations that are none.
CameraNoise ReadCameraNoise(const std::string& path);
CameraNoise ParseCameraNoise(const std::string& yaml, const std::string& path);

inline constexpr const char* kNoiseFromFile = "from_file";
inline constexpr const char* kNoiseFileKey = "noise_file";

// Where the settings choose `noise: from_file`: the same with `noise: displacement_field` and the sigma,
// share and reach that the file of `noise_file` holds, so that these, not its path, are what a study is known
// by. Keys that are given beside it have precedence. The path is seen from the working directory.
Settings WithNoiseFile(const Settings& settings);

}  // namespace rcme
