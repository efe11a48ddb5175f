#include "estimator/model_choice/gate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "estimator/estimator_registry.h"
#include "estimator/loop_inspection.h"
#include "estimator/model_choice/verdict.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/family_problem.h"
#include "tests/test_support/option_checks.h"

namespace rcme {
namespace {

MotionEstimate AskGate(const std::string& estimator, const Settings& options, const MotionProblem& problem) {
  RandomStream rng({.seed = 1, .purpose = 4});
  return MakeEstimator(estimator, options)->Estimate(problem, rng);
}

TEST(Gate, IsOffByDefaultAndThenNotThere) {
  const std::unique_ptr<MotionEstimator> estimator = MakeEstimator("standard", {});
  EXPECT_NE(FindInspection(*estimator), nullptr);
  EXPECT_EQ(FindInspection(*MakeEstimator("standard", {{"model_choice", "gic"}})), nullptr);
}

TEST(Gate, WhatItLetsThroughIsTheAnswerWithoutIt) {
  const MotionProblem problem = ProblemFamily("uniform_volume", "general", 200, 0.2).Make(0);
  for (const auto& [name, criterion] : CriterionNames()) {
    for (const char* estimator : {"standard", "rcme"}) {
      const MotionEstimate with = AskGate(estimator, {{"model_choice", name}}, problem);
      ASSERT_EQ(with.status, MotionStatus::kOk) << with.message;
      EXPECT_EQ(ListEstimateNumbers(with), ListEstimateNumbers(AskGate(estimator, {}, problem))) << name;
    }
  }
}

TEST(Gate, RefusesByTheVerdict) {
  const MotionProblem plane = ProblemFamily("plane", "general", 200, 0.2).Make(0);
  const MotionProblem rotation = ProblemFamily("uniform_volume", "pure_rotation", 200, 0.2).Make(0);
  const auto status = [](const MotionProblem& problem, Settings options) {
    options.emplace_back("solver", "five_point");
    options.emplace_back("refinement", "none");  // which refuses a rotation itself, more often than not
    const MotionEstimate estimate = AskGate("standard", options, problem);
    if (estimate.status != MotionStatus::kOk) {
      EXPECT_TRUE(estimate.inliers.empty());
      EXPECT_FALSE(estimate.message.empty());
      EXPECT_GT(estimate.counts.num_hypotheses, 0);
    }
    return estimate.status;
  };
  EXPECT_EQ(status(plane, {}), MotionStatus::kOk);
  EXPECT_EQ(status(plane, {{"model_choice", "gic"}}), MotionStatus::kPlanarScene);
  EXPECT_EQ(status(plane, {{"model_choice", "aic"}}), MotionStatus::kOk);
  EXPECT_EQ(status(plane, {{"model_choice", "gic"}, {"planar_scenes", "answered"}}), MotionStatus::kOk);
  EXPECT_EQ(status(plane, {{"model_choice", "gic"}, {"least_parallax_share", "1"}}),
            MotionStatus::kTooLittleParallax);
  EXPECT_EQ(status(rotation, {}), MotionStatus::kOk);
  EXPECT_EQ(status(rotation, {{"model_choice", "gric"}}), MotionStatus::kRotationOnly);
  EXPECT_EQ(status(rotation, {{"model_choice", "orb_slam2"}}), MotionStatus::kTooLittleParallax);
}

TEST(Gate, RefusalsOfTheEstimatorStay) {
  const Settings options = {{"model_choice", "gic"}};
  MotionProblem few = ProblemFamily("plane", "general", 7, 0.0).Make(0);
  EXPECT_EQ(AskGate("standard", options, few).status, MotionStatus::kTooFewMatches);
}

TEST(Gate, IsALimitThatCanBeLifted) {
  const auto model = ConfigureEstimator("rcme", {{"model_choice", "gic"}});
  model->LiftLimits();
  const std::vector<Parameter> options = model->Parameters();
  EXPECT_EQ(FindOption("rcme", options, "model_choice").Value(), "off");
}

// As where a user's estimator is made of one of the registry.
TEST(Gate, StandsBeforeAnEstimatorOnce) {
  const std::unique_ptr<EstimatorModel> model = WithGate(ConfigureEstimator("standard", {}));
  EXPECT_EQ(std::ranges::count(model->Parameters(), "model_choice", &Parameter::name), 1);
}

TEST(Gate, LeavesTheEffortAsItIs) {
  const std::optional<Effort> effort = ConfigureEstimator("standard", {})->EffortOption();
  ASSERT_TRUE(effort.has_value());
  EXPECT_EQ(effort->option, "num_iterations");
}

TEST(Gate, NamesTheCriteriaThereAre) {
  EXPECT_TRUE(ThrowsInputError(
      [] {
        MakeEstimator("standard", {{"model_choice", "bic"}});
      },
      {"model_choice", "'bic'", "off, orb_slam2, aic, gic, gric, gric_of_inliers"}));
}

}  // namespace
}  // namespace rcme
