#include "estimator/calibrated/intrinsics_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

IntrinsicsCheck CheckFitted(const FittedMode& f) {
  return CheckIntrinsics(f.problem, f.mode, Explain(f.matches, f.mode));
}

// The points of an image as they would be undistorted by this k1.
void UndistortPoints(const Camera& camera, double k1, Eigen::Vector2d Correspondence::*x_px,
                     MotionProblem* problem) {
  for (Correspondence& match : problem->matches) {
    const Eigen::Vector2d ray = camera.Ray(match.*x_px).head<2>(), centre_px(camera.cx, camera.cy);
    match.*x_px -= k1 * ray.squaredNorm() * (match.*x_px - centre_px);
  }
}

// Image 1 or 2 with an error of its calibration.
struct Image {
  Camera MotionProblem::*camera;
  Eigen::Vector2d Correspondence::*x_px;
};
constexpr Image kImages[] = {{&MotionProblem::camera1, &Correspondence::x1_px},
                             {&MotionProblem::camera2, &Correspondence::x2_px}};

// `error` of an intrinsic of one image: 0: ln f, 1 and 2: principal point in px, 3: k1.
void ChangeCalibration(const Image& image, int intrinsic, double error, MotionProblem* problem) {
  Camera& camera = problem->*image.camera;
  if (intrinsic == 0) {
    camera.fx *= std::exp(error);
    camera.fy *= std::exp(error);
  } else if (intrinsic == 1) {
    camera.cx += error;
  } else if (intrinsic == 2) {
    camera.cy += error;
  } else {
    UndistortPoints(camera, error, image.x_px, problem);
  }
}

constexpr double kUsualError[] = {0.014, 4.7, 4.7, 0.023};
constexpr double kShare = 0.01;  // of a usual error

Vector5d FindMove(const FittedMode& f, const MotionProblem& changed) {
  return LocalCoordinates(f.mode.pose, FitFromTruth(changed, f.mode.pose).mode.pose);
}

// The same scene with camera 1 in both images.
FittedMode FitOneCamera(int num_matches, double sigma_px, std::uint32_t trial) {
  Scene scene = TwoCameraScene(num_matches, trial);
  scene.camera2 = scene.camera1;
  const MotionProblem problem = {ObserveTwoCameraScene(scene, sigma_px, 0.0, trial).matches, scene.camera1,
                                 scene.camera2, sigma_px};
  return FitFromTruth(problem, scene.cam2_from_cam1_true);
}

// Every match of a scene with little noise; the motion is fitted again with each error of the calibration.
TEST(IntrinsicsCheck, ReachIsHowFarTheFitMoves) {
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const FittedMode two = FitScene(100, 0.1, 0.0, trial), one = FitOneCamera(100, 0.1, trial);
    double square_of_two = 0.0, square_of_one = 0.0;
    for (int intrinsic = 0; intrinsic < 4; ++intrinsic) {
      MotionProblem changed_in_both = one.problem;
      for (const Image& image : kImages) {
        MotionProblem changed = two.problem;
        ChangeCalibration(image, intrinsic, kShare * kUsualError[intrinsic], &changed);
        square_of_two += (FindMove(two, changed) / kShare).tail<2>().squaredNorm();
        ChangeCalibration(image, intrinsic, kShare * kUsualError[intrinsic], &changed_in_both);
      }
      square_of_one += (FindMove(one, changed_in_both) / kShare).tail<2>().squaredNorm();
    }
    EXPECT_NEAR(std::log(CheckFitted(two).reach_rad), 0.5 * std::log(square_of_two), 0.15) << trial;
    EXPECT_NEAR(std::log(CheckFitted(one).reach_rad), 0.5 * std::log(square_of_one), 0.15) << trial;
  }
}

// q'Vq is chi-square with four degrees of freedom, or less where the prior decides. Of many matches, because
// a term that is missing from the residuals' derivative is a bias of the score that grows with their number.
TEST(IntrinsicsCheck, MatchesOfARightCalibrationSpeakForNoError) {
  constexpr int kScenes = 50;
  double sum = 0.0;
  for (std::uint32_t trial = 0; trial < kScenes; ++trial)
    sum += std::pow(CheckFitted(FitOneCamera(1000, 0.5, trial)).root_gain, 2) / kScenes;
  EXPECT_GT(sum, 0.5);
  EXPECT_LT(sum, 4.0 + 5.0 * std::sqrt(8.0 / kScenes));
}

// k1 = 0.1 in both images, which 400 matches show. The shift is as long as the error that the distortion
// causes, within a factor of two in the geometric mean over the scenes.
TEST(IntrinsicsCheck, PlantedDistortionIsSeen) {
  constexpr int kScenes = 20;
  int num_seen = 0;
  double log_ratio = 0.0;
  for (std::uint32_t trial = 0; trial < kScenes; ++trial) {
    const FittedMode f = FitOneCamera(400, 0.3, trial);
    MotionProblem distorted = f.problem;
    for (const Image& image : kImages) ChangeCalibration(image, 3, 0.1, &distorted);
    const IntrinsicsCheck check = CheckFitted(FitFromTruth(distorted, f.pose_true));
    num_seen += check.root_gain > 4.0;
    log_ratio += std::log(check.shift_rad / FindMove(f, distorted).tail<2>().norm()) / kScenes;
  }
  EXPECT_GE(num_seen, 17);
  EXPECT_NEAR(log_ratio, 0.0, std::log(2.0));
}

// Beyond the usual standard deviations of the header, their excess; within them nothing.
TEST(ExceedUsualErrors, IsTheExcessOfEachVariance) {
  CalibrationPrior stated{
      .focal_sd = std::hypot(0.014, 0.03), .principal_point_sd_px = 4.7, .distortion_sd = 0.0};
  stated.of_pixels1(0, 1) = 2.0;
  const CalibrationPrior beyond = ExceedUsualErrors(stated);
  EXPECT_NEAR(beyond.focal_sd, 0.03, 1e-12);
  EXPECT_NEAR(beyond.principal_point_sd_px, 0.0, 1e-6);
  EXPECT_EQ(beyond.distortion_sd, 0.0);
  EXPECT_EQ(beyond.of_pixels1(0, 1), 2.0);
}

}  // namespace
}  // namespace rcme
