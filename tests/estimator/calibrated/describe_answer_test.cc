// Each reason in words, from a check or modes that give it, with numbers that agree.
#include "estimator/calibrated/describe_answer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace rcme {
namespace {

using testing::HasSubstr;
using testing::Not;

MotionEstimate EstimateWith(Doubt doubt) {
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  estimate.inliers = {0, 2};
  estimate.inlier_probabilities = {0.9, 0.1, 0.8};
  estimate.sigma_estimated_px = 0.5;
  estimate.failure_probability = 0.2;
  estimate.doubt = doubt;
  return estimate;
}
std::string Describe(Doubt doubt, const ModelCheck& check = {}) {
  return DescribeAnswer(EstimateWith(doubt), 0.5, check);
}

TEST(DescribeAnswer, SaysHowManyMatchesAgreeAndHowSureItIs) {
  const std::string text = Describe(Doubt::kNone);
  EXPECT_THAT(text, HasSubstr("2 of 3 matches agree, sigma 0.5 px; wrong with probability 0.2"));
  EXPECT_THAT(text, Not(HasSubstr(":")));
}

TEST(DescribeAnswer, LowParallaxIsOnlySaidOfIt) {
  ModelCheck check;
  check.usual_depth = 2.0;
  EXPECT_THAT(Describe(Doubt::kLowParallax, check), HasSubstr("hardly any parallax"));
  check.usual_depth = 1266.0;
  EXPECT_THAT(Describe(Doubt::kLowParallax, check), Not(HasSubstr("hardly any parallax")));
  EXPECT_THAT(Describe(Doubt::kLowParallax, check), HasSubstr("the direction is poorly determined"));
}

TEST(DescribeAnswer, AnotherMotionThatExplainsNoMoreIsSaidToExplainAsMuch) {
  MotionEstimate estimate = EstimateWith(Doubt::kOtherMotion);
  estimate.other_modes.resize(1);
  estimate.other_modes[0].explained_share = 0.25;
  EXPECT_THAT(DescribeAnswer(estimate, 0.5, {}),
              HasSubstr("another motion explains 25 % more of the matches"));
  estimate.other_modes[0].explained_share = 0.0;
  EXPECT_THAT(DescribeAnswer(estimate, 0.5, {}), HasSubstr("another motion explains the matches as well"));
}

TEST(DescribeAnswer, TheModelsDoubtIsTheOneThatTheCheckFound) {
  ModelCheck check;
  check.partner_dependence.order_z = 5.0;
  EXPECT_THAT(Describe(Doubt::kModel, check), HasSubstr("matches like these"));
  check.planar_share = 0.95;
  EXPECT_THAT(Describe(Doubt::kModel, check), HasSubstr("a plane"));
  check.log_parallax_share = std::log(0.1);
  EXPECT_THAT(Describe(Doubt::kModel, check), HasSubstr("a small part of the image"));
  check.wrong_share = 0.3, check.wrong_coherence = 0.8;
  EXPECT_THAT(Describe(Doubt::kModel, check), HasSubstr("wrong matches move together"));
  check.log_noise_ratio = std::log(3.0);
  EXPECT_THAT(Describe(Doubt::kModel, check), HasSubstr("the noise is 3 times the assumed"));
  check.neighbour_z = 6.0;
  EXPECT_THAT(Describe(Doubt::kModel, check), HasSubstr("neighbouring matches err alike"));
  check.partner_dependence = {1.0, -0.5};
  EXPECT_THAT(Describe(Doubt::kModel, check), HasSubstr("as random ones would"));
}

// The greatest part of the probability decides, and none below a hundredth.
TEST(FindDoubt, IsTheGreatestPart) {
  const std::vector<ExplainedMode> modes(2);
  ModeWeights weights;
  weights.of_modes = {0.9, 0.05};
  weights.is_rival = {false, true};
  weights.is_second_motion = {false, false};
  weights.of_no_motion = 0.05;
  EXPECT_EQ(FindDoubt(modes, weights, {.by_modes = 0.2, .failure_probability = 0.5}), Doubt::kModel);
  EXPECT_EQ(FindDoubt(modes, weights, {.by_modes = 0.5, .failure_probability = 0.5, .mass_beyond = 0.4}),
            Doubt::kLowParallax);
  // Of 0.012 that the check lowers from 0.5, 0.4 / 0.5 are below a hundredth.
  EXPECT_EQ(FindDoubt(modes, weights, {.by_modes = 0.5, .failure_probability = 0.012, .mass_beyond = 0.4}),
            Doubt::kNone);
  EXPECT_EQ(FindDoubt(modes, weights, {.by_modes = 0.5, .failure_probability = 0.014, .mass_beyond = 0.4}),
            Doubt::kLowParallax);
  EXPECT_EQ(FindDoubt(modes, weights, {.by_modes = 0.1, .failure_probability = 0.1}), Doubt::kFewMatches);
  // Uncertain intrinsics leave half of .8.
  EXPECT_EQ(
      FindDoubt(modes, weights, {.by_modes = 0.2, .failure_probability = 0.6, .left_by_intrinsics = 0.5}),
      Doubt::kLowParallax);
  weights.of_no_motion = 0.0;
  weights.of_modes = {0.995, 0.005};
  EXPECT_EQ(FindDoubt(modes, weights, {.by_modes = 0.005, .failure_probability = 0.005}), Doubt::kNone);
}

}  // namespace
}  // namespace rcme
