#include "estimator/calibrated/neighbour_matches.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

MotionProblem MakeNeighbourProblem(std::vector<Correspondence> matches, double sigma_px) {
  MotionProblem problem;
  problem.camera1 = TestCamera1();
  problem.camera2 = TestCamera2();
  problem.sigma_px = sigma_px;
  problem.matches = std::move(matches);
  return problem;
}

TEST(NearestNeighbours, AreTheNearestThatAreFarEnoughInBothImages) {
  const MotionProblem problem = MakeNeighbourProblem({{{0.0, 0.0}, {0.0, 0.0}},
                                                      {{0.5, 0.0}, {9.0, 0.0}},
                                                      {{3.0, 0.0}, {0.5, 0.0}},
                                                      {{5.0, 0.0}, {5.0, 0.0}}},
                                                     1.0);
  EXPECT_EQ(FindNearestNeighbours(problem, {0, 1, 2, 3}, 0.0), (std::vector<size_t>{1, 0, 3, 2}));
  // Two key points half a pixel apart in either image are one.
  EXPECT_EQ(FindNearestNeighbours(problem, {0, 1, 2, 3}, 1.0), (std::vector<size_t>{3, 2, 3, 2}));
  EXPECT_EQ(FindNearestNeighbours(problem, {2}, 0.0), std::vector<size_t>{0}) << "itself";
}

// Matches that share a displacement move together; of 100 unrelated ones fewer than ten do in any of 20
// draws.
TEST(Coherence, IsOneOfAPatchAndNearlyZeroOfUnrelatedMatches) {
  std::vector<size_t> all(100);
  std::iota(all.begin(), all.end(), size_t{0});
  double greatest = 0.0;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2844});
    const auto point = [&] { return Eigen::Vector2d(rng.Uniform(0.0, 640.0), rng.Uniform(0.0, 480.0)); };
    std::vector<Correspondence> together, unrelated;
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector2d x1 = point();
      together.push_back({x1, x1 + Eigen::Vector2d(20.0, -7.0)});
      unrelated.push_back({x1, point()});
    }
    EXPECT_EQ(ComputeCoherence(MakeNeighbourProblem(together, 0.5), all), 1.0);
    greatest = std::max(greatest, ComputeCoherence(MakeNeighbourProblem(unrelated, 0.5), all));
  }
  EXPECT_LT(greatest, 0.1);
  EXPECT_EQ(ComputeCoherence(MakeNeighbourProblem({{{1.0, 2.0}, {3.0, 4.0}}}, 0.5), {0}), 0.0)
      << "no neighbour";
}

}  // namespace
}  // namespace rcme
