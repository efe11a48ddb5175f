// Scenes that are met several times (Study::repeats_per_scene): what repeats share, and what they do not.
#include <gtest/gtest.h>

#include <string>

#include "experiments/run/run_until.h"
#include "experiments/statistics/trial_output.h"
#include "experiments/study/run_description.h"
#include "experiments/study/study_file.h"
#include "experiments/trial/trial.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

StudyPlan PlanWithRepeats(int repeats_per_scene) {
  Study study = SmallStudy();
  study.repeats_per_scene = repeats_per_scene;
  return MakePlan(study);
}

std::vector<Correspondence> DrawMatches(const StudyPlan& plan, std::uint32_t trial) {
  return RunTrial(plan, plan.conditions[1], trial).data.problem.matches;
}

// Trial k meets the scene that trial k / R meets in a study without repeats, with the samples that trial k
// draws there.
TEST(RepeatsPerScene, ShareTheSceneAndNotTheSamples) {
  const StudyPlan single = PlanWithRepeats(1), triple = PlanWithRepeats(3);
  for (std::uint32_t trial = 0; trial < 9; ++trial) {
    const TrialResult repeat = RunTrial(triple, triple.conditions[1], trial);
    const TrialResult scene = RunTrial(single, single.conditions[1], trial / 3);
    EXPECT_EQ(repeat.problem.trial, trial);
    EXPECT_EQ(repeat.problem.severity.crb_rotation_deg, scene.problem.severity.crb_rotation_deg);
    const std::vector<Correspondence>&matches = repeat.data.problem.matches,
          expected = scene.data.problem.matches;
    ASSERT_EQ(matches.size(), expected.size());
    for (size_t i = 0; i < matches.size(); ++i) {
      EXPECT_EQ(matches[i].x1_px, expected[i].x1_px);
      EXPECT_EQ(matches[i].x2_px, expected[i].x2_px);
    }
    RandomStream rng = StreamFor(NameOfTrial(single, single.conditions[1], trial), StreamPurpose::kSampling);
    const MotionEstimate estimate = single.estimators[0]->Estimate(scene.data.problem, rng);
    EXPECT_EQ(repeat.estimates[0].cam2_from_cam1.R, estimate.cam2_from_cam1.R);
  }
  EXPECT_NE(DrawMatches(triple, 2)[0].x1_px, DrawMatches(triple, 3)[0].x1_px) << "another scene";
  EXPECT_NE(RunTrial(triple, triple.conditions[1], 0).estimates[0].cam2_from_cam1.R,
            RunTrial(triple, triple.conditions[1], 1).estimates[0].cam2_from_cam1.R)
      << "other samples";
}

TEST(RepeatsPerScene, OfOneAreNoChange) {
  EXPECT_EQ(PlanWithRepeats(1).identity, MakePlan(SmallStudy()).identity);
  EXPECT_NE(PlanWithRepeats(2).identity, MakePlan(SmallStudy()).identity);
  EXPECT_EQ(Describe(PlanWithRepeats(2)).repeats_per_scene, 2);
}

TEST(RepeatsPerScene, AreAKeyOfTheStudy) {
  const auto parse = [](const std::string& repeats) {
    return ParseStudy("repeats_per_scene: " + repeats + "\n" + SmallStudyYaml(), "study.yaml");
  };
  EXPECT_EQ(parse("10").repeats_per_scene, 10);
  EXPECT_EQ(ParseStudy(ToYaml(parse("10")), "study.yaml").repeats_per_scene, 10);
  for (const std::string bad : {"0", "-1", "10001", "1.5", "many"})
    EXPECT_TRUE(ThrowsInputError([&] { parse(bad); }, {"study.yaml", "repeats_per_scene", "[1, 10000]"}));
}

TEST(RepeatsPerScene, LeaveNothingToStopBy) {
  const TempFolder folder;
  const StudyPlan plan = PlanWithRepeats(2);
  ResultStore store = ResultStore::OpenForRun(folder.Path("run"), plan);
  EXPECT_TRUE(ThrowsInputError([&] { RunUntil(plan, {}, &store); }, {"--until", "repeats_per_scene"}));
  EXPECT_TRUE(store.Description().stopping_rule.empty());
  EXPECT_EQ(store.Description().repeats_per_scene, 2);
}

}  // namespace
}  // namespace rcme
