// Errors of the calibration of images that a lens distorts.
#include "estimator/uncertainty/calibration_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "estimator/calibrated/whitened_problem.h"
#include "estimator/refinement/sampson_equations.h"
#include "estimator/refinement/sampson_mle.h"
#include "estimator/undistortion.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

const Lens kFisheye{{190.0, 195.0, 255.5, 255.5, 512, 512}, LensModel::kFisheye, {-0.01, 0.02, -0.01, 0.003}};

// A right match per point up to about 60 deg from the axis, as the images have it.
struct DistortedScene {
  MotionProblem distorted;
  RelativePose pose;
};
DistortedScene MakeDistortedScene() {
  RandomStream rng({.seed = 1, .purpose = 2845});
  DistortedScene scene;
  scene.pose = {RotationFromVector(0.1 * RandomDirection(rng)), RandomDirection(rng)};
  while (scene.distorted.matches.size() < 300) {
    const double z = 3.0 + 3.0 * rng.Uniform();
    const Eigen::Vector3d point(3.4 * z * (rng.Uniform() - 0.5), 3.4 * z * (rng.Uniform() - 0.5), z);
    const Eigen::Vector3d in_cam2 = scene.pose.R * point + scene.pose.t;
    if (in_cam2.z() < 0.5) continue;
    const auto image = [&](const Eigen::Vector3d& x) -> Eigen::Vector2d {
      return ProjectThrough(kFisheye, x.hnormalized()) + 0.3 * Eigen::Vector2d(rng.Normal(), rng.Normal());
    };
    scene.distorted.matches.push_back({image(point), image(in_cam2)});
  }
  scene.distorted.sigma_px = 0.3;
  return scene;
}

Vector5d ComputeGradient(const MotionProblem& problem, const RelativePose& pose, Matrix5d* inverse_hessian) {
  std::vector<int> all(problem.matches.size());
  for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  const auto sums = LinearizeSampson(problem, all, pose, Loss::kSquared);
  if (inverse_hessian != nullptr) *inverse_hessian = sums.hessian.llt().solve(Matrix5d::Identity());
  return sums.gradient;
}

// Each image of a reconstruction has a K of its own, rounded in its last digit.
TEST(IsOfOneCamera, TakesRoundedIntrinsicsForEqualOnes) {
  MotionProblem problem;
  problem.camera1 = problem.camera2 = kFisheye.camera;
  problem.camera2.fx *= 1.0 + 1e-8;
  EXPECT_TRUE(IsOfOneCamera(problem));
  problem.undistortion = {kFisheye, kFisheye};
  EXPECT_TRUE(IsOfOneCamera(problem));
  problem.undistortion->lens2.k[0] += 1e-3;
  EXPECT_FALSE(IsOfOneCamera(problem));
  problem.undistortion.reset();
  problem.camera2.fx *= 1.001;
  EXPECT_FALSE(IsOfOneCamera(problem));
}

// An error of one standard deviation in both images, which one camera took: the motion fitted to the matches
// as a lens with this error undistorts them.
TEST(CalibrationCovariance, OfALensIsThatOfFitsToMatchesUndistortedByAnother) {
  const DistortedScene scene = MakeDistortedScene();
  const MotionProblem problem = UndistortProblem(kFisheye, kFisheye, scene.distorted).problem;
  ASSERT_EQ(problem.matches.size(), 300U);
  const RefinedMotion at = RefineAllBySampson(problem, scene.pose);
  ASSERT_TRUE(at.converged);
  constexpr double kFocal = 1e-3, kShiftPx = 0.1, kDistortion = 1e-3;
  struct Error {
    CalibrationPrior prior;
    std::vector<Lens> lenses;
  };
  std::vector<Error> errors(3);
  for (Error& error : errors) error.lenses = {kFisheye};
  errors[0].prior.focal_sd = kFocal;
  errors[0].lenses[0].camera.fx *= 1.0 + kFocal;
  errors[0].lenses[0].camera.fy *= 1.0 + kFocal;
  errors[1].prior.principal_point_sd_px = kShiftPx;
  errors[1].lenses.push_back(kFisheye);
  errors[1].lenses[0].camera.cx += kShiftPx;
  errors[1].lenses[1].camera.cy += kShiftPx;
  errors[2].prior.distortion_sd = kDistortion;
  errors[2].lenses[0].k[0] += kDistortion;
  Matrix5d inverse_hessian;
  ComputeGradient(problem, at.cam2_from_cam1, &inverse_hessian);
  for (const Error& error : errors) {
    Matrix5d expected = Matrix5d::Zero();
    for (const Lens& lens : error.lenses) {
      MotionProblem changed = UndistortProblem(lens, lens, scene.distorted).problem;
      changed.noise_scale = problem.noise_scale;
      const RefinedMotion moved_to = RefineAllBySampson(changed, at.cam2_from_cam1);
      const Vector5d moved = LocalCoordinates(at.cam2_from_cam1, moved_to.cam2_from_cam1);
      expected += moved * moved.transpose();
    }
    const Matrix5d found = CalibrationCovariance(
        problem, error.prior, inverse_hessian,
        [&](const MotionProblem& changed) { return ComputeGradient(changed, at.cam2_from_cam1, nullptr); });
    EXPECT_LT((found - expected).norm(), 0.1 * expected.norm()) << found << "\n\n" << expected;
  }
}

