#include "experiments/real/answer/estimate_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "estimator/conform/conform_estimator.h"
#include "estimator/conform/conform_file.h"
#include "experiments/real/answer/refusal_advice.h"
#include "tests/estimator/conform/conform_examples.h"
#include "tests/peers/process_entry.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

using testing::Contains;
using testing::HasSubstr;

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
