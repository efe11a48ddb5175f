// Data sets of rendered images, whose motions are known, in every layout: what is read, which pairs are made
// of it, and what is said to what is missing or wrong.
#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <numbers>

#include "estimator/estimator_registry.h"
#include "estimator/geometry/essential_matrix.h"
#include "experiments/data/match_folder.h"
#include "experiments/sequences/colmap_model.h"
#include "experiments/sequences/layouts.h"
#include "experiments/sequences/make_pairs.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/rendered_sequence.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr int kNumFrames = 6;

RenderedCamera Distorting() {
  RenderedCamera camera;
  camera.radtan = {-0.28, 0.07, 0.0004, -0.0003};
  return camera;
}
RenderedCamera Fisheye() {
  RenderedCamera camera;
  camera.fisheye = {-0.02, 0.01, -0.004, 0.001};
  return camera;
}

// Each data set is rendered once; tests that break one do it to a copy.
class Sequences : public testing::Test {
 protected:
  static void SetUpTestSuite() { rendered_ = new TempFolder; }
  static void TearDownTestSuite() { delete rendered_; }

  // The folder of a data set, rendered when it is first asked for.
  static std::string Folder(const std::string& name) {
    const std::string folder = rendered_->Path(name);
    if (fs::exists(folder)) return folder;
    if (name == "dataset") WriteKittiSequence(folder, "04", kNumFrames);
    if (name == "MH_01_easy") WriteEurocSequence(folder, kNumFrames, Distorting());
    if (name == "rgbd_dataset_desk") WriteTumSequence(folder, kNumFrames, Distorting());
    if (name == "corridor") WriteImageFolder(folder, kNumFrames, Fisheye());
    return folder;
  }

  // A copy of a data set, to be broken.
  std::string Copy(const std::string& name) {
    const std::string copy = folder_.Path(name);
    fs::remove_all(copy);
    fs::copy(Folder(name), copy, fs::copy_options::recursive);
    return copy;
  }
  static DatasetOptions Options(const std::string& name, const std::string& folder = "") {
    DatasetOptions options;
    options.folder = folder.empty() ? Folder(name) : folder;
    if (name == "rgbd_dataset_desk" || name == "corridor") {
      const Camera camera = RenderedCamera().camera;
      options.K = {camera.fx, camera.fy, camera.cx, camera.cy};
      options.lens = name == "corridor" ? LensModel::kFisheye : LensModel::kRadtan;
      options.distortion = name == "corridor" ? Fisheye().fisheye : Distorting().radtan;
    }
    return options;
  }

  static TempFolder* rendered_;
  TempFolder folder_;
};
TempFolder* Sequences::rendered_ = nullptr;

std::vector<PairRow> Make(const std::vector<Sequence>& sequences, PairsOptions options,
                          const std::string& out) {
  options.out = out;
  PairJournal journal(out, "test");
  MakePairsOfImages(sequences, options, &journal);
  WritePairTables(journal, {}, out);
  return journal.rows();
}

// The number of a rendered frame from the end of a pair's name.
double FrameOf(const std::string& pair_id, int which) {
  const std::string end = pair_id.substr(pair_id.size() - 13);
  return std::stod(which == 1 ? end.substr(0, 6) : end.substr(7));
}

RelativePose RenderedMotion(const std::string& pair_id) {
  return TrueMotion(PoseOnWalk(FrameOf(pair_id, 1)), PoseOnWalk(FrameOf(pair_id, 2)));
}

// The matches of each pair that was kept, and the motion that they give, are those that was rendered: the
// estimated rotation to within .25 degrees, the direction to within 3 (key points err by some tenths of a
// pixel at f = 260 px).
void ExpectTheRenderedMotions(const std::vector<PairRow>& rows, const std::string& out) {
  const auto estimator = MakeEstimator("rcme_calibrated");
  int num_kept = 0;
  for (const PairRow& row : rows) {
    if (row.reason != kKeptPair) continue;
    ++num_kept;
    const MatchFile file = ReadMatchFile(out + "/" + row.pair_id + ".csv");
    const RelativePose rendered = RenderedMotion(row.pair_id);
    EXPECT_EQ(file.sigma_px.size(), file.matches.size());
    EXPECT_EQ(file.image1, row.image1);
    const Eigen::Matrix3d F =
        FundamentalFromEssential(EssentialFromPose(rendered), file.camera1, file.camera2);
    int num_near = 0;
    for (const Correspondence& match : file.matches) {
      const Eigen::Vector3d line = F * match.x1_px.homogeneous();
      num_near += std::abs(line.dot(match.x2_px.homogeneous())) < 1.5 * line.head<2>().norm();
    }
    EXPECT_GT(num_near, 0.8 * static_cast<double>(file.matches.size())) << row.pair_id;
    RandomStream rng({.seed = 1, .purpose = 4});
    const MotionEstimate estimate = estimator->Estimate({file.matches, file.camera1, file.camera2, 0.5}, rng);
    ASSERT_EQ(estimate.status, MotionStatus::kOk) << row.pair_id;
    EXPECT_LT(kDegPerRad * RotationAngleBetween(estimate.cam2_from_cam1.R, rendered.R), 0.25) << row.pair_id;
    EXPECT_LT(kDegPerRad * AngleBetween(estimate.cam2_from_cam1.t, rendered.t), 3.0) << row.pair_id;
  }
  EXPECT_GE(num_kept, 2);
}

