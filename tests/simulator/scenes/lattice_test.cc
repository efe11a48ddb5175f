#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "simulator/scenes/scenes.h"
#include "stats/distributions.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/scene_samples.h"

namespace rcme {
namespace {

// All sites that StillView() shows, in the order of the draw: candidates until there are no more.
std::vector<Eigen::Vector3d> Sites(const SceneModel& model, std::uint32_t trial = 0) {
  const auto world = DrawWorld(model, trial);
  RandomStream rng({1, 0, trial, 2});
  std::vector<Eigen::Vector3d> sites;
  PointBlock block;
  do {
    world->DrawCandidates(0, sites.size(), rng, &block);
    for (size_t i = 0; i < PointBlock::kSize && block.z_m[i] > 0.0; ++i) {
      sites.emplace_back(block.x_m[i], block.y_m[i], block.z_m[i]);
    }
  } while (block.z_m[PointBlock::kSize - 1] > 0.0);
  return sites;
}

bool Holds(const std::vector<Eigen::Vector3d>& sites, const Eigen::Vector3d& site) {
  return std::ranges::any_of(sites, [&](const auto& other) { return (other - site).norm() < 1e-12; });
}

// 8 x 6 cells of 0.5 m at 10 m: 4 m x 3 m in a view of 9.1 m x 6.9 m.
const Settings kSmall = {{"lattice_columns", "8"}, {"lattice_rows", "6"}, {"motif_points", "3"}};

TEST(Lattice, EveryCellShowsTheSameMotif) {
  const auto model = Configured(MakeLattice(), kSmall);
  const std::vector<Eigen::Vector3d> sites = Sites(*model);
  ASSERT_EQ(sites.size(), 8u * 6u * 3u);
  const std::vector<Eigen::Vector3d> steps_m = DrawWorld(*model)->RepeatSteps();
  EXPECT_THAT(steps_m, testing::ElementsAre(Eigen::Vector3d(0.5, 0, 0), Eigen::Vector3d(0, 0.5, 0)));
  // A step leads from every site to a site, but for those of the last column or row.
  for (const auto& [step, num_lines] : {std::pair{0, 8}, {1, 6}}) {
    const auto num_carried = std::ranges::count_if(sites, [&, k = step](const auto& site) {
      return Holds(sites, site + steps_m[static_cast<size_t>(k)]);
    });
    EXPECT_EQ(num_carried, 144 - 144 / num_lines);
  }
}

// Where the lattice is larger than the view, a step leads to a site or out of the image.
TEST(Lattice, StepsLeadToSitesWhereverTheImageShowsThem) {
  const auto model = Configured(MakeLattice(), {{"lattice_step_m", "1"}, {"motif_points", "4"}});
  const std::vector<Eigen::Vector3d> sites = Sites(*model);
  ASSERT_GT(sites.size(), 150u);
  for (const Eigen::Vector3d& site : sites) {
    for (const Eigen::Vector3d& step_m : DrawWorld(*model)->RepeatSteps()) {
      for (const double sign : {-1.0, 1.0}) {
        const Eigen::Vector3d twin = site + sign * step_m;
        EXPECT_EQ(Holds(sites, twin), StillView().Sees(twin));
      }
    }
  }
}

// Points of the motif in the cell and in depth: 1,500 motifs of two points; Kolmogorov-Smirnov at 1e-4, and a
// relief 15 % larger is rejected (D = 0.065, sqrt(n) D = 3.6).
TEST(Lattice, TheMotifIsUniformInTheCellAndInTheRelief) {
  const auto model =
      Configured(MakeLattice(), {{"lattice_columns", "1"}, {"lattice_rows", "1"}, {"motif_points", "2"}});
  std::vector<double> differences, depths_m;
  for (std::uint32_t trial = 0; trial < 1500; ++trial) {
    const std::vector<Eigen::Vector3d> motif = Sites(*model, trial);
    ASSERT_EQ(motif.size(), 2u);
    for (const Eigen::Vector3d& point : motif) depths_m.push_back(point.z());
    for (const int k : {0, 1}) differences.push_back(std::abs(motif[0](k) - motif[1](k)) / 0.5);
  }
  EXPECT_GT(UniformPValue(depths_m, 9.8, 10.2), 1e-4);
  EXPECT_LT(UniformPValue(depths_m, 9.77, 10.23), 1e-6);
  // The distance of two uniform numbers: P(d <= x) = 1 - (1 - x)^2.
  const auto cdf = [](double x) { return 1.0 - (1.0 - std::min(x, 1.0)) * (1.0 - std::min(x, 1.0)); };
  EXPECT_GT(TestKolmogorovSmirnov(differences, cdf).p_value, 1e-4);
}

// The lattice stands anywhere within half a cell of the optical axis: its left border over 2,000 worlds, by a
// cell of so many points that the leftmost is 1/500 of a cell from it. Kolmogorov-Smirnov at 1e-4; the bias
// of 1/500 is far below the test's D of 0.05.
TEST(Lattice, ThePlaceOfTheLatticeIsUniformWithinACell) {
  const auto model =
      Configured(MakeLattice(), {{"lattice_columns", "1"}, {"lattice_rows", "1"}, {"motif_points", "500"}});
  std::vector<double> left, top;
  for (std::uint32_t trial = 0; trial < 2000; ++trial) {
    const std::vector<Eigen::Vector3d> motif = Sites(*model, trial);
    left.push_back(std::min(std::ranges::min_element(motif, {}, Coordinate(0))->x(), 0.0));
    top.push_back(std::min(std::ranges::min_element(motif, {}, Coordinate(1))->y(), 0.0));
  }
  EXPECT_GT(UniformPValue(left, -0.5, 0.0), 1e-4);
  EXPECT_GT(UniformPValue(top, -0.5, 0.0), 1e-4);
}

// The first site drawn, over 4,800 worlds of 8 x 6 cells: Pearson's chi-square at 1e-4. A cell drawn twice as
// often as it should (200 for 100) gives 100 more than the 47 expected: rejected.
TEST(Lattice, EverySiteIsEquallyLikelyToBeDrawnFirst) {
  const auto model = Configured(MakeLattice(), kSmall);
  std::vector<double> counts(48, 0.0);
  for (std::uint32_t trial = 0; trial < 4800; ++trial) {
    const std::vector<Eigen::Vector3d> sites = Sites(*model, trial);
    // A site's cell: how many of its own motif are left of it and above it.
    int column = 0, row = 0;
    for (const Eigen::Vector3d& other : sites) {
      if (std::abs(other.z() - sites[0].z()) > 1e-13) continue;
      column += std::abs(other.y() - sites[0].y()) < 1e-9 && other.x() < sites[0].x() - 0.1;
      row += std::abs(other.x() - sites[0].x()) < 1e-9 && other.y() < sites[0].y() - 0.1;
    }
    counts[static_cast<size_t>(8 * row + column)] += 1.0;
  }
  const auto p_value = [&] {
    double statistic = 0.0;
    for (const double count : counts) statistic += (count - 100.0) * (count - 100.0) / 100.0;
    return 1.0 - ChiSquareCdf(47, statistic);
  };
  EXPECT_GT(p_value(), 1e-4);
  counts[0] += 100.0;
  EXPECT_LT(p_value(), 1e-4);
}

TEST(Lattice, NoPointComesTwiceEvenIfAllSitesAreNeeded) {
  SceneGenerator generator("lattice", "pinhole", "pure_rotation");
  Set(generator, kSmall);
  Set(generator, {{"num_matches", "144"}, {"max_rotation_deg", "0"}});
  const Scene scene = Generate(generator, 0);
  std::set<std::vector<double>> different;
  for (const Eigen::Vector3d& point : scene.points_in_cam1) {
    different.insert({point.x(), point.y(), point.z()});
  }
  EXPECT_EQ(different.size(), 144u);
  EXPECT_EQ(scene.repeat_steps_m.size(), 2u);
  Set(generator, {{"num_matches", "145"}});
  EXPECT_TRUE(
      ThrowsInputError([&] { Generate(generator, 0); },
                       {"only 144 of", "145 are needed", "num_matches", "motif_points", "lattice_rows"}));
}

TEST(Lattice, ContradictionsNameTheirKeysAndAHugeLatticeIsRefused) {
  const auto refuses = [](const Settings& settings, const std::vector<std::string>& fragments) {
    SceneGenerator generator("lattice");
    Set(generator, settings);
    return ThrowsInputError([&] { Generate(generator, 0); }, fragments);
  };
  EXPECT_TRUE(refuses({{"relief_m", "10"}}, {"relief_m: 10", "lattice_depth_m = 10"}));
  EXPECT_TRUE(refuses({{"lattice_columns", "10000"}, {"lattice_rows", "10000"}, {"motif_points", "10000"}},
                      {"lattice_columns", "lattice_rows", "motif_points", "10000 x 10000 x 10000"}));
  EXPECT_TRUE(refuses({{"lattice_depth_m", "0.5"}, {"baseline_m", "50"}}, {"lattice_depth_m", "baseline_m"}));
}

}  // namespace
}  // namespace rcme
