// What names the random streams of a trial: the same condition draws the same numbers in any study.
#include "experiments/study/study_plan.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "experiments/study/study_file.h"
#include "parameters/input_error.h"
#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

StudyPlan PlanOfText(std::string text) {
  text += "estimators: [{name: standard}]\n";
  return MakePlan(ParseStudy(text, "study.yaml"));
}

// The key of the condition with these levels.
std::uint64_t FindStreamKey(const StudyPlan& plan, const std::vector<std::string>& levels) {
  for (const Condition& condition : plan.conditions) {
    if (condition.levels == levels) return condition.stream_key;
  }
  ADD_FAILURE() << "no such condition";
  return 0;
}

std::vector<std::uint64_t> ListStreamKeys(const StudyPlan& plan) {
  std::vector<std::uint64_t> keys;
  for (const Condition& condition : plan.conditions) keys.push_back(condition.stream_key);
  return keys;
}

TEST(StreamKey, IsTheSameInEveryStudyThatHoldsTheCondition) {
  const StudyPlan plan = PlanOfText(
      "data: {scene: uniform_volume, num_matches: 60}\n"
      "factors: {outlier_ratio: [0.1, 0.5], sigma_px: [0.5, 1]}\n");
  const StudyPlan more_levels = PlanOfText(
      "data: {scene: uniform_volume, num_matches: 60}\n"
      "factors: {outlier_ratio: [0, 0.1, 0.3, 0.5], sigma_px: [1, 0.5]}\n");
  const StudyPlan other_order = PlanOfText(
      "data: {scene: uniform_volume, num_matches: 60}\n"
      "factors: {sigma_px: [0.50, 1.0], outlier_ratio: [0.5, 0.10]}\n");
  const StudyPlan fixed = PlanOfText(
      "data: {sigma_px: 1, scene: uniform_volume, outlier_ratio: 0.5, num_matches: 60, noise: gaussian}\n");
  const std::uint64_t key = FindStreamKey(plan, {"0.5", "1"});
  EXPECT_EQ(key, FindStreamKey(more_levels, {"0.5", "1"}));
  EXPECT_EQ(key, FindStreamKey(other_order, {"1", "0.5"}));
  EXPECT_EQ(key, fixed.conditions.front().stream_key);
}

TEST(StreamKey, DiffersBetweenConditions) {
  const StudyPlan plan = PlanOfText(
      "data: {num_matches: 60}\n"
      "factors: {scene: [uniform_volume, room], outlier_ratio: [0.1, 0.5], sigma_px: [0.5, 1]}\n");
  const std::vector<std::uint64_t> keys = ListStreamKeys(plan);
  EXPECT_EQ(std::set(keys.begin(), keys.end()).size(), 8u);
  for (const std::uint64_t key : keys) EXPECT_LT(key, 1ULL << 48);
}

TEST(StreamKey, DoesNotDependOnWhatIsOnlyMeasured) {
  EXPECT_EQ(ListStreamKeys(PlanOfText("data: {scene: room, severity: skipped}\n")),
            ListStreamKeys(PlanOfText("data: {scene: room, severity: measured}\n")));
}

TEST(CommonScenes, AreThoseOfAllLevelsThatDoNotShapeTheScene) {
  const StudyPlan plan = PlanOfText(
      "common_scenes: true\ndata: {scene: uniform_volume}\n"
      "factors: {num_matches: [60, 80], outlier_ratio: [0.1, 0.5], sigma_px: [0.5, 1]}\n");
  const std::vector<std::uint64_t> keys = ListStreamKeys(plan);
  EXPECT_EQ(std::set(keys.begin(), keys.begin() + 4).size(), 1u);
  EXPECT_EQ(std::set(keys.begin() + 4, keys.end()).size(), 1u);
  EXPECT_NE(keys.front(), keys.back());
}

// The same trial at three noise levels, the first as good as none: the noise of the third is twice that of
// the second, match by match.
TEST(CommonScenes, PairTheNoiseOfTwoLevels) {
  const StudyPlan plan = PlanOfText(
      "common_scenes: true\ndata: {scene: uniform_volume, num_matches: 60, outlier_ratio: 0}\n"
      "factors: {sigma_px: [1e-9, 0.5, 1]}\n");
  for (std::uint32_t trial = 0; trial < 5; ++trial) {
    std::vector<std::vector<Correspondence>> matches;
    for (const Condition& condition : plan.conditions) {
      matches.push_back(condition.source->Make(NameOfTrial(plan, condition, trial)).problem.matches);
    }
    for (size_t i = 0; i < 60; ++i) {
      const Eigen::Vector2d once = matches[1][i].x2_px - matches[0][i].x2_px,
                            twice = matches[2][i].x2_px - matches[0][i].x2_px;
      EXPECT_GT(once.norm(), 1e-3);
      EXPECT_LT((twice - 2.0 * once).norm(), 1e-6);
    }
  }
}

TEST(CommonScenes, AreRefusedWhereThereAreNone) {
  try {
    PlanOfText("common_scenes: true\ndata: {scene: match_files, folder: no_such_folder}\n");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("common_scenes: ")) << error.what();
  }
}

TEST(CommonScenes, AreNoneOfTheDrawsOfAPopulation) {
  EXPECT_TRUE(ThrowsInputError(
      [] {
        PlanOfText(
            "common_scenes: true\ndata: {scene: uniform_volume}\n"
            "conditions: {number: 2, ranges: {sigma_px: [0.3, 0.5]}}\n");
      },
      {"common_scenes: ", "population", "leave it out"}));
}

TEST(CommonScenes, SurviveTheStudysOwnText) {
  const Study study =
      ParseStudy("common_scenes: true\ndata: {scene: room}\nestimators: [{name: standard}]\n", "study.yaml");
  EXPECT_TRUE(study.common_scenes);
  EXPECT_TRUE(ParseStudy(ToYaml(study), "study.yaml").common_scenes);
}

}  // namespace
}  // namespace rcme