// The truth of the files is what was rendered, to within these angles.
void ExpectTheRenderedTruth(const std::vector<PairRow>& rows, const std::string& out, double within_deg) {
  for (const PairRow& row : rows) {
    if (row.reason != kKeptPair) continue;
    const MatchFile file = ReadMatchFile(out + "/" + row.pair_id + ".csv");
    const RelativePose rendered = RenderedMotion(row.pair_id);
    ASSERT_TRUE(file.cam2_from_cam1_true.has_value()) << row.pair_id;
    EXPECT_LT(kDegPerRad * RotationAngleBetween(file.cam2_from_cam1_true->R, rendered.R), within_deg);
    EXPECT_LT(kDegPerRad * AngleBetween(file.cam2_from_cam1_true->t, rendered.t), within_deg);
  }
}

TEST_F(Sequences, Kitti) {
  const std::vector<Sequence> read = ReadKitti(Options("dataset"));
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].name, "kitti_04");
  EXPECT_EQ(read[0].frames.size(), 1u * kNumFrames);
  EXPECT_EQ(read[0].frames[3].time_s, 0.3);
  EXPECT_EQ(read[0].lens.camera.width, 320);
  EXPECT_EQ(read[0].lens.camera.fy, 262.0);
  const std::string out = folder_.Path("out");
  const std::vector<PairRow> rows = Make(read, {}, out);
  ExpectTheRenderedMotions(rows, out);
  ExpectTheRenderedTruth(rows, out, 1e-4);
  // The folder is one that studies take.
  const auto scenes = LoadMatchFolder({out, 0.5});
  ASSERT_EQ(scenes.size(), 1u);
  EXPECT_EQ(scenes[0].first, "kitti_04");
  EXPECT_EQ(ReadKitti(Options("dataset", rendered_->path())).size(), 1u);  // above it, as unpacked
  DatasetOptions named = Options("dataset");
  named.name = "KITTI/";
  named.max_frames = 3;
  EXPECT_EQ(ReadKitti(named)[0].name, "KITTI/04");
  EXPECT_EQ(ReadKitti(named)[0].frames.size(), 3u);
}

TEST_F(Sequences, Euroc) {
  const std::string out = folder_.Path("out");
  const std::vector<PairRow> rows = Make(ReadEuroc(Options("MH_01_easy")), {}, out);
  EXPECT_EQ(rows.at(0).scene, "MH_01_easy");
  ExpectTheRenderedMotions(rows, out);
  ExpectTheRenderedTruth(rows, out, 0.05);  // taken between two samples
  EXPECT_EQ(ReadEuroc(Options("", rendered_->path())).size(), 1u);
}

TEST_F(Sequences, Tum) {
  const std::string out = folder_.Path("out");
  const std::vector<PairRow> rows = Make(ReadTum(Options("rgbd_dataset_desk")), {}, out);
  ExpectTheRenderedMotions(rows, out);
  ExpectTheRenderedTruth(rows, out, 0.05);
  // The camera by the folder's name.
  fs::rename(Copy("rgbd_dataset_desk"), folder_.Path("rgbd_dataset_freiburg2_desk"));
  const std::vector<Sequence> known = ReadTum(Options("", folder_.Path("rgbd_dataset_freiburg2_desk")));
  EXPECT_EQ(known[0].lens.camera.fx, 520.9);
  EXPECT_EQ(known[0].lens.k[4], 0.9172);
}

TEST_F(Sequences, AFolderOfImages) {
  const std::string out = folder_.Path("out");
  const std::vector<PairRow> rows = Make(ReadImageFolder(Options("corridor")), {}, out);
  ExpectTheRenderedMotions(rows, out);
  for (const fs::path& file : MatchFilesIn(out))
    EXPECT_FALSE(ReadMatchFile(file.string()).cam2_from_cam1_true.has_value());
}

