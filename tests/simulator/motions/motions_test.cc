// The motions' laws, and the contract of every motion in the registry.
#include "simulator/motions/motions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "simulator/motion_registry.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "tests/test_support/goodness_of_fit.h"
#include "tests/test_support/uniform_cdf.h"

namespace rcme {
namespace {

constexpr std::uint32_t kNumMotions = 2000;

Motion Draw(const MotionModel& model, std::uint32_t trial) {
  RandomStream rng({1, 0, trial, 1});
  return model.Draw(rng);
}

Eigen::Vector3d Centre2(const Motion& motion) {  // in camera 1, over the baseline
  return -(motion.cam2_from_cam1.R.transpose() * motion.cam2_from_cam1.t);
}

class MotionContract : public testing::TestWithParam<MotionEntry> {};

TEST_P(MotionContract, DrawsRotationsAndUnitDirectionsFromTheStreamAlone) {
  const std::unique_ptr<MotionModel> model = GetParam().make();
  if (Baseline* baseline = model->MutableBaseline())
    baseline->length_of_parallax_m = 0.1;  // for one given as parallax
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    const Motion motion = Draw(*model, trial), again = Draw(*model, trial);
    const Eigen::Matrix3d& R = motion.cam2_from_cam1.R;
    EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_GT(R.determinant(), 0.0);
    EXPECT_NEAR(motion.cam2_from_cam1.t.norm(), 1.0, 1e-14);
    EXPECT_GE(motion.baseline_m, 0.0);
    EXPECT_EQ(R, again.cam2_from_cam1.R);
    EXPECT_EQ(motion.cam2_from_cam1.t, again.cam2_from_cam1.t);
  }
  for (const Parameter& parameter : model->Parameters()) {
    const std::string value = parameter.Value();
    parameter.SetFromText(value);
    EXPECT_EQ(parameter.Value(), value) << parameter.name();
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, MotionContract, testing::ValuesIn(MotionRegistry()),
                         [](const auto& motion) { return motion.param.name; });

// Angle uniform up to the bound, direction uniform on the sphere (each coordinate uniform on [-1, 1]);
// Kolmogorov-Smirnov at 1e-4. The same test sees angles that are uniform in their square.
TEST(GeneralMotion, FollowsItsLaw) {
  const std::unique_ptr<MotionModel> model = MakeGeneralMotion();
  std::vector<double> angles, squares, tx, tz;
  for (std::uint32_t trial = 0; trial < kNumMotions; ++trial) {
    const RelativePose pose = Draw(*model, trial).cam2_from_cam1;
    angles.push_back(VectorFromRotation(pose.R).norm() * kDegPerRad / 10.0);
    squares.push_back(angles.back() * angles.back());
    tx.push_back(0.5 * (pose.t.x() + 1.0));
    tz.push_back(0.5 * (pose.t.z() + 1.0));
  }
  for (const std::vector<double>& sample : {angles, tx, tz}) {
    EXPECT_GT(TestKolmogorovSmirnov(sample, UniformCdf).p_value, 1e-4);
  }
  EXPECT_LT(TestKolmogorovSmirnov(squares, UniformCdf).p_value, 1e-10);
}

// Camera 2 stands within 5 deg of the axis, uniform on the cap: (1 - cos angle) / (1 - cos 5 deg) is uniform.
TEST(DirectedMotions, StandUniformlyInACone) {
  for (const bool is_forward : {true, false}) {
    const std::unique_ptr<MotionModel> model = is_forward ? MakeForwardMotion() : MakeSidewaysMotion();
    std::vector<double> heights;
    int num_left = 0;
    for (std::uint32_t trial = 0; trial < kNumMotions; ++trial) {
      const Eigen::Vector3d centre2 = Centre2(Draw(*model, trial));
      const double along = is_forward ? centre2.z() : std::abs(centre2.x());
      num_left += centre2.x() < 0.0;
      heights.push_back((1.0 - along) / (1.0 - std::cos(5.0 / kDegPerRad)));
    }
    EXPECT_LE(*std::ranges::max_element(heights), 1.0 + 1e-9);
    EXPECT_GT(TestKolmogorovSmirnov(heights, UniformCdf).p_value, 1e-4);
    EXPECT_NEAR(num_left, kNumMotions / 2, 4.0 * std::sqrt(kNumMotions / 4.0));  // 6e-5
  }
}

// The point on the first optical axis at distance b / (2 sin(angle / 2)) stays in the middle, as far away.
TEST(Orbit, LooksAtTheSamePointFromTheSameDistance) {
  const std::unique_ptr<MotionModel> model = MakeOrbit();
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const Motion motion = Draw(*model, trial);
    const double distance_m = motion.baseline_m / (2.0 * std::sin(3.0 / kDegPerRad));
    const Eigen::Vector3d point(0.0, 0.0, distance_m);
    const Eigen::Vector3d in_cam2 =
        motion.cam2_from_cam1.R * point + motion.baseline_m * motion.cam2_from_cam1.t;
    EXPECT_LT((in_cam2 - point).norm(), 1e-12 * distance_m);
  }
}

TEST(Orbit, RunsToEitherSide) {
  int num_left = 0;
  for (std::uint32_t trial = 0; trial < kNumMotions; ++trial)
    num_left += Centre2(Draw(*MakeOrbit(), trial)).x() < 0.0;
  EXPECT_NEAR(num_left, kNumMotions / 2, 4.0 * std::sqrt(kNumMotions / 4.0));  // 6e-5
}

// The yaw has the given standard deviation, pitch and roll half of it (Kolmogorov-Smirnov at 1e-4; one that
// is 20 % off is seen).
TEST(HandHeld, YawsTwiceAsMuchAsItPitchesAndRolls) {
  const std::unique_ptr<MotionModel> model = MakeHandHeld();
  FindParameter(model->Parameters(), "rotation_sd_deg").SetFromText("4");
  std::array<std::vector<double>, 3> turns;  // pitch, yaw, roll over their standard deviations
  for (std::uint32_t trial = 0; trial < kNumMotions; ++trial) {
    const Eigen::Vector3d turn_deg = kDegPerRad * VectorFromRotation(Draw(*model, trial).cam2_from_cam1.R);
    turns[0].push_back(turn_deg.x() / 2.0);
    turns[1].push_back(turn_deg.y() / 4.0);
    turns[2].push_back(turn_deg.z() / 2.0);
  }
  for (std::vector<double>& turn : turns) {
    EXPECT_GT(TestKolmogorovSmirnov(turn, NormalCdf).p_value, 1e-4);
    for (double& z : turn) z *= 1.2;
    EXPECT_LT(TestKolmogorovSmirnov(turn, NormalCdf).p_value, 1e-4) << "no power";
  }
}

// Planar, and the chord makes half the yaw with the heading.
TEST(Ackermann, IsACircularArc) {
  const std::unique_ptr<MotionModel> model = MakeAckermann();
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    const Motion motion = Draw(*model, trial);
    const Eigen::Vector3d turn = VectorFromRotation(motion.cam2_from_cam1.R);
    const Eigen::Vector3d centre2 = Centre2(motion);
    EXPECT_NEAR(turn.x(), 0.0, 1e-15);
    EXPECT_NEAR(turn.z(), 0.0, 1e-15);
    EXPECT_NEAR(centre2.y(), 0.0, 1e-15);
    EXPECT_NEAR(std::atan2(centre2.x(), centre2.z()), -0.5 * turn.y(), 1e-12);  // y points down
    EXPECT_LE(std::abs(turn.y()) * kDegPerRad, 5.0 + 1e-12);
  }
}

