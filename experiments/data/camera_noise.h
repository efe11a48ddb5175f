// The errors of a camera and its front end at key points, as `rcme calibrate-noise` estimates them from
// pairs, and the file that stores them.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "estimator/geometry/camera.h"
#include "parameters/settings.h"

namespace rcme {

// A figure of a camera with its standard error; NaN: not known.
struct ValueWithError {
  double value = std::numeric_limits<double>::quiet_NaN();
  double standard_error = std::numeric_limits<double>::quiet_NaN();
};

// The camera faults that a file may correct, in the order of CameraFault (real/truth_free/camera_faults.h
// describes each).
inline constexpr std::array kCorrectableFaults = {"focal_length",  "principal_point_x", "principal_point_y",
                                                  "distortion",    "readout_time",      "image2_shift_x",
                                                  "image2_shift_y"};

struct CameraCorrection {
  size_t fault = 0;          // index in kCorrectableFaults
  ValueWithError estimate;   // estimated together with the other faults
  double removed = 0.0;      // the correction to apply
  double uncertainty = 0.0;  // rms of what may be left of the fault, corrected or not
};

// A displacement of the observations that all images of a camera share, in px: bilinear between the centres
// of columns x rows cells, constant beyond them.
struct DisplacementCells {
  int columns = 0, rows = 0;         // 0: no displacement
  std::vector<double> dx_px, dy_px;  // row by row
  double rms_px = 0.0, p_value = 1.0;
};

struct CameraNoise {
  // The data on which the estimates are based.
  int num_pairs = 0;
  std::int64_t num_matches = 0;
  double effective_pairs = 0.0;  // equally weighted pairs that determine sigma as well
  std::string estimator;

  Camera camera;                 // as stated by the pairs
  ValueWithError sigma_px;       // per coordinate, for a key point of median size, including shared parts
  ValueWithError size_exponent;  // sigma grows with this power of the stated size; NaN: no sizes
  // Standard deviations of the error that all matches of one key point share, and of an error field over
  // each image with correlation exp(-d / reach). Both are parts of sigma_px. 0: not significant.
  double key_point_px = 0.0;
  ValueWithError displacement_px{0.0, 0.0};
  double reach_px = 0.0, reach_factor = 1.0;  // reach_factor: one standard error upwards or downwards
  // If no field was found: the standard deviation to expect of a field that reaches as far as the image,
  // which pairs show least and motions are most sensitive to. Part of sigma_px. 0: a field was found.
  double unseen_px = 0.0, unseen_reach_px = 0.0;
  std::vector<CameraCorrection> corrections;
  std::vector<double> correlations,
      uncertainty_correlations;  // of the estimates and of the remaining faults; row by row
  double seconds_between = std::numeric_limits<double>::quiet_NaN();  // the readout time is a share of this
  DisplacementCells systematic;

  // The share of the displacement field in sigma_px^2.
  double DisplacementShare() const;
};

// The file is YAML whose first key is rcme_camera_noise, with its version.
inline constexpr const char *kNoiseVersionKey = "rcme_camera_noise", *kNoiseVersion = "1";
std::string CameraNoiseAsYaml(const CameraNoise& noise);
// Throws InputError that names file, line, key and what is allowed: a missing file, a file of another kind
// or version, an unknown, missing or repeated key, a number out of range, a matrix that is no correlation
// matrix.
CameraNoise ReadCameraNoise(const std::string& path);
CameraNoise ParseCameraNoise(const std::string& yaml, const std::string& path);

inline constexpr const char* kNoiseFromFile = "from_file";
inline constexpr const char* kNoiseFileKey = "noise_file";

// Replaces `noise: from_file` by `noise: displacement_field` with sigma, share and reach in the file of
// `noise_file`, so the study is identified by these and not by the path. Keys given beside it take
// precedence. The path is relative to the working directory.
Settings WithNoiseFile(const Settings& settings);

}  // namespace rcme