// In coordinates turned about the optical axes the rays move as in those of the images: a linear function of
// the rays, in the frame of the images, stands for the gradient.
TEST(CalibrationCovariance, OfALensIsThatOfTurnedCoordinatesToo) {
  const DistortedScene scene = MakeDistortedScene();
  const MotionProblem problem = UndistortProblem(kFisheye, kFisheye, scene.distorted).problem;
  Eigen::Matrix2d shape;
  shape << 1.0, 0.4, 0.4, 0.6;
  const WhitenedProblem whitened(problem, shape);
  const auto rays = [](const MotionProblem& p, bool is_image1) {
    Eigen::Matrix2Xd found(2, static_cast<Eigen::Index>(p.matches.size()));
    for (size_t i = 0; i < p.matches.size(); ++i)
      found.col(static_cast<Eigen::Index>(i)) = is_image1 ? p.camera1.Ray(p.matches[i].x1_px).head<2>()
                                                          : p.camera2.Ray(p.matches[i].x2_px).head<2>();
    return found;
  };
  const auto turn = [&](bool is_image1) -> Eigen::Matrix2d {  // from turned rays to those of the images
    const Eigen::Matrix2Xd to = rays(problem, is_image1), from = rays(whitened.problem(), is_image1);
    return to * from.transpose() * (from * from.transpose()).inverse();
  };
  EXPECT_LT((turn(true) * turn(true).transpose() - Eigen::Matrix2d::Identity()).norm(), 1e-9);
  EXPECT_GT((turn(true) - Eigen::Matrix2d::Identity()).norm(), 0.1) << "nothing is turned";
  const auto gradient = [&](const MotionProblem& p, const Eigen::Matrix2d& turn1,
                            const Eigen::Matrix2d& turn2) {
    const Eigen::Matrix2Xd rays1 = turn1 * rays(p, true), rays2 = turn2 * rays(p, false);
    Vector5d sums;
    sums << rays1.row(0).sum(), rays1.row(1).squaredNorm(), rays2.row(0).squaredNorm(), rays2.row(1).sum(),
        rays1.row(0).dot(rays2.row(1));
    return sums;
  };
  const CalibrationPrior prior{.focal_sd = 0.01, .principal_point_sd_px = 1.0, .distortion_sd = 0.01};
  CalibrationPrior turned = prior;
  turned.of_pixels1 = whitened.of_pixels1();
  turned.of_pixels2 = whitened.of_pixels2();
  const Eigen::Matrix2d none = Eigen::Matrix2d::Identity(), turn1 = turn(true), turn2 = turn(false);
  const Matrix5d expected = CalibrationCovariance(
      problem, prior, Matrix5d::Identity(), [&](const MotionProblem& p) { return gradient(p, none, none); });
  const Matrix5d found =
      CalibrationCovariance(whitened.problem(), turned, Matrix5d::Identity(),
                            [&](const MotionProblem& p) { return gradient(p, turn1, turn2); });
  EXPECT_LT((found - expected).norm(), 1e-3 * expected.norm()) << found << "\n\n" << expected;
}

}  // namespace
}  // namespace rcme
