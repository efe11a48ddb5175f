// COLMAP's databases and reconstructions, of rendered images.
#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <Eigen/Geometry>

#include "experiments/data/colmap_camera.h"
#include "experiments/real/sequences/colmap_model.h"
#include "experiments/real/sequences/listed_pairs.h"
#include "tests/test_support/dataset_checks.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

// As COLMAP's feature extractor guesses a camera without a calibration: 1.2 times the longer side, no
// distortion.
constexpr double kGuessedFocalLength = 384.0;

std::vector<double> ParametersOfOpenCvModel() {
  const Camera c = RenderedCamera().camera;
  const std::vector<double> k = DistortingCamera().radtan;
  return {c.fx, c.fy, c.cx + 0.5, c.cy + 0.5, k[0], k[1], k[2], k[3]};
}

// A database with a guessed camera, and the reconstruction, which has the right one, as text.
class Colmap : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_.Path("sparse/0"));
    SQLite::Database database(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    database.exec(
        "CREATE TABLE cameras (camera_id INTEGER PRIMARY KEY, model INTEGER, width INTEGER, height INTEGER, "
        "params BLOB, prior_focal_length INTEGER);"
        "CREATE TABLE images (image_id INTEGER PRIMARY KEY, name TEXT UNIQUE, camera_id INTEGER);"
        "CREATE TABLE keypoints (image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB);"
        "CREATE TABLE matches (pair_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB);");
    const Camera c = RenderedCamera().camera;
    const std::vector<double> guess = {kGuessedFocalLength, c.width / 2.0, c.height / 2.0, 0.0};
    SQLite::Statement camera(database, "INSERT INTO cameras VALUES (1, 2, ?, ?, ?, 0)");
    camera.bind(1, c.width);
    camera.bind(2, c.height);
    camera.bind(3, guess.data(), static_cast<int>(guess.size() * sizeof(double)));
    camera.exec();
    std::ofstream(folder_.Path("sparse/0/cameras.txt"))
        << "# Camera list\n"
        << fmt::format("4 OPENCV {} {} {}\n", c.width, c.height, fmt::join(ParametersOfOpenCvModel(), " "));
    std::ofstream model(folder_.Path("sparse/0/images.txt"));
    model << "# Image list\n";
    std::vector<Features> features;
    for (const int i : {0, 2, 4}) {
      const GreyImage image{c.width, c.height, RenderHall(DistortingCamera(), PoseOnWalk(i))};
      features.push_back(DetectFeatures(image, {}));
      AddImage(database, static_cast<int>(features.size()), i, features.back(), model);
    }
    for (std::int64_t a = 1; a <= 3; ++a) {
      for (std::int64_t b = a + 1; b <= 3; ++b) {
        const std::vector<FeatureMatch> matches =
            MatchFeatures(features[static_cast<size_t>(a - 1)], features[static_cast<size_t>(b - 1)], {});
        std::vector<std::uint32_t> data;
        for (const FeatureMatch& match : matches) data.insert(data.end(), {match.at1, match.at2});
        InsertBlob(database, "matches", 2147483647 * a + b, matches.size(), 2, data.data(), data.size() * 4);
      }
    }
  }

  static void AddImage(SQLite::Database& database, int id, int frame, const Features& features,
                       std::ofstream& model) {
    const std::string name = fmt::format("frames/{}.png", frame);
    SQLite::Statement row(database, "INSERT INTO images VALUES (?, ?, 1)");
    row.bind(1, id);
    row.bind(2, name);
    row.exec();
    std::vector<float> data;
    for (const KeyPoint& p : features.key_points)
      data.insert(data.end(), {p.x_px + 0.5f, p.y_px + 0.5f, p.size_px / 2, 0.0f});
    InsertBlob(database, "keypoints", id, data.size() / 4, 4, data.data(), data.size() * sizeof(float));
    const RenderedPose pose = PoseOnWalk(frame);
    const Eigen::Quaterniond q(Eigen::Matrix3d(pose.R_world_from_cam.transpose()));
    const Eigen::Vector3d t = -(pose.R_world_from_cam.transpose() * pose.center);
    model << fmt::format("{} {} {} {} {} {} {} {} 4 {}\n\n", id, q.w(), q.x(), q.y(), q.z(), t.x(), t.y(),
                         t.z(), name);
  }

  static void InsertBlob(SQLite::Database& database, const std::string& table, std::int64_t id, size_t rows,
                         int columns, const void* data, size_t num_bytes) {
    SQLite::Statement row(database, "INSERT INTO " + table + " VALUES (?, ?, ?, ?)");
    row.bind(1, id);
    row.bind(2, static_cast<std::int64_t>(rows));
    row.bind(3, columns);
    row.bind(4, data, static_cast<int>(num_bytes));
    row.exec();
  }

  // A copy of the database, changed, its reconstruction not beside it.
  std::string Changed(const std::string& sql) const {
    fs::create_directories(folder_.Path("changed"));
    const std::string copy = folder_.Path("changed/broken.db");
    fs::copy_file(path_, copy, fs::copy_options::overwrite_existing);
    SQLite::Database(copy, SQLite::OPEN_READWRITE).exec(sql);
    return copy;
  }
  testing::AssertionResult Refuses(const std::string& sql, const std::vector<std::string>& fragments) const {
    return RefusesFile(Changed(sql), fragments);
  }
  static testing::AssertionResult RefusesFile(const std::string& path,
                                              const std::vector<std::string>& fragments) {
    return ThrowsInputError(
        [&] {
          const auto pairs = OpenColmap(MakeDatasetOptions(path));
          for (size_t i = 0; i < pairs->size(); ++i) pairs->Read(i);
        },
        fragments);
  }
  // What is said of a reconstruction of which one file is changed.
  testing::AssertionResult RefusesModel(const std::string& file, const std::string& from,
                                        const std::string& to,
                                        const std::vector<std::string>& fragments) const {
    const std::string model = folder_.Path("sparse/0"), kept = ReadBytes(model + "/" + file);
    Replace(file, from, to)(model);
    const testing::AssertionResult result =
        ThrowsInputError([&] { OpenColmap(MakeDatasetOptions(folder_.path())); }, fragments);
    Overwrite(model + "/" + file, kept);
    return result;
  }

  TempFolder folder_;
  std::string path_ = folder_.Path("database.db");
};