TEST_F(Sequences, NeighboursGiveTriplesAndTheTruthsOwnErrorItsHeader) {
  PairsOptions options;
  options.neighbours = 2;
  options.truth_sd = {0.03, 0.012};
  const std::string out = folder_.Path("out");
  const std::vector<PairRow> rows = Make(ReadKitti(Options("dataset")), options, out);
  std::set<std::pair<std::string, std::string>> kept;
  for (const PairRow& row : rows) {
    if (row.reason == kKeptPair) kept.emplace(row.image1, row.image2);
  }
  int num_triples = 0;
  for (const auto& [a, b] : kept) {
    for (const auto& [c, d] : kept) num_triples += b == c && kept.contains({a, d});
  }
  EXPECT_GE(num_triples, 1);
  const PairRow& row = rows.at(0);
  const TruthSd sd = SdOfMotion(*options.truth_sd, row.baseline);
  EXPECT_NEAR(sd.rotation_rad.x(), std::sqrt(2.0) * 0.03 / kDegPerRad, 1e-12);
  EXPECT_NEAR(sd.translation.y(), std::hypot(std::sqrt(2.0) * 0.012 / row.baseline, 0.03 / kDegPerRad),
              1e-12);
  for (const PairRow& each : rows) {
    if (each.reason != kKeptPair) continue;
    const MatchFile file = ReadMatchFile(out + "/" + each.pair_id + ".csv");
    ASSERT_TRUE(file.truth_sd.has_value());
    EXPECT_NEAR(file.truth_sd->translation.z(), SdOfMotion(*options.truth_sd, each.baseline).translation.z(),
                1e-9);
  }
}

// The error of a motion between two poses that err: against 20,000 draws; the standard error of a standard
// deviation is .5 %, the bound six of them (false alarm of the six numbers below 1e-7).
TEST(TruthSdOfPoses, IsThatOfDraws) {
  const PoseSd sd{0.5, 0.01};
  const CameraPose a{RotationFromVector({0.1, 0.2, -0.3}), {0.3, 0.1, 0.0}},
      b{RotationFromVector({0.4, 0, 0}), {1.3, 0.4, 0.7}};
  const TrueMotion12 exact = MotionBetween(a, b);
  RandomStream rng({.seed = 1, .purpose = 91});
  const auto noisy = [&](const CameraPose& pose) {
    const auto draw = [&](double s) {
      return Eigen::Vector3d(s * rng.Normal(), s * rng.Normal(), s * rng.Normal());
    };
    return CameraPose{pose.R_world_from_cam * RotationFromVector(draw(sd.rotation_deg / kDegPerRad)),
                      pose.center + draw(sd.position)};
  };
  constexpr int kDraws = 20'000;
  Eigen::Vector3d rotation2 = Eigen::Vector3d::Zero();
  double direction2 = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const TrueMotion12 drawn = MotionBetween(noisy(a), noisy(b));
    rotation2 += VectorFromRotation(drawn.cam2_from_cam1.R * exact.cam2_from_cam1.R.transpose())
                     .array()
                     .square()
                     .matrix();
    direction2 += std::pow(AngleBetween(drawn.cam2_from_cam1.t, exact.cam2_from_cam1.t), 2);
  }
  const TruthSd stated = SdOfMotion(sd, exact.baseline);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(std::sqrt(rotation2[i] / kDraws) / stated.rotation_rad[i], 1.0, 0.03);
  EXPECT_NEAR(std::sqrt(direction2 / kDraws / 2.0) / stated.translation[0], 1.0, 0.03);
}

TEST_F(Sequences, WorkThatWasCutOffGoesOnAndGivesTheSameBytes) {
  const std::vector<Sequence> read = ReadKitti(Options("dataset"));
  PairsOptions options;
  options.neighbours = 2;
  options.cache = folder_.Path("cache");
  const std::string whole = folder_.Path("whole"), cut = folder_.Path("cut");
  const size_t num_rows = Make(read, options, whole).size();
  ASSERT_GE(num_rows, 4u);
  fs::copy(whole, cut, fs::copy_options::recursive);
  const std::string journal = ReadBytes(whole + "/pairs.journal");
  // Cut within the third row; the files of what is behind are gone too.
  size_t at = 0;
  for (int line = 0; line < 3; ++line) at = journal.find('\n', at) + 1;
  std::ofstream(cut + "/pairs.journal", std::ios::binary) << journal.substr(0, at + 20);
  fs::remove(cut + "/INDEX.csv");
  const PairJournal opened(cut, "test");
  EXPECT_EQ(opened.num_before(), 2);
  for (const fs::path& file : MatchFilesIn(cut)) {
    if (!opened.Find(PairIdOf(file))) fs::remove(file);
  }
  EXPECT_EQ(Make(read, options, cut).size(), num_rows);
  for (const char* name : {"/INDEX.csv", "/pairs.txt", "/pairs.journal"})
    EXPECT_TRUE(ReadBytes(cut + name) == ReadBytes(whole + name)) << name;
  for (const fs::path& file : MatchFilesIn(whole))
    EXPECT_TRUE(ReadBytes(cut + "/" + file.filename().string()) == ReadBytes(file.string())) << file;
  EXPECT_TRUE(ThrowsInputError([&] { PairJournal(whole, "other"); }, {"--out: " + whole, "other options"}));
  std::ofstream(cut + "/pairs.journal", std::ios::binary) << "{}\n";
  EXPECT_TRUE(ThrowsInputError([&] { PairJournal(cut, "test"); }, {"pairs.journal:1: is damaged"}));
  folder_.Write("foreign.csv", "x");
  EXPECT_TRUE(ThrowsInputError([&] { PairJournal(folder_.path(), "test"); }, {"holds foreign.csv"}));
}

