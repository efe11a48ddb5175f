#include "estimator/kernels/soft_score.h"

#include <gtest/gtest.h>

#include <optional>

#include "estimator/calibrated/match_terms.h"
#include "estimator/geometry/essential_matrix.h"
#include "tests/test_support/every_target.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

class SoftScoreOf : public OnEveryTarget {};

constexpr double kScale = 2.5;
constexpr int kSoftSizes[] = {1, 7, 8, 9, 15, 16, 17, 31, 33, 200};

struct SoftProblem {
  MotionProblem problem;
  RelativePose pose;
};
SoftProblem MakeSoftProblem(int num_matches) {
  SoftProblem c;
  c.problem = TwoCameraProblem(num_matches, 0.5, 0.3, static_cast<std::uint32_t>(num_matches), &c.pose);
  return c;
}

double ScalarSum(const SoftProblem& c, int first, int end) {
  double sum = 0.0;
  for (int i = first; i < end; ++i) {
    const Correspondence& match = c.problem.matches[static_cast<size_t>(i)];
    sum += SoftScore(EvaluateMatch(c.problem, c.pose, match).residual, kScale);
  }
  return sum;
}

double Sum(const SoftProblem& c, int first, int end, double length = 1.0) {
  const MatchBlocks matches(c.problem);
  double F[9];
  WriteRowMajor(length * matches.FundamentalFromEssential(EssentialFromPose(c.pose)), F);
  return ScoreMatches(matches).SumScores(F, kScale, first, end);
}

// Single precision: coordinates of up to 1e3 sigma, so that residuals are good to some 1e-3 sigma.
TEST_F(SoftScoreOf, EqualsTheSumInDoublePrecision) {
  for (const int n : kSoftSizes) {
    const SoftProblem c = MakeSoftProblem(n);
    const double expected = ScalarSum(c, 0, n);
    ASSERT_GT(expected, 0.3 * n);
    Run([&] { EXPECT_NEAR(Sum(c, 0, n), expected, 2e-3 * n) << n; });
  }
}

TEST_F(SoftScoreOf, TheLengthOfFMeansNothing) {
  const SoftProblem c = MakeSoftProblem(33);
  const double expected = ScalarSum(c, 0, 33);
  Run([&] {
    for (const double length : {1e-12, -1.0, 1e12}) EXPECT_NEAR(Sum(c, 0, 33, length), expected, 0.05);
  });
}

TEST_F(SoftScoreOf, PartsAddUpToTheWhole) {
  const SoftProblem c = MakeSoftProblem(200);
  Run([&] {
    const double whole = Sum(c, 0, 200);
    for (const int at : {16, 64, 192}) EXPECT_NEAR(Sum(c, 0, at) + Sum(c, at, 200), whole, 1e-4);
    EXPECT_NEAR(Sum(c, 16, 61), ScalarSum(c, 16, 61), 0.1);
    EXPECT_EQ(Sum(c, 64, 64), 0.0);
  });
}

TEST_F(SoftScoreOf, IsTheSameBitsOnEveryInstructionSet) {
  for (const int n : kSoftSizes) {
    const SoftProblem c = MakeSoftProblem(n);
    std::optional<double> first;
    Run([&] {
      const double sum = Sum(c, 0, n);
      if (!first) first = sum;
      EXPECT_EQ(sum, *first) << n;
    });
  }
}

TEST_F(SoftScoreOf, OfNoModelIsZero) {
  const SoftProblem c = MakeSoftProblem(20);
  Run([&] { EXPECT_EQ(Sum(c, 0, 20, 0.0), 0.0); });
}

}  // namespace
}  // namespace rcme
