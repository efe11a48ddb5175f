#include "simulator/motion_sensors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/constants.h"
#include "stats/intervals.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

ViewPair RandomView(std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 4111});
  return {TestCamera1(), TestCamera2(), RandomPose(rng, 40.0), 0.5};
}

RandomStream MakeStream(std::uint32_t trial) {
  return RandomStream({.seed = 1, .trial = trial, .purpose = 4112});
}

TEST(MotionSensors, MeasureNothingUnlessAskedFor) {
  const MotionSensors none;
  EXPECT_TRUE(none.IsNone());
  RandomStream rng = MakeStream(0);
  const MeasuredMotion measured = none.Measure(RandomView(0), rng);
  EXPECT_FALSE(measured.R || measured.gravity || measured.t);
}

TEST(MotionSensors, ParametersByHand) {
  MotionSensors sensors;
  const std::vector<Parameter> all = Parameters(sensors);
  FindParameter(all, "prior_rotation_sd_deg").SetFromText("0.5");
  FindParameter(all, "prior_gravity_sd_deg").SetFromText("1");
  FindParameter(all, "prior_direction_sd_deg").SetFromText("5");
  FindParameter(all, "prior_bias_deg").SetFromText("3");
  EXPECT_EQ(sensors.rotation_sd_deg, 0.5);
  EXPECT_EQ(sensors.gravity_sd_deg, 1.0);
  EXPECT_EQ(sensors.direction_sd_deg, 5.0);
  EXPECT_EQ(sensors.bias_deg, 3.0);
  FindParameter(all, "prior_rotation_sd_deg").SetFromText("none");
  EXPECT_TRUE(std::isnan(sensors.rotation_sd_deg));
}

// Sums of n squares of standard normals: of the rotation 3 a trial, of gravity and the direction 2. Six
// standard deviations, sqrt(2 n), are exceeded in less than one of 1e6 runs.
TEST(MotionSensors, NoiseHasTheStandardDeviationOnItsSide) {
  constexpr int kTrials = 3000;
  MotionSensors sensors;
  sensors.rotation_sd_deg = 0.5;
  sensors.gravity_sd_deg = 1.0;
  sensors.direction_sd_deg = 2.0;
  double of_rotation = 0.0, of_gravity1 = 0.0, of_gravity2 = 0.0, of_direction = 0.0;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    const ViewPair view = RandomView(trial);
    RandomStream rng = MakeStream(trial);
    const MeasuredMotion m = sensors.Measure(view, rng);
    const RelativePose& truth = view.cam2_from_cam1_true;
    const Eigen::Vector3d down = Eigen::Vector3d::UnitY();
    of_rotation += VectorFromRotation(truth.R * m.R->transpose()).squaredNorm();
    of_gravity1 += std::pow(AngleBetween(m.gravity->front(), down), 2);
    of_gravity2 += std::pow(AngleBetween(m.gravity->back(), truth.R * down), 2);
    of_direction += std::pow(AngleBetween(*m.t, truth.t), 2);
    EXPECT_NEAR(m.t->norm(), 1.0, 1e-12);
  }
  const auto expect = [](double sum, double sd_deg, double n) {
    EXPECT_NEAR(sum / std::pow(kRadPerDeg * sd_deg, 2), n, 6.0 * std::sqrt(2.0 * n));
  };
  expect(of_rotation, 0.5, 3.0 * kTrials);
  expect(of_gravity1, 1.0, 2.0 * kTrials);
  expect(of_gravity2, 1.0, 2.0 * kTrials);
  expect(of_direction, 2.0, 2.0 * kTrials);
}

TEST(MotionSensors, BiasTurnsByItsAngle) {
  MotionSensors sensors;
  sensors.rotation_sd_deg = sensors.gravity_sd_deg = sensors.direction_sd_deg = 1e-4;
  sensors.bias_deg = 5.0;
  const ViewPair view = RandomView(3);
  RandomStream rng = MakeStream(3);
  const MeasuredMotion m = sensors.Measure(view, rng);
  const RelativePose& truth = view.cam2_from_cam1_true;
  EXPECT_NEAR(RotationAngleBetween(*m.R, truth.R), 5.0 * kRadPerDeg, 1e-4);
  EXPECT_NEAR(AngleBetween(m.gravity->back(), truth.R * m.gravity->front()), 5.0 * kRadPerDeg, 1e-4);
  EXPECT_NEAR(AngleBetween(*m.t, truth.t), 5.0 * kRadPerDeg, 1e-4);
}

// One sensor more, or another noise, changes nothing about the numbers of the others.
TEST(MotionSensors, DrawTheSameNumbersWhateverIsMeasured) {
  const ViewPair view = RandomView(5);
  MotionSensors one, all;
  one.direction_sd_deg = all.direction_sd_deg = 2.0;
  all.rotation_sd_deg = all.gravity_sd_deg = 1.0;
  RandomStream first = MakeStream(5), second = MakeStream(5);
  EXPECT_EQ(*one.Measure(view, first).t, *all.Measure(view, second).t);
  EXPECT_EQ(first.Next32(), second.Next32());
}

TEST(MotionSensors, APureRotationHasNoDirection) {
  ViewPair view = RandomView(6);
  view.baseline_m = 0.0;
  MotionSensors sensors;
  sensors.direction_sd_deg = 1.0;
  RandomStream rng = MakeStream(6);
  EXPECT_FALSE(sensors.Measure(view, rng).t);
}

}  // namespace
}  // namespace rcme