// The yaw is uniform to either side; at 1e-4.
TEST(Ackermann, TurnsUniformlyToEitherSide) {
  const std::unique_ptr<MotionModel> model = MakeAckermann();
  std::vector<double> yaws;
  for (std::uint32_t trial = 0; trial < kNumMotions; ++trial) {
    yaws.push_back(0.5 - 0.1 * kDegPerRad * VectorFromRotation(Draw(*model, trial).cam2_from_cam1.R).y());
  }
  EXPECT_GT(TestKolmogorovSmirnov(yaws, UniformCdf).p_value, 1e-4);
}

// On a straight road the jitter is all that is left: pitch, roll and both angles of the direction are normal
// with the given standard deviation (Kolmogorov-Smirnov at 1e-4; one that is 20 % off is seen), and the yaw
// has none.
TEST(Vehicle, JittersInEverythingButTheYaw) {
  const std::unique_ptr<MotionModel> model = MakeVehicle();
  FindParameter(model->Parameters(), "max_yaw_deg").SetFromText("0");
  FindParameter(model->Parameters(), "jitter_deg").SetFromText("2");
  const RelativePose straight{Eigen::Matrix3d::Identity(), -Eigen::Vector3d::UnitZ()};
  std::array<std::vector<double>, 5> jitter;
  for (std::uint32_t trial = 0; trial < kNumMotions; ++trial) {
    const Vector5d moved = LocalCoordinates(straight, Draw(*model, trial).cam2_from_cam1);
    for (int k = 0; k < 5; ++k) jitter[static_cast<size_t>(k)].push_back(moved(k) * kDegPerRad / 2.0);
  }
  for (const size_t k : {0, 2, 3, 4}) {
    EXPECT_GT(TestKolmogorovSmirnov(jitter[k], NormalCdf).p_value, 1e-4) << k;
    for (double& z : jitter[k]) z *= 1.2;
    EXPECT_LT(TestKolmogorovSmirnov(jitter[k], NormalCdf).p_value, 1e-4) << "no power: " << k;
  }
  for (const double yaw : jitter[1]) ASSERT_NEAR(yaw, 0.0, 1e-12);
}

