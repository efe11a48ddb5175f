#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>

#include "experiments/core/files/database.h"
#include "experiments/core/files/regular_file.h"
#include "experiments/data/colmap_camera.h"
#include "experiments/real/images/features.h"
#include "experiments/real/sequences/colmap_model.h"
#include "experiments/real/sequences/layout_files.h"
#include "experiments/real/sequences/listed_pairs.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

// pair_id = kMaxImages id1 + id2, id1 < id2.
constexpr std::int64_t kMaxImages = 2147483647;
constexpr std::int64_t kMaxRows = 1'000'000;

// Turns errors of SQLite into messages that name the file.
template <typename Action>
auto NamingColmap(const std::string& path, Action action) {
  try {
    return action();
  } catch (const SQLite::Exception& error) {
    throw InputError(fmt::format(
        "{}: cannot be read as a database of COLMAP: {}; it is cut off, damaged or something else", path,
        error.what()));
  }
}

// Reads a whole number of a row.
std::int64_t WholeIn(const SQLite::Column& column, const std::string& place) {
  if (!column.isInteger())
    throw InputError(fmt::format("{}: {} is no whole number", place, column.getName()));
  return column.getInt64();
}

// Reads `count` numbers of a blob.
template <typename Number>
std::vector<Number> NumbersIn(const SQLite::Column& column, size_t count, const std::string& place) {
  if (count == 0) return {};
  const auto size = static_cast<size_t>(column.getBytes());
  if (!column.isBlob() || size != count * sizeof(Number))
    throw InputError(fmt::format("{}: {} holds {} bytes; {} are needed", place, column.getName(), size,
                                 count * sizeof(Number)));
  std::vector<Number> numbers(count);
  std::memcpy(numbers.data(), column.getBlob(), size);
  return numbers;
}

struct ColmapImage {
  std::string name;
  std::int64_t camera = 0;
};

// The key points of an image, in pixels of a pinhole camera.
struct ColmapKeyPoints {
  std::vector<std::optional<Eigen::Vector2d>> x_px;
  std::vector<KeyPoint> key_points;  // for their sizes; 0: not known
};

SQLite::Database OpenColmap(const std::string& path) {
  RegularFile(path, {"database of COLMAP", "a database of COLMAP"});
  return OpenDatabase(path, SQLite::OPEN_READONLY);
}

class ColmapPairs : public ListedPairs {
 public:
  ColmapPairs(const fs::path& path, const DatasetOptions& options)
      : path_(path.string()), database_(OpenColmap(path_)) {
    const std::string folder = FolderName(fs::absolute(path).parent_path());
    scene_ = options.name.empty() ? folder : options.name;
    ReadCameras();
    ReadImages();
    ReadPairIds();
    ReadReconstruction(path.parent_path(), options);
  }

  size_t size() const override { return pair_ids_.size(); }
  std::string PairId(size_t i) const override {
    return fmt::format("{}_{:06}_{:06}", scene_, pair_ids_.at(i) / kMaxImages, pair_ids_.at(i) % kMaxImages);
  }
  std::string Note() const override { return note_; }
  ListedPair Read(size_t i) override {
    return NamingColmap(path_, [&] { return ReadPair(pair_ids_.at(i)); });
  }

 private:
  std::string Place(const std::string& table, std::int64_t id) const {
    return fmt::format("{}: {} {}", path_, table, id);
  }

  void ReadCameras() {
    SQLite::Statement rows(database_, "SELECT camera_id, model, width, height, params FROM cameras");
    while (rows.executeStep()) {
      const std::int64_t id = WholeIn(rows.getColumn(0), path_ + ": cameras");
      const std::string place = Place("camera", id);
      ColmapCamera camera{WholeIn(rows.getColumn(1), place),
                          WholeIn(rows.getColumn(2), place),
                          WholeIn(rows.getColumn(3), place),
                          {}};
      camera.parameters =
          NumbersIn<double>(rows.getColumn(4), NumColmapParameters(camera.model, place), place);
      cameras_[id] = LensOfColmapCamera(camera, place);
    }
  }

