#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "simulator/outliers/outlier_laws.h"
#include "stats/distributions.h"
#include "tests/simulator/outliers/wrong_matches.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/goodness_of_fit.h"
#include "tests/test_support/linear_algebra.h"

namespace rcme {
namespace {

// The linear equations that a motion puts on matches, one row ray2 ray1' (row-major) each, and what solves
// them.
struct OwnMotion {
  double
      relative_residual;  // smallest over greatest singular value; 0 if the matches have a motion in common
  Eigen::Matrix3d E;      // the solution
};

OwnMotion FitMotion(const Scene& scene, const DrawnOutliers& wrong, size_t num_wrong) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(num_wrong), 9);
  for (size_t i = 0; i < num_wrong; ++i) {
    const Eigen::Vector3d ray1 = scene.camera1.Ray(wrong.matches[i].x1_px);
    const Eigen::Vector3d ray2 = scene.camera2.Ray(wrong.matches[i].x2_px);
    for (int j = 0; j < 3; ++j) {
      rows.block<1, 3>(static_cast<Eigen::Index>(i), 3 * j) = ray2(j) * ray1.transpose();
    }
  }
  const Eigen::VectorXd singular_values = SingularValues(rows), f = NullVector(rows);
  OwnMotion motion;
  motion.relative_residual = singular_values(8) / singular_values(0);
  motion.E << f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7), f(8);
  return motion;
}

// The two rotations that E admits; one of them turns by little.
Eigen::Matrix3d SmallRotation(const Eigen::Matrix3d& E, const Eigen::Matrix3d& expected) {
  const FullSvd svd(E);
  const Eigen::Matrix3d U = svd.U, V = svd.V;
  Eigen::Matrix3d W;
  W << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  Eigen::Matrix3d best = Eigen::Matrix3d::Zero();
  for (Eigen::Matrix3d R :
       {Eigen::Matrix3d(U * W * V.transpose()), Eigen::Matrix3d(U * W.transpose() * V.transpose())}) {
    if (R.determinant() < 0.0) R = -R;
    if ((R - expected).norm() < (best - expected).norm()) best = R;
  }
  return best;
}

double UniformObjectCdf(double u) { return std::clamp(u, 0.0, 1.0); }

const Settings kLargeObject = {{"object_size_m", "1"}, {"object_shift_m", "0.5"}};

// Without noise 40 wrong matches satisfy one linear system to rounding, and its solution is an essential
// matrix: two equal singular values and a zero. Uniform mismatches do neither; and the matches do not satisfy
// the camera's own constraint.
TEST(MovingObject, ItsMatchesHaveOneRigidMotionOfTheirOwn) {
  const auto law = WithSettings(MakeMovingObject(), kLargeObject);
  const auto uniform = MakeUniformOutliers();
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    const Scene scene = SceneForOutliers(60, trial);
    const DrawnOutliers wrong = MakeWrong(*law, scene, 40, 0.0, trial);
    const OwnMotion own = FitMotion(scene, wrong, 40);
    EXPECT_LT(own.relative_residual, 1e-12);
    const Eigen::Vector3d sv = SingularValues(own.E);
    EXPECT_NEAR(sv(1) / sv(0), 1.0, 1e-6);
    EXPECT_LT(sv(2) / sv(0), 1e-6);
    double farthest = 0.0;
    for (size_t i = 0; i < 40; ++i) {
      farthest = std::max(farthest, std::abs(TripleProduct(scene, wrong.matches[i])));
    }
    EXPECT_GT(farthest, 1e-4);
    EXPECT_GT(FitMotion(scene, MakeWrong(*uniform, scene, 40, 0.0, trial), 40).relative_residual, 1e-4)
        << "no power";
  }
}

