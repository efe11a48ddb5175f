#include "estimator/calibrated/hypothesis_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "estimator/geometry/essential_matrix.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

HypothesisSearch Search(const MotionProblem& problem, const CalibratedOptions& options) {
  const MatchBlocks matches(problem);
  RandomStream rng({.seed = 1, .purpose = 2750});
  return SearchHypotheses(matches, ScoreMatches(matches), options, rng);
}
HypothesisSearch SearchSamples(const MotionProblem& problem, int num_samples) {
  CalibratedOptions options;
  options.min_samples = options.max_samples = num_samples;
  return Search(problem, options);
}

// Samples of five until one is right throughout with probability 0.999, by the share that the best score
// shows (0.88 a right match).
int SamplesFor(double best_score, int num_matches) {
  const double share = std::min(best_score / (0.88 * num_matches), 0.999);
  return static_cast<int>(std::ceil(std::log(1e-3) / std::log(1.0 - std::pow(share, 5))));
}

TEST(HypothesisSearch, DrawsAsManySamplesAsTheShareOfRightMatchesNeeds) {
  for (const double outlier_ratio : {0.0, 0.3, 0.5, 0.6}) {
    const MotionProblem problem = TwoCameraProblem(300, 0.5, outlier_ratio, 1);
    int num_samples = 64;
    for (;;) {
      const int needed = SamplesFor(SearchSamples(problem, num_samples).candidates.front().score, 300);
      if (num_samples >= needed) break;
      num_samples = std::min(needed, 2 * num_samples);
    }
    EXPECT_EQ(Search(problem, {}).counts.num_hypotheses,
              SearchSamples(problem, num_samples).counts.num_hypotheses)
        << outlier_ratio << ": " << num_samples << " samples";
    // At least as many as the true share needs.
    EXPECT_GE(num_samples, std::log(1e-3) / std::log1p(-std::pow(1.0 - outlier_ratio, 5) + 1e-6));
  }
}

TEST(HypothesisSearch, StopsAtTheGreatestNumber) {
  const MotionProblem problem = TwoCameraProblem(100, 0.5, 1.0, 2);
  CalibratedOptions options;
  options.max_samples = 500;
  EXPECT_EQ(Search(problem, options).counts.num_hypotheses,
            SearchSamples(problem, 500).counts.num_hypotheses);
}

// Samples are drawn eight models at a time, so that more may be there already than a next round, here of one
// more sample, asks for.
TEST(HypothesisSearch, GoesOnFromMoreSamplesThanItAskedFor) {
  const MotionProblem problem = TwoCameraProblem(100, 0.5, 1.0, 2);
  CalibratedOptions options;
  for (options.min_samples = 8; options.min_samples < 80; ++options.min_samples) {
    options.max_samples = options.min_samples + 1;
    EXPECT_FALSE(Search(problem, options).candidates.empty()) << options.min_samples;
  }
}

double Likeness(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return 0.5 * std::abs(a.cwiseProduct(b).sum());
}

TEST(HypothesisSearch, ReturnsDistinctCandidatesOfWhichTheBestIsNearTheTruth) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    RelativePose pose_true;
    const MotionProblem problem = TwoCameraProblem(200, 0.5, 0.4, trial, &pose_true);
    CalibratedOptions options;
    options.num_candidates = 24;
    const std::vector<ScoredEssential> candidates = Search(problem, options).candidates;
    ASSERT_EQ(candidates.size(), 24U);
    double nearest = 0.0;
    for (size_t i = 0; i < candidates.size(); ++i) {
      const Eigen::Matrix3d& E = candidates[i].E;
      EXPECT_NEAR(E.norm(), std::sqrt(2.0), 1e-9);
      EXPECT_NEAR((E * E.transpose() * E - E).norm(), 0.0, 1e-5);  // singular values 1, 1, 0
      if (i < 12) nearest = std::max(nearest, Likeness(E, EssentialFromPose(pose_true)));
      for (size_t k = 0; k < i; ++k) EXPECT_LT(Likeness(E, candidates[k].E), i < 12 ? 0.9999 : 0.98);
      // The best first; then, again from the best, those far from all others.
      if (i > 0 && i != 12) {
        EXPECT_LE(candidates[i].score, candidates[i - 1].score);
      }
    }
    EXPECT_GT(nearest, 0.999) << trial;
  }
}

TEST(HypothesisSearch, ScoresAreThoseOfAllMatches) {
  const MotionProblem problem = TwoCameraProblem(150, 0.5, 0.3, 4);
  const MatchBlocks matches(problem);
  for (const ScoredEssential& candidate : Search(problem, {}).candidates) {
    double F[9];
    WriteRowMajor(matches.FundamentalFromEssential(candidate.E), F);
    EXPECT_NEAR(ScoreMatches(matches).SumScores(F, kSoftScale, 0, 150), candidate.score, 0.05);
  }
}

}  // namespace
}  // namespace rcme