  void ReadImages() {
    SQLite::Statement rows(database_, "SELECT image_id, name, camera_id FROM images");
    while (rows.executeStep()) {
      const std::int64_t id = WholeIn(rows.getColumn(0), path_ + ": images");
      if (rows.getColumn(1).isNull()) throw InputError(Place("image", id) + ": has no name");
      const ColmapImage image{rows.getColumn(1).getString(), WholeIn(rows.getColumn(2), Place("image", id))};
      if (image.name.find_first_of("\n\r") != std::string::npos ||
          FindNotPlain(image.name) != std::string::npos)
        throw InputError(fmt::format("{}: its name {} is not allowed; UTF-8 without control characters is",
                                     Place("image", id), Quoted(image.name)));
      if (!cameras_.contains(image.camera))
        throw InputError(
            fmt::format("{}: its camera {} is not in the database", Place("image", id), image.camera));
      images_[id] = image;
    }
  }

  void ReadPairIds() {
    SQLite::Statement rows(database_, "SELECT pair_id FROM matches WHERE rows > 0 ORDER BY pair_id");
    while (rows.executeStep()) {
      const std::int64_t pair = WholeIn(rows.getColumn(0), path_ + ": matches");
      for (const std::int64_t image : {pair / kMaxImages, pair % kMaxImages}) {
        if (!images_.contains(image))
          throw InputError(
              fmt::format("{}: its image {} is not in the database", Place("pair", pair), image));
      }
      if (pair / kMaxImages == pair % kMaxImages)
        throw InputError(
            fmt::format("{}: is of image {} and itself", Place("pair", pair), pair % kMaxImages));
      pair_ids_.push_back(pair);
    }
    if (pair_ids_.empty())
      throw InputError(
          fmt::format("{}: its table matches is empty; run one of colmap's matchers first", path_));
  }

  void ReadReconstruction(const fs::path& beside, const DatasetOptions& options) {
    const fs::path folder = options.model.empty() ? beside / "sparse" / "0" : fs::path(options.model);
    if (options.model.empty() && !fs::exists(folder)) {
      note_ = fmt::format("no truth: {} is not there, and no --model was given", folder.string());
      return;
    }
    views_ = ReadColmapModel(folder);
    size_t num_known = 0;
    for (const auto& [id, image] : images_) {
      const auto view = views_.find(image.name);
      if (view == views_.end()) continue;
      ++num_known;
      const Camera &now = view->second.lens.camera, &before = cameras_.at(image.camera).camera;
      if (now.width != before.width || now.height != before.height)
        throw InputError(fmt::format(
            "{}: {} is of {} x {} px in the reconstruction, of {} x {} in {}; key "
            "points of one are not those of the other",
            folder.string(), Quoted(image.name), now.width, now.height, before.width, before.height, path_));
    }
    note_ = fmt::format("truth: {} of {} images have a pose in {}, and their cameras are those of there",
                        num_known, images_.size(), folder.string());
  }

  // Returns the best known lens of an image.
  const Lens& FindLens(std::int64_t image) const {
    const auto view = views_.find(images_.at(image).name);
    return view == views_.end() ? cameras_.at(images_.at(image).camera) : view->second.lens;
  }

  const ColmapKeyPoints& ReadKeyPoints(std::int64_t image) {
    if (const auto found = key_points_.find(image); found != key_points_.end()) return found->second;
    SQLite::Statement row(database_, "SELECT rows, cols, data FROM keypoints WHERE image_id = ?");
    row.bind(1, image);
    const std::string place = Place("keypoints of image", image);
    if (!row.executeStep()) throw InputError(fmt::format("{}: are not in the database", place));
    const std::int64_t num_rows = WholeIn(row.getColumn(0), place),
                       num_columns = WholeIn(row.getColumn(1), place);
    if (num_rows < 0 || num_rows > kMaxRows || (num_columns != 2 && num_columns != 4 && num_columns != 6))
      throw InputError(fmt::format("{}: {} x {}; up to {} rows of 2, 4 or 6 are allowed", place, num_rows,
                                   num_columns, kMaxRows));
    const auto width = static_cast<size_t>(num_columns);
    const std::vector<float> data =
        NumbersIn<float>(row.getColumn(2), static_cast<size_t>(num_rows) * width, place);
    const Lens& lens = FindLens(image);
    ColmapKeyPoints points;
    for (size_t at = 0; at < data.size(); at += width) {
      const Eigen::Vector2d x_px(data[at] - kColmapHalfPixel, data[at + 1] - kColmapHalfPixel);
      if (!x_px.allFinite()) throw InputError(fmt::format("{}: a coordinate is not finite", place));
      points.x_px.push_back(Undistort(lens, x_px));
      points.key_points.push_back({data[at], data[at + 1], Diameter(&data[at], width)});
    }
    return key_points_[image] = std::move(points);
  }

