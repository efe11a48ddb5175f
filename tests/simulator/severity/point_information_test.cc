#include "simulator/severity/point_information.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "estimator/geometry/sampson.h"
#include "tests/test_support/linear_algebra.h"
#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// The four pixels of a point, and the same as the motion and the point move: x = [rotation, direction,
// point].
Eigen::Vector4d Pixels(const ViewPair& view, const Eigen::Vector3d& point, const Eigen::VectorXd& x) {
  ViewPair moved = view;
  moved.cam2_from_cam1_true = Retract(view.cam2_from_cam1_true, x.head<5>());
  const Eigen::Vector3d at = point + x.tail<3>();
  Eigen::Vector4d pixels;
  pixels << view.camera1.Project(at), view.camera2.Project(moved.InCamera2(at));
  return pixels;
}

Eigen::MatrixXd PixelJacobian(const ViewPair& view, const Eigen::Vector3d& point) {
  return NumericJacobian([&](const Eigen::VectorXd& x) { return Pixels(view, point, x); },
                         Eigen::VectorXd::Zero(8), 1e-3);
}

TEST(PointConstraint, DoesNotDependOnThePointAndMovesWithTheMotion) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const Scene scene = TwoCameraScene(30, trial);
    for (const Eigen::Vector3d& point : scene.points_in_cam1) {
      const PointConstraint constraint = ComputePointConstraint(scene, point);
      const Eigen::RowVectorXd moved = constraint.gradient_px.transpose() * PixelJacobian(scene, point);
      const double scale = constraint.gradient_motion.norm();
      ASSERT_GT(scale, 0.0);
      EXPECT_LT(moved.tail(3).norm(), 1e-6 * scale);
      EXPECT_LT((moved.head(5) - constraint.gradient_motion).norm(), 1e-6 * scale);
    }
  }
}

// The same information from the epipolar constraint, g_p' g_p / (sigma^2 |J|^2), which the simulator does not
// use.
TEST(PointConstraint, HasTheInformationOfTheEpipolarConstraint) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const Scene scene = TwoCameraScene(30, trial);
    const RelativePose& pose = scene.cam2_from_cam1_true;
    const auto to_F = [&](const Eigen::Matrix3d& E) {
      return FundamentalFromEssential(E, scene.camera1, scene.camera2);
    };
    Matrix5d ours = Matrix5d::Zero(), theirs = Matrix5d::Zero();
    for (const Eigen::Vector3d& point : scene.points_in_cam1) {
      const PointConstraint constraint = ComputePointConstraint(scene, point);
      ours += constraint.gradient_motion.transpose() * constraint.gradient_motion /
              constraint.gradient_px.squaredNorm();
      const Correspondence match{scene.camera1.Project(point), scene.camera2.Project(scene.InCamera2(point))};
      Eigen::Matrix<double, 1, 5> g_p;
      for (size_t k = 0; k < 5; ++k) {
        g_p(static_cast<int>(k)) = EvaluateConstraint(to_F(EssentialTangent(pose)[k]), match).g;
      }
      theirs +=
          g_p.transpose() * g_p / EvaluateConstraint(to_F(EssentialFromPose(pose)), match).squared_gradient();
    }
    EXPECT_LT((ours - theirs).norm(), 1e-9 * theirs.norm());
  }
}

// Schur complement of the whole least-squares problem: rotation, depth-free points as directions.
TEST(RotationInformation, IsThatOfTheFullProblemWithoutTranslation) {
  const double sigma_px = 0.7;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const Scene scene = TwoCameraScene(30, trial, 0.0);
    for (const Eigen::Vector3d& point : scene.points_in_cam1) {
      const Eigen::MatrixXd J = PixelJacobian(scene, point) / sigma_px;
      const Eigen::MatrixXd Jr = J.leftCols(3), Jx = J.block(0, 5, 4, 2);  // x and y at a fixed depth
      const Eigen::MatrixXd cross = Multiply(Jr.transpose(), Jx);
      const Eigen::MatrixXd expected =
          Multiply(Jr.transpose(), Jr) - Propagate(cross, Inverse(Multiply(Jx.transpose(), Jx)));
      EXPECT_LT((ComputeRotationInformation(scene, point, sigma_px) - expected).norm(),
                1e-6 * expected.norm());
    }
  }
}

}  // namespace
}  // namespace rcme
