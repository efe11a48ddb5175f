// A folder of `.npz` files, one per pair, with key points and matches as SuperGlue, LightGlue and hloc write
// them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimator/problem_check.h"
#include "experiments/data/camera_plausibility.h"
#include "experiments/real/sequences/layout_files.h"
#include "experiments/real/sequences/listed_pairs.h"
#include "experiments/real/sequences/npz_file.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr size_t kMaxNpzPairs = 100'000;

[[noreturn]] void FailShape(const NpzFile& file, const std::string& name, const NpzArray& array,
                            const std::string& allowed) {
  throw InputError(fmt::format("{}: is of shape {}{}; {}", file.Place(name), FormatShape(array.shape),
                               array.is_whole ? " of whole numbers" : "", allowed));
}

// Shape [n, 2], px; (0, 0) is the centre of the first pixel.
std::vector<Eigen::Vector2d> ReadNpzPoints(const NpzFile& file, const std::string& name) {
  const NpzArray array = file.Read(name);
  if (array.shape.size() != 2 || array.shape[1] != 2)
    FailShape(file, name, array, "[n, 2] of coordinates in px is needed");
  if (array.shape[0] > kMaxMatchesPerFile)
    FailShape(file, name, array, fmt::format("at most {} key points are allowed", kMaxMatchesPerFile));
  std::vector<Eigen::Vector2d> points;
  for (size_t i = 0; i < array.shape[0]; ++i) {
    points.emplace_back(array.values[2 * i], array.values[2 * i + 1]);
    if (!points.back().allFinite() || points.back().cwiseAbs().maxCoeff() > kMaxCoordinatePx)
      throw InputError(fmt::format("{}: key point {} is ({}, {}); finite numbers in [{}, {}] px are allowed",
                                   file.Place(name), i, points.back().x(), points.back().y(),
                                   -kMaxCoordinatePx, kMaxCoordinatePx));
  }
  return points;
}

struct NpzMatches {
  struct Match {
    size_t point1, point2;
    size_t score;  // index of its score
  };
  std::vector<Match> matches;
  size_t num_scores = 0;  // number of scores that belong to them
};

size_t CheckNpzIndex(const NpzFile& file, const std::string& name, size_t row, double index,
                     size_t num_points) {
  if (index >= 0.0 && index < static_cast<double>(num_points)) return static_cast<size_t>(index);
  throw InputError(fmt::format("{}: row {} is of key point {:g}; the image has {}{}", file.Place(name), row,
                               index, num_points, ", counted from 0; -1 for none is allowed in [n0] only"));
}

// Reads [n0], the key point of image 2 or -1 for each of image 1, or [m, 2] with a row per match.
NpzMatches ReadNpzMatches(const NpzFile& file, const std::string& name, size_t num_points1,
                          size_t num_points2) {
  const NpzArray array = file.Read(name);
  const bool is_list = array.shape.size() == 2 && array.shape[1] == 2;
  const bool is_by_point = array.shape.size() == 1 && array.shape[0] == num_points1;
  if (!array.is_whole || (!is_list && !is_by_point))
    FailShape(
        file, name, array,
        fmt::format("whole numbers (i4, i8) of shape [{}], one for each row of keypoints0, or [m, 2] are "
                    "needed",
                    num_points1));
  if (array.shape[0] > kMaxMatchesPerFile)
    FailShape(file, name, array, fmt::format("at most {} matches are allowed", kMaxMatchesPerFile));
  NpzMatches read;
  read.num_scores = array.shape[0];
  for (size_t i = 0; i < array.shape[0]; ++i) {
    if (is_list) {
      read.matches.push_back({CheckNpzIndex(file, name, i, array.values[2 * i], num_points1),
                              CheckNpzIndex(file, name, i, array.values[2 * i + 1], num_points2), i});
    } else if (array.values[i] != -1.0) {
      read.matches.push_back({i, CheckNpzIndex(file, name, i, array.values[i], num_points2), i});
    }
  }
  return read;
}

