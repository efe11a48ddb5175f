// The robot's header: the estimator's own numbers in OpenCV's types, and what comes back for bad input.
#include "robot/two_view.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "estimator/estimator_registry.h"
#include "estimator/geometry/pose.h"
#include "estimator/protection_level.h"
#include "stats/random.h"

namespace rcme {
namespace {

struct Matches {
  std::vector<cv::Point2f> points1, points2;
};

// A camera of 640 x 480, f = 600, moved by (0.8, 0.6, 0) and turned by 2 degrees about y; every fifth match
// is wrong.
const Eigen::Matrix3d kR = RotationFromVector({0.0, 0.035, 0.0});
const Eigen::Vector3d kT(0.8, 0.6, 0.0);

Matches MakeMatches(int n) {
  RandomStream rng({.seed = 1, .purpose = 79});
  Matches made;
  for (int i = 0; i < n; ++i) {
    const double z = rng.Uniform(4.0, 12.0);
    const Eigen::Vector3d X(z * rng.Uniform(-0.4, 0.4), z * rng.Uniform(-0.3, 0.3), z), Y = kR * X + kT;
    const auto pixel = [&](const Eigen::Vector3d& P) {
      const double x = 600.0 * P.x() / P.z() + 319.5 + 0.3 * rng.Normal();
      return cv::Point2f(static_cast<float>(x),
                         static_cast<float>(600.0 * P.y() / P.z() + 239.5 + 0.3 * rng.Normal()));
    };
    made.points1.push_back(pixel(X));
    made.points2.push_back(pixel(Y));
    if (i % 5 == 0) {
      const double x = rng.Uniform(0.0, 640.0);
      made.points2.back() = {static_cast<float>(x), static_cast<float>(rng.Uniform(0.0, 480.0))};
    }
  }
  return made;
}

TwoViewOptions Options() {
  TwoViewOptions options;
  options.K1 = options.K2 = (cv::Mat_<float>(3, 3) << 600, 0, 319.5, 0, 600, 239.5, 0, 0, 1);
  options.size1 = options.size2 = cv::Size(640, 480);
  return options;
}

TEST(TwoViewInitializer, GivesTheEstimatorsOwnAnswer) {
  const Matches m = MakeMatches(200);
  const TwoViewMotion motion = TwoViewInitializer(Options()).Estimate(m.points1, m.points2);
  ASSERT_EQ(motion.verdict, TwoViewVerdict::kGood) << motion.message;
  EXPECT_EQ(motion.status, "ok");
  const Camera camera{600.0, 600.0, 319.5, 239.5, 640, 480};
  MotionProblem problem{{}, camera, camera, 0.5};
  for (size_t i = 0; i < m.points1.size(); ++i)
    problem.matches.push_back({{m.points1[i].x, m.points1[i].y}, {m.points2[i].x, m.points2[i].y}});
  RandomStream rng({.seed = 1});
  const MotionEstimate own =
      MakeEstimator("rcme_calibrated", {{"covariance", "robust"}})->Estimate(problem, rng);
  for (int r = 0; r < 3; ++r) {
    EXPECT_EQ(motion.t.at<double>(r), own.cam2_from_cam1.t(r));
    for (int c = 0; c < 3; ++c) EXPECT_EQ(motion.R.at<double>(r, c), own.cam2_from_cam1.R(r, c));
  }
  for (int r = 0; r < 5; ++r) {
    for (int c = 0; c < 5; ++c) EXPECT_EQ(motion.covariance.at<double>(r, c), own.pose_cov(r, c));
  }
  EXPECT_EQ(motion.failure_probability, own.failure_probability);
  EXPECT_NEAR(motion.sigma_px, 0.3, 0.06);
  const ProtectionLevels levels = ComputeProtectionLevels(own, 1e-3);
  EXPECT_EQ(motion.rotation_protection_level, levels.rotation_rad);
  EXPECT_EQ(motion.direction_protection_level, levels.direction_rad);
  EXPECT_NEAR(cv::norm(motion.direction_basis.t() * motion.t), 0.0, 1e-12);
  size_t num_inliers = 0;
  for (const bool is_inlier : motion.is_inlier) num_inliers += is_inlier;
  EXPECT_EQ(num_inliers, own.inliers.size());
  EXPECT_LT(AngleBetween(own.cam2_from_cam1.t, kT), 0.05);
}

TEST(TwoViewInitializer, SigmasAreOnePerMatchInAnyUnit) {
  const Matches m = MakeMatches(100);
  const TwoViewInitializer initializer(Options());
  std::vector<double> sigmas(m.points1.size(), 3.0);
  EXPECT_EQ(cv::norm(initializer.Estimate(m.points1, m.points2, sigmas).R,
                     initializer.Estimate(m.points1, m.points2).R),
            0.0);
  sigmas.pop_back();
  const TwoViewMotion motion = initializer.Estimate(m.points1, m.points2, sigmas);
  EXPECT_EQ(motion.verdict, TwoViewVerdict::kBadInput);
  EXPECT_NE(motion.message.find("99 entries for 100 matches"), std::string::npos) << motion.message;
}

// A point of a right match in camera 1's frame projects onto its key point: within three pixels.
TEST(TwoViewInitializer, TriangulatesWhatAgrees) {
  const Matches m = MakeMatches(200);
  const TwoViewMotion motion = TwoViewInitializer(Options()).Estimate(m.points1, m.points2);
  int num_points = 0;
  for (size_t i = 0; i < m.points1.size(); ++i) {
    if (!motion.is_triangulated[i]) continue;
    ++num_points;
    EXPECT_TRUE(motion.is_inlier[i]);
    const cv::Point3f X = motion.points[i];
    EXPECT_GT(X.z, 2.0F);
    EXPECT_NEAR(600.0F * X.x / X.z + 319.5F, m.points1[i].x, 0.01F);
  }
  EXPECT_GT(num_points, 150);
}

TEST(TwoViewInitializer, TakesKeyPointsAndMatchesAsOrbSlam2HasThem) {
  const Matches m = MakeMatches(100);
  std::vector<cv::KeyPoint> keys1, keys2;
  std::vector<int> matches12;
  keys1.emplace_back(cv::Point2f(5, 5), 31.0F);  // without a match
  matches12.push_back(-1);
  for (size_t i = 0; i < 100; ++i) {
    keys1.emplace_back(m.points1[i], 31.0F);
    keys2.emplace_back(m.points2[99 - i], 31.0F);
    matches12.push_back(99 - static_cast<int>(i));
  }
  const TwoViewInitializer initializer(Options());
  const TwoViewMotion motion = initializer.Estimate(keys1, keys2, matches12),
                      plain = initializer.Estimate(m.points1, m.points2);
  ASSERT_EQ(motion.verdict, plain.verdict);
  EXPECT_EQ(cv::norm(motion.R, plain.R), 0.0);
  ASSERT_EQ(motion.is_inlier.size(), 101u);
  EXPECT_FALSE(motion.is_inlier[0]);
  for (size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(motion.is_inlier[i + 1], plain.is_inlier[i]);
    EXPECT_EQ(motion.is_triangulated[i + 1], plain.is_triangulated[i]);
  }
  matches12[3] = 100;
  EXPECT_EQ(initializer.Estimate(keys1, keys2, matches12).verdict, TwoViewVerdict::kBadInput);
  matches12.pop_back();
  EXPECT_NE(initializer.Estimate(keys1, keys2, matches12).message.find("100 entries for 101"),
            std::string::npos);
}

TEST(TwoViewInitializer, LevelsAreOfTheRiskAskedFor) {
  const Matches m = MakeMatches(200);
  TwoViewOptions options = Options();
  options.integrity_risk = 0.1;
  const TwoViewMotion often = TwoViewInitializer(options).Estimate(m.points1, m.points2);
  options.integrity_risk = 1e-2;
  const TwoViewMotion seldom = TwoViewInitializer(options).Estimate(m.points1, m.points2);
  EXPECT_GT(often.rotation_protection_level, 0.0);
  EXPECT_GT(seldom.rotation_protection_level, often.rotation_protection_level);
  EXPECT_GT(seldom.direction_protection_level, often.direction_protection_level);
  EXPECT_TRUE(std::isnan(TwoViewInitializer(options).Estimate({}, {}).rotation_protection_level));
  for (const double risk : {0.0, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    options.integrity_risk = risk;
    EXPECT_THROW(TwoViewInitializer{options}, std::runtime_error) << risk;
  }
}

struct PoseOfRos {
  Eigen::Quaterniond orientation;
  Eigen::Vector3d position;
};

PoseOfRos PoseFrom(const RosPose& ros) {
  const auto& q = ros.orientation;
  return {Eigen::Quaterniond(q[3], q[0], q[1], q[2]), {ros.position[0], ros.position[1], ros.position[2]}};
}

TEST(RosPose, IsThatOfCamera2InCamera1) {
  const Matches m = MakeMatches(200);
  const TwoViewMotion motion = TwoViewInitializer(Options()).Estimate(m.points1, m.points2);
  const PoseOfRos pose = PoseFrom(ComputeRosPose(motion));
  EXPECT_NEAR(pose.position.norm(), 1.0, 1e-12);
  const Eigen::Vector3d X1(0.3, -0.2, 5.0);
  const cv::Mat X2 = motion.R * (cv::Mat_<double>(3, 1) << X1.x(), X1.y(), X1.z()) + motion.t;
  const Eigen::Vector3d back =
      pose.orientation * Eigen::Vector3d(X2.at<double>(0), X2.at<double>(1), X2.at<double>(2)) +
      pose.position;
  EXPECT_NEAR((back - X1).norm(), 0.0, 1e-12);
  EXPECT_NEAR((pose.position - kR.transpose() * -kT).norm(), 0.0, 0.1);
  EXPECT_THROW(ComputeRosPose(TwoViewMotion{}), std::runtime_error);
}

// A motion with a covariance of the size of a hundredth of a degree, turned by 40 degrees, so that the axes
// of the two cameras differ.
TwoViewMotion TurnedMotion(RelativePose* pose, Matrix5d* root) {
  RandomStream rng({.seed = 3, .purpose = 79});
  *pose = {RotationFromVector({0.3, -0.5, 0.4}), Eigen::Vector3d(0.36, 0.48, 0.8)};
  for (double& x : root->reshaped()) x = 2e-4 * rng.Normal();
  const Matrix5d cov = *root * root->transpose();
  TwoViewMotion motion;
  motion.R = cv::Mat_<double>(3, 3);
  motion.t = cv::Mat_<double>(3, 1);
  motion.covariance = cv::Mat_<double>(5, 5);
  for (int r = 0; r < 3; ++r) {
    motion.t.at<double>(r) = pose->t(r);
    for (int c = 0; c < 3; ++c) motion.R.at<double>(r, c) = pose->R(r, c);
  }
  for (int r = 0; r < 5; ++r) {
    for (int c = 0; c < 5; ++c) motion.covariance.at<double>(r, c) = cov(r, c);
  }
  return motion;
}

// [position, rotation about camera 1's fixed axes] of another motion, as seen from the first.
Eigen::Matrix<double, 6, 1> RosDifference(const RelativePose& from, const RelativePose& to) {
  Eigen::Matrix<double, 6, 1> d;
  d.head<3>() = -to.R.transpose() * to.t + from.R.transpose() * from.t;
  d.tail<3>() = VectorFromRotation(to.R.transpose() * from.R);
  return d;
}

TEST(RosPose, CovarianceIsByTheNumericalJacobian) {
  RelativePose pose;
  Matrix5d root;
  const RosPose ros = ComputeRosPose(TurnedMotion(&pose, &root));
  Eigen::Matrix<double, 6, 5> J;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 5; ++i) {
    const Vector5d step = kStep * Vector5d::Unit(i);
    J.col(i) =
        (RosDifference(pose, Retract(pose, step)) - RosDifference(pose, Retract(pose, -step))) / (2 * kStep);
  }
  const Eigen::Matrix<double, 6, 6> expected = J * root * root.transpose() * J.transpose();
  for (int i = 0; i < 36; ++i)
    EXPECT_NEAR(ros.covariance[static_cast<size_t>(i)], expected(i / 6, i % 6), 1e-8 * expected.norm()) << i;
}

// 20,000 motions drawn with the covariance: each of the 21 different elements within five of its standard
// errors, which is missed with probability at most 2e-5. About other axes many elements are off by far.
TEST(RosPose, CovarianceIsThatOfDrawnMotions) {
  RelativePose pose;
  Matrix5d root;
  const RosPose ros = ComputeRosPose(TurnedMotion(&pose, &root));
  RandomStream rng({.seed = 4, .purpose = 79});
  constexpr int kNumDraws = 20000;
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (int k = 0; k < kNumDraws; ++k) {
    Vector5d z;
    for (double& x : z) x = rng.Normal();
    const Eigen::Matrix<double, 6, 1> d = RosDifference(pose, Retract(pose, root * z));
    sum += d * d.transpose() / kNumDraws;
  }
  const auto stated = [&](int r, int c) { return ros.covariance[static_cast<size_t>(6 * r + c)]; };
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c <= r; ++c) {
      const double variance = stated(r, r) * stated(c, c) + std::pow(stated(r, c), 2);
      EXPECT_NEAR(sum(r, c), stated(r, c), 5.0 * std::sqrt(variance / kNumDraws)) << r << " " << c;
    }
  }
}

