#include "experiments/data/match_file.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>
#include <string_view>

#include "estimator/noise_scale.h"
#include "estimator/problem_check.h"
#include "estimator/undistortion.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/files/gzip_lines.h"
#include "experiments/data/colmap_camera.h"
#include "experiments/data/likely_size.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"
#include "stats/constants.h"

namespace rcme {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::array<std::string_view, 4> kColumns = {"x1", "y1", "x2", "y2"};
constexpr std::string_view kSigmaColumn = "sigma_px", kScoreColumn = "score";
constexpr size_t kMaxColumns = 1000;
constexpr size_t kMaxSceneBytes = 200;
constexpr std::array<std::string_view, 23> kHeaderKeys = {"camera1",
                                                          "camera2",
                                                          "size1",
                                                          "size2",
                                                          "K1_fx_fy_cx_cy",
                                                          "K2_fx_fy_cx_cy",
                                                          "R_rowmajor",
                                                          "t_unit",
                                                          "truth_sd",
                                                          "baseline",
                                                          "noise_level",
                                                          "image1",
                                                          "image2",
                                                          "scene",
                                                          "seconds_between",
                                                          "prior_rotation_rowmajor",
                                                          "prior_rotation_sd_deg",
                                                          "gravity1",
                                                          "gravity2",
                                                          "gravity_sd_deg",
                                                          "prior_direction",
                                                          "prior_direction_sd_deg",
                                                          "better_score"};

std::string_view Trim(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> SplitAtCommas(std::string_view text) {
  std::vector<std::string> parts;
  while (true) {
    const size_t end = text.find(',');
    parts.emplace_back(Trim(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::vector<std::string> SplitAtBlanks(std::string_view text) {
  std::vector<std::string> parts;
  for (text = Trim(text); !text.empty(); text = Trim(text)) {
    const size_t end = std::min(text.find_first_of(" \t"), text.size());
    parts.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return parts;
}

// The values of the known header keys with the lines they stand on.
class Header {
 public:
  explicit Header(std::string path) : path_(std::move(path)) {}

  void AddLine(std::string_view line, const GzipLines& lines) {
    const size_t colon = line.find(':');
    if (colon == std::string_view::npos) return;  // a comment
    const std::string key(Trim(line.substr(1, colon - 1)));
    if (std::ranges::find(kHeaderKeys, key) == kHeaderKeys.end()) return;
    const Entry entry{std::string(Trim(line.substr(colon + 1))), lines.line_number()};
    if (!entries_.emplace(key, entry).second) lines.Fail(fmt::format("key '{}' stands twice", key));
  }

  // "file:12: key".
  std::string Place(const std::string& key) const {
    return fmt::format("{}:{}: {}", path_, entries_.at(key).line_number, key);
  }
  bool Has(const std::string& key) const { return entries_.count(key) > 0; }
  std::string Text(const std::string& key) const { return entries_.at(key).text; }

  // The `count` numbers of a key that must be there.
  std::vector<double> Numbers(const std::string& key, size_t count) const {
    if (!Has(key)) {
      throw InputError(
          fmt::format("{}: header key '# {}: ...' is missing (without a header, give the intrinsics by `rcme "
                      "estimate --K`)",
                      path_, key));
    }
    std::vector<double> numbers;
    for (const std::string& word : SplitAtBlanks(entries_.at(key).text)) {
      double number = 0.0;
      if (!ParseReal(word, &number)) Fail(key, fmt::format("{} is not a finite number", Quoted(word)));
      numbers.push_back(number);
    }
    if (numbers.size() != count)
      Fail(key, fmt::format("has {} numbers; {} are needed", numbers.size(), count));
    return numbers;
  }

  [[noreturn]] void Fail(const std::string& key, const std::string& what) const {
    throw InputError(fmt::format("{}: {}", Place(key), what));
  }

 private:
  struct Entry {
    std::string text;
    int line_number = 0;
  };
  std::string path_;
  std::map<std::string, Entry> entries_;
};

std::array<int, 2> SizeFrom(const Header& header, const std::string& key) {
  const std::vector<double> size = header.Numbers(key, 2);
  for (const double length : size) {
    if (length >= 1.0 && length <= kMaxImageLength && length == std::floor(length)) continue;
    header.Fail(key, "width and height must be whole numbers in [1, 1e6] px");
  }
  return {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

// Of the key `camera1` or `camera2`, beside which the others have nothing to say.
Lens NamedLensFrom(const Header& header, const std::string& camera_key, const std::string& size_key,
                   const std::string& k_key, const Lens* given) {
  if (given) header.Fail(camera_key, "the file has its own intrinsics; leave out --K and --camera");
  for (const std::string& key : {size_key, k_key}) {
    if (header.Has(key)) header.Fail(key, fmt::format("{} says it already; leave one out", camera_key));
  }
  return LensFromWords(SplitAtBlanks(header.Text(camera_key)), header.Place(camera_key));
}

// Camera 1 or 2. Nothing given: the file has to say it all.
Lens CameraFrom(const Header& header, const std::string& number, const Lens* given,
                const std::vector<Correspondence>& matches, Eigen::Vector2d Correspondence::*x_px) {
  const std::string size_key = "size" + number, k_key = "K" + number + "_fx_fy_cx_cy",
                    camera_key = "camera" + number;
  if (header.Has(camera_key)) return NamedLensFrom(header, camera_key, size_key, k_key, given);
  Lens lens;
  Camera& camera = lens.camera;
  if (given) {
    if (header.Has(k_key)) header.Fail(k_key, "the file has its own intrinsics; leave out --K");
    lens = *given;
  }
  const std::array<int, 2> size =
      given && !header.Has(size_key) ? LikelySize(camera, matches, x_px) : SizeFrom(header, size_key);
  if (!given) {
    const std::vector<double> k = header.Numbers(k_key, 4);
    camera = {k[0], k[1], k[2], k[3]};
  }
  camera.width = size[0];
  camera.height = size[1];
  if (!given && !camera.IsValid()) header.Fail(k_key, "K is singular or mirrored; fx and fy must be > 0");
  return lens;
}

// What is suspicious about the cameras of a file whose K may be given.
std::vector<CameraDoubt> FindDoubts(const Header& header, const MatchFile& file, bool is_given) {
  const auto has_own = [&](const std::string& number) { return header.Has("camera" + number); };
  const auto place = [&](const std::string& number) {
    if (has_own(number)) return header.Place("camera" + number);
    return is_given ? fmt::format("{}: --K", file.path) : header.Place("K" + number + "_fx_fy_cx_cy");
  };
  return FindPairDoubts(file.camera1, file.camera2, file.matches, {place("1"), place("2")},
                        {header.Has("size1") || has_own("1"), header.Has("size2") || has_own("2")});
}

Eigen::Matrix3d RotationFrom(const Header& header, const std::string& key) {
  const std::vector<double> r = header.Numbers(key, 9);
  Eigen::Matrix3d R;
  R << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
  const double misfit = (R * R.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(misfit < 1e-4) || R.determinant() < 0.0) header.Fail(key, "is not a rotation matrix");
  return R;
}

std::optional<RelativePose> TruePoseFrom(const Header& header) {
  if (!header.Has("R_rowmajor") && !header.Has("t_unit")) return std::nullopt;
  RelativePose pose;
  pose.R = RotationFrom(header, "R_rowmajor");
  const std::vector<double> t = header.Numbers("t_unit", 3);
  pose.t << t[0], t[1], t[2];
  if (!(std::abs(pose.t.norm() - 1.0) < 1e-4)) header.Fail("t_unit", "is not of unit length");
  pose.t.normalize();
  return pose;
}

std::optional<TruthSd> TruthSdFrom(const Header& header) {
  if (!header.Has("truth_sd")) return std::nullopt;
  const std::vector<double> sd = header.Numbers("truth_sd", 6);
  if (!header.Has("R_rowmajor"))
    header.Fail("truth_sd", "needs a true motion, but R_rowmajor and t_unit are missing");
  if (std::ranges::any_of(sd, [](double x) { return x < 0.0; }))
    header.Fail("truth_sd", "standard deviations must be >= 0");
  return TruthSd{kRadPerDeg * Eigen::Vector3d(sd[0], sd[1], sd[2]), {sd[3], sd[4], sd[5]}};
}

// A direction, of any length.
Eigen::Vector3d DirectionFrom(const Header& header, const std::string& key) {
  const std::vector<double> v = header.Numbers(key, 3);
  const Eigen::Vector3d direction(v[0], v[1], v[2]);
  const double length = direction.stableNorm();
  if (!(length > 1e-9) || !(length < 1e9)) header.Fail(key, "must have a length in (1e-9, 1e9)");
  return direction.normalized();
}

double PriorSdFrom(const Header& header, const std::string& key, double sd_deg) {
  constexpr double kLeastDeg = 1e-4, kGreatestDeg = 180.0;
  if (!(sd_deg >= kLeastDeg && sd_deg <= kGreatestDeg))
    header.Fail(key, fmt::format("{} is not in [{:g}, {:g}] deg", sd_deg, kLeastDeg, kGreatestDeg));
  return kRadPerDeg * sd_deg;
}

RotationPrior RotationPriorFrom(const Header& header) {
  const std::string key = "prior_rotation_sd_deg";
  RotationPrior prior;
  prior.R = RotationFrom(header, "prior_rotation_rowmajor");
  const bool is_one = header.Has(key) && SplitAtBlanks(header.Text(key)).size() == 1;
  const std::vector<double> sd_deg = header.Numbers(key, is_one ? 1 : 3);
  for (int axis = 0; axis < 3; ++axis) {
    const double sd = PriorSdFrom(header, key, sd_deg[is_one ? 0 : static_cast<size_t>(axis)]);
    prior.cov(axis, axis) = sd * sd;
  }
  return prior;
}

// What sensors say; of each measurement every key must be there, or none.
std::optional<MotionPrior> PriorFrom(const Header& header) {
  const auto has_any = [&](std::initializer_list<const char*> keys) {
    return std::ranges::any_of(keys, [&](const char* key) { return header.Has(key); });
  };
  MotionPrior prior;
  if (has_any({"prior_rotation_rowmajor", "prior_rotation_sd_deg"}))
    prior.rotation = RotationPriorFrom(header);
  if (has_any({"gravity1", "gravity2", "gravity_sd_deg"})) {
    const double sd = PriorSdFrom(header, "gravity_sd_deg", header.Numbers("gravity_sd_deg", 1).front());
    prior.gravity = {DirectionFrom(header, "gravity1"), DirectionFrom(header, "gravity2"), sd, sd};
  }
  if (has_any({"prior_direction", "prior_direction_sd_deg"})) {
    const double sd =
        PriorSdFrom(header, "prior_direction_sd_deg", header.Numbers("prior_direction_sd_deg", 1).front());
    prior.direction = {DirectionFrom(header, "prior_direction"), sd};
  }
  if (CountPriorFreedom(prior) == 0) return std::nullopt;
  return prior;
}

// The number that stands first; NaN without one that is positive.
double BaselineFrom(const Header& header) {
  double baseline = 0.0;
  if (!header.Has("baseline")) return MatchFile().baseline;
  const std::vector<std::string> words = SplitAtBlanks(header.Text("baseline"));
  if (words.empty() || !ParseReal(words.front(), &baseline) || baseline <= 0.0) return MatchFile().baseline;
  return baseline;
}

double NoiseLevelFrom(const Header& header) {
  if (!header.Has("noise_level")) return 1.0;
  const double level = header.Numbers("noise_level", 1).front();
  if (!(level > 0.0)) header.Fail("noise_level", "must be > 0");
  return level;
}

double SecondsBetweenFrom(const Header& header) {
  if (!header.Has("seconds_between")) return MatchFile().seconds_between;
  const double seconds = header.Numbers("seconds_between", 1).front();
  if (!(seconds > 0.0)) header.Fail("seconds_between", "must be > 0");
  return seconds;
}

bool AreColumnNames(const std::vector<std::string>& fields) {
  return std::ranges::find_first_of(fields, kColumns) != fields.end();
}

bool HasColumnsFirst(const std::vector<std::string>& fields) {
  return fields.size() >= kColumns.size() && std::equal(kColumns.begin(), kColumns.end(), fields.begin());
}

// A name that tables, pages and JSON show.
std::string SceneFrom(const Header& header) {
  if (!header.Has("scene")) return MatchFile().scene;
  const std::string scene = header.Text("scene");
  if (FindNotInLine(scene) != std::string::npos)
    header.Fail("scene",
                fmt::format("{} is not allowed; give UTF-8 without control characters", Quoted(scene)));
  if (scene.size() > kMaxSceneBytes)
    header.Fail("scene", fmt::format("the name is too long; at most {} bytes are allowed", kMaxSceneBytes));
  return scene;
}

Correspondence MatchFrom(const std::vector<std::string>& fields, const GzipLines& lines) {
  if (fields.size() < kColumns.size())
    lines.Fail(fmt::format("{} columns; x1,y1,x2,y2 are needed", fields.size()));
  std::array<double, 4> x{};
  for (size_t i = 0; i < x.size(); ++i) {
    if (ParseReal(fields[i], &x[i]) && std::abs(x[i]) <= kMaxCoordinatePx) continue;
    lines.Fail(fmt::format("{}: {} is not a finite number in [{}, {}] px", kColumns[i], Quoted(fields[i]),
                           -kMaxCoordinatePx, kMaxCoordinatePx));
  }
  return {{x[0], x[1]}, {x[2], x[3]}};
}

// The rows of a file: the names of the columns, which stand before the first match, and the matches.
class Rows {
 public:
  explicit Rows(MatchFile* file) : file_(file) {}

  // "file:12" of a match.
  std::string Place(size_t match) const { return fmt::format("{}:{}", file_->path, line_numbers_.at(match)); }

  // Of a file whose header says which scores are better; nothing without one such column.
  std::optional<std::vector<double>> Scores() const {
    if (num_score_columns_ != 1) return std::nullopt;
    std::vector<double> scores(scores_.size());
    for (size_t i = 0; i < scores.size(); ++i) {
      if (!ParseReal(scores_[i], &scores[i])) {
        throw InputError(
            fmt::format("{}: {}: {} is not a finite number", Place(i), kScoreColumn, Quoted(scores_[i])));
      }
    }
    return scores;
  }

  void Add(std::string_view line, const GzipLines& lines) {
    const std::vector<std::string> fields =
        line.find(',') == std::string_view::npos ? SplitAtBlanks(line) : SplitAtCommas(line);
    if (fields.size() > kMaxColumns)
      lines.Fail(fmt::format("too many columns; at most {} are allowed", kMaxColumns));
    if (AreColumnNames(fields)) {
      SetNames(fields, line, lines);
    } else if (file_->matches.size() == kMaxMatchesPerFile) {
      lines.Fail(fmt::format("too many matches; at most {} are allowed", kMaxMatchesPerFile));
    } else {
      file_->matches.push_back(MatchFrom(fields, lines));
      line_numbers_.push_back(lines.line_number());
      if (sigma_column_ > 0) file_->sigma_px.push_back(SigmaFrom(fields, lines));
      if (score_column_ > 0) scores_.push_back(score_column_ < fields.size() ? fields[score_column_] : "");
    }
  }

 private:
  void SetNames(const std::vector<std::string>& fields, std::string_view line, const GzipLines& lines) {
    if (!file_->matches.empty() || !HasColumnsFirst(fields)) {
      lines.Fail(
          fmt::format("column names {} are not allowed; give {}[,...], before the first match, or none",
                      Quoted(line), fmt::join(kColumns, ",")));
    }
    if (std::ranges::count(fields, kSigmaColumn) > 1)
      lines.Fail(fmt::format("column {} stands twice", kSigmaColumn));
    sigma_column_ = FindColumn(fields, kSigmaColumn);
    score_column_ = FindColumn(fields, kScoreColumn);
    num_score_columns_ = std::ranges::count(fields, kScoreColumn);
  }

  // 0, where x1 is: there is none.
  static size_t FindColumn(const std::vector<std::string>& fields, std::string_view name) {
    const auto found = std::ranges::find(fields, name);
    return found == fields.end() ? 0 : static_cast<size_t>(found - fields.begin());
  }

  double SigmaFrom(const std::vector<std::string>& fields, const GzipLines& lines) const {
    double sigma_px = 0.0;
    const std::string text = sigma_column_ < fields.size() ? fields[sigma_column_] : "";
    if (!ParseReal(text, &sigma_px) || sigma_px <= 0.0 || sigma_px > kMaxCoordinatePx) {
      lines.Fail(fmt::format("{}: {} is not a finite number in (0, {}] px", kSigmaColumn, Quoted(text),
                             kMaxCoordinatePx));
    }
    return sigma_px;
  }

  MatchFile* file_;
  std::vector<int> line_numbers_;    // of the matches
  std::vector<std::string> scores_;  // of the matches, as text: a number where the header names it a score
  size_t sigma_column_ = 0, score_column_ = 0;  // 0, where x1 is: none
  std::ptrdiff_t num_score_columns_ = 0;
};

void ReadScores(const Header& header, const Rows& rows, MatchFile* file) {
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

// Throws InputError that names the row of a match that has no rays.
void UndistortMatches(const Lens& lens1, const Lens& lens2, const Rows& rows, MatchFile* file) {
  if (lens1.model == LensModel::kPinhole && lens2.model == LensModel::kPinhole) return;
  file->had_lens = true;
  const size_t n = file->matches.size();
  UndistortedProblem undistorted = UndistortProblem(
      lens1, lens2, {file->matches, {}, {}, 1.0, ComputeNoiseScale(std::move(file->sigma_px))});
  for (size_t i = 0; i < n && undistorted.kept.size() < n; ++i) {
    if (i < undistorted.kept.size() && undistorted.kept[i] == i) continue;
    const bool is_first = !Undistort(lens1, file->matches[i].x1_px);
    const Eigen::Vector2d& x_px = is_first ? file->matches[i].x1_px : file->matches[i].x2_px;
    throw InputError(fmt::format(
        "{}: no ray of camera {} reaches ({}, {}) px, by the lens that is stated; leave the match out",
        rows.Place(i), is_first ? 1 : 2, x_px.x(), x_px.y()));
  }
  file->matches = std::move(undistorted.problem.matches);
  file->sigma_px = std::move(undistorted.problem.noise_scale);
  file->noise_growth = undistorted.problem.sigma_px;
}

MatchFile ReadMatches(const std::string& path, GzipLines lines, const GivenCameras& given) {
  MatchFile file;
  file.path = path;
  Header header(path);
  Rows rows(&file);
  for (std::string_view line; lines.Next(&line);) {
    if (lines.line_number() == 1 && line.starts_with(kByteOrderMark))
      line.remove_prefix(kByteOrderMark.size());
    line = Trim(line);
    if (line.empty()) continue;
    if (line.front() == '#') {
      header.AddLine(line, lines);
    } else {
      rows.Add(line, lines);
    }
  }
  const Lens lens1 = CameraFrom(header, "1", given ? &given->front() : nullptr, file.matches,
                                &Correspondence::x1_px),
             lens2 = CameraFrom(header, "2", given ? &given->back() : nullptr, file.matches,
                                &Correspondence::x2_px);
  file.camera1 = lens1.camera;
  file.camera2 = lens2.camera;
  file.doubts = FindDoubts(header, file, given.has_value());
  UndistortMatches(lens1, lens2, rows, &file);
  file.cam2_from_cam1_true = TruePoseFrom(header);
  file.truth_sd = TruthSdFrom(header);
  file.baseline = BaselineFrom(header);
  file.noise_level = NoiseLevelFrom(header);
  file.seconds_between = SecondsBetweenFrom(header);
  file.prior = PriorFrom(header);
  ReadScores(header, rows, &file);
  file.scene = SceneFrom(header);
  if (header.Has("image1")) file.image1 = header.Text("image1");
  if (header.Has("image2")) file.image2 = header.Text("image2");
  return file;
}

}  // namespace

MatchFile ReadMatchFile(const std::string& path, const GivenCameras& given) {
  return ReadMatches(path, GzipLines(path, {"match file", "a match file"}), given);
}

MatchFile ReadMatchesFromInput(const GivenCameras& given) {
  return ReadMatches("standard input", GzipLines::OfStandardInput(), given);
}

MotionProblem MakeMotionProblem(MatchFile file, double sigma_px) {
  return {std::move(file.matches),
          file.camera1,
          file.camera2,
          sigma_px * file.noise_growth,
          ComputeNoiseScale(std::move(file.sigma_px)),
          file.prior};
}

namespace {

// The header lines of a prior; a covariance by the standard deviations on its diagonal, of gravity the noise
// of both as that of each.
std::string PriorText(const MotionPrior& prior) {
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

}  // namespace

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
  if (file.noise_level != 1.0) text += fmt::format("# noise_level: {}\n", file.noise_level);
  if (file.seconds_between > 0.0) text += fmt::format("# seconds_between: {}\n", file.seconds_between);
  if (file.prior) text += PriorText(*file.prior);
  if (file.better_score)
    text +=
        fmt::format("# better_score: {}\n", *file.better_score == BetterScore::kLower ? "lower" : "higher");
  const bool has_sigma = !file.sigma_px.empty(), has_scores = file.better_score.has_value();
  text +=
      fmt::format("{}{}{}", fmt::join(kColumns, ","), has_sigma ? "," : "", has_sigma ? kSigmaColumn : "");
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
