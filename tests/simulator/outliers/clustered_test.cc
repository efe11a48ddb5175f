#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "simulator/outliers/outlier_laws.h"
#include "stats/distributions.h"
#include "tests/simulator/outliers/wrong_matches.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/goodness_of_fit.h"
#include "tests/test_support/uniform_cdf.h"

namespace rcme {
namespace {

double PUniform(const std::vector<double>& sample) {
  return TestKolmogorovSmirnov(sample, UniformCdf).p_value;
}

// The matches by cluster, for a spread far below the distance of the clusters: by the point in image 1 or 2,
// rounded to 10 px.
std::map<std::pair<long, long>, std::vector<Correspondence>> ByCluster(const DrawnOutliers& wrong,
                                                                       bool by_image1) {
  std::map<std::pair<long, long>, std::vector<Correspondence>> clusters;
  for (const Correspondence& match : wrong.matches) {
    const Eigen::Vector2d& x_px = by_image1 ? match.x1_px : match.x2_px;
    clusters[{std::lround(x_px.x() / 10.0), std::lround(x_px.y() / 10.0)}].push_back(match);
  }
  return clusters;
}

// Differences of successive points of one cluster, over sqrt(2) spread: standard normal whatever the centre
// is.
std::vector<double> Differences(const std::vector<Eigen::Vector2d>& points_px, double spread_px) {
  std::vector<double> differences;
  for (size_t i = 0; i + 1 < points_px.size(); i += 2) {
    for (const int axis : {0, 1}) {
      differences.push_back((points_px[i + 1](axis) - points_px[i](axis)) / (std::sqrt(2.0) * spread_px));
    }
  }
  return differences;
}

// One cluster of 4,000 matches whose spread is far below the image's size: normal with the given standard
// deviation (at 1e-4, one that is 20 % off is seen), the other end uniform or as it was.
TEST(ClusteredOutliers, AreNormalAroundACentreInTheImageTheyAreNamedAfter) {
  const Scene scene = SceneForOutliers(4000);
  const Settings one_cluster = {{"num_outlier_clusters", "1"}, {"outlier_spread_px", "0.5"}};
  for (const bool in_image1 : {true, false}) {
    const auto law = WithSettings(in_image1 ? MakeClusteredInImage1() : MakeClusteredInImage2(), one_cluster);
    const DrawnOutliers wrong = MakeWrong(*law, scene, 4000, 0.3, 3);
    std::vector<Eigen::Vector2d> clustered;
    std::vector<double> other_x, other_y;
    for (size_t i = 0; i < 4000; ++i) {
      clustered.push_back(in_image1 ? wrong.matches[i].x1_px : wrong.matches[i].x2_px);
      other_x.push_back((wrong.matches[i].x2_px.x() + 0.5) / scene.camera2.width);
      other_y.push_back((wrong.matches[i].x2_px.y() + 0.5) / scene.camera2.height);
      if (!in_image1) {
        ASSERT_EQ(wrong.matches[i].x1_px, wrong.noisy[i].x1_px);
      }
    }
    EXPECT_GT(TestKolmogorovSmirnov(Differences(clustered, 0.5), NormalCdf).p_value, 1e-4);
    EXPECT_LT(TestKolmogorovSmirnov(Differences(clustered, 0.6), NormalCdf).p_value, 1e-4) << "no power";
    if (in_image1) {
      EXPECT_GT(PUniform(other_x), 1e-4);
      EXPECT_GT(PUniform(other_y), 1e-4);
    } else {
      EXPECT_LT(PUniform(other_x), 1e-10) << "no power";
    }
  }
}

// The offset from the centre is the same in both images, up to the match's own noise: x2 - x1 takes one value
// a cluster. Without noise to rounding.
TEST(ClusteredOutliers, InBothImagesAClusterAgreesOnOneShift) {
  const Scene scene = SceneForOutliers(2000);
  const auto law =
      WithSettings(MakeClusteredInBoth(), {{"num_outlier_clusters", "4"}, {"outlier_spread_px", "15"}});
  std::map<std::pair<long, long>, int> shifts;
  const DrawnOutliers exact = MakeWrong(*law, scene, 2000), noisy = MakeWrong(*law, scene, 2000, 0.3);
  std::vector<Eigen::Vector2d> spread;
  for (size_t i = 0; i < 2000; ++i) {
    const Eigen::Vector2d shift_px = exact.matches[i].x2_px - exact.matches[i].x1_px;
    ++shifts[{std::lround(shift_px.x() * 1e6), std::lround(shift_px.y() * 1e6)}];
    EXPECT_TRUE(scene.camera1.IsInImage(exact.matches[i].x1_px));
    EXPECT_TRUE(scene.camera2.IsInImage(exact.matches[i].x2_px));
    // The match's own noise.
    EXPECT_LT((noisy.matches[i].x1_px - exact.matches[i].x1_px - noisy.noisy[i].x1_px + exact.exact[i].x1_px)
                  .norm(),
              1e-9);
    EXPECT_LT((noisy.matches[i].x2_px - exact.matches[i].x2_px - noisy.noisy[i].x2_px + exact.exact[i].x2_px)
                  .norm(),
              1e-9);
  }
  EXPECT_EQ(shifts.size(), 4u);
}

// Chi-square of the number of matches in each of 20 clusters (19 degrees of freedom) at 1e-4; were one
// cluster drawn twice as often as the others, it would be seen.
TEST(ClusteredOutliers, EveryClusterIsEquallyLikely) {
  const Scene scene = SceneForOutliers(4000);
  const auto law =
      WithSettings(MakeClusteredInImage2(), {{"num_outlier_clusters", "20"}, {"outlier_spread_px", "0.001"}});
  const auto chi_square = [](const std::vector<double>& counts) {
    double total = 0.0, sum = 0.0;
    for (const double count : counts) total += count;
    const double expected = total / static_cast<double>(counts.size());
    for (const double count : counts) sum += (count - expected) * (count - expected) / expected;
    return sum;
  };
  std::vector<double> counts;
  for (const auto& [place, matches] : ByCluster(MakeWrong(*law, scene, 4000), false)) {
    counts.push_back(static_cast<double>(matches.size()));
  }
  ASSERT_EQ(counts.size(), 20u);
  const double limit = ChiSquareQuantile(19, 1.0 - 1e-4);
  EXPECT_LT(chi_square(counts), limit);
  counts[0] *= 2.0;
  EXPECT_GT(chi_square(counts), 2.0 * limit) << "no power";
}

// 2,000 centres of each law: uniform over the image in both coordinates, at 1e-4; over the other camera's
// image they are not.
TEST(ClusteredOutliers, CentresAreUniformOverTheImage) {
  const Scene scene = SceneForOutliers(1);
  const Settings tiny = {{"num_outlier_clusters", "1"}, {"outlier_spread_px", "0.001"}};
  for (const bool in_image1 : {true, false}) {
    const auto law = WithSettings(in_image1 ? MakeClusteredInImage1() : MakeClusteredInImage2(), tiny);
    const Camera& camera = in_image1 ? scene.camera1 : scene.camera2;
    const Camera& other = in_image1 ? scene.camera2 : scene.camera1;
    std::vector<double> x, y, x_in_other;
    for (std::uint32_t trial = 0; trial < 2000; ++trial) {
      const Correspondence match = MakeWrong(*law, scene, 1, 0.0, trial).matches[0];
      const Eigen::Vector2d x_px = in_image1 ? match.x1_px : match.x2_px;
      x.push_back((x_px.x() + 0.5) / camera.width);
      y.push_back((x_px.y() + 0.5) / camera.height);
      x_in_other.push_back((x_px.x() + 0.5) / other.width);
    }
    EXPECT_GT(PUniform(x), 1e-4);
    EXPECT_GT(PUniform(y), 1e-4);
    EXPECT_LT(PUniform(x_in_other), 1e-10) << "no power";
  }
}

TEST(ClusteredOutliers, ASpreadFarBeyondTheImageNamesTheKey) {
  const Scene scene = SceneForOutliers(200, 0, "general");
  const auto law = WithSettings(MakeClusteredInBoth(), {{"outlier_spread_px", "10000"}});
  EXPECT_TRUE(ThrowsInputError([&] { MakeWrong(*law, scene, 200); }, {"outlier_spread_px: 10000"}));
}

}  // namespace
}  // namespace rcme