// Returns a score for each match; nothing if the file has none. With these names higher is better.
std::vector<double> ReadNpzScores(const NpzFile& file, const NpzMatches& matches,
                                  const std::vector<std::string>& names) {
  const auto name = std::ranges::find_if(names, [&](const std::string& known) { return file.Has(known); });
  if (name == names.end()) return {};
  const NpzArray array = file.Read(*name);
  if (array.shape != std::vector<size_t>{matches.num_scores})
    FailShape(file, *name, array, fmt::format("[{}] is needed, as matches has", matches.num_scores));
  std::vector<double> scores;
  for (const NpzMatches::Match& match : matches.matches) {
    scores.push_back(array.values[match.score]);
    if (!std::isfinite(scores.back()))
      throw InputError(fmt::format("{}: row {} is {}; finite numbers are allowed", file.Place(*name),
                                   match.score, scores.back()));
  }
  return scores;
}

class NpzPairs : public ListedPairs {
 public:
  explicit NpzPairs(const DatasetOptions& options) {
    const std::filesystem::path folder(options.folder);
    CheckIsThere(folder, "give a folder of .npz files");
    if (!std::filesystem::is_directory(folder))
      throw InputError(fmt::format("{}: is not a folder", folder.string()));
    if (options.K.empty())
      throw InputError(
          fmt::format("--K: fx fy cx cy of the camera is needed, because the .npz files of {} hold "
                      "only key points and matches",
                      folder.string()));
    lens_ = MakeLens({options.K[0], options.K[1], options.K[2], options.K[3], 0, 0}, options.lens,
                     options.distortion, "--K, --lens, --distortion");
    scene_ = options.name.empty() ? FolderName(folder) : options.name;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".npz") paths_.push_back(entry.path());
    }
    if (paths_.empty()) throw InputError(fmt::format("{}: holds no *.npz", folder.string()));
    if (paths_.size() > kMaxNpzPairs)
      throw InputError(
          fmt::format("{}: holds {} pairs; {} are allowed", folder.string(), paths_.size(), kMaxNpzPairs));
    std::ranges::sort(paths_);
  }

  size_t size() const override { return paths_.size(); }
  std::string PairId(size_t i) const override { return paths_.at(i).stem().string(); }
  std::filesystem::path Source(size_t i) const override { return paths_.at(i); }
  std::string Note() const override { return "no truth: .npz files of matches have none"; }
  ListedPair Read(size_t i) override {
    const NpzFile npz(paths_.at(i).string());
    ListedPair listed;
    MatchFile& file = listed.file;
    file.path = paths_.at(i).string();
    file.scene = scene_;
    FillMatches(npz, &file);
    file.camera1 = CameraOfSize(file.matches, &Correspondence::x1_px);
    file.camera2 = CameraOfSize(file.matches, &Correspondence::x2_px);
    UndistortMatches(
        lens_, lens_, [&](size_t row) { return fmt::format("{}: match {}", file.path, row); }, &file);
    return listed;
  }

 private:
  // LightGlue's raw output has both `matches` and `matches0` with the same content; hloc has only the
  // latter.
  static void FillMatches(const NpzFile& npz, MatchFile* file) {
    const std::vector<Eigen::Vector2d> points1 = ReadNpzPoints(npz, "keypoints0"),
                                       points2 = ReadNpzPoints(npz, "keypoints1");
    const bool is_hloc = !npz.Has("matches") && npz.Has("matches0");
    const NpzMatches read =
        ReadNpzMatches(npz, is_hloc ? "matches0" : "matches", points1.size(), points2.size());
    for (const NpzMatches::Match& match : read.matches)
      file->matches.push_back({points1[match.point1], points2[match.point2]});
    const std::vector<std::string> names =
        is_hloc ? std::vector<std::string>{"matching_scores0"}
                : std::vector<std::string>{"match_confidence", "scores", "matching_scores"};
    file->scores = ReadNpzScores(npz, read, names);
    if (!file->scores.empty()) file->better_score = BetterScore::kHigher;
  }

  Camera CameraOfSize(const std::vector<Correspondence>& matches,
                      Eigen::Vector2d Correspondence::*x_px) const {
    Camera camera = lens_.camera;
    const std::array<int, 2> size = LikelySize(camera, matches, x_px);
    camera.width = size[0];
    camera.height = size[1];
    return camera;
  }

  Lens lens_;
  std::string scene_;
  std::vector<std::filesystem::path> paths_;
};

}  // namespace

std::unique_ptr<ListedPairs> OpenNpzPairs(const DatasetOptions& options) {
  return std::make_unique<NpzPairs>(options);
}

}  // namespace rcme
