#include "experiments/real/truth_free/pair_set.h"

#include <gtest/gtest.h>

#include "experiments/data/match_file.h"
#include "experiments/real/truth_free/loops.h"
#include "experiments/trial/trial.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// Files of two scenes in one folder: a set for each, named as the files say, whose problems are the files'.
TEST(PairSetsOfFolder, AreTheScenesOfItsFiles) {
  const TempFolder folder;
  for (const auto& [name, scene, trial] :
       {std::tuple{"p1.csv", "yard", 1u}, {"p2.csv", "hall", 2u}, {"p3.csv", "yard", 3u}}) {
    const MotionProblem problem = TwoCameraProblem(8 + static_cast<int>(trial), 0.5, 0.0, trial);
    MatchFile file;
    file.scene = scene;
    file.image1 = std::string(name) + "_1";
    file.image2 = std::string(name) + "_2";
    file.camera1 = problem.camera1;
    file.camera2 = problem.camera2;
    file.matches = problem.matches;
    WriteMatchFile(file, folder.Path(name));
  }
  const std::vector<PairSet> sets = PairSetsOfFolder(folder.path(), 0.7);
  ASSERT_EQ(sets.size(), 2u);
  EXPECT_EQ(sets[0].name, "hall");
  EXPECT_EQ(sets[1].name, "yard");
  ASSERT_EQ(sets[0].pairs.size(), 1u);
  ASSERT_EQ(sets[1].pairs.size(), 2u);
  EXPECT_EQ(sets[0].pairs[0].name, "p2.csv");
  EXPECT_EQ(sets[1].pairs[1].name, "p3.csv");
  EXPECT_EQ(sets[1].pairs[1].image1, "p3.csv_1");
  EXPECT_EQ(sets[1].pairs[1].image2, "p3.csv_2");
  EXPECT_EQ(sets[1].pairs[1].problem.matches.size(), 11u);
  EXPECT_EQ(sets[1].pairs[1].problem.sigma_px, 0.7);
}

// Of a study the pairs are its trials: as many as each condition has, and no two alike.
TEST(PairSetsOfStudy, AreTheTrialsOfItsConditions) {
  const StudyPlan plan = MakePlan(SmallStudy());
  const std::vector<PairSet> sets = PairSetsOfStudy(plan);
  ASSERT_EQ(sets.size(), 2u);
  EXPECT_NE(sets[0].name, sets[1].name);
  for (size_t c = 0; c < 2; ++c) {
    ASSERT_EQ(sets[c].pairs.size(), 6u);
    for (std::uint32_t trial = 0; trial < 6; ++trial) {
      const MotionProblem expected = RunTrial(plan, plan.conditions[c], trial).data.problem;
      const MotionProblem& found = sets[c].pairs[trial].problem;
      ASSERT_EQ(found.matches.size(), expected.matches.size());
      EXPECT_EQ(found.matches[3].x1_px, expected.matches[3].x1_px) << c << " " << trial;
      EXPECT_EQ(found.matches[3].x2_px, expected.matches[3].x2_px) << c << " " << trial;
    }
  }
}

// Each trial of four images is five pairs that name its images, and shares none with another trial.
TEST(SequencesOfStudy, NameTheImagesOfEachTrial) {
  const std::vector<PairSet> sets = SequencesOfStudy(MakePlan(SmallStudy()), 4);
  ASSERT_EQ(sets.size(), 2u);
  ASSERT_EQ(sets[0].pairs.size(), 30u);
  EXPECT_EQ(sets[0].pairs[0].image1, "trial 000000 image 00");
  EXPECT_EQ(sets[0].pairs[0].image2, "trial 000000 image 01");
  EXPECT_EQ(sets[0].pairs[4].image1, "trial 000000 image 00");
  EXPECT_EQ(sets[0].pairs[4].image2, "trial 000000 image 03");
  EXPECT_EQ(sets[0].pairs[5].image1, "trial 000001 image 00");
  EXPECT_EQ(FindLoopsOfLength(sets[0].pairs, 4).size(), 6u);
}

TEST(SequencesOfStudy, RefusesRealPairs) {
  const TempFolder folder;
  const MotionProblem problem = TwoCameraProblem(20, 0.5, 0.0, 1);
  MatchFile file;
  file.camera1 = problem.camera1;
  file.camera2 = problem.camera2;
  file.matches = problem.matches;
  WriteMatchFile(file, folder.Path("pair.csv"));
  Study study = SmallStudy();
  study.factors.clear();
  study.data = {{"scene", "match_files"}, {"folder", folder.path()}};
  EXPECT_THROW(SequencesOfStudy(MakePlan(study), 4), InputError);
}

}  // namespace
}  // namespace rcme
