// The last step's own account of itself, on sets of matches whose counts are written down.
#include "estimator/refine_winner.h"

#include <gtest/gtest.h>

#include <numeric>

#include "estimator/reference_matches.h"
#include "estimator/solvers/eight_point.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

// Returns given numbers of consistent matches: before and after the refinement, and of all matches.
class ScriptedMatches : public ReferenceMatches {
 public:
  ScriptedMatches(const MotionProblem& problem, int before, int after, int explained)
      : ReferenceMatches(problem, RefinementError::kSampson), counts_{before, after, explained} {}
  int CountConsistent(const Set& set, const RelativePose& pose, double threshold) const {
    sizes.push_back(set.size());
    poses.push_back(pose);
    thresholds.push_back(threshold);
    return counts_[sizes.size() - 1];
  }
  mutable std::vector<size_t> sizes;
  mutable std::vector<RelativePose> poses;
  mutable std::vector<double> thresholds;

 private:
  std::array<int, 3> counts_;
};

// 30 noisy matches, the first 20 of them the support.
struct Case {
  MotionProblem problem;
  std::optional<Hypothesis<EightPoint>> hypothesis;
  std::vector<int> support;
};
Case MakeCase() {
  RandomStream rng({.seed = 1, .purpose = 930});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 30});
  AddNoise(0.5, rng, &random.problem);
  Case made{random.problem, InstantiateModel<EightPoint>(random.problem, {{0, 1, 2, 3, 4, 5, 6, 7}}),
            std::vector<int>(20)};
  std::iota(made.support.begin(), made.support.end(), 0);
  return made;
}

MotionEstimate Refined(const Case& made, const ScriptedMatches& matches, double kappa) {
  RansacOptions options;
  options.refinement = Refinement::kMle;
  options.kappa = kappa;
  MotionEstimate estimate;
  RefineWinner(matches, options, made.hypothesis, made.support, &estimate);
  return estimate;
}

// n*_I / n_I <= kappa: equality is a failure.
TEST(RefineWinner, TheKappaFlagIsSetAtEqualityToo) {
  const Case made = MakeCase();
  const auto flag = [&](int before, int after, double kappa) {
    return Refined(made, ScriptedMatches(made.problem, before, after, 30), kappa).failed_by_kappa;
  };
  EXPECT_TRUE(flag(10, 5, 0.5));
  EXPECT_FALSE(flag(10, 6, 0.5));
  EXPECT_TRUE(flag(20, 4, 0.25));
  EXPECT_TRUE(flag(20, 5, 0.25));
  EXPECT_FALSE(flag(20, 6, 0.25));
  EXPECT_TRUE(flag(0, 0, 0.5));
}

// The winner's motion and the refined one are counted on the support, the refined one on all matches too;
// each with chi2_2.
TEST(RefineWinner, CountsWhatItSaysItCounts) {
  const Case made = MakeCase();
  const ScriptedMatches matches(made.problem, 11, 17, 23);
  const MotionEstimate estimate = Refined(made, matches, 0.5);
  ASSERT_EQ(estimate.status, MotionStatus::kOk);
  EXPECT_EQ(estimate.num_consistent_before, 11);
  EXPECT_EQ(estimate.num_consistent_after, 17);
  EXPECT_EQ(estimate.num_explained, 23);
  EXPECT_EQ(matches.sizes, (std::vector<size_t>{20, 20, 30}));
  EXPECT_EQ(matches.poses[0].R, estimate.initial_pose.R);
  EXPECT_EQ(matches.poses[1].R, estimate.cam2_from_cam1.R);
  EXPECT_EQ(matches.poses[2].R, estimate.cam2_from_cam1.R);
  EXPECT_NE(estimate.initial_pose.R, estimate.cam2_from_cam1.R);
  for (const double threshold : matches.thresholds)
    EXPECT_NEAR(threshold, 5.991464547, 1e-9);  // chi2_2, 95 %
}

// The first `num_agreeing` matches of the problem agree with every motion.
class AgreeingMatches : public ReferenceMatches {
 public:
  AgreeingMatches(const MotionProblem& problem, int num_agreeing)
      : ReferenceMatches(problem, RefinementError::kSampson), agreeing_(static_cast<size_t>(num_agreeing)) {
    std::iota(agreeing_.begin(), agreeing_.end(), 0);
  }
  Set SelectFitSet(const RefinedMotion&, const Set&) const { return agreeing_; }
  RefinedMotion Refine(const Set& set, const RelativePose& start, Loss loss) const {
    starts.push_back(start);
    refined.push_back(ReferenceMatches::Refine(set, start, loss));
    return refined.back();
  }
  mutable std::vector<RelativePose> starts;
  mutable std::vector<RefinedMotion> refined;

 private:
  Set agreeing_;
};

TEST(RefineWinner, EveryRefitBeginsWhereTheLastOneEnded) {
  const Case made = MakeCase();
  RandomStream rng({.seed = 1, .purpose = 930});
  const AgreeingMatches matches(made.problem, 25);
  FitRobustly(matches, made.support, MakeRandomProblem(rng, {.num_matches = 30}).pose_true);
  ASSERT_GE(matches.starts.size(), 2u);
  for (size_t k = 1; k < matches.starts.size(); ++k) {
    EXPECT_EQ(matches.starts[k].R, matches.refined[k - 1].cam2_from_cam1.R);
    EXPECT_EQ(matches.starts[k].t, matches.refined[k - 1].cam2_from_cam1.t);
  }
}

// Five matches have no residuals that could speak for a motion; six have.
TEST(RefineWinner, AFitToFiveMatchesHasNotConverged) {
  const Case made = MakeCase();
  RandomStream rng({.seed = 1, .purpose = 930});
  const RelativePose start = MakeRandomProblem(rng, {.num_matches = 30}).pose_true;
  const auto fit = [&](int num_agreeing) {
    return FitRobustly(AgreeingMatches(made.problem, num_agreeing), made.support, start);
  };
  EXPECT_FALSE(fit(5).motion.converged);
  EXPECT_EQ(fit(5).fitted.size(), 5u);
  EXPECT_TRUE(fit(6).motion.converged);
  EXPECT_EQ(fit(6).fitted.size(), 6u);
  const std::vector<int> five(made.support.begin(), made.support.begin() + 5);
  EXPECT_FALSE(FitRobustly(AgreeingMatches(made.problem, 20), five, start).motion.converged);
}

}  // namespace
}  // namespace rcme
