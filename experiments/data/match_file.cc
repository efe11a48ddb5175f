#include "experiments/data/match_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include "estimator/motion_prior.h"
#include "estimator/noise_scale.h"
#include "estimator/undistortion.h"
#include "experiments/core/files/file_output.h"
#include "experiments/data/camera_plausibility.h"
#include "experiments/data/colmap_camera.h"
#include "experiments/data/match_header.h"
#include "experiments/data/match_rows.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"
#include "stats/constants.h"

namespace rcme {
namespace {

std::array<int, 2> ReadSize(const MatchHeader& header, const std::string& key) {
  const std::vector<double> size = header.Numbers(key, 2);
  for (const double length : size) {
    if (length >= 1.0 && length <= kMaxImageLength && length == std::floor(length)) continue;
    header.Fail(key, "width and height must be whole numbers in [1, 1e6] px");
  }
  return {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

// Throws InputError if an option gives the intrinsics that the header has under this key.
void RefuseGiven(const MatchHeader& header, const std::string& key, const GivenCameras& given) {
  if (given && header.Has(key))
    header.Fail(key, "the file has its own intrinsics; leave out " + given->option);
}

// Reads the key `camera1` or `camera2`, which excludes the other keys of that camera.
Lens ReadNamedLens(const MatchHeader& header, const std::string& camera_key, const std::string& size_key,
                   const std::string& k_key) {
  for (const std::string& key : {size_key, k_key}) {
    if (header.Has(key)) header.Fail(key, fmt::format("{} says it already; leave one out", camera_key));
  }
  return LensFromWords(SplitAtBlanks(header.Text(camera_key)), header.Place(camera_key));
}

// Reads camera 1 or 2 (`number`). If none is given, the header must have all of the camera.
Lens ReadLens(const MatchHeader& header, int number, const GivenCameras& given,
              const std::vector<Correspondence>& matches) {
  const std::string size_key = fmt::format("size{}", number), k_key = fmt::format("K{}_fx_fy_cx_cy", number),
                    camera_key = fmt::format("camera{}", number);
  RefuseGiven(header, camera_key, given);
  if (header.Has(camera_key)) return ReadNamedLens(header, camera_key, size_key, k_key);
  RefuseGiven(header, k_key, given);
  Lens lens;
  Camera& camera = lens.camera;
  if (given) lens = number == 1 ? given->lenses.front() : given->lenses.back();
  const auto x_px = number == 1 ? &Correspondence::x1_px : &Correspondence::x2_px;
  const std::array<int, 2> size =
      given && !header.Has(size_key) ? LikelySize(camera, matches, x_px) : ReadSize(header, size_key);
  if (!given) {
    const std::vector<double> k = header.Numbers(k_key, 4);
    camera = {k[0], k[1], k[2], k[3]};
  }
  camera.width = size[0];
  camera.height = size[1];
  if (!given && !camera.IsValid()) header.Fail(k_key, "K is singular or mirrored; fx and fy must be > 0");
  return lens;
}

// Returns doubts about the cameras of a file.
std::vector<InputDoubt> FindHeaderDoubts(const MatchHeader& header, const MatchFile& file,
                                         const std::array<LensModel, 2>& models, const GivenCameras& given) {
  const auto has_own = [&](const std::string& number) { return header.Has("camera" + number); };
  const auto place = [&](const std::string& number) {
    if (has_own(number)) return header.Place("camera" + number);
    return given ? fmt::format("{}: {}", file.path, given->option)
                 : header.Place("K" + number + "_fx_fy_cx_cy");
  };
  return FindPairDoubts(file.camera1, file.camera2, file.matches, {place("1"), place("2")},
                        {header.Has("size1") || has_own("1"), header.Has("size2") || has_own("2")}, models);
}

double ReadPriorSd(const MatchHeader& header, const std::string& key, double sd_deg) {
  constexpr double kLeastDeg = 1e-4, kGreatestDeg = 180.0;
  if (!(sd_deg >= kLeastDeg && sd_deg <= kGreatestDeg))
    header.Fail(key, fmt::format("{} is not in [{:g}, {:g}] deg", sd_deg, kLeastDeg, kGreatestDeg));
  return kRadPerDeg * sd_deg;
}

RotationPrior ReadRotationPrior(const MatchHeader& header) {
  const std::string key = "prior_rotation_sd_deg";
  RotationPrior prior;
  prior.R = header.Rotation("prior_rotation_rowmajor");
  const size_t count = header.Has(key) ? SplitAtBlanks(header.Text(key)).size() : 3;
  if (count != 1 && count != 3) header.Fail(key, fmt::format("has {} numbers; give one or three", count));
  const bool is_one = count == 1;
  const std::vector<double> sd_deg = header.Numbers(key, count);
  for (int axis = 0; axis < 3; ++axis) {
    const double sd = ReadPriorSd(header, key, sd_deg[is_one ? 0 : static_cast<size_t>(axis)]);
    prior.cov(axis, axis) = sd * sd;
  }
  return prior;
}

// Reads the priors of the motion, which are measurements of sensors (estimator/motion_prior.h). Each
// measurement needs all of its keys or none.
std::optional<MotionPrior> ReadPrior(const MatchHeader& header) {
  const auto has_any = [&](std::initializer_list<const char*> keys) {
    return std::ranges::any_of(keys, [&](const char* key) { return header.Has(key); });
  };
  MotionPrior prior;
  if (has_any({"prior_rotation_rowmajor", "prior_rotation_sd_deg"}))
    prior.rotation = ReadRotationPrior(header);
  if (has_any({"gravity1", "gravity2", "gravity_sd_deg"})) {
    const double sd = ReadPriorSd(header, "gravity_sd_deg", header.Numbers("gravity_sd_deg", 1).front());
    prior.gravity = {header.Direction("gravity1"), header.Direction("gravity2"), sd, sd};
  }
  if (has_any({"prior_direction", "prior_direction_sd_deg"})) {
    const double sd =
        ReadPriorSd(header, "prior_direction_sd_deg", header.Numbers("prior_direction_sd_deg", 1).front());
    prior.direction = {header.Direction("prior_direction"), sd};
  }
  if (CountPriorFreedom(prior) == 0) return std::nullopt;
  return prior;
}

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kZipArchive = "PK\x03\x04";
constexpr size_t kMaxSceneBytes = 200;

std::optional<RelativePose> ReadTruePose(const MatchHeader& header) {
  if (!header.Has("R_rowmajor") && !header.Has("t_unit")) return std::nullopt;
  RelativePose pose;
  pose.R = header.Rotation("R_rowmajor");
  const std::vector<double> t = header.Numbers("t_unit", 3);
  pose.t << t[0], t[1], t[2];
  if (!(std::abs(pose.t.norm() - 1.0) < 1e-4)) header.Fail("t_unit", "is not of unit length");
  pose.t.normalize();
  return pose;
}

std::optional<TruthSd> ReadTruthSd(const MatchHeader& header) {
  if (!header.Has("truth_sd")) return std::nullopt;
  const std::vector<double> sd = header.Numbers("truth_sd", 6);
  if (!header.Has("R_rowmajor"))
    header.Fail("truth_sd", "needs a true motion, but R_rowmajor and t_unit are missing");
  if (std::ranges::any_of(sd, [](double x) { return x < 0.0; }))
    header.Fail("truth_sd", "standard deviations must be >= 0");
  return TruthSd{kRadPerDeg * Eigen::Vector3d(sd[0], sd[1], sd[2]), {sd[3], sd[4], sd[5]}};
}

// The first word; the unit of the data set may follow, in any words.
double ReadBaseline(const MatchHeader& header) {
  const std::string key = "baseline";
  double baseline = 0.0;
  if (!header.Has(key)) return MatchFile().baseline;
  const std::vector<std::string> words = SplitAtBlanks(header.Text(key));
  if (words.empty() || !ParseReal(words.front(), &baseline) || baseline <= 0.0)
    header.Fail(
        key, fmt::format("{} is not allowed; give a length > 0, such as 0.83 m", Quoted(header.Text(key))));
  return baseline;
}

double ReadNoiseLevel(const MatchHeader& header) {
  if (!header.Has("noise_level")) return 1.0;
  const double level = header.Numbers("noise_level", 1).front();
  if (!(level > 0.0)) header.Fail("noise_level", "must be > 0");
  return level;
}

std::optional<double> ReadAssumedSigma(const MatchHeader& header) {
  const std::string key = "sigma_px";
  if (!header.Has(key)) return std::nullopt;
  double sigma_px = 0.0;
  if (!ParseReal(header.Text(key), &sigma_px) || sigma_px < 1e-9 || sigma_px > 1000.0)
    header.Fail(
        key, fmt::format("{} is not allowed; give a number in [1e-09, 1000], px", Quoted(header.Text(key))));
  return sigma_px;
}

double ReadSecondsBetween(const MatchHeader& header) {
  if (!header.Has("seconds_between")) return MatchFile().seconds_between;
  const double seconds = header.Numbers("seconds_between", 1).front();
  if (!(seconds > 0.0)) header.Fail("seconds_between", "must be > 0");
  return seconds;
}

// A name shown in tables, pages and JSON.
std::string ReadScene(const MatchHeader& header) {
  if (!header.Has("scene")) return MatchFile().scene;
  const std::string scene = header.Text("scene");
  if (FindNotInLine(scene) != std::string::npos)
    header.Fail("scene",
                fmt::format("{} is not allowed; give UTF-8 without control characters", Quoted(scene)));
  if (scene.size() > kMaxSceneBytes)
    header.Fail("scene", fmt::format("the name is too long; at most {} bytes are allowed", kMaxSceneBytes));
  return scene;
}

void ReadScores(const MatchHeader& header, const MatchRows& rows, MatchFile* file) {
  const std::string key = "better_score";
  if (!header.Has(key)) return;
  const std::string word = header.Text(key);
  if (word != "lower" && word != "higher")
    header.Fail(key, fmt::format("{} is not allowed; lower or higher is", Quoted(word)));
  std::optional<std::vector<double>> scores = rows.Scores();
  if (!scores) header.Fail(key, fmt::format("needs one column named {}", kScoreColumn));
  file->better_score = word == "lower" ? BetterScore::kLower : BetterScore::kHigher;
  file->scores = std::move(*scores);
}

double FindNoiseGrowth(const MatchFile& file) {
  return file.undistortion ? file.undistortion->noise_growth : 1.0;
}

// Twice the matches that are allowed: a small packed file may hold millions of empty lines.
constexpr int kMaxLines = 2 * static_cast<int>(kMaxMatchesPerFile);

MatchFile ReadMatches(const std::string& path, GzipLines lines, const GivenCameras& given) {
  MatchFile file;
  file.path = path;
  MatchHeader header(path);
  MatchRows rows(&file);
  bool is_empty = true;
  for (std::string_view line; lines.Next(&line); is_empty = false) {
    if (lines.line_number() == 1 && line.starts_with(kByteOrderMark))
      line.remove_prefix(kByteOrderMark.size());
    if (lines.line_number() == 1 && line.starts_with(kZipArchive))
      throw InputError(
          fmt::format("{}: is a zip or npz archive; a match file is text, and `rcme pairs "
                      "--layout npz` makes such files of archives",
                      path));
    if (lines.line_number() > kMaxLines)
      lines.Fail(fmt::format("too many lines; at most {} are allowed", kMaxLines));
    line = Trim(line);
    if (line.empty()) continue;
    if (line.front() == '#') {
      header.AddLine(line, lines);
    } else {
      rows.Add(line, lines);
    }
  }
  if (is_empty)
    throw InputError(fmt::format("{}: is empty; a match file has a row x1,y1,x2,y2 for each match", path));
  const Lens lens1 = ReadLens(header, 1, given, file.matches),
             lens2 = ReadLens(header, 2, given, file.matches);
  file.camera1 = lens1.camera;
  file.camera2 = lens2.camera;
  file.doubts = FindHeaderDoubts(header, file, {lens1.model, lens2.model}, given);
  std::ranges::move(rows.ListDoubts(), std::back_inserter(file.doubts));
  std::ranges::copy(header.doubts(), std::back_inserter(file.doubts));
  ReadScores(header, rows, &file);
  UndistortMatches(
      lens1, lens2, [&](size_t i) { return rows.Place(i); }, &file);
  file.cam2_from_cam1_true = ReadTruePose(header);
  file.truth_sd = ReadTruthSd(header);
  file.baseline = ReadBaseline(header);
  file.noise_level = ReadNoiseLevel(header);
  file.assumed_sigma_px = ReadAssumedSigma(header);
  file.seconds_between = ReadSecondsBetween(header);
  file.prior = ReadPrior(header);
  file.scene = ReadScene(header);
  if (header.Has("image1")) file.image1 = header.Text("image1");
  if (header.Has("image2")) file.image2 = header.Text("image2");
  return file;
}

}  // namespace

std::string FormatPrior(const MotionPrior& prior) {
  const auto numbers = [](const Eigen::MatrixXd& values) {
    return fmt::format("{}", fmt::join(values.data(), values.data() + values.size(), " "));
  };
  std::string text;
  if (const std::optional<RotationPrior>& rotation = prior.rotation) {
    text += fmt::format("# prior_rotation_rowmajor: {}\n", numbers(rotation->R.transpose()));
    text += fmt::format("# prior_rotation_sd_deg: {}\n",
                        numbers(kDegPerRad * rotation->cov.diagonal().cwiseSqrt()));
  }
  if (const std::optional<GravityPrior>& gravity = prior.gravity) {
    text += fmt::format("# gravity1: {}\n# gravity2: {}\n# gravity_sd_deg: {}\n", numbers(gravity->in_cam1),
                        numbers(gravity->in_cam2),
                        kDegPerRad * std::hypot(gravity->sd1_rad, gravity->sd2_rad) / std::numbers::sqrt2);
  }
  if (const std::optional<DirectionPrior>& direction = prior.direction) {
    text += fmt::format("# prior_direction: {}\n# prior_direction_sd_deg: {}\n", numbers(direction->t),
                        kDegPerRad * direction->sd_rad);
  }
  return text;
}

MatchFile ReadMatchFile(const std::string& path, const GivenCameras& given) {
  return ReadMatches(path, GzipLines(path, {"match file", "a match file"}), given);
}

MatchFile ReadMatchesFromInput(const GivenCameras& given) {
  return ReadMatches("standard input", GzipLines::OfStandardInput(), given);
}

void UndistortMatches(const Lens& lens1, const Lens& lens2, const std::function<std::string(size_t)>& place,
                      MatchFile* file) {
  if (lens1.model == LensModel::kPinhole && lens2.model == LensModel::kPinhole) return;
  file->num_rows = file->matches.size();
  MotionProblem distorted{
      std::move(file->matches), {}, {}, 1.0, ComputeNoiseScale(std::move(file->sigma_px))};
  distorted.match_quality = std::move(file->scores);
  UndistortedProblem undistorted = UndistortProblem(lens1, lens2, std::move(distorted));
  file->rows = std::move(undistorted.kept);
  file->matches = std::move(undistorted.problem.matches);
  file->sigma_px = std::move(undistorted.problem.noise_scale);
  file->scores = std::move(undistorted.problem.match_quality);
  file->undistortion = undistorted.problem.undistortion;
  const size_t num_lost = file->num_rows - file->rows.size();
  if (num_lost == 0) return;
  size_t first = 0;
  while (first < file->rows.size() && file->rows[first] == first) ++first;
  const std::string others = num_lost > 1 ? fmt::format(" and {} more rows", num_lost - 1) : "";
  file->doubts.push_back({place(first) + others,
                          "a match is left out if its lens has no ray for one of its points; rays are taken "
                          "up to 84.3 deg from the axis"});
}

MotionProblem MakeMotionProblem(MatchFile file, std::optional<double> sigma_px) {
  if (file.better_score == BetterScore::kLower)
    for (double& score : file.scores) score = -score;
  return {std::move(file.matches),
          file.camera1,
          file.camera2,
          sigma_px.value_or(file.assumed_sigma_px.value_or(kUsualSigmaPx)) * FindNoiseGrowth(file),
          ComputeNoiseScale(std::move(file.sigma_px)),
          file.prior,
          std::move(file.scores),
          file.undistortion};
}

void WriteMatchFile(const MatchFile& file, const std::string& path) {
  std::string text = fmt::format("# scene: {}\n", file.scene);
  if (!file.image1.empty()) text += fmt::format("# image1: {}\n", file.image1);
  if (!file.image2.empty()) text += fmt::format("# image2: {}\n", file.image2);
  int index = 1;
  for (const Camera& camera : {file.camera1, file.camera2}) {
    text += fmt::format("# size{}: {} {}\n", index, camera.width, camera.height);
    text +=
        fmt::format("# K{}_fx_fy_cx_cy: {} {} {} {}\n", index++, camera.fx, camera.fy, camera.cx, camera.cy);
  }
  if (const std::optional<RelativePose>& pose = file.cam2_from_cam1_true) {
    const Eigen::Matrix3d R_rows = pose->R.transpose();
    text += fmt::format("# R_rowmajor: {}\n", fmt::join(R_rows.data(), R_rows.data() + 9, " "));
    text += fmt::format("# t_unit: {}\n", fmt::join(pose->t.data(), pose->t.data() + 3, " "));
  }
  if (const std::optional<TruthSd>& sd = file.truth_sd) {
    const Eigen::Vector3d rotation_deg = sd->rotation_rad / kRadPerDeg;
    text += fmt::format("# truth_sd: {} {} {} {} {} {}\n", rotation_deg.x(), rotation_deg.y(),
                        rotation_deg.z(), sd->translation.x(), sd->translation.y(), sd->translation.z());
  }
  if (file.baseline > 0.0) text += fmt::format("# baseline: {}\n", file.baseline);
  if (file.assumed_sigma_px)
    text += fmt::format("# sigma_px: {}\n", *file.assumed_sigma_px * FindNoiseGrowth(file));
  if (file.noise_level != 1.0) text += fmt::format("# noise_level: {}\n", file.noise_level);
  if (file.seconds_between > 0.0) text += fmt::format("# seconds_between: {}\n", file.seconds_between);
  if (file.prior) text += FormatPrior(*file.prior);
  if (file.better_score)
    text +=
        fmt::format("# better_score: {}\n", *file.better_score == BetterScore::kLower ? "lower" : "higher");
  const bool has_sigma = !file.sigma_px.empty(), has_scores = file.better_score.has_value();
  text += fmt::format("{}{}{}", fmt::join(kCoordinateColumns, ","), has_sigma ? "," : "",
                      has_sigma ? kSigmaColumn : "");
  text += has_scores ? fmt::format(",{}\n", kScoreColumn) : "\n";
  for (size_t i = 0; i < file.matches.size(); ++i) {
    const Correspondence& m = file.matches[i];
    text += fmt::format("{},{},{},{}", m.x1_px.x(), m.x1_px.y(), m.x2_px.x(), m.x2_px.y());
    if (has_sigma) text += fmt::format(",{}", file.sigma_px.at(i));
    if (has_scores) text += fmt::format(",{}", file.scores.at(i));
    text += '\n';
  }
  WriteFileWhole(path, text);
}

}  // namespace rcme