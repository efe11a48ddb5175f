#include "simulator/observe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "simulator/noise/noise_laws.h"
#include "stats/distributions.h"
#include "tests/test_support/goodness_of_fit.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

Scene MakeScene(int num_matches, std::uint32_t trial = 0) { return TwoCameraScene(num_matches, trial); }

Observation ObserveScene(const Scene& scene, double sigma_px, double outlier_ratio, std::uint32_t trial = 0) {
  RandomStream noise_rng({1, 0, trial, 2}), outlier_rng({1, 0, trial, 3});
  return Observe(scene, *MakeGaussianNoise(sigma_px), OutlierModel(outlier_ratio), noise_rng, outlier_rng);
}

// The exact projections, sorted by x1: observations come shuffled.
std::vector<Eigen::Vector4d> Projections(const Scene& scene) {
  std::vector<Eigen::Vector4d> all;
  for (const Eigen::Vector3d& point : scene.points_in_cam1) {
    Eigen::Vector4d x;
    x << scene.camera1.Project(point), scene.camera2.Project(scene.InCamera2(point));
    all.push_back(x);
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a(0) < b(0); });
  return all;
}

TEST(Observe, TheOutlierRatioIsExact) {
  for (const int n : {1, 7, 500}) {
    for (const double ratio : {0.0, 0.1, 0.25, 0.5, 1.0}) {
      const Observation observation = ObserveScene(MakeScene(n), 0.5, ratio);
      const auto num_outliers =
          std::count(observation.is_inlier_true.begin(), observation.is_inlier_true.end(), false);
      EXPECT_EQ(num_outliers, std::lround(ratio * n)) << n << " " << ratio;
      EXPECT_EQ(static_cast<int>(observation.matches.size()), n);
    }
  }
}

// All 4 x 2,000 noise values against N(0, sigma^2), Kolmogorov-Smirnov at 1e-4; the same test rejects a sigma
// that is 10 % off (D is about 0.024, sqrt(n) D = 2.2, p about 1e-4; measured below at 20 %: p < 1e-10).
TEST(Observe, NoiseIsGaussianWithTheGivenSigmaInEveryCoordinate) {
  const Scene scene = MakeScene(2000);
  const double sigma = 1e-6;  // far below the spacing of the points: the order by x1 is kept
  std::vector<Correspondence> matches = ObserveScene(scene, sigma, 0.0).matches;
  std::sort(matches.begin(), matches.end(),
            [](const auto& a, const auto& b) { return a.x1_px.x() < b.x1_px.x(); });
  const std::vector<Eigen::Vector4d> exact = Projections(scene);
  std::vector<double> noise;
  for (size_t i = 0; i < matches.size(); ++i) {
    Eigen::Vector4d x;
    x << matches[i].x1_px, matches[i].x2_px;
    for (int k = 0; k < 4; ++k) noise.push_back((x(k) - exact[i](k)) / sigma);
  }
  EXPECT_GT(TestKolmogorovSmirnov(noise, NormalCdf).p_value, 1e-4);
  EXPECT_LT(TestKolmogorovSmirnov(noise, [](double x) { return NormalCdf(x / 1.2); }).p_value, 1e-10);
}

// Mismatches are uniform over image 2 in both coordinates.
TEST(Observe, OutliersAreUniformInImage2) {
  const Observation observation = ObserveScene(MakeScene(5000), 0.5, 1.0);
  std::vector<double> x, y;
  for (const Correspondence& match : observation.matches) {
    x.push_back((match.x2_px.x() + 0.5) / TestCamera2().width);
    y.push_back((match.x2_px.y() + 0.5) / TestCamera2().height);
  }
  const auto uniform = [](double u) { return std::clamp(u, 0.0, 1.0); };
  EXPECT_GT(TestKolmogorovSmirnov(x, uniform).p_value, 1e-4);
  EXPECT_GT(TestKolmogorovSmirnov(y, uniform).p_value, 1e-4);
}

TEST(Observe, NoiseDoesNotDependOnTheOutlierRatio) {
  const Scene scene = MakeScene(100);
  const Observation clean = ObserveScene(scene, 0.5, 0.0);
  const Observation mixed = ObserveScene(scene, 0.5, 0.3);
  std::set<std::pair<double, double>> clean_x1, mixed_x1;
  for (const Correspondence& match : clean.matches) clean_x1.insert({match.x1_px.x(), match.x1_px.y()});
  for (const Correspondence& match : mixed.matches) mixed_x1.insert({match.x1_px.x(), match.x1_px.y()});
  EXPECT_EQ(clean_x1, mixed_x1);
}

// Match by match: noise in the order of the points, mismatches in a random order, a second order for the
// list.
Observation ObserveOneByOne(const Scene& scene, double sigma_px, size_t num_outliers, std::uint32_t trial) {
  RandomStream noise_rng({1, 0, trial, 2}), outlier_rng({1, 0, trial, 3});
  std::vector<Correspondence> matches;
  for (const Eigen::Vector3d& point : scene.points_in_cam1) {
    matches.push_back({scene.camera1.Project(point), scene.camera2.Project(scene.InCamera2(point))});
    for (Eigen::Vector2d* x_px : {&matches.back().x1_px, &matches.back().x2_px}) {
      for (int k = 0; k < 2; ++k) (*x_px)(k) += sigma_px * noise_rng.Normal();
    }
  }
  std::vector<size_t> order(matches.size());
  std::iota(order.begin(), order.end(), size_t{0});
  outlier_rng.Shuffle(std::span(order));
  std::vector<bool> is_inlier(matches.size(), true);
  for (size_t k = 0; k < num_outliers; ++k) {
    for (const int axis : {0, 1}) {
      const int size = axis == 0 ? scene.camera2.width : scene.camera2.height;
      matches[order[k]].x2_px(axis) = outlier_rng.Uniform(-0.5, size - 0.5);
    }
    is_inlier[order[k]] = false;
  }
  outlier_rng.Shuffle(std::span(order));
  Observation observation;
  for (const size_t i : order) {
    observation.matches.push_back(matches[i]);
    observation.is_inlier_true.push_back(is_inlier[i]);
  }
  return observation;
}

TEST(Observe, IsThePlainLoopOverMatches) {
  for (const int n : {1, 7, 64, 65, 500}) {
    for (std::uint32_t trial = 0; trial < 20; ++trial) {
      const Scene scene = MakeScene(n, trial);
      const Observation observation = ObserveScene(scene, 0.5, 0.2, trial);
      const Observation plain = ObserveOneByOne(scene, 0.5, static_cast<size_t>(std::lround(0.2 * n)), trial);
      ASSERT_EQ(observation.is_inlier_true, plain.is_inlier_true);
      for (size_t i = 0; i < plain.matches.size(); ++i) {
        ASSERT_EQ(observation.matches[i].x1_px, plain.matches[i].x1_px);
        ASSERT_EQ(observation.matches[i].x2_px, plain.matches[i].x2_px);
      }
    }
  }
}

// The place of an outlier in the list says nothing: over 500 scenes the first match is one at the outlier
// ratio. 500 Bernoulli(0.2): mean 100, sd 8.9; 4.5 sd either way has a false-alarm rate below 1e-5, and a
// list that begins with its outliers gives 500.
TEST(Observe, OutliersStandAnywhereInTheList) {
  int num_first = 0;
  const Scene scene = MakeScene(50);
  for (std::uint32_t trial = 0; trial < 500; ++trial) {
    num_first += !ObserveScene(scene, 0.5, 0.2, trial).is_inlier_true[0];
  }
  EXPECT_NEAR(num_first, 100, 40);
}

}  // namespace
}  // namespace rcme
