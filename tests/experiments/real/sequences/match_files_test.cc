// A folder of match files as a data set: what it says of its directions, and what is written of its motions.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "experiments/data/match_folder.h"
#include "experiments/real/sequences/listed_pairs.h"
#include "experiments/real/sequences/make_pairs.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/temp_folder.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

void WriteTwoPairs(const TempFolder& folder) {
  for (const std::uint32_t trial : {1u, 2u}) {
    RelativePose pose;
    const MotionProblem problem = TwoCameraProblem(150, 0.3, 0.0, trial, &pose);
    MatchFile file;
    file.scene = "hall";
    file.camera1 = problem.camera1;
    file.camera2 = problem.camera2;
    file.matches = problem.matches;
    pose.R = RotationFromVector({0.0, 0.1 * trial, 0.0});
    file.cam2_from_cam1_true = pose;
    WriteMatchFile(file, folder.Path("pair" + std::to_string(trial) + ".csv"));
  }
}

TEST(OpenMatchFiles, KnowsWeakDirections) {
  const TempFolder folder;
  WriteTwoPairs(folder);
  folder.Write("INDEX.csv", "pair_id,t_gt_weak\npair1,0\npair2,1\n");
  DatasetOptions options;
  options.folder = folder.path();
  const auto pairs = OpenMatchFiles(options);
  ASSERT_EQ(pairs->size(), 2u);
  EXPECT_EQ(pairs->PairId(1), "pair2");
  EXPECT_FALSE(pairs->Read(0).is_direction_weak);
  EXPECT_TRUE(pairs->Read(1).is_direction_weak);
}

// The rotation of a pair's true motion stands in its row in degrees: 0.1 and 0.2 rad.
TEST(MakeListedPairs, StatesTheTrueRotation) {
  const TempFolder folder, out;
  WriteTwoPairs(folder);
  DatasetOptions dataset;
  dataset.folder = folder.path();
  PairsOptions options;
  options.out = out.Path("pairs");
  options.gate.criterion.reset();
  PairJournal journal(options.out, "test");
  MakeListedPairs(*OpenMatchFiles(dataset), options, &journal);
  ASSERT_EQ(journal.rows().size(), 2u);
  EXPECT_NEAR(journal.rows()[0].rotation_deg, 5.7295780, 1e-4);
  EXPECT_NEAR(journal.rows()[1].rotation_deg, 11.459156, 1e-4);
  EXPECT_FALSE(journal.rows()[0].num_inliers.has_value());  // nothing was judged: all are kept
}

// The length of a true motion is kept, and a source that changed after its pair was made is named.
TEST(MakeListedPairs, KeepsBaselinesAndNoticesNewerSources) {
  const TempFolder folder, out;
  WriteTwoPairs(folder);
  MatchFile file = ReadMatchFile(folder.Path("pair1.csv"));
  file.baseline = 0.83;
  WriteMatchFile(file, folder.Path("pair1.csv"));
  DatasetOptions dataset;
  dataset.folder = folder.path();
  PairsOptions options;
  options.out = out.Path("pairs");
  options.gate.criterion.reset();
  const auto make = [&] {
    PairJournal journal(options.out, "test");
    MakeListedPairs(*OpenMatchFiles(dataset), options, &journal);
    return journal.rows();
  };
  EXPECT_EQ(make()[0].baseline, 0.83);
  EXPECT_EQ(ReadMatchFile(options.out + "/pair1.csv").baseline, 0.83);
  EXPECT_NO_THROW(make());
  std::filesystem::last_write_time(
      folder.Path("pair2.csv"),
      std::filesystem::last_write_time(options.out + "/pair2.csv") + std::chrono::seconds(2));
  EXPECT_TRUE(ThrowsInputError(make, {"pair2.csv: is newer than", "give another --out"}));
}

}  // namespace
}  // namespace rcme
