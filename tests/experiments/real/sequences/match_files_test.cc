// A folder of match files as a data set: what it says of its directions, and what is written of its motions.
#include <gtest/gtest.h>

#include <fstream>

#include "experiments/data/match_folder.h"
#include "experiments/real/sequences/listed_pairs.h"
#include "experiments/real/sequences/make_pairs.h"
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
  EXPECT_EQ(journal.rows()[0].num_inliers, 0);  // nothing was judged: all are kept
}

}  // namespace
}  // namespace rcme
