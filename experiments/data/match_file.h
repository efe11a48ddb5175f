#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "estimator/geometry/lens.h"
#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"
#include "experiments/data/input_doubt.h"
#include "experiments/data/truth_sd.h"

namespace rcme {

// One pair of images as a text file, plain or gzip:
//
//   # size1: 1536 1024                       width height, px
//   # size2: 1536 1024
//   # K1_fx_fy_cx_cy: 1379.7 1382.1 760.1 503.2
//   # K2_fx_fy_cx_cy: 1379.7 1382.1 760.1 503.2
//   # camera1: OPENCV 1536 1024 1379.7 1382.1 760.1 503.2 -.2 .05 0 0    replaces size1 and K1 for an image
//                                          with lens distortion: a COLMAP camera model, width, height and
//                                          its parameters (colmap_camera.h), in the pixels of this file;
//                                          camera2 likewise
//   # R_rowmajor: ... (9)                    optional, with t_unit: the true motion X2 = R X1 + t
//   # t_unit: ... (3)
//   # truth_sd: 0.01 0.01 0.01 2e-3 2e-3 2e-3   optional: standard deviations of that motion along the axes
//                                          of camera 2: rotation in degrees, translation relative to the
//                                          baseline
//   # baseline: 1.628 m                    optional: length of the true translation > 0, in the data set's
//                                          unit, which may follow in any words
//   # sigma_px: 0.7                        optional: the noise level that estimators are told, per coordinate
//   # noise_level: 1.2                     optional: factor for the noise of a template (rcme twin)
//   # image1: frames/0001.png                optional, with image2: names the images, so that pairs of a
//   # image2: frames/0002.png                scene that share an image can be recognized
//   # seconds_between: 0.1                 optional: time from image 1 to image 2, of one moving camera
//   # scene: name                            optional, groups pairs in a study
//   # prior_rotation_rowmajor: ... (9)       optional, like the next five: sensor measurements of the motion
//   # prior_rotation_sd_deg: 0.5 0.5 0.5       about the axes of camera 2, or one number for all
//   # gravity1: 0.01 0.999 0.02              direction of gravity in camera 1, of any length
//   # gravity2: 0.03 0.998 0.05              and in camera 2
//   # gravity_sd_deg: 1                      of each of them
//   # prior_direction: 0.1 0 0.99            of t, of any length
//   # prior_direction_sd_deg: 5
//   # better_score: lower                    or higher: for the column score
//   # key: value                             any other key is skipped
//   x1,y1,x2,y2[,...]                        column names, optional, before the first match
//   14.499,496.324,192.576,795.354[,...]     px; pixel (0, 0) is the centre of the top-left pixel
//
// Two further columns are read; others are skipped:
// - sigma_px is the standard deviation of a match per coordinate (real/images/features.h describes that of
//   our front end). Estimators get the ratios between matches; the header sigma_px states the absolute size
//   (MakeMotionProblem).
// - score is the quality of a match, any finite number. It is read only if the header has better_score: a
//   ratio of distances is better if lower, a confidence if higher.
enum class BetterScore { kLower, kHigher };
struct MatchFile {
  std::string path;
  std::string scene = "unnamed";
  std::vector<Correspondence> matches;
  Camera camera1, camera2;
  std::optional<RelativePose> cam2_from_cam1_true;
  std::optional<TruthSd> truth_sd;
  std::string image1, image2;    // empty: not stated
  std::vector<double> sigma_px;  // per match; empty: the file has no such column
  // Of images with lens distortion: matches are undistorted, camera1 and camera2 are pinholes.
  std::optional<Undistortion> undistortion = {};
  std::vector<size_t> rows = {};  // of the matches among all in the file; empty: all of them
  size_t num_rows = 0;            // in the file, with those that are left out
  double baseline = std::numeric_limits<double>::quiet_NaN();         // NaN: not stated
  std::optional<double> assumed_sigma_px = {};                        // the header sigma_px
  double noise_level = 1.0;                                           // of a template
  double seconds_between = std::numeric_limits<double>::quiet_NaN();  // NaN: not stated
  std::vector<InputDoubt> doubts = {};                                // about K
  std::optional<MotionPrior> prior = {};
  std::optional<BetterScore> better_score = {};  // nothing: the file has no scores
  std::vector<double> scores = {};               // per match, as in the file
};

inline constexpr size_t kMaxMatchesPerFile = 1'000'000;
inline constexpr double kUsualSigmaPx = 0.5;  // assumed if neither the caller nor the file states a level

// The cameras of files without intrinsics, camera 1 first; their width and height are ignored.
struct CamerasOfOption {
  std::array<Lens, 2> lenses;
  std::string option = "--K";  // that gave them, for messages
};
using GivenCameras = std::optional<CamerasOfOption>;

// Reads a match file line by line; memory is that of the matches. Columns are separated by commas or, in a
// line without commas, by blanks. Throws InputError that names the file, the line, what is wrong and what is
// allowed: a missing or truncated file, a missing key, a K that is not invertible or cannot be that of the
// image (camera_plausibility.h), an invalid rotation, columns in another order, a coordinate or score that
// is not finite, a sigma_px that is not positive (in the header: not in [1e-9, 1000]), better_score without a
// column score, or more than kMaxMatchesPerFile matches, 1,000 columns or what GzipLines allows.
//
// Matches of images with lens distortion are undistorted. The result has the matches of pinhole cameras with
// the same K, and sigma_px is the noise of each match there relative to the others
// (estimator/undistortion.h). A match at a pixel that no ray reaches is left out, and `doubts` says so.
//
// If the intrinsics are given, the file must not have any. If it does not state the image size either, that
// is twice the principal point, or more if that does not contain all points.
MatchFile ReadMatchFile(const std::string& path, const GivenCameras& given = std::nullopt);
// The same from standard input; the path of the result is "standard input".
MatchFile ReadMatchesFromInput(const GivenCameras& given = std::nullopt);

// Undistorts the matches of a file that are as its images have them, with sigma_px and scores. Those without
// rays are left out; `place` names a row for the doubts of the file.
void UndistortMatches(const Lens& lens1, const Lens& lens2, const std::function<std::string(size_t)>& place,
                      MatchFile* file);

// Returns the problem for estimators: the matches and cameras of a file, the noise level assumed for the
// images as they were taken (`sigma_px`, or else that of the file, or else kUsualSigmaPx), each match's
// sigma_px relative to the median (noise_scale), and its score, negated if lower is better (match_quality).
MotionProblem MakeMotionProblem(MatchFile file, std::optional<double> sigma_px);

// Writes the same format, not compressed. Throws InputError if the path cannot be written; never leaves a
// partial file.
void WriteMatchFile(const MatchFile& file, const std::string& path);

// Formats a prior as header lines. A covariance is written as the standard deviations on its diagonal; the
// two standard deviations of gravity are written as their root mean square.
std::string FormatPrior(const MotionPrior& prior);

}  // namespace rcme
