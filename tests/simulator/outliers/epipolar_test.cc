#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulator/outliers/outlier_laws.h"
#include "tests/simulator/outliers/wrong_matches.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/goodness_of_fit.h"
#include "tests/test_support/linear_algebra.h"

namespace rcme {
namespace {

// Inverse depths in camera 1 of the point that both ends of an exact match show: ray1 turned + w t
// proportional to ray2, and the depth in camera 2 over that in camera 1.
Eigen::Vector2d InverseDepthAndRatio(const Scene& scene, const Correspondence& match) {
  Eigen::MatrixXd A(3, 2);
  A << -scene.baseline_m * scene.cam2_from_cam1_true.t, scene.camera2.Ray(match.x2_px);
  return Multiply(PseudoInverse(A), scene.cam2_from_cam1_true.R * scene.camera1.Ray(match.x1_px));
}

// Whether x1 is that of the match's own scene point, before noise.
bool IsOnItsOwnRay(const DrawnOutliers& wrong, size_t i) {
  return (wrong.matches[i].x1_px - wrong.exact[i].x1_px).norm() < 1e-9;
}

// Without noise, for motions of every kind: on the epipolar line to 1e-12, flagged, in front of both cameras,
// in both images, at least 5 px from the true point; on the ray of its own point or of another one of the
// scene.
TEST(EpipolarOutliers, SatisfyTheTrueConstraintAwayFromTheTruePoint) {
  for (const char* motion : {"general", "forward", "sideways", "orbit", "vanishing_baseline"}) {
    int num_own = 0, num_all = 0;
    for (std::uint32_t trial = 0; trial < 10; ++trial) {
      const Scene scene = SceneForOutliers(300, trial, motion);
      const DrawnOutliers wrong = MakeWrong(*MakeEpipolarOutliers(), scene, 200, 0.0, trial);
      for (size_t i = 0; i < 300; ++i) {
        EXPECT_EQ(wrong.is_undetectable[i], i < 200);
        if (i >= 200) continue;
        const Correspondence& match = wrong.matches[i];
        EXPECT_LT(std::abs(TripleProduct(scene, match)), 1e-12) << motion;
        const Eigen::Vector2d depths = InverseDepthAndRatio(scene, match);
        EXPECT_GT(depths(0), -1e-9) << motion;
        EXPECT_GT(depths(1), 0.0) << motion;
        EXPECT_TRUE(scene.camera1.IsInImage(match.x1_px) && scene.camera2.IsInImage(match.x2_px)) << motion;
        const auto source = std::ranges::find_if(wrong.exact, [&](const Correspondence& exact) {
          return (exact.x1_px - match.x1_px).norm() < 1e-9;
        });
        ASSERT_NE(source, wrong.exact.end()) << motion;
        EXPECT_GT((source->x2_px - match.x2_px).norm(), 5.0 - 1e-9) << motion;
        num_own += IsOnItsOwnRay(wrong, i);
        ++num_all;
      }
    }
    EXPECT_GT(num_own, 0.8 * num_all) << motion;
  }
}

// The lines end at the border of image 2, half a pixel outside its outermost pixel centres: of an image of
// 16 px about one wrong point in sixteen lies in the half pixel where the lines leave, on either side.
TEST(EpipolarOutliers, ReachTheBordersOfTheImage) {
  const auto law = WithSettings(MakeEpipolarOutliers(), {{"outlier_min_shift_px", "0"}});
  int num_left = 0, num_right = 0;
  for (std::uint32_t trial = 0; trial < 8; ++trial) {
    const Scene scene = SceneForOutliers(
        300, trial, "sideways",
        {{"image2_width", "16"}, {"image2_height", "16"}, {"focal2_px", "17.5"}, {"max_rotation_deg", "0"}});
    for (const Correspondence& match : MakeWrong(*law, scene, 300, 0.0, trial).matches) {
      EXPECT_TRUE(scene.camera2.IsInImage(match.x2_px));
      num_left += match.x2_px.x() < 0.0;
      num_right += match.x2_px.x() > 15.0;
    }
  }
  EXPECT_GT(num_left, 20);
  EXPECT_GT(num_right, 20);
}

// A step to the right without rotation: image 2 shows the ray from where it is infinitely far, at the same
// place of image 2 as in image 1 for equal cameras, along the row to the border on the left. The wrong point
// is uniform there but for 2 x 30 px around the true one, and so is its inverse depth: Kolmogorov-Smirnov at
// 1e-4. That without the gap is seen.
TEST(EpipolarOutliers, AreUniformOnTheVisibleLineButForTheGap) {
  SceneGenerator generator("uniform_volume", "pinhole", "sideways");
  for (const auto& [key, value] : Settings{{"num_matches", "5000"}, {"max_rotation_deg", "0"}}) {
    FindParameter(generator.Parameters(), key).SetFromText(value);
  }
  RandomStream rng({.seed = 1, .purpose = 83});
  Scene scene = generator.Generate(rng);
  scene.cam2_from_cam1_true = {Eigen::Matrix3d::Identity(), -Eigen::Vector3d::UnitX()};
  std::erase_if(scene.points_in_cam1, [&](const Eigen::Vector3d& point) { return !scene.Sees(point); });
  const size_t n = scene.points_in_cam1.size();
  const auto law = WithSettings(MakeEpipolarOutliers(), {{"outlier_min_shift_px", "30"}});
  const DrawnOutliers wrong = MakeWrong(*law, scene, n);
  std::vector<double> places, places_without_gap;
  for (size_t i = 0; i < n; ++i) {
    if (!IsOnItsOwnRay(wrong, i)) continue;
    EXPECT_NEAR(wrong.matches[i].x2_px.y(), wrong.exact[i].x1_px.y(), 1e-9);
    const double from_far = wrong.exact[i].x1_px.x() - wrong.matches[i].x2_px.x();
    const double true_from_far = wrong.exact[i].x1_px.x() - wrong.exact[i].x2_px.x();
    const double length = wrong.exact[i].x1_px.x() + 0.5;
    const double before = std::max(0.0, true_from_far - 30.0),
                 after = std::max(0.0, length - true_from_far - 30.0);
    const double place = from_far < true_from_far ? from_far : from_far - (true_from_far + 30.0) + before;
    places.push_back(place / (before + after));
    places_without_gap.push_back(from_far / length);
  }
  const auto uniform = [](double u) { return std::clamp(u, 0.0, 1.0); };
  EXPECT_GT(places.size(), 3000u);
  EXPECT_GE(*std::ranges::min_element(places), -1e-9);
  EXPECT_LE(*std::ranges::max_element(places), 1.0 + 1e-9);
  EXPECT_GT(TestKolmogorovSmirnov(places, uniform).p_value, 1e-4);
  EXPECT_LT(TestKolmogorovSmirnov(places_without_gap, uniform).p_value, 1e-4) << "no power";
}

TEST(EpipolarOutliers, KeepTheNoiseOfTheMatchTheyReplace) {
  const Scene scene = SceneForOutliers(100);
  const auto law = MakeEpipolarOutliers();
  const DrawnOutliers exact = MakeWrong(*law, scene, 100), noisy = MakeWrong(*law, scene, 100, 0.5);
  for (size_t i = 0; i < 100; ++i) {
    const Eigen::Vector2d noise1_px = noisy.noisy[i].x1_px - noisy.exact[i].x1_px;
    const Eigen::Vector2d noise2_px = noisy.noisy[i].x2_px - noisy.exact[i].x2_px;
    EXPECT_LT((noisy.matches[i].x1_px - exact.matches[i].x1_px - noise1_px).norm(), 1e-9);
    EXPECT_LT((noisy.matches[i].x2_px - exact.matches[i].x2_px - noise2_px).norm(), 1e-9);
    if (IsOnItsOwnRay(exact, i)) {
      EXPECT_EQ(noisy.matches[i].x1_px, noisy.noisy[i].x1_px);
    }
  }
}

// The rays through a distortion are found by bisection, the pose between the two rows that were read from
// their times: matches then are as coplanar with the baseline as right ones, 1e-9, and those of ideal cameras
// are not.
double TripleProductOfRows(const ViewPair& view, const CameraDefects& defects, const Correspondence& match) {
  const auto ideal_ray = [&](const SceneCamera& camera, const Eigen::Vector2d& x_px) {
    const Eigen::Vector3d bent = camera.Ray(x_px);
    const double r = bent.head<2>().norm();
    double low = 0.0, high = 2.0;  // the factor from the bent ray back
    for (int i = 0; i < 100; ++i) {
      const double factor = 0.5 * (low + high);
      (factor * (1.0 + defects.distortion_k1 * factor * factor * r * r) < 1.0 ? low : high) = factor;
    }
    return Eigen::Vector3d(low * bent.x(), low * bent.y(), 1.0);
  };
  const Eigen::Vector3d w = VectorFromRotation(view.cam2_from_cam1_true.R);
  const auto time = [&](const SceneCamera& camera, double row_px) {
    return defects.rolling_shutter * ((row_px + 0.5) / camera.height - 0.5);
  };
  const double a1 = time(view.camera1, match.x1_px.y()), a2 = 1.0 + time(view.camera2, match.x2_px.y());
  const Eigen::Matrix3d R = RotationFromVector(a2 * w) * RotationFromVector(a1 * w).transpose();
  const Eigen::Vector3d t = view.cam2_from_cam1_true.t, T = a2 * t - R * (a1 * t);
  return ideal_ray(view.camera2, match.x2_px).dot(T.cross(R * ideal_ray(view.camera1, match.x1_px)));
}

TEST(EpipolarOutliers, WithDefectsOfTheCamerasAreAsRightMatchesAre) {
  const auto law = MakeEpipolarOutliers();
  for (const CameraDefects& defects : {CameraDefects{.distortion_k1 = 0.05},
                                       {.distortion_k1 = -0.02},
                                       {.rolling_shutter = 0.1},
                                       {.distortion_k1 = 0.05, .rolling_shutter = -0.1}}) {
    for (const char* motion : {"general", "forward", "sideways"}) {
      const Scene scene = SceneForOutliers(200, 3, motion, {{"max_rotation_deg", "5"}});
      const DrawnOutliers wrong = MakeWrong(*law, scene, 100, 0.0, 3, defects),
                          ideal = MakeWrong(*law, scene, 100, 0.0, 3);
      int num_far = 0;
      for (size_t i = 0; i < 200; ++i) {
        EXPECT_LT(std::abs(TripleProductOfRows(scene, defects, wrong.matches[i])), 1e-6) << motion << i;
        if (i < 100) {
          EXPECT_TRUE(wrong.is_undetectable[i]);
          num_far += std::abs(TripleProductOfRows(scene, defects, ideal.matches[i])) > 1e-5;
        }
      }
      EXPECT_GT(num_far, 50) << "no power: " << motion;
    }
  }
}

TEST(EpipolarOutliers, WithoutABaselineOrARoomyImageTheyNameTheKeys) {
  const auto law = MakeEpipolarOutliers();
  const Scene turning = SceneForOutliers(10, 0, "pure_rotation");
  EXPECT_TRUE(ThrowsInputError([&] { MakeWrong(*law, turning, 1); }, {"epipolar", "motion", "baseline_m"}));
  const auto far = WithSettings(MakeEpipolarOutliers(), {{"outlier_min_shift_px", "5000"}});
  EXPECT_TRUE(ThrowsInputError([&] { MakeWrong(*far, SceneForOutliers(10), 1); },
                               {"outlier_min_shift_px: 5000", "motion", "baseline_m"}));
}

}  // namespace
}  // namespace rcme
