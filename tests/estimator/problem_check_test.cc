#include "estimator/problem_check.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "stats/constants.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

MotionProblem OrdinaryProblem(int num_matches, std::uint32_t trial = 0) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 140});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = num_matches});
  AddNoise(0.5, rng, &random.problem);
  return random.problem;
}

// The refusal must have this status, and a sentence that holds `word`.
void ExpectRefusal(const MotionProblem& problem, MotionStatus status, const std::string& word) {
  const std::optional<MotionEstimate> refusal = RefuseUnsolvable(problem, 8);
  ASSERT_TRUE(refusal) << word;
  EXPECT_EQ(refusal->status, status) << refusal->message;
  EXPECT_NE(refusal->message.find(word), std::string::npos) << refusal->message;
  EXPECT_EQ(refusal->counts.num_hypotheses, 0);
}

TEST(RefuseUnsolvable, OrdinaryProblemsAreAccepted) {
  for (std::uint32_t trial = 0; trial < 2000; ++trial) {
    const std::optional<MotionEstimate> refusal = RefuseUnsolvable(OrdinaryProblem(8, trial), 8);
    EXPECT_FALSE(refusal) << refusal->message;
  }
  EXPECT_FALSE(RefuseUnsolvable(OrdinaryProblem(500), 8));
}

TEST(RefuseUnsolvable, MatchesAllWrongAreNotItsBusiness) {
  RandomStream rng({.seed = 1, .purpose = 141});
  MotionProblem problem = OrdinaryProblem(50);
  for (Correspondence& match : problem.matches) match.x2_px << rng.Uniform(0, 799), rng.Uniform(0, 599);
  EXPECT_FALSE(RefuseUnsolvable(problem, 8));
}

TEST(RefuseUnsolvable, BadCamera) {
  for (const double bad : {0.0, -700.0, kNaN, kInfinity}) {
    MotionProblem problem = OrdinaryProblem(20);
    problem.camera1.fx = bad;
    ExpectRefusal(problem, MotionStatus::kInvalidInput, "camera");
    problem = OrdinaryProblem(20);
    problem.camera2.fy = bad;
    ExpectRefusal(problem, MotionStatus::kInvalidInput, "camera");
  }
  MotionProblem problem = OrdinaryProblem(20);
  problem.camera2.width = 0;
  ExpectRefusal(problem, MotionStatus::kInvalidInput, "camera");
}

TEST(RefuseUnsolvable, BadNoiseLevel) {
  for (const double bad : {0.0, -0.5, kNaN, kInfinity}) {
    MotionProblem problem = OrdinaryProblem(20);
    problem.sigma_px = bad;
    ExpectRefusal(problem, MotionStatus::kInvalidInput, "sigma_px");
  }
}

TEST(RefuseUnsolvable, NoiseScalesAreOnePerMatchFiniteAndPositive) {
  MotionProblem problem = OrdinaryProblem(20);
  problem.noise_scale.assign(20, 2.0);
  EXPECT_FALSE(RefuseUnsolvable(problem, 8));
  for (const double bad : {0.0, -1.0, kNaN, kInfinity, 1e-7, 1e7}) {
    problem.noise_scale[7] = bad;
    ExpectRefusal(problem, MotionStatus::kInvalidInput, "noise_scale of match 7 is ");
  }
  for (const size_t count : {1u, 19u, 21u}) {
    problem.noise_scale.assign(count, 1.0);
    ExpectRefusal(problem, MotionStatus::kInvalidInput, fmt::format("{} entries for 20 matches", count));
  }
}

TEST(RefuseUnsolvable, MatchQualitiesAreOnePerMatchAndFinite) {
  MotionProblem problem = OrdinaryProblem(20);
  problem.match_quality.assign(20, -2.0);
  EXPECT_FALSE(RefuseUnsolvable(problem, 8));
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    problem.match_quality[7] = bad;
    ExpectRefusal(problem, MotionStatus::kInvalidInput, "match_quality of match 7 is ");
  }
  for (const size_t count : {1u, 19u, 21u}) {
    problem.match_quality.assign(count, 1.0);
    ExpectRefusal(problem, MotionStatus::kInvalidInput, fmt::format("{} entries for 20 matches", count));
  }
}

TEST(RefuseUnsolvable, BadCoordinateIsNamed) {
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1.1e6, -1.1e6}) {
    for (int coordinate = 0; coordinate < 4; ++coordinate) {
      MotionProblem problem = OrdinaryProblem(20);
      Correspondence& match = problem.matches[13];
      (coordinate < 2 ? match.x1_px(coordinate) : match.x2_px(coordinate - 2)) = bad;
      ExpectRefusal(problem, MotionStatus::kInvalidInput, "match 13 ");
    }
  }
}

TEST(RefuseUnsolvable, TooFewMatches) {
  ExpectRefusal(OrdinaryProblem(0), MotionStatus::kTooFewMatches, "0 distinct matches of 0");
  ExpectRefusal(OrdinaryProblem(7), MotionStatus::kTooFewMatches, "7 distinct matches of 7; at least 8");
}

TEST(RefuseUnsolvable, RepeatedMatchesCountOnce) {
  MotionProblem problem = OrdinaryProblem(7);
  for (int i = 0; i < 20; ++i) problem.matches.push_back(problem.matches[static_cast<size_t>(i % 7)]);
  ExpectRefusal(problem, MotionStatus::kTooFewMatches, "7 distinct matches of 27");
  // One coordinate apart is another match.
  problem.matches.push_back(problem.matches[0]);
  problem.matches.back().x2_px.y() += 1e-3;
  EXPECT_FALSE(RefuseUnsolvable(problem, 8));
}

TEST(RefuseUnsolvable, MinimumIsTheCallers) {
  EXPECT_FALSE(RefuseUnsolvable(OrdinaryProblem(5), 5));
  EXPECT_TRUE(RefuseUnsolvable(OrdinaryProblem(4), 5));
}

TEST(RefuseUnsolvable, PointsOfOneImageOnALine) {
  RandomStream rng({.seed = 1, .purpose = 142});
  for (const bool in_first : {true, false}) {
    for (const double slope : {0.0, 0.7, -30.0}) {
      MotionProblem problem = OrdinaryProblem(50);
      const Eigen::Vector2d along = Eigen::Vector2d(1.0, slope).normalized();
      const Eigen::Vector2d normal(-along.y(), along.x());
      for (Correspondence& match : problem.matches) {
        Eigen::Vector2d& point = in_first ? match.x1_px : match.x2_px;
        // On the line, with the noise of the problem.
        point =
            Eigen::Vector2d(300.0, 200.0) + rng.Uniform(-150.0, 150.0) * along + 0.5 * rng.Normal() * normal;
      }
      ExpectRefusal(problem, MotionStatus::kDegenerateMatches, in_first ? "image 1" : "image 2");
    }
  }
}

TEST(RefuseUnsolvable, PointsInOneSpotAreOnALineToo) {
  MotionProblem problem = OrdinaryProblem(50);
  for (Correspondence& match : problem.matches) match.x1_px << 320.0, 240.0;
  ExpectRefusal(problem, MotionStatus::kDegenerateMatches, "image 1");
}

TEST(RefuseUnsolvable, NarrowBandWellAboveTheNoiseIsAccepted) {
  RandomStream rng({.seed = 1, .purpose = 143});
  MotionProblem problem = OrdinaryProblem(50);
  for (Correspondence& match : problem.matches) match.x1_px.y() = 200.0 + 5.0 * rng.Normal();
  EXPECT_FALSE(RefuseUnsolvable(problem, 8));
}

}  // namespace
}  // namespace rcme
