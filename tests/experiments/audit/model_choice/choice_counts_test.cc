#include "experiments/audit/model_choice/choice_counts.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/in_memory.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

// Four conditions of four kinds, quick to run.
Study KindsStudy() {
  return ParseStudy(
      "name: kinds\n"
      "seed: 3\n"
      "trials: 5\n"
      "data: {num_matches: 80, sigma_px: 0.5, outlier_ratio: 0.1}\n"
      "factors:\n"
      "  scene: [uniform_volume, plane]\n"
      "  motion: [general, pure_rotation]\n"
      "estimators:\n"
      "  - {name: standard}\n",
      "kinds.yaml");
}

std::int64_t Sum(const ConfusionMatrix& matrix) {
  std::int64_t sum = 0;
  for (const auto& row : matrix) sum = std::accumulate(row.begin(), row.end(), sum);
  return sum;
}

// One trial after the other, from the exact scene and one call per criterion.
TEST(CountChoices, AreThoseOfSingleTrials) {
  const StudyPlan plan = MakePlan(KindsStudy());
  std::vector<ConfusionMatrix> expected(CriterionNames().size());
  for (const Condition& condition : plan.conditions) {
    for (std::uint32_t trial = 0; trial < 5; ++trial) {
      const StreamName name = NameOfTrial(plan, condition, trial);
      const TrialData data = condition.source->Make(name);
      const bool is_rotation = condition.levels[1] == "pure_rotation";
      const TrueKind kind = is_rotation                      ? TrueKind::kRotationOnly
                            : condition.levels[0] == "plane" ? TrueKind::kPlanar
                                                             : TrueKind::kGeneral;
      for (size_t c = 0; c < expected.size(); ++c) {
        RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
        const ModelChoice choice = ChooseModel(data.problem, {.criterion = CriterionNames()[c].second}, rng);
        const size_t answer =
            choice.status == MotionStatus::kOk ? static_cast<size_t>(choice.verdict) : kSceneVerdicts.size();
        ++expected[c][static_cast<size_t>(kind)][answer];
      }
    }
  }
  for (const int num_threads : {1, 3}) {
    const ChoiceCounts counts = CountChoicesInMemory(plan, {}, num_threads);
    ASSERT_EQ(counts.groups.size(), 1u);
    EXPECT_TRUE(counts.groups[0].levels.empty());
    EXPECT_EQ(counts.groups[0].matrices, expected) << num_threads;
  }
}

TEST(CountChoices, GroupsAreThoseOfTheFactors) {
  const StudyPlan plan = MakePlan(KindsStudy());
  const ConfusionMatrix all = CountChoicesInMemory(plan, {}, 1).groups[0].matrices[1];
  const ChoiceCounts counts = CountChoicesInMemory(plan, {"motion"}, 1);
  ASSERT_EQ(counts.groups.size(), 2u);
  EXPECT_EQ(counts.groups[0].levels, (std::vector<std::string>{"general"}));
  EXPECT_EQ(counts.groups[1].levels, (std::vector<std::string>{"pure_rotation"}));
  const ConfusionMatrix& general = counts.groups[0].matrices[1];
  const ConfusionMatrix& rotation = counts.groups[1].matrices[1];
  EXPECT_EQ(Sum(general), 10);
  EXPECT_EQ(Sum(rotation), 10);
  const auto row_of_rotations = static_cast<size_t>(TrueKind::kRotationOnly);
  for (size_t kind = 0; kind < kTrueKinds.size(); ++kind) {
    EXPECT_EQ(kind == row_of_rotations ? rotation[kind] : general[kind], all[kind]);
  }
}

// A match whose truth is "wrong" says nothing about the scene: of wrong matches alone the kind is unknown.
TEST(CountChoices, TheTruthIsThatOfTheRightMatches) {
  Study study = KindsStudy();
  for (auto& [key, value] : study.data) {
    if (key == "outlier_ratio") value = "1";
  }
  const ConfusionMatrix matrix = CountChoicesInMemory(MakePlan(study), {}, 1).groups[0].matrices[0];
  const auto& row = matrix[static_cast<size_t>(TrueKind::kBorderline)];
  EXPECT_EQ(std::accumulate(row.begin(), row.end(), std::int64_t{0}), 20);
}

TEST(CountChoices, SaysWhatCannotBeScored) {
  const auto refusal = [](auto change, const std::vector<std::string>& by = {}) {
    Study study = KindsStudy();
    change(study);
    return [study, by] { CountChoicesInMemory(MakePlan(study), by, 1); };
  };
  EXPECT_TRUE(ThrowsInputError(refusal([](Study&) {}, {"outlier_ratio"}),
                               {"--by outlier_ratio", "no such factor", "scene, motion"}));
  EXPECT_TRUE(ThrowsInputError(refusal([](Study& s) { s.repeats_per_scene = 2; }), {"repeats_per_scene"}));
  EXPECT_TRUE(ThrowsInputError(refusal([](Study& s) { s.common_scenes = true; }), {"common_scenes"}));
  EXPECT_TRUE(ThrowsInputError(refusal([](Study& s) {
                                 s.data.emplace_back("outlier_count", "bernoulli");
                                 s.data.emplace_back("tilted_to", "0.3");
                               }),
                               {"tilted_to"}));
}

}  // namespace
}  // namespace rcme