// The angle between the rotation of the object's matches and the camera's is uniform up to the bound:
// Kolmogorov-Smirnov at 1e-4 over 300 objects; its square is not. The chance that an object is in view hardly
// depends on the angle.
TEST(MovingObject, TurnsByAnAngleUniformUpToTheBound) {
  const auto law =
      WithSettings(MakeMovingObject(),
                   {{"object_size_m", "0.5"}, {"object_shift_m", "0.1"}, {"object_rotation_deg", "20"}});
  std::vector<double> shares;
  for (std::uint32_t trial = 0; trial < 300; ++trial) {
    const Scene scene = SceneForOutliers(60, trial);
    const Eigen::Matrix3d& R = scene.cam2_from_cam1_true.R;
    const OwnMotion own = FitMotion(scene, MakeWrong(*law, scene, 40, 0.0, trial), 40);
    const double angle_rad = RotationAngleBetween(SmallRotation(own.E, R), R);
    shares.push_back(angle_rad * 180.0 / std::numbers::pi / 20.0);
  }
  EXPECT_LE(*std::ranges::max_element(shares), 1.0 + 1e-6);
  EXPECT_GT(TestKolmogorovSmirnov(shares, UniformObjectCdf).p_value, 1e-4);
  for (double& share : shares) share *= share;
  EXPECT_LT(TestKolmogorovSmirnov(shares, UniformObjectCdf).p_value, 1e-10) << "no power";
}

// A camera that only turns sees an object that only shifts: E = [R shift]x R, whose left null vector is the
// direction of the shift, up to sign. Uniform on the sphere: |z| in camera 1 is uniform, at 1e-4 over 300
// objects.
TEST(MovingObject, ShiftsInAUniformDirection) {
  const auto law =
      WithSettings(MakeMovingObject(),
                   {{"object_size_m", "0.5"}, {"object_shift_m", "0.05"}, {"object_rotation_deg", "0"}});
  std::vector<double> heights;
  for (std::uint32_t trial = 0; trial < 300; ++trial) {
    const Scene scene = SceneForOutliers(60, trial, "pure_rotation");
    const OwnMotion own = FitMotion(scene, MakeWrong(*law, scene, 40, 0.0, trial), 40);
    const Eigen::Vector3d direction_in_cam2 = NullVector(own.E.transpose());
    const Eigen::Vector3d direction_in_cam1 = scene.cam2_from_cam1_true.R.transpose() * direction_in_cam2;
    heights.push_back(std::abs(direction_in_cam1.z()));
  }
  EXPECT_GT(TestKolmogorovSmirnov(heights, UniformObjectCdf).p_value, 1e-4);
  for (double& height : heights) height *= height;
  EXPECT_LT(TestKolmogorovSmirnov(heights, UniformObjectCdf).p_value, 1e-10) << "no power";
}

// A camera that does not move and a scene of one point straight ahead: a small object spreads normally around
// it with f size / depth px in image 1, and the means of the two images differ by what its shift projects to,
// at most f shift / depth (and a little more towards the border). At 1e-4; a size that is 10 % off is seen.
TEST(MovingObject, LiesAroundAPointOfTheScene) {
  Scene scene = SceneForOutliers(1, 0, "pure_rotation", {{"max_rotation_deg", "0"}});
  scene.points_in_cam1.assign(4000, Eigen::Vector3d(0.0, 0.0, 5.0));
  const auto law =
      WithSettings(MakeMovingObject(),
                   {{"object_size_m", "0.01"}, {"object_shift_m", "0.2"}, {"object_rotation_deg", "0"}});
  const DrawnOutliers wrong = MakeWrong(*law, scene, 4000);
  const Correspondence centre = ExactMatch(scene, scene.points_in_cam1[0]);
  std::vector<double> offsets, wider;
  Eigen::Vector2d sum_shift_px = Eigen::Vector2d::Zero();
  for (size_t i = 0; i < 4000; ++i) {
    for (const int axis : {0, 1}) {
      const double offset_px = wrong.matches[i].x1_px(axis) - centre.x1_px(axis);
      offsets.push_back(offset_px / (scene.camera1.fx * 0.01 / 5.0));
      wider.push_back(1.1 * offsets.back());
    }
    sum_shift_px += wrong.matches[i].x2_px - centre.x2_px;
  }
  EXPECT_GT(TestKolmogorovSmirnov(offsets, NormalCdf).p_value, 1e-4);
  EXPECT_LT(TestKolmogorovSmirnov(wider, NormalCdf).p_value, 1e-4) << "no power";
  EXPECT_LT(sum_shift_px.norm() / 4000.0, scene.camera2.fx * 0.2 / 4.8);
  EXPECT_GT(sum_shift_px.norm() / 4000.0, 0.01);
}