TEST(PureRotation, HasNoBaseline) { EXPECT_EQ(Draw(*MakePureRotation(), 0).baseline_m, 0.0); }

TEST(BaselineLength, IsMetresOrThatOfTheParallax) {
  Baseline baseline;
  EXPECT_EQ(baseline.Length(), 0.5);
  baseline.parallax_deg = 4.0;
  EXPECT_THROW(baseline.Length(), std::logic_error) << "not known yet";
  baseline.length_of_parallax_m = 0.7;
  EXPECT_EQ(baseline.Length(), 0.7);
}

// Moved motions have the law of drawn ones: angle and height above the rim of the cap uniform, half of them
// to either side, axes of rotation uniform. Kolmogorov and Smirnov's tests at 1e-4; a short step goes nearby.
TEST(SidewaysMotion, DrawNearKeepsTheLaw) {
  const std::unique_ptr<MotionModel> model = MakeSidewaysMotion();
  const double max_angle = 5.0 / kDegPerRad, rim = std::cos(max_angle);
  for (const double step : {0.1, 0.5, 1.0}) {
    std::vector<double> angles, heights, axes;
    int num_right = 0, num_moved = 0;
    for (std::uint32_t trial = 0; trial < kNumMotions; ++trial) {
      RandomStream rng({2, 0, trial, 1});
      Motion motion = Draw(*model, trial);
      for (int move = 0; move < 10; ++move) {
        const Motion before = motion;
        motion = model->DrawNear(before, step, rng).value();
        EXPECT_EQ(motion.baseline_m, before.baseline_m);
        num_moved += Centre2(motion) != Centre2(before);
        const Eigen::AngleAxisd turn(
            Eigen::Matrix3d(motion.cam2_from_cam1.R * before.cam2_from_cam1.R.transpose()));
        EXPECT_LT(turn.angle(), step <= 0.1 ? 0.6 * max_angle : 2.1 * max_angle);
      }
      const Eigen::AngleAxisd rotation(motion.cam2_from_cam1.R);
      angles.push_back(rotation.angle() / max_angle);
      axes.push_back(0.5 * (1.0 + rotation.axis().z()));
      const double x = Centre2(motion).x();
      num_right += x > 0.0;
      heights.push_back((std::abs(x) - rim) / (1.0 - rim));
    }
    for (const std::vector<double>& sample : {angles, heights, axes})
      EXPECT_GT(TestKolmogorovSmirnov(sample, UniformCdf).p_value, 1e-4) << step;
    EXPECT_NEAR(num_right, kNumMotions / 2, 3.9 * std::sqrt(kNumMotions / 4.0));
    EXPECT_GT(num_moved, 10 * kNumMotions / 3);
  }
  EXPECT_FALSE(MakePureRotation()->DrawNear({}, 0.5, *std::make_unique<RandomStream>(StreamName{})));
}

}  // namespace
}  // namespace rcme