TEST_F(Sequences, ADamagedImageIsSkippedCountedAndNamed) {
  const std::string copy = Copy("dataset"), out = folder_.Path("out");
  const std::string image = copy + "/sequences/04/image_0/000002.png";
  fs::resize_file(image, fs::file_size(image) / 2);
  std::ofstream(copy + "/sequences/04/image_0/000003.png", std::ios::binary) << "no image";
  Make(ReadKitti(Options("", copy)), {}, out);
  const std::string text = ReadBytes(out + "/pairs.txt");
  for (const char* said : {"000002.png: the image is damaged: it ends early", "000003.png: is not a PNG"}) {
    const std::string line = "skipped: " + copy + "/sequences/04/image_0/";
    EXPECT_NE(text.find(line + said), std::string::npos) << text;
  }
  const PairJournal journal(out, "test");
  EXPECT_EQ(journal.damaged().size(), 2u);
  for (const PairRow& row : journal.rows()) {
    for (const char* damaged : {"image_0/000002.png", "image_0/000003.png"}) {
      EXPECT_NE(row.image1, damaged);
      EXPECT_NE(row.image2, damaged);
    }
  }
}

// One way of breaking a data set, and what is to be said.
struct Broken {
  std::function<void(const std::string& folder)> how;
  std::vector<std::string> message;
};
std::function<void(const std::string&)> Remove(const std::string& path) {
  return [=](const std::string& folder) { fs::remove_all(folder + "/" + path); };
}
std::function<void(const std::string&)> Replace(const std::string& path, const std::string& from,
                                                const std::string& to) {
  return [=](const std::string& folder) {
    std::string text = ReadBytes(folder + "/" + path);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << path << " does not hold " << from;
    std::ofstream(folder + "/" + path, std::ios::binary) << text.replace(at, from.size(), to);
  };
}
std::function<void(const std::string&)> Shrink(const std::string& path) {
  return [=](const std::string& folder) {
    WriteImage(folder + "/" + path, {1, 1, 0, 0, 160, 120}, std::vector<std::uint8_t>(160 * 120));
  };
}

TEST_F(Sequences, ABrokenKittiIsNamedByPath) {
  const std::string s = "sequences/04/";
  const std::vector<Broken> cases = {
      {Remove("sequences"), {"/sequences: is not there; the archives of KITTI"}},
      {Remove(s + "image_0"), {"/sequences/image_0: is not there", "data_odometry_gray.zip"}},
      {Remove(s + "calib.txt"), {s + "calib.txt: is not there", "data_odometry_calib.zip"}},
      {Remove(s + "times.txt"), {s + "times.txt: is not there"}},
      {Remove(s + "image_0/000002.png"), {s + "image_0/000002.png: is not there"}},
      {Remove(s + "image_0/000005.png"), {s + "image_0/000005.png: is not there"}},
      {Shrink(s + "image_0/000003.png"), {s + "image_0/000003.png: is of 160 x 120 px", "320 x 240"}},
      {Replace(s + "calib.txt", "P0: 2.6", "P0: x"), {s + "calib.txt:1: 'x", "is not a finite number"}},
      {Replace(s + "calib.txt", "P0: 2.6", "P0: 0.0"), {s + "calib.txt: P0: fx 0", "are no camera"}},
      {Replace(s + "calib.txt", "P0:", "P9:"), {s + "calib.txt: has no line 'P0: ...'"}},
      {Replace(s + "calib.txt", "\nP1", " 1\nP1"), {}},  // more numbers than are needed
      {Replace(s + "times.txt", "2.000000e-01", "5.000000e-02"),
       {s + "times.txt: the time of image_0/000002.png", "must grow"}},
      {Replace(s + "times.txt", "5.000000e-01\n", ""),
       {s + "times.txt: has 5 lines, and there is an image image_0/000005.png"}},
      {Replace("poses/04.txt", "1.000000000000e+00", "2"),
       {"poses/04.txt:1: the matrix does not begin with a rotation"}},
      {Replace("poses/04.txt", " ", ""), {"poses/04.txt:1: 11 fields; 12 are needed"}},
  };
  for (const Broken& broken : cases) {
    const std::string copy = Copy("dataset");
    broken.how(copy);
    if (broken.message.empty()) {
      EXPECT_NO_THROW(ReadKitti(Options("", copy)));
    } else {
      EXPECT_TRUE(ThrowsInputError([&] { ReadKitti(Options("", copy)); }, broken.message));
    }
  }
  const std::string copy = Copy("dataset");
  fs::remove_all(copy + "/poses");
  EXPECT_NE(ReadKitti(Options("", copy))[0].note.find("poses/04.txt is not there"), std::string::npos);
  DatasetOptions other = Options("dataset");
  other.only = {"07"};
  EXPECT_TRUE(ThrowsInputError([&] { ReadKitti(other); }, {"--sequence: '07' is not in", "there are 04"}));
}

