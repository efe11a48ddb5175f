// What the tests of every layout of data sets do: render it once, read it, make pairs of it, and break copies
// of it.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "estimator/estimator_registry.h"
#include "estimator/geometry/essential_matrix.h"
#include "experiments/data/match_folder.h"
#include "experiments/real/sequences/layouts.h"
#include "experiments/real/sequences/make_pairs.h"
#include "stats/constants.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/rendered_sequence.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {

constexpr int kNumRenderedFrames = 6;

inline RenderedCamera DistortingCamera() {
  RenderedCamera camera;
  camera.radtan = {-0.28, 0.07, 0.0004, -0.0003};
  return camera;
}
inline RenderedCamera FisheyeCamera() {
  RenderedCamera camera;
  camera.fisheye = {-0.02, 0.01, -0.004, 0.001};
  return camera;
}

inline DatasetOptions MakeDatasetOptions(const std::string& folder, const std::vector<double>& K = {}) {
  DatasetOptions options;
  options.folder = folder;
  options.K = K;
  return options;
}

// A data set of a layout in the folder NAME, rendered when a test first asks for it; tests that break it do
// it to a copy.
class DatasetTest : public testing::Test {
 protected:
  using Writer = std::function<void(const std::string& folder)>;
  DatasetTest(std::string name, Writer write) : name_(std::move(name)), write_(std::move(write)) {}

  std::string Folder() const {
    static const TempFolder rendered;
    const std::string folder = rendered.Path(name_);
    if (!std::filesystem::exists(folder)) write_(folder);
    return folder;
  }
  std::string Copy() const {
    const std::string copy = folder_.Path(name_);
    std::filesystem::remove_all(copy);
    std::filesystem::copy(Folder(), copy, std::filesystem::copy_options::recursive);
    return copy;
  }

  TempFolder folder_;

 private:
  std::string name_;
  Writer write_;
};

inline std::vector<PairRow> MakePairsInto(const std::string& out, const std::vector<Sequence>& sequences,
                                          PairsOptions options = {}) {
  options.out = out;
  PairJournal journal(out, "test");
  MakePairsOfImages(sequences, options, &journal);
  WritePairTables(journal, {}, out);
  return journal.rows();
}

// The motion between the two rendered frames whose numbers end a pair's name.
inline RelativePose ComputeRenderedMotion(const std::string& pair_id) {
  const std::string end = pair_id.substr(pair_id.size() - 13);
  return TrueMotion(PoseOnWalk(std::stod(end.substr(0, 6))), PoseOnWalk(std::stod(end.substr(7))));
}

// The estimated rotation is the rendered one to within .25 degrees, the direction to within 3 (key points err
// by some tenths of a pixel at f = 260 px).
inline void ExpectTheMotion(const MatchFile& file, const RelativePose& rendered, const std::string& pair_id) {
  RandomStream rng({.seed = 1, .purpose = 4});
  const MotionEstimate estimate =
      MakeEstimator("rcme_calibrated")->Estimate({file.matches, file.camera1, file.camera2, 0.5}, rng);
  ASSERT_EQ(estimate.status, MotionStatus::kOk) << pair_id;
  EXPECT_LT(kDegPerRad * RotationAngleBetween(estimate.cam2_from_cam1.R, rendered.R), 0.25) << pair_id;
  EXPECT_LT(kDegPerRad * AngleBetween(estimate.cam2_from_cam1.t, rendered.t), 3.0) << pair_id;
}

// The matches of each pair that was kept, and the motion that they give, are those that was rendered.
inline void ExpectTheRenderedMotions(const std::vector<PairRow>& rows, const std::string& out) {
  int num_kept = 0;
  for (const PairRow& row : rows) {
    if (row.reason != kKeptPair) continue;
    ++num_kept;
    const MatchFile file = ReadMatchFile(out + "/" + row.pair_id + ".csv");
    const RelativePose rendered = ComputeRenderedMotion(row.pair_id);
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
    ExpectTheMotion(file, rendered, row.pair_id);
  }
  EXPECT_GE(num_kept, 2);
}

// The truth of the files is what was rendered, to within these angles.
inline void ExpectTheRenderedTruth(const std::vector<PairRow>& rows, const std::string& out,
                                   double within_deg) {
  for (const PairRow& row : rows) {
    if (row.reason != kKeptPair) continue;
    const MatchFile file = ReadMatchFile(out + "/" + row.pair_id + ".csv");
    const RelativePose rendered = ComputeRenderedMotion(row.pair_id);
    ASSERT_TRUE(file.cam2_from_cam1_true.has_value()) << row.pair_id;
    EXPECT_LT(kDegPerRad * RotationAngleBetween(file.cam2_from_cam1_true->R, rendered.R), within_deg);
    EXPECT_LT(kDegPerRad * AngleBetween(file.cam2_from_cam1_true->t, rendered.t), within_deg);
  }
}

// One way of changing a data set, and what is to be said; nothing: it is read as before.
struct Change {
  std::function<void(const std::string& folder)> how;
  std::vector<std::string> message;
};
inline std::function<void(const std::string&)> Remove(const std::string& path) {
  return [=](const std::string& folder) { std::filesystem::remove_all(folder + "/" + path); };
}
inline void Overwrite(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}
// Once, or wherever it stands.
enum class Where { kFirst, kAll };
inline std::function<void(const std::string&)> Replace(const std::string& path, const std::string& from,
                                                       const std::string& to, Where where = Where::kFirst) {
  return [=](const std::string& folder) {
    std::string text = ReadBytes(folder + "/" + path);
    size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << path << " does not hold " << from;
    for (; at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
      if (where == Where::kFirst) break;
    }
    Overwrite(folder + "/" + path, text);
  };
}
inline std::function<void(const std::string&)> WriteInstead(const std::string& path,
                                                            const std::string& text) {
  return [=](const std::string& folder) { Overwrite(folder + "/" + path, text); };
}
inline std::function<void(const std::string&)> ShrinkImage(const std::string& path) {
  return [=](const std::string& folder) {
    WriteImage(folder + "/" + path, {1, 1, 0, 0, 160, 120}, std::vector<std::uint8_t>(160 * 120));
  };
}

}  // namespace rcme
