#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "estimator/geometry/lens.h"
#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"
#include "experiments/data/camera_plausibility.h"
#include "experiments/data/truth_sd.h"

namespace rcme {

// One pair of images as a text file, plain or gzip:
//
//   # size1: 1536 1024                       width height, px
//   # size2: 1536 1024
//   # K1_fx_fy_cx_cy: 1379.7 1382.1 760.1 503.2
//   # K2_fx_fy_cx_cy: 1379.7 1382.1 760.1 503.2
//   # camera1: OPENCV 1536 1024 1379.7 1382.1 760.1 503.2 -.2 .05 0 0    in place of size1 and K1, of
//                                          an image that a lens distorts: a camera model of COLMAP, width,
//                                          height and its parameters (colmap_camera.h), in the pixels of this
//                                          file; camera2 likewise
//   # R_rowmajor: ... (9)                    optional, with t_unit: the true motion X2 = R X1 + t
//   # t_unit: ... (3)
//   # truth_sd: 0.01 0.01 0.01 2e-3 2e-3 2e-3   optional: that motion's own standard deviations, along the
//                                          axes of camera 2: rotation in degrees, translation over the
//                                          baseline
//   # baseline: 1.628 m                    optional: length of the true translation in the data set's unit,
//                                          which may follow it
//   # noise_level: 1.2                     optional: a template (rcme twin) gets so many times the noise
//   # image1: frames/0001.png                optional, with image2: pairs of one scene
//   # image2: frames/0002.png                that share an image say so
//   # seconds_between: 0.1                 optional: time from image 1 to image 2, of one moving camera
//   # scene: name                            optional, groups pairs in a study
//   # prior_rotation_rowmajor: ... (9)       optional, as the next five: what sensors say of the motion
//   # prior_rotation_sd_deg: 0.5 0.5 0.5       about the axes of camera 2, or one number for all
//   # gravity1: 0.01 0.999 0.02              its direction in camera 1, of any length
//   # gravity2: 0.03 0.998 0.05              and in camera 2
//   # gravity_sd_deg: 1                      of each of them
//   # prior_direction: 0.1 0 0.99            of t, of any length
//   # prior_direction_sd_deg: 5
//   # better_score: lower                    or higher: of the column score
//   # key: value                             any further one is skipped
//   x1,y1,x2,y2[,...]                        column names, optional, before the first match
//   14.499,496.324,192.576,795.354[,...]     px; pixel (0, 0) is the centre of the top-left pixel
//
// A further column named sigma_px is each match's own standard deviation per coordinate (features.h says
// what those of our front end are). An estimator is given how these compare with each other, not how large
// they are (MakeMotionProblem). A column named score says how good each match is, any finite number, where
// the header says which are better: a ratio of distances is better where it is lower, a confidence where it
// is higher. Without that key the column is skipped, as other columns are.
enum class BetterScore { kLower, kHigher };
struct MatchFile {
  std::string path;
  std::string scene = "unnamed";
  std::vector<Correspondence> matches;
  Camera camera1, camera2;
  std::optional<RelativePose> cam2_from_cam1_true;
  std::optional<TruthSd> truth_sd;
  std::string image1, image2;    // empty: not said
  std::vector<double> sigma_px;  // per match; empty: the file has no such column
  bool had_lens = false;  // matches are undistorted; camera1 and camera2 are what is left of the lenses
  // Noise of the median match over what it was in the images as they were taken, before undistortion.
  double noise_growth = 1.0;
  double baseline = std::numeric_limits<double>::quiet_NaN();         // NaN: the file does not say
  double noise_level = 1.0;                                           // of a template
  double seconds_between = std::numeric_limits<double>::quiet_NaN();  // NaN: the file does not say
  std::vector<CameraDoubt> doubts = {};                               // about K, as the reader found them
  std::optional<MotionPrior> prior = {};
  std::optional<BetterScore> better_score = {};  // nothing: the file has no scores
  std::vector<double> scores = {};               // per match, as they are in the file
};

inline constexpr size_t kMaxMatchesPerFile = 1'000'000;

// The cameras of files that have none, camera 1 first; width and height do not count.
using GivenCameras = std::optional<std::array<Lens, 2>>;

// Reads line by line; memory is that of the matches. Throws InputError that names the file, the line, what is
// wrong and what is allowed: missing or truncated file, missing key, a K that is not invertible or cannot be
// that of the image (camera_plausibility.h), an invalid rotation, columns in another order, a coordinate that
// is not finite, a sigma_px that is not positive, a score that is not finite, better_score without such a
// column, more than kMaxMatchesPerFile matches, 1,000 columns or what
// GzipLines allows. Columns are separated by commas or, in a line without one, by blanks.
//
// Matches of images that a lens distorts are undistorted: the file has those of the pinhole cameras with the
// same K, and sigma_px says how noisy each is beside the others there (estimator/undistortion.h). A row whose
// pixel no ray reaches throws as the others do.
//
// Where the intrinsics are given the file must have none; where it does not say the size of the images
// either, it is twice the principal point, or what holds all points if that is more.
MatchFile ReadMatchFile(const std::string& path, const GivenCameras& given = std::nullopt);
// The same from standard input, which is also the path of the result.
MatchFile ReadMatchesFromInput(const GivenCameras& given = std::nullopt);

// What an estimator is given of a file: its matches and cameras, the noise level that is assumed of the
// images as they were taken, and of a column sigma_px each one's share of the median (noise_scale).
MotionProblem MakeMotionProblem(MatchFile file, double sigma_px);

// Writes the same format, plain. Throws InputError if the path cannot be written; never leaves half a file.
void WriteMatchFile(const MatchFile& file, const std::string& path);

}  // namespace rcme