TEST(TwoViewInitializer, AnswersBadMatchesWithAStatus) {
  const TwoViewInitializer initializer(Options());
  Matches m = MakeMatches(60);
  EXPECT_EQ(initializer.Estimate({}, {}).verdict, TwoViewVerdict::kRefused);
  EXPECT_EQ(initializer.Estimate({}, {}).status, "too_few_matches");
  const std::vector<cv::Point2f> same(60, cv::Point2f(10, 10));
  EXPECT_EQ(initializer.Estimate(same, same).verdict, TwoViewVerdict::kRefused);
  const TwoViewMotion unmoved = initializer.Estimate(m.points1, m.points1);
  EXPECT_TRUE(unmoved.verdict == TwoViewVerdict::kRefused || unmoved.failure_probability > 0.05);
  EXPECT_NE(unmoved.verdict, TwoViewVerdict::kGood);
  m.points1.pop_back();
  const TwoViewMotion unequal = initializer.Estimate(m.points1, m.points2);
  EXPECT_EQ(unequal.verdict, TwoViewVerdict::kBadInput);
  EXPECT_NE(unequal.message.find("59 points of image 1 and 60"), std::string::npos) << unequal.message;
  m = MakeMatches(60);
  m.points2[7].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(initializer.Estimate(m.points1, m.points2).verdict, TwoViewVerdict::kBadInput);
  m.points2[7].x = std::numeric_limits<float>::infinity();
  EXPECT_EQ(initializer.Estimate(m.points1, m.points2).status, "invalid_input");
}

