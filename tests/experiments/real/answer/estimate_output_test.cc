#include "experiments/real/answer/estimate_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "estimator/conform/conform_estimator.h"
#include "estimator/conform/conform_file.h"
#include "experiments/real/answer/refusal_advice.h"
#include "stats/constants.h"
#include "tests/estimator/conform/conform_examples.h"
#include "tests/peers/process_entry.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

EstimatorSpec MakeConformed(const TempFolder& folder) {
  ConformRule rule = ExampleRule();
  rule.max_rotation_error_deg = 2.5;
  rule.max_direction_error_deg = 12.0;
  ProcessEntryName();  // adds `conform` too
  EstimatorSpec spec = DefaultEstimator(kConformEstimator);
  SetOptions(&spec, ConformOptions(folder.Write("x.conform.json", ConformFileText(rule, {}))));
  return spec;
}

TEST(EstimateOutput, ConformStatesTheBoundsOfItsFile) {
  TempFolder folder;
  PairAnswer answer;
  answer.estimate.status = MotionStatus::kOk;
  answer.estimate.cam2_from_cam1.t = Eigen::Vector3d::UnitX();
  answer.estimate.failure_probability = 0.13;
  EXPECT_THAT(AnswerAsText(answer, MakeConformed(folder)),
              HasSubstr("0.13  (rotation off by more than 2.5 deg or direction by 12 deg)"));
}

// The posterior of an answer whose own spread puts more beyond the bounds than is stated.
TEST(EstimateOutput, ACovarianceThatIsWiderThanTheDistributionSaysByHowMuch) {
  PairAnswer answer;
  answer.estimate.status = MotionStatus::kOk;
  answer.estimate.cam2_from_cam1.t = Eigen::Vector3d::UnitX();
  answer.estimate.failure_probability = 0.04;
  const MotionBounds bounds{kRadPerDeg * 3.0, kRadPerDeg * 15.0};
  const auto summary = [&](double sd_deg, double failure_probability) {
    const double sd = kRadPerDeg * sd_deg;
    const MotionComponent only{answer.estimate.cam2_from_cam1, sd * sd * Matrix5d::Identity(), 1.0, true};
    return SummarizePosterior(MakeMotionPosterior(only.mean, bounds, failure_probability, {only}, {}));
  };
  const EstimatorSpec spec = DefaultEstimator("rcme_calibrated");
  answer.posterior = summary(3.0, 0.04);
  EXPECT_LT(answer.posterior->narrowed, 0.5);
  // P(chi_3 > q / sd) = 0.04 for q = 3 deg, the bound: 95 % of the rotations are within 0.967 of it.
  EXPECT_NEAR(kDegPerRad * answer.posterior->quantile_95.rotation_rad, 2.9, 0.06);
  EXPECT_THAT(AnswerAsText(answer, spec), AllOf(HasSubstr("standard deviations are 2.9 times"),
                                                HasSubstr("are within 2.9 deg of the answer")));
  EXPECT_NEAR(AnswerAsJson(answer, spec)["posterior"]["narrowed"].get<double>(), answer.posterior->narrowed,
              1e-12);
  answer.posterior = summary(3.0, 0.2);
  EXPECT_NEAR(answer.posterior->median.t.x(), 1.0, 1e-6);
  answer.posterior = summary(0.1, 0.2);  // the rest is none of its motions
  EXPECT_EQ(answer.posterior->narrowed, 1.0);
  EXPECT_THAT(AnswerAsText(answer, spec), Not(HasSubstr("is wider")));
  EXPECT_TRUE(AnswerAsJson(answer, spec)["posterior"]["rotation_95_deg"].is_null());
}

TEST(EstimateOutput, ErrorsOfTheCalibrationThatTheMatchesShowAreNamed) {
  PairAnswer answer;
  answer.estimate.status = MotionStatus::kOk;
  answer.estimate.cam2_from_cam1.t = Eigen::Vector3d::UnitX();
  answer.estimate.failure_probability = 0.04;
  const EstimatorSpec spec = DefaultEstimator("rcme_calibrated");
  EXPECT_FALSE(AnswerAsJson(answer, spec).contains("calibration_error_probability"));
  answer.estimate.calibration_error_probability = 0.01;
  EXPECT_THAT(AnswerAsText(answer, spec), Not(HasSubstr("K is off")));
  answer.estimate.calibration_error_probability = 0.5;
  EXPECT_THAT(AnswerAsText(answer, spec), HasSubstr("K is off   with probability 0.5,"));
  EXPECT_EQ(AnswerAsJson(answer, spec)["calibration_error_probability"], 0.5);
}

TEST(EstimateOutput, TablesMarkAnExtrapolatedProbability) {
  PairAnswer answer;
  answer.estimate.status = MotionStatus::kOk;
  answer.estimate.cam2_from_cam1.t = Eigen::Vector3d::UnitX();
  answer.estimate.failure_probability = 0.25;
  const std::vector<FailureBounds> none;
  answer.estimate.probability_domain = ProbabilityDomain::kVerified;
  EXPECT_EQ(FormatAnswerRow("pair", answer, {none})[4], "0.25");
  answer.estimate.probability_domain = ProbabilityDomain::kExtrapolated;
  EXPECT_EQ(FormatAnswerRow("pair", answer, {none})[4], "0.25*");
}

// What is advised is an option of the estimator.
TEST(EstimateOutput, AnUncertainMotionIsSeenByAnOptionThatTheEstimatorHas) {
  TempFolder folder;
  MotionEstimate refusal;
  refusal.status = MotionStatus::kTooUncertain;
  const std::string see = "see the motion with its probability: --set ";
  EstimatorSpec conformed = MakeConformed(folder), calibrated = DefaultEstimator("rcme_calibrated");
  EXPECT_THAT(AdviceFor(refusal, conformed), Contains(see + "accept_rule=ignore"));
  EXPECT_THAT(AdviceFor(refusal, calibrated), Contains(see + "max_failure_probability=1"));
  SetOptions(&conformed, {{"accept_rule", "ignore"}});
  SetOptions(&calibrated, {{"max_failure_probability", "1"}});
}

}  // namespace
}  // namespace rcme