TEST_F(Colmap, ADatabaseAndItsReconstruction) {
  DatasetOptions options = MakeDatasetOptions(folder_.path());
  options.name = "hall";
  const auto pairs = OpenColmap(options);
  ASSERT_EQ(pairs->size(), 3u);
  EXPECT_EQ(pairs->PairId(0), "hall_000001_000002");
  EXPECT_NE(pairs->Note().find("3 of 3 images"), std::string::npos) << pairs->Note();
  const std::string out = folder_.Path("out");
  PairsOptions making;
  making.out = out;
  PairJournal journal(out, "test");
  MakeListedPairs(*pairs, making, &journal);
  std::vector<PairRow> rows = journal.rows();
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].image2, "frames/2.png");
  for (const PairRow& row : rows) {
    ASSERT_EQ(row.reason, kKeptPair) << row.pair_id;
    const MatchFile file = ReadMatchFile(out + "/" + row.pair_id + ".csv");
    const RelativePose rendered =
        TrueMotion(PoseOnWalk(std::stod(row.image1.substr(7))), PoseOnWalk(std::stod(row.image2.substr(7))));
    EXPECT_EQ(file.camera1.cx, RenderedCamera().camera.cx);
    EXPECT_EQ(file.camera2.fy, RenderedCamera().camera.fy);  // the reconstruction's, not the guess
    EXPECT_EQ(file.sigma_px.size(), file.matches.size());
    EXPECT_LT(RotationAngleBetween(file.cam2_from_cam1_true->R, rendered.R), 1e-6);
    EXPECT_LT(AngleBetween(file.cam2_from_cam1_true->t, rendered.t), 1e-5);
    ExpectTheMotion(file, rendered, row.pair_id);
  }
}

TEST_F(Colmap, WithoutAReconstructionTheCamerasAreThoseOfTheDatabase) {
  const auto pairs = OpenColmap(MakeDatasetOptions(Changed("")));
  EXPECT_NE(pairs->Note().find("no truth: "), std::string::npos) << pairs->Note();
  const MatchFile file = pairs->Read(0).file;
  EXPECT_EQ(file.camera1.fx, kGuessedFocalLength);
  EXPECT_EQ(file.camera2.cy, 119.5);
  EXPECT_FALSE(file.cam2_from_cam1_true.has_value());
}