TEST_F(Sequences, ABrokenEurocIsNamedByPath) {
  const std::string cam = "mav0/cam0/";
  const std::vector<Broken> cases = {
      {Remove("mav0"), {"/mav0: is not there"}},
      {Remove(cam + "sensor.yaml"), {cam + "sensor.yaml: is not there"}},
      {Remove(cam + "data.csv"), {cam + "data.csv: is not there"}},
      {Remove(cam + "data/1403636579813555584.png"), {cam + "data/1403636579813555584.png: is not there"}},
      {Shrink(cam + "data/1403636579813555584.png"), {"is of 160 x 120 px", "as its calibration says"}},
      {Replace(cam + "sensor.yaml", "radial-tangential", "pyramid"),
       {"sensor.yaml", "'pyramid' is not known"}},
      {Replace(cam + "sensor.yaml", "intrinsics: [260", "intrinsics: [nan"),
       {"sensor.yaml", "intrinsics: 'nan'"}},
      {Replace(cam + "sensor.yaml", "intrinsics: [260", "intrinsics: [0"), {"sensor.yaml", "are no camera"}},
      {Replace(cam + "sensor.yaml", "intrinsics", "instrinsics"), {"sensor.yaml", "intrinsics: a list"}},
      {Replace(cam + "sensor.yaml", "T_BS", "T_SB"), {"sensor.yaml", "T_BS: is missing"}},
      {Replace(cam + "sensor.yaml", "data: [", "data: [9, "),
       {"sensor.yaml", "T_BS: does not begin with a rotation"}},
      {Replace(cam + "sensor.yaml", "[", "{["), {"sensor.yaml"}},
      {Replace(cam + "data.csv", "1403636579813555584,", "1403636579763555584,"),
       {cam + "data.csv: the time of", "must grow"}},
      {Replace(cam + "data.csv", ",1403636579813555584.png", ""),
       {cam + "data.csv:3: 1 fields; 2 are needed"}},
      {Replace("mav0/state_groundtruth_estimate0/data.csv", ",0.0\n", ",0.0\n1,0,0,0,1,0,0,0\n"),
       {"data.csv:3: the time is not after"}},
      {Replace("mav0/state_groundtruth_estimate0/data.csv", "\n1", "\n1,0,0,0,2,0,0,0\n1"),
       {"data.csv:2: a quaternion of length 2"}},
  };
  for (const Broken& broken : cases) {
    const std::string copy = Copy("MH_01_easy");
    broken.how(copy);
    EXPECT_TRUE(ThrowsInputError([&] { ReadEuroc(Options("", copy)); }, broken.message));
  }
  const std::string copy = Copy("MH_01_easy");
  fs::remove_all(copy + "/mav0/state_groundtruth_estimate0");
  EXPECT_NE(ReadEuroc(Options("", copy))[0].note.find("no truth: "), std::string::npos);
}

TEST_F(Sequences, OtherBrokenFoldersAreNamedByPath) {
  const std::vector<Broken> tum = {
      {Remove("rgb.txt"), {"/rgb.txt: is not there"}},
      {Remove("rgb/1305031102.175300.png"), {"rgb/1305031102.175300.png: is not there"}},
      {Replace("rgb.txt", "1305031102.208633 ", "1305031102.1 "),
       {"rgb.txt: the time of rgb/1305031102.208633.png", "must grow"}},
      {Replace("groundtruth.txt", "1305031102.1823", "1"), {"groundtruth.txt:5: the time is not after"}},
  };
  for (const Broken& broken : tum) {
    const std::string copy = Copy("rgbd_dataset_desk");
    broken.how(copy);
    EXPECT_TRUE(ThrowsInputError([&] { ReadTum(Options("rgbd_dataset_desk", copy)); }, broken.message));
  }
  EXPECT_TRUE(ThrowsInputError([&] { ReadTum(Options("", Folder("rgbd_dataset_desk"))); }, {"give --K"}));
  DatasetOptions images = Options("corridor");
  images.distortion.pop_back();
  EXPECT_TRUE(ThrowsInputError([&] { ReadImageFolder(images); },
                               {"3 distortion coefficients; radtan has 4, 5 or 8"}));
  images.K.clear();
  EXPECT_TRUE(ThrowsInputError([&] { ReadImageFolder(images); }, {"--K: fx fy cx cy"}));
  EXPECT_TRUE(
      ThrowsInputError([&] { ReadImageFolder(Options("corridor", folder_.path())); }, {"names 0 images"}));
  EXPECT_TRUE(ThrowsInputError([&] { ReadImageFolder(Options("corridor", "/nowhere")); },
                               {"/nowhere: is not there"}));
}