  // Returns twice the scale. A row is x, y, scale, orientation, or x, y and a 2x2 matrix whose columns have
  // the length of the scale.
  static float Diameter(const float* row, size_t width) {
    if (width == 4) return 2.0f * row[2];
    if (width == 6) return std::hypot(row[2], row[4]) + std::hypot(row[3], row[5]);
    return 0.0f;
  }

  ListedPair ReadPair(std::int64_t pair) {
    const std::int64_t id1 = pair / kMaxImages, id2 = pair % kMaxImages;
    ListedPair listed;
    MatchFile& file = listed.file;
    file.scene = scene_;
    file.image1 = images_.at(id1).name;
    file.image2 = images_.at(id2).name;
    file.camera1 = FindLens(id1).camera;
    file.camera2 = FindLens(id2).camera;
    // Pairs are ordered by their first images, so key points of other images can be dropped.
    std::erase_if(key_points_, [&](const auto& entry) { return entry.first != id1 && entry.first != id2; });
    const ColmapKeyPoints &points1 = ReadKeyPoints(id1), &points2 = ReadKeyPoints(id2);

    SQLite::Statement row(database_, "SELECT rows, cols, data FROM matches WHERE pair_id = ?");
    row.bind(1, pair);
    const std::string place = Place("matches of pair", pair);
    if (!row.executeStep()) throw InputError(fmt::format("{}: are not in the database", place));
    const std::int64_t num_rows = WholeIn(row.getColumn(0), place);
    if (num_rows < 0 || num_rows > kMaxRows || WholeIn(row.getColumn(1), place) != 2)
      throw InputError(fmt::format("{}: up to {} rows of 2 are allowed", place, kMaxRows));
    const auto data = NumbersIn<std::uint32_t>(row.getColumn(2), 2 * static_cast<size_t>(num_rows), place);
    for (size_t i = 0; i + 1 < data.size(); i += 2) {
      if (data[i] >= points1.x_px.size() || data[i + 1] >= points2.x_px.size())
        throw InputError(fmt::format("{}: match {} is of a key point that is not there", place, i / 2));
      const auto &x1 = points1.x_px[data[i]], &x2 = points2.x_px[data[i + 1]];
      if (!x1 || !x2) continue;
      const KeyPoint &p1 = points1.key_points[data[i]], &p2 = points2.key_points[data[i + 1]];
      file.matches.push_back({*x1, *x2});
      if (p1.size_px > 0.0f && p2.size_px > 0.0f)
        file.sigma_px.push_back(SigmaOfMatch(Detector::kSift, p1, p2));
    }
    if (file.sigma_px.size() != file.matches.size()) file.sigma_px.clear();
    const auto view1 = views_.find(file.image1), view2 = views_.find(file.image2);
    if (view1 != views_.end() && view2 != views_.end()) {
      const TrueMotion12 motion = MotionBetween(view1->second.pose, view2->second.pose);
      file.cam2_from_cam1_true = motion.cam2_from_cam1;
      listed.baseline = motion.baseline;
    }
    return listed;
  }

  std::string path_, scene_, note_;
  SQLite::Database database_;
  std::map<std::int64_t, Lens> cameras_;
  std::map<std::int64_t, ColmapImage> images_;
  std::map<std::int64_t, ColmapKeyPoints> key_points_;
  std::vector<std::int64_t> pair_ids_;
  std::map<std::string, ColmapView> views_;
};

}  // namespace

std::unique_ptr<ListedPairs> OpenColmap(const DatasetOptions& options) {
  fs::path path(options.folder);
  CheckIsThere(path, "give a database of COLMAP or its folder");
  if (fs::is_directory(path)) path /= "database.db";
  CheckIsThere(path, "it is the database of COLMAP: colmap feature_extractor and a matcher make it");
  return NamingColmap(path.string(), [&] { return std::make_unique<ColmapPairs>(path, options); });
}

}  // namespace rcme
