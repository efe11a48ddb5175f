#include "experiments/tuning/setting_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/tuned_study.h"

namespace rcme {
namespace {

SettingPlan PlanWith(const std::string& options) {
  return MakeTunedSettings(TunedPlan("  options: {" + options + "}\n"));
}

TEST(SettingPlan, TheFirstOptionIsTheSlowest) {
  const SettingPlan plan = PlanWith("lambda: [0.5, 1], mu: [2, 4, 6]");
  ASSERT_EQ(plan.settings.size(), 6u);
  EXPECT_EQ(plan.settings[1].levels, (std::vector<std::string>{"0.5", "4"}));
  EXPECT_EQ(plan.settings[3].levels, (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(ReadOption(plan.settings[3].spec, "lambda"), "1");
  EXPECT_EQ(ReadOption(plan.settings[3].spec, "mu"), "2");
  EXPECT_EQ(plan.settings[3].spec.label, "ours");
  EXPECT_EQ(ReadOption(plan.settings[3].spec, "num_iterations"), "20") << "what is not tuned is the study's";
}

TEST(SettingPlan, DecisionOptionsShareOneTrace) {
  const SettingPlan plan = PlanWith(
      "mu: [2, 4], quality_test: [as_printed, level_alpha], lambda: [0.5, 1], inlier_ratio: [inferred, 0.5],"
      "selection: [mean_entropy, predictive_likelihood], early_stop_entropy: [off, 1], "
      "num_iterations: [10, 30, 20]");
  ASSERT_EQ(plan.groups.size(), 1u);
  EXPECT_EQ(plan.groups[0].settings.size(), 2u * 2 * 2 * 2 * 2 * 2 * 3);
}

// Every option that is no decision option makes a trace of its own.
TEST(SettingPlan, OtherOptionsDoNotShareATrace) {
  for (const char* option :
       {"significance_level: [0.01, 0.05]", "sample_significance_level: [significance_level, 0.01]",
        "kappa: [0.1, 0.9]", "reading: [as_printed, rank_aware]", "refinement: [none, mle]",
        "implementation: [fast, reference]", "refinement_error: [sampson, reprojection]"}) {
    const SettingPlan plan = PlanWith(option + std::string(", mu: [2, 4, 6]"));
    ASSERT_EQ(plan.groups.size(), 2u) << option;
    std::set<size_t> all;
    for (const TraceGroup& group : plan.groups) {
      EXPECT_EQ(group.settings.size(), 3u) << option;
      all.insert(group.settings.begin(), group.settings.end());
    }
    EXPECT_EQ(all.size(), 6u) << option;
  }
}

TEST(SettingPlan, WithoutItsLimitsASettingIsSharedByThoseThatDifferInLimitsAlone) {
  const SettingPlan plan = PlanWith(
      "mu: [2, 4], inlier_ratio: [inferred, 0.5], least_explained_share: [0, 0.5], lambda: [0.5, 1]");
  std::set<const MotionEstimator*> distinct;
  for (const auto& estimator : plan.without_limits) distinct.insert(estimator.get());
  EXPECT_EQ(distinct.size(), 2u);
  EXPECT_EQ(plan.without_limits[0], plan.without_limits[14]);
  EXPECT_NE(plan.without_limits[0], plan.without_limits[1]);
}

TEST(SettingPlan, TheTraceHasAsManyHypothesesAsAnySettingLooksAt) {
  const StudyPlan study = TunedPlan("  options: {num_iterations: [10, 30, 20], early_stop_entropy: [50]}\n");
  const SettingPlan plan = MakeTunedSettings(study);
  ASSERT_EQ(plan.groups.size(), 1u);
  const StreamName name{1, 0, 0, 0};
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  const MotionProblem problem = study.conditions[0].source->Make(name).problem;
  EXPECT_EQ(plan.groups[0].tracer->Trace(problem, rng).hypotheses.size(), 30u);
}

TEST(SettingPlan, AnEstimatorThatIsNotInTheStudy) {
  const Study study = TunedPlan("  options: {mu: [2]}\n").study;
  Tuning tuning = *study.tuning;
  tuning.estimator = "theirs";
  EXPECT_TRUE(
      ThrowsInputError([&] { MakeSettingPlan(study, tuning); }, {"tune", "'theirs'", "standard, ours"}));
}

}  // namespace
}  // namespace rcme