// A database as COLMAP makes it, of the rendered images, and their reconstruction as text.
class Colmap : public Sequences {
 protected:
  void SetUp() override {
    fs::create_directories(folder_.Path("sparse/0"));
    SQLite::Database database(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    database.exec(
        "CREATE TABLE cameras (camera_id INTEGER PRIMARY KEY, model INTEGER, width INTEGER, height INTEGER, "
        "params BLOB, "
        "prior_focal_length INTEGER);"
        "CREATE TABLE images (image_id INTEGER PRIMARY KEY, name TEXT UNIQUE, camera_id INTEGER);"
        "CREATE TABLE keypoints (image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB);"
        "CREATE TABLE matches (pair_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB);");
    const Camera c = RenderedCamera().camera;
    const std::vector<double> k = Distorting().radtan;
    const std::vector<double> params = {c.fx, c.fy, c.cx + 0.5, c.cy + 0.5, k[0], k[1], k[2], k[3]};
    SQLite::Statement camera(database, "INSERT INTO cameras VALUES (1, 4, ?, ?, ?, 0)");
    camera.bind(1, c.width);
    camera.bind(2, c.height);
    camera.bind(3, params.data(), static_cast<int>(params.size() * sizeof(double)));
    camera.exec();
    std::ofstream model(folder_.Path("sparse/0/images.txt"));
    model << "# Image list\n";
    std::vector<Features> features;
    for (const int i : {0, 2, 4}) {
      const GreyImage image{c.width, c.height, RenderHall(Distorting(), PoseOnWalk(i))};
      features.push_back(DetectFeatures(image, {}));
      const auto id = static_cast<int>(features.size());
      const std::string name = fmt::format("frames/{}.png", i);
      SQLite::Statement row(database, "INSERT INTO images VALUES (?, ?, 1)");
      row.bind(1, id);
      row.bind(2, name);
      row.exec();
      std::vector<float> data;
      for (const KeyPoint& p : features.back().key_points)
        data.insert(data.end(), {p.x_px + 0.5f, p.y_px + 0.5f, p.size_px / 2, 0.0f});
      InsertBlob(database, "keypoints", id, data.size() / 4, 4, data.data(), data.size() * sizeof(float));
      const RenderedPose pose = PoseOnWalk(i);
      const Eigen::Quaterniond q(Eigen::Matrix3d(pose.R_world_from_cam.transpose()));
      const Eigen::Vector3d t = -(pose.R_world_from_cam.transpose() * pose.center);
      model << fmt::format("{} {} {} {} {} {} {} {} 1 {}\n\n", id, q.w(), q.x(), q.y(), q.z(), t.x(), t.y(),
                           t.z(), name);
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

  static void InsertBlob(SQLite::Database& database, const std::string& table, std::int64_t id, size_t rows,
                         int columns, const void* data, size_t num_bytes) {
    SQLite::Statement row(database, "INSERT INTO " + table + " VALUES (?, ?, ?, ?)");
    row.bind(1, id);
    row.bind(2, static_cast<std::int64_t>(rows));
    row.bind(3, columns);
    row.bind(4, data, static_cast<int>(num_bytes));
    row.exec();
  }

  testing::AssertionResult Refuses(const std::string& sql, const std::vector<std::string>& fragments) {
    const std::string copy = folder_.Path("broken.db");
    fs::copy_file(path_, copy, fs::copy_options::overwrite_existing);
    SQLite::Database(copy, SQLite::OPEN_READWRITE).exec(sql);
    return RefusesFile(copy, fragments);
  }
  static testing::AssertionResult RefusesFile(const std::string& path,
                                              const std::vector<std::string>& fragments) {
    DatasetOptions options;
    options.folder = path;
    return ThrowsInputError(
        [&] {
          const auto pairs = OpenColmap(options);
          for (size_t i = 0; i < pairs->size(); ++i) pairs->Read(i);
        },
        fragments);
  }

  std::string path_ = folder_.Path("database.db");
};

TEST_F(Colmap, ADatabaseAndItsReconstruction) {
  DatasetOptions options;
  options.folder = folder_.path();
  options.name = "hall";
  const auto pairs = OpenColmap(options);
  ASSERT_EQ(pairs->size(), 3u);
  EXPECT_EQ(pairs->IdOf(0), "hall_000001_000002");
  EXPECT_NE(pairs->Note().find("3 of 3 images"), std::string::npos) << pairs->Note();
  const std::string out = folder_.Path("out");
  PairsOptions making;
  making.out = out;
  PairJournal journal(out, "test");
  MakeListedPairs(*pairs, making, &journal);
  std::vector<PairRow> rows = journal.rows();
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].image2, "frames/2.png");
  const auto estimator = MakeEstimator("rcme_calibrated");
  for (const PairRow& row : rows) {
    ASSERT_EQ(row.reason, kKeptPair) << row.pair_id;
    const MatchFile file = ReadMatchFile(out + "/" + row.pair_id + ".csv");
    const RelativePose rendered =
        TrueMotion(PoseOnWalk(std::stod(row.image1.substr(7))), PoseOnWalk(std::stod(row.image2.substr(7))));
    EXPECT_EQ(file.camera1.cx, RenderedCamera().camera.cx);
    EXPECT_EQ(file.sigma_px.size(), file.matches.size());
    EXPECT_LT(RotationAngleBetween(file.cam2_from_cam1_true->R, rendered.R), 1e-6);
    EXPECT_LT(AngleBetween(file.cam2_from_cam1_true->t, rendered.t), 1e-5);
    RandomStream rng({.seed = 1, .purpose = 4});
    const MotionEstimate estimate = estimator->Estimate({file.matches, file.camera1, file.camera2, 0.5}, rng);
    EXPECT_LT(kDegPerRad * RotationAngleBetween(estimate.cam2_from_cam1.R, rendered.R), 0.25) << row.pair_id;
    EXPECT_LT(kDegPerRad * AngleBetween(estimate.cam2_from_cam1.t, rendered.t), 3.0) << row.pair_id;
  }
}

TEST_F(Colmap, APoseIsTheSameInTextAndBytes) {
  const std::map<std::string, CameraPose> text = ReadColmapPoses(folder_.Path("sparse/0"));
  ASSERT_EQ(text.size(), 3u);
  fs::create_directories(folder_.Path("binary"));
  std::ofstream file(folder_.Path("binary/images.bin"), std::ios::binary);
  const auto put = [&](auto number) { file.write(reinterpret_cast<const char*>(&number), sizeof(number)); };
  put(std::uint64_t{3});
  for (const auto& [name, pose] : text) {
    put(std::uint32_t{7});
    const Eigen::Quaterniond q(Eigen::Matrix3d(pose.R_world_from_cam.transpose()));
    const Eigen::Vector3d t = -(pose.R_world_from_cam.transpose() * pose.center);
    for (const double x : {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()}) put(x);
    put(std::uint32_t{1});
    file.write(name.c_str(), static_cast<std::streamsize>(name.size() + 1));
    put(std::uint64_t{2});
    for (int i = 0; i < 2; ++i) put(1.0), put(2.0), put(std::int64_t{-1});
  }
  file.close();
  const std::map<std::string, CameraPose> bytes = ReadColmapPoses(folder_.Path("binary"));
  ASSERT_EQ(bytes.size(), 3u);
  for (const auto& [name, pose] : text) {
    EXPECT_LT((bytes.at(name).R_world_from_cam - pose.R_world_from_cam).norm(), 1e-12);
    EXPECT_LT((bytes.at(name).center - pose.center).norm(), 1e-12);
  }
  const std::string whole = ReadBytes(folder_.Path("binary/images.bin"));
  for (size_t size = 0; size < whole.size(); size += 7) {
    std::ofstream(folder_.Path("binary/images.bin"), std::ios::binary) << whole.substr(0, size);
    EXPECT_TRUE(
        ThrowsInputError([&] { ReadColmapPoses(folder_.Path("binary")); }, {"images.bin: ends early"}))
        << size;
  }
  EXPECT_TRUE(ThrowsInputError([&] { ReadColmapPoses(folder_.path()); }, {"images.txt: is not there"}));
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
  EXPECT_TRUE(Refuses("DELETE FROM cameras", {"image 1: its camera 1 is not in the database"}));
  EXPECT_TRUE(
      Refuses("DELETE FROM keypoints WHERE image_id = 3", {"keypoints of image 3: are not in the database"}));
  EXPECT_TRUE(Refuses("UPDATE cameras SET model = 10", {"camera 1: model 10 is not supported"}));
  EXPECT_TRUE(
      Refuses("UPDATE cameras SET params = x'00'", {"camera 1: params holds 1 bytes; 64 are needed"}));
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

TEST_F(Sequences, MatchFilesAreJudgedAgain) {
  const std::string first = folder_.Path("first"), again = folder_.Path("again");
  PairsOptions options;
  options.gate.criterion.reset();  // all are kept
  const size_t num_pairs = Make(ReadKitti(Options("dataset")), options, first).size();
  EXPECT_EQ(num_pairs, kNumFrames - 1u);
  DatasetOptions dataset;
  dataset.folder = first;
  PairJournal journal(again, "test");
  options.out = again;
  MakeListedPairs(*OpenMatchFiles(dataset), options, &journal);
  ASSERT_EQ(journal.rows().size(), num_pairs);
  for (const fs::path& path : MatchFilesIn(first)) {
    const MatchFile one = ReadMatchFile(path.string());
    const MatchFile other = ReadMatchFile(again + "/" + path.filename().string());
    EXPECT_EQ(one.sigma_px, other.sigma_px);
    EXPECT_EQ(one.matches.back().x2_px, other.matches.back().x2_px);
    EXPECT_LT((one.cam2_from_cam1_true->t - other.cam2_from_cam1_true->t).norm(), 1e-12);
  }
  PairJournal strict(folder_.Path("strict"), "test");
  options.out = folder_.Path("strict");
  options.gate = {ModelCriterion::kGric, 100'000};
  MakeListedPairs(*OpenMatchFiles(dataset), options, &strict);
  for (const PairRow& row : strict.rows()) EXPECT_EQ(row.reason, kTooFewMatches);
  const std::string table = PairsAsTable(strict.rows(), strict.damaged());
  EXPECT_NE(table.find("too_few_matches"), std::string::npos) << table;
}

// cv::projectPoints and cv::fisheye::projectPoints of OpenCV 4.6 at (.5, -.3, 1) and (-.2, .4, 1).
TEST(Lens, DistortsAsOpenCv) {
  const Camera euroc{458.654, 457.296, 367.215, 248.375, 752, 480};
  const auto expect = [&](LensModel model, const std::vector<double>& k, const Eigen::Vector2d& first,
                          const Eigen::Vector2d& second) {
    const Lens lens = MakeLens(euroc, model, k, "");
    EXPECT_LT((ProjectThrough(lens, {0.5, -0.3}) - first).norm(), 2e-6) << ProjectThrough(lens, {0.5, -0.3});
    EXPECT_LT((ProjectThrough(lens, {-0.2, 0.4}) - second).norm(), 2e-6) << ProjectThrough(lens, {-0.2, 0.4});
  };
  expect(LensModel::kRadtan, {-0.28, 0.07, 0.02, -0.03}, {562.255779, 132.007984}, {275.043892, 428.513040});
  expect(LensModel::kRadtan, {0.1, -0.2, 0.01, 0.02, 0.3, 0.5, -0.1, 0.2}, {574.629873, 127.715124},
         {284.272171, 418.342457});
  expect(LensModel::kFisheye, {-0.1, 0.2, -0.3, 0.4}, {571.424674, 126.211974}, {282.051848, 418.196996});
}

TEST(Lens, UndistortsWhatItDistorts) {
  const Camera euroc{458.654, 457.296, 367.215, 248.375, 752, 480};
  const std::vector<Lens> lenses = {
      MakeLens(euroc, LensModel::kPinhole, {}, ""),
      MakeLens(euroc, LensModel::kRadtan, {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05}, ""),
      MakeLens(euroc, LensModel::kRadtan, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}, ""),
      MakeLens(euroc, LensModel::kRadtan, {0.1, -0.2, 0.001, 0.002, 0.03, 0.05, -0.1, 0.02}, ""),
      MakeLens(euroc, LensModel::kFisheye, {-0.01, 0.02, -0.01, 0.003}, "")};
  for (const Lens& lens : lenses) {
    for (double x = -0.6; x <= 0.6; x += 0.1) {
      for (double y = -0.4; y <= 0.4; y += 0.1) {
        const std::optional<Eigen::Vector2d> ideal = Undistort(lens, ProjectThrough(lens, {x, y}));
        ASSERT_TRUE(ideal.has_value()) << x << " " << y;
        EXPECT_LT((*ideal - euroc.Project({x, y, 1.0})).norm(), 1e-5) << x << " " << y;
      }
    }
  }
  // r (1 - .5 r^2) is .544 at most: beyond that no ray arrives, and the way back down is not taken.
  const Lens folding = MakeLens({100, 100, 0, 0, 200, 200}, LensModel::kRadtan, {-0.5, 0, 0, 0}, "");
  EXPECT_TRUE(Undistort(folding, {54.0, 0.0}).has_value());
  EXPECT_LT(Undistort(folding, {54.0, 0.0})->x(), 100.0 * std::sqrt(2.0 / 3.0));
  EXPECT_FALSE(Undistort(folding, {55.0, 0.0}).has_value());
  EXPECT_TRUE(ThrowsInputError(
      [] {
        MakeLens({1, 0, 0, 0, 1, 1}, LensModel::kPinhole, {}, "file");
      },
      {"file: fx 1, fy 0"}));
}

TEST(Trajectory, IsTakenBetweenItsPosesAndNowhereElse) {
  Trajectory trajectory;
  const CameraPose a{RotationFromVector({0, 0, 0.1}), {0, 0, 0}},
      b{RotationFromVector({0, 0, 0.3}), {2, 0, 4}};
  EXPECT_TRUE(trajectory.Add(1.0, a));
  EXPECT_TRUE(trajectory.Add(2.0, b));
  EXPECT_FALSE(trajectory.Add(2.0, b));
  EXPECT_FALSE(trajectory.Add(1.5, b));
  const std::optional<CameraPose> between = trajectory.At(1.25, 1.0);
  ASSERT_TRUE(between.has_value());
  EXPECT_LT((between->center - Eigen::Vector3d(0.5, 0, 1)).norm(), 1e-12);
  EXPECT_LT((between->R_world_from_cam - RotationFromVector({0, 0, 0.15})).norm(), 1e-12);
  EXPECT_TRUE(trajectory.At(1.0, 0.5).has_value());
  EXPECT_TRUE(trajectory.At(2.0, 0.5).has_value());
  for (const double outside : {0.999, 2.001}) EXPECT_FALSE(trajectory.At(outside, 1.0).has_value());
  EXPECT_FALSE(trajectory.At(1.5, 0.5).has_value());  // a gap
}

}  // namespace
}  // namespace rcme
