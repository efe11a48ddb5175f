// Protection levels: closed forms, what they rise and fall with, errors drawn as an answer states them, and
// what is refused.
#include "estimator/protection_level.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {
namespace {

using testing::HasSubstr;

MotionEstimate AnswerWith(const Matrix5d& pose_cov, double failure_probability = kNaN) {
  MotionEstimate answer;
  answer.status = MotionStatus::kOk;
  answer.pose_cov = pose_cov;
  answer.failure_probability = failure_probability;
  return answer;
}

// The same standard deviation in every direction.
MotionEstimate RoundAnswer(double failure_probability = kNaN) {
  return AnswerWith(1e-4 * Matrix5d::Identity(), failure_probability);
}

TEST(ProtectionLevels, OfARoundCovarianceAreRootsOfChiSquares) {
  for (const double risk : {0.3, 1e-2, 1e-3, 1e-5}) {
    const ProtectionLevels levels = ComputeProtectionLevels(RoundAnswer(), risk);
    EXPECT_NEAR(levels.rotation_rad, 0.01 * std::sqrt(ChiSquareQuantile(3, 1.0 - risk)), 1e-11);
    EXPECT_NEAR(levels.direction_rad, 0.01 * std::sqrt(-2.0 * std::log(risk)), 1e-13);
  }
}

// A single uncertain way, across the axes.
TEST(ProtectionLevels, OfRankOneAreNormalQuantiles) {
  Vector5d v;
  v << 0.01, 0.02, -0.02, 0.03, 0.04;
  const ProtectionLevels levels = ComputeProtectionLevels(AnswerWith(v * v.transpose()), 1e-3);
  const double z = NormalQuantile(1.0 - 0.5e-3);
  EXPECT_NEAR(levels.rotation_rad, 0.03 * z, 1e-8);
  EXPECT_NEAR(levels.direction_rad, 0.05 * z, 1e-8);
}

// A tenth of the errors are five times as wide. In two dimensions the tail of a normal length is exp(-r^2 / 2
// sd^2). A normal law of the second moment would promise too little.
TEST(ProtectionLevels, OfAMixtureCountBothLaws) {
  const double sd = 0.01, wide = 0.05, weight = 0.1, risk = 1e-3;
  MotionEstimate answer =
      AnswerWith(((1.0 - weight) * sd * sd + weight * wide * wide) * Matrix5d::Identity());
  const double normal = ComputeProtectionLevels(answer, risk).direction_rad;
  answer.calibration_error_probability = weight;
  answer.pose_cov_without_errors = sd * sd * Matrix5d::Identity();
  answer.pose_cov_with_errors = wide * wide * Matrix5d::Identity();
  const ProtectionLevels levels = ComputeProtectionLevels(answer, risk);
  const auto beyond = [&](double r) {
    return (1.0 - weight) * std::exp(-0.5 * std::pow(r / sd, 2)) +
           weight * std::exp(-0.5 * std::pow(r / wide, 2));
  };
  EXPECT_NEAR(beyond(levels.direction_rad), risk, 1e-9);
  EXPECT_GT(beyond(normal), 3.0 * risk);
  EXPECT_GT(levels.rotation_rad, levels.direction_rad);
}

TEST(ProtectionLevels, AFailureProbabilityTakesItsShareOfTheRisk) {
  const double risk = 1e-2, p = 4e-3;
  const ProtectionLevels levels = ComputeProtectionLevels(RoundAnswer(p), risk);
  EXPECT_NEAR(levels.direction_rad, 0.01 * std::sqrt(-2.0 * std::log((risk - p) / (1.0 - p))), 1e-13);
  for (const double whole : {1e-2, 0.02, 1.0}) {
    EXPECT_EQ(ComputeProtectionLevels(RoundAnswer(whole), risk).rotation_rad, std::numbers::pi);
    EXPECT_EQ(ComputeProtectionLevels(RoundAnswer(whole), risk).direction_rad, std::numbers::pi);
  }
}

TEST(ProtectionLevels, RiseWithTheProbabilityAndFallWithTheRisk) {
  RandomStream rng({.seed = 1, .purpose = 492});
  for (int i = 0; i < 50; ++i) {
    Matrix5d A;
    for (double& x : A.reshaped()) x = 0.02 * rng.Normal();
    const Matrix5d cov = A * A.transpose();
    ProtectionLevels before;
    for (const double p : {0.0, 1e-4, 5e-4, 9e-4, 9.999e-4, 1e-3}) {
      const ProtectionLevels levels = ComputeProtectionLevels(AnswerWith(cov, p), 1e-3);
      EXPECT_GE(levels.rotation_rad, before.rotation_rad);
      EXPECT_GE(levels.direction_rad, before.direction_rad);
      before = levels;
    }
    before = {4.0, 4.0};
    for (const double risk : {1e-12, 1e-9, 1e-6, 1e-3, 0.1, 0.5}) {
      const ProtectionLevels levels = ComputeProtectionLevels(AnswerWith(cov), risk);
      EXPECT_LE(levels.rotation_rad, before.rotation_rad);
      EXPECT_LE(levels.direction_rad, before.direction_rad);
      before = levels;
    }
  }
}

TEST(ProtectionLevels, AreAtMostPi) {
  const ProtectionLevels levels = ComputeProtectionLevels(AnswerWith(100.0 * Matrix5d::Identity()), 1e-3);
  EXPECT_EQ(levels.rotation_rad, std::numbers::pi);
  EXPECT_EQ(levels.direction_rad, std::numbers::pi);
  const ProtectionLevels none = ComputeProtectionLevels(AnswerWith(Matrix5d::Zero()), 1e-3);
  EXPECT_EQ(none.rotation_rad, 0.0);
  EXPECT_EQ(none.direction_rad, 0.0);
}

// Errors as the answer states them, a wrong motion being off by pi: the levels are exceeded as often as the
// risk says. Of 10 answers with 20,000 errors each an exact 99.9 % interval misses one of the 20 levels with
// probability at most 2 %; one that is a tenth too small is exceeded half as often again, far outside.
TEST(ProtectionLevels, AreExceededAsOftenAsTheRiskSays) {
  RandomStream rng({.seed = 2, .purpose = 492});
  constexpr int kNumErrors = 20000;
  constexpr double kRisk = 0.03;
  for (int i = 0; i < 10; ++i) {
    Matrix5d A;
    for (double& x : A.reshaped()) x = 0.02 * rng.Normal();
    const double p = i % 2 == 0 ? 0.0 : 0.01;
    const MotionEstimate answer = AnswerWith(A * A.transpose(), p);
    const ProtectionLevels levels = ComputeProtectionLevels(answer, kRisk);
    int beyond_rotation = 0, beyond_direction = 0;
    for (int k = 0; k < kNumErrors; ++k) {
      const bool is_wrong = rng.Uniform() < p;
      Vector5d z;
      for (double& x : z) x = rng.Normal();
      const RelativePose truth = Retract(answer.cam2_from_cam1, A * z);
      const double rotation = RotationAngleBetween(truth.R, answer.cam2_from_cam1.R),
                   direction = AngleBetween(truth.t, answer.cam2_from_cam1.t);
      beyond_rotation += is_wrong || rotation > levels.rotation_rad;
      beyond_direction += is_wrong || direction > levels.direction_rad;
    }
    EXPECT_TRUE(ExactBinomialInterval(beyond_rotation, kNumErrors, 0.999).Contains(kRisk)) << i;
    EXPECT_TRUE(ExactBinomialInterval(beyond_direction, kNumErrors, 0.999).Contains(kRisk)) << i;
  }
}

void ExpectRefused(const MotionEstimate& answer, double risk, const std::string& words) {
  try {
    ComputeProtectionLevels(answer, risk);
    ADD_FAILURE() << words;
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr(words));
  }
}

TEST(ProtectionLevels, NameWhatIsWrong) {
  for (const double risk : {0.0, 1.0, -1.0, 1e-13, kNaN}) ExpectRefused(RoundAnswer(), risk, "the risk");
  ExpectRefused(RoundAnswer(1.5), 1e-3, "failure probability 1.5");
  MotionEstimate answer = RoundAnswer();
  answer.status = MotionStatus::kNoCandidate;
  ExpectRefused(answer, 1e-3, "no_candidate");
  answer = RoundAnswer();
  answer.pose_cov(4, 4) = kNaN;
  ExpectRefused(answer, 1e-3, "not finite");
  answer = RoundAnswer();
  answer.pose_cov(0, 3) = 1e-5;
  ExpectRefused(answer, 1e-3, "not symmetric");
  answer = RoundAnswer();
  answer.pose_cov(1, 1) = -1e-4;
  ExpectRefused(answer, 1e-3, "not positive semidefinite");
}

}  // namespace
}  // namespace rcme