// The object turns about its own centre and not about the camera: a point-like one that hardly shifts stays
// where it was, however far from the optical axis and however much it turns.
TEST(MovingObject, TurnsAboutItsOwnCentre) {
  Scene scene = SceneForOutliers(1, 0, "pure_rotation", {{"max_rotation_deg", "0"}});
  scene.points_in_cam1.assign(40, Eigen::Vector3d(0.9, -0.6, 5.0));
  const auto law =
      WithSettings(MakeMovingObject(),
                   {{"object_size_m", "1e-6"}, {"object_shift_m", "1e-6"}, {"object_rotation_deg", "90"}});
  const Correspondence centre = ExactMatch(scene, scene.points_in_cam1[0]);
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const DrawnOutliers wrong = MakeWrong(*law, scene, 40, 0.0, trial);
    for (const Correspondence& match : wrong.matches) {
      EXPECT_LT((match.x1_px - centre.x1_px).norm(), 0.01);
      EXPECT_LT((match.x2_px - centre.x2_px).norm(), 0.01);
    }
  }
}

TEST(MovingObject, KeepsTheNoiseOfTheMatchItReplacesOrAShareOfIt) {
  const Scene scene = SceneForOutliers(50);
  for (const double share : {1.0, 0.25, 0.0}) {
    const auto law = WithSettings(MakeMovingObject(), {{"object_noise_share", std::to_string(share)}});
    const DrawnOutliers exact = MakeWrong(*law, scene, 30), noisy = MakeWrong(*law, scene, 30, 0.5);
    for (size_t i = 0; i < 30; ++i) {
      const Eigen::Vector2d noise1_px = share * (noisy.noisy[i].x1_px - noisy.exact[i].x1_px);
      const Eigen::Vector2d noise2_px = share * (noisy.noisy[i].x2_px - noisy.exact[i].x2_px);
      EXPECT_LT((noisy.matches[i].x1_px - exact.matches[i].x1_px - noise1_px).norm(), 1e-9);
      EXPECT_LT((noisy.matches[i].x2_px - exact.matches[i].x2_px - noise2_px).norm(), 1e-9);
    }
  }
}

// A ray of image 1 or 2 is bent as a right match's is: (1 + k1 r^2) times the ideal offset from the centre.
TEST(MovingObject, HasTheDistortionOfTheCameras) {
  const double k1 = 0.1;
  const auto law = WithSettings(MakeMovingObject(), kLargeObject);
  const Scene scene = SceneForOutliers(60, 1);
  const DrawnOutliers ideal = MakeWrong(*law, scene, 40, 0.0, 1),
                      bent = MakeWrong(*law, scene, 40, 0.0, 1, {.distortion_k1 = k1});
  for (size_t i = 0; i < 40; ++i) {
    for (const auto& [camera, x_px, bent_px] :
         {std::tuple{scene.camera1, ideal.matches[i].x1_px, bent.matches[i].x1_px},
          {scene.camera2, ideal.matches[i].x2_px, bent.matches[i].x2_px}}) {
      const Eigen::Vector3d ray = camera.Ray(x_px);
      const double factor = 1.0 + k1 * ray.head<2>().squaredNorm();
      EXPECT_LT((bent_px - camera.Project({factor * ray.x(), factor * ray.y(), 1.0})).norm(), 1e-9);
    }
  }
}

// Long focal lengths: of an object of the usual size the images show one point in some hundreds.
TEST(MovingObject, AnObjectThatIsNotInViewNamesTheKeys) {
  const Scene scene = SceneForOutliers(50, 0, "general",
                                       {{"focal1_px", "100000"},
                                        {"focal2_px", "100000"},
                                        {"max_rotation_deg", "0"},
                                        {"baseline_m", "0.0001"}});
  EXPECT_TRUE(ThrowsInputError([&] { MakeWrong(*MakeMovingObject(), scene, 50); },
                               {"object_shift_m: 0.3", "object_size_m: 0.3"}));
}

}  // namespace
}  // namespace rcme