// Up to 3.11 images have the columns of a prior pose, later pose priors, rigs and frames have tables; the
// oldest databases are written ahead (WAL).
TEST_F(Colmap, DatabasesOfOtherVersionsAreReadTheSame) {
  const auto number_of_matches = [](const std::string& path) {
    const auto pairs = OpenColmap(MakeDatasetOptions(path));
    size_t sum = 0;
    for (size_t i = 0; i < pairs->size(); ++i) sum += pairs->Read(i).file.matches.size();
    return sum;
  };
  const size_t expected = number_of_matches(Changed(""));
  EXPECT_GT(expected, 300u);
  for (const char* sql :
       {"ALTER TABLE images ADD COLUMN prior_qw REAL; ALTER TABLE images ADD COLUMN prior_tz REAL;"
        "CREATE TABLE inlier_matches (pair_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB, "
        "config INTEGER)",
        "CREATE TABLE pose_priors (image_id INTEGER PRIMARY KEY, position BLOB, coordinate_system INTEGER);"
        "CREATE TABLE rigs (rig_id INTEGER PRIMARY KEY, ref_sensor_id INTEGER, ref_sensor_type INTEGER);"
        "CREATE TABLE frames (frame_id INTEGER PRIMARY KEY, rig_id INTEGER);"
        "CREATE TABLE two_view_geometries (pair_id INTEGER PRIMARY KEY, rows INTEGER, F BLOB, qvec BLOB)",
        "PRAGMA journal_mode = WAL", "INSERT INTO matches VALUES (9, 0, 2, NULL)"})
    EXPECT_EQ(number_of_matches(Changed(sql)), expected) << sql;
}

TEST_F(Colmap, AReconstructionIsTheSameInTextAndBytes) {
  const std::map<std::string, ColmapView> text = ReadColmapModel(folder_.Path("sparse/0"));
  ASSERT_EQ(text.size(), 3u);
  fs::create_directories(folder_.Path("binary"));
  const auto put = [](std::ofstream& file, auto number) {
    file.write(reinterpret_cast<const char*>(&number), sizeof(number));
  };
  std::ofstream cameras(folder_.Path("binary/cameras.bin"), std::ios::binary);
  put(cameras, std::uint64_t{1});
  for (const std::int32_t number : {8, 4}) put(cameras, number);  // camera, model
  for (const std::uint64_t length : {320, 240}) put(cameras, length);
  for (const double x : ParametersOfOpenCvModel()) put(cameras, x);
  cameras.close();
  std::ofstream images(folder_.Path("binary/images.bin"), std::ios::binary);
  put(images, std::uint64_t{3});
  for (const auto& [name, view] : text) {
    put(images, std::uint32_t{7});
    const Eigen::Quaterniond q(Eigen::Matrix3d(view.pose.R_world_from_cam.transpose()));
    const Eigen::Vector3d t = -(view.pose.R_world_from_cam.transpose() * view.pose.center);
    for (const double x : {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()}) put(images, x);
    put(images, std::uint32_t{8});
    images.write(name.c_str(), static_cast<std::streamsize>(name.size() + 1));
    put(images, std::uint64_t{2});
    for (int i = 0; i < 2; ++i) put(images, 1.0), put(images, 2.0), put(images, std::int64_t{-1});
  }
  images.close();
  const std::map<std::string, ColmapView> bytes = ReadColmapModel(folder_.Path("binary"));
  ASSERT_EQ(bytes.size(), 3u);
  for (const auto& [name, view] : text) {
    EXPECT_LT((bytes.at(name).pose.R_world_from_cam - view.pose.R_world_from_cam).norm(), 1e-12);
    EXPECT_LT((bytes.at(name).pose.center - view.pose.center).norm(), 1e-12);
    EXPECT_EQ(bytes.at(name).lens.camera.fx, view.lens.camera.fx);
    EXPECT_EQ(bytes.at(name).lens.k, view.lens.k);
  }
  for (const char* name : {"binary/images.bin", "binary/cameras.bin"}) {
    const std::string whole = ReadBytes(folder_.Path(name));
    for (size_t size = 0; size < whole.size(); size += 7) {
      Overwrite(folder_.Path(name), whole.substr(0, size));
      EXPECT_TRUE(ThrowsInputError([&] { ReadColmapModel(folder_.Path("binary")); },
                                   {std::string(name).substr(7) + ": ends early"}))
          << size;
    }
    Overwrite(folder_.Path(name), whole);
  }
  EXPECT_TRUE(ThrowsInputError([&] { ReadColmapModel(folder_.path()); }, {"images.txt: is not there"}));
  fs::remove(folder_.Path("binary/cameras.bin"));
  EXPECT_TRUE(ThrowsInputError([&] { ReadColmapModel(folder_.Path("binary")); },
                               {"cameras.bin: is not there; it comes with images.bin"}));
}