TEST(TwoViewInitializer, WithoutAProbabilityNoMotionIsGood) {
  TwoViewOptions options = Options();
  options.estimator = "standard";
  options.options = {};
  const Matches m = MakeMatches(200);
  EXPECT_EQ(TwoViewInitializer(options).Estimate(m.points1, m.points2).verdict, TwoViewVerdict::kDoubtful);
}

TEST(TwoViewInitializer, RefusesOptionsThatMakeNoSense) {
  const auto message_of = [](const TwoViewOptions& options) -> std::string {
    try {
      const TwoViewInitializer made(options);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(message_of(Options()), "none");
  TwoViewOptions wrong = Options();
  wrong.K2 = cv::Mat();
  EXPECT_NE(message_of(wrong).find("K2: 0x0"), std::string::npos);
  wrong = Options();
  wrong.K1 = cv::Mat::zeros(3, 3, CV_64F);
  EXPECT_NE(message_of(wrong).find("K1 or size1"), std::string::npos);
  wrong = Options();
  wrong.size1 = cv::Size();
  EXPECT_NE(message_of(wrong).find("0 x 0"), std::string::npos);
  wrong = Options();
  wrong.estimator = "nobody";
  EXPECT_NE(message_of(wrong).find("nobody"), std::string::npos);
  wrong = Options();
  wrong.options = {{"mu", "1"}};
  EXPECT_NE(message_of(wrong).find("no option 'mu'"), std::string::npos);
  wrong = Options();
  wrong.sigma_px = -1.0;
  EXPECT_NE(message_of(wrong).find("sigma_px: -1"), std::string::npos);
  wrong = Options();
  wrong.greatest_failure_probability = std::nan("");
  EXPECT_NE(message_of(wrong).find("greatest_failure_probability"), std::string::npos);
}

}  // namespace
}  // namespace rcme