TEST_F(Colmap, ABrokenReconstructionIsNamedByPath) {
  EXPECT_TRUE(
      RefusesModel("cameras.txt", "4 OPENCV", "5 OPENCV",
                   {"images.txt:2: the camera 4 of 'frames/0.png' is not among the reconstruction's 1"}));
  EXPECT_TRUE(RefusesModel("cameras.txt", "OPENCV", "FOV", {"cameras.txt: camera 4: model 'FOV' is not"}));
  EXPECT_TRUE(RefusesModel("cameras.txt", "OPENCV", "PINHOLE", {"camera 4: 8 parameters; PINHOLE has 4"}));
  EXPECT_TRUE(RefusesModel("cameras.txt", " 320 ", " 3x0 ", {"cameras.txt:2: '3x0' is not a whole number"}));
  EXPECT_TRUE(RefusesModel("cameras.txt", " 320 ", " 640 ",
                           {"'frames/0.png' is of 640 x 240 px in the reconstruction, of 320 x 240 in"}));
  EXPECT_TRUE(RefusesModel("cameras.txt", " 320 ", " 0 ", {"camera 4: an image of 0 x 240 px"}));
  EXPECT_TRUE(RefusesModel("images.txt", " 4 frames/0", "", {"images.txt:2: is not IMAGE_ID QW"}));
  EXPECT_TRUE(RefusesModel("images.txt", "frames/2.png", "frames/0.png", {"'frames/0.png' has two poses"}));
  EXPECT_TRUE(
      RefusesModel("images.txt", "1 ", "1 2", {"images.txt:2: a pose is damaged: a quaternion of length"}));
}

TEST_F(Colmap, ABrokenDatabaseIsNamedByPath) {
  const std::string whole = ReadBytes(path_);
  for (const size_t size : {whole.size() / 2, whole.size() / 4, size_t{2000}, size_t{50}, size_t{0}}) {
    const std::string cut = folder_.Write("cut.db", whole.substr(0, size));
    EXPECT_TRUE(RefusesFile(cut, {cut + ": "})) << size;
  }
  EXPECT_TRUE(RefusesFile(folder_.Write("text.db", "no database, but long enough to be looked at"),
                          {"text.db: cannot be read"}));
  EXPECT_TRUE(Refuses("DELETE FROM matches", {"broken.db: its table matches is empty"}));
  EXPECT_TRUE(Refuses("DELETE FROM images WHERE image_id = 2", {"its image 2 is not in the database"}));
  EXPECT_TRUE(Refuses(
      "UPDATE matches SET pair_id = 2147483647 * 2 + 2 WHERE pair_id = (SELECT min(pair_id) FROM matches)",
      {"is of image 2 and itself"}));
  EXPECT_TRUE(Refuses("DELETE FROM cameras", {"image 1: its camera 1 is not in the database"}));
  EXPECT_TRUE(
      Refuses("DELETE FROM keypoints WHERE image_id = 3", {"keypoints of image 3: are not in the database"}));
  EXPECT_TRUE(Refuses("UPDATE cameras SET model = 10", {"camera 1: model '10' is not supported"}));
  EXPECT_TRUE(
      Refuses("UPDATE cameras SET params = x'00'", {"camera 1: params holds 1 bytes; 32 are needed"}));
  EXPECT_TRUE(Refuses("UPDATE cameras SET width = 0", {"camera 1: an image of 0 x 240 px"}));
  EXPECT_TRUE(Refuses("UPDATE keypoints SET rows = rows + 1", {"keypoints of image 1: data holds"}));
  EXPECT_TRUE(
      Refuses("UPDATE keypoints SET rows = 1000000000000", {"keypoints of image 1: 1000000000000 x 4"}));
  EXPECT_TRUE(Refuses("UPDATE keypoints SET rows = 1, data = substr(data, 1, 16)",
                      {"match", "is of a key point that is not there"}));
  EXPECT_TRUE(Refuses("UPDATE matches SET cols = 3", {"matches of pair"}));
  EXPECT_TRUE(
      Refuses("DROP TABLE keypoints", {"broken.db: cannot be read as a database of COLMAP: no such table"}));
  EXPECT_TRUE(RefusesFile(folder_.Path("nothing.db"), {"nothing.db: is not there"}));
}

}  // namespace
}  // namespace rcme
