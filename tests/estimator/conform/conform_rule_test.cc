#include "estimator/conform/conform_rule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "estimator/estimator_registry.h"
#include "stats/consistency.h"
#include "stats/distributions.h"
#include "tests/estimator/conform/conform_examples.h"
#include "tests/test_support/family_problem.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

TEST(FeatureModel, IsASumOverItsTerms) {
  const FeatureModel model{1.0, {{0, 2.0, 4.0, 3.0, 0.5}, {3, 0.0, 1.0, -1.0, 0.0}}};
  VisibleFeatures features;
  features.fill(kNaN);
  EXPECT_DOUBLE_EQ(model.At(features), 1.0);
  features[0] = 6.0;  // z = 1
  EXPECT_DOUBLE_EQ(model.At(features), 4.0);
  features[0] = 10.0;  // z = 2, z^2 - 1 = 3
  EXPECT_DOUBLE_EQ(model.At(features), 8.5);
  features[3] = 100.0;  // z = 3 at most
  EXPECT_DOUBLE_EQ(model.At(features), 5.5);
}

TEST(ConformJudge, FindsStratumProbabilityAndVerdict) {
  const ConformJudge judge(ExampleRule());
  const ConformVerdict easy = judge.Judge(FeaturesWith(4.0, -8.0));
  EXPECT_EQ(easy.stratum, 0U);
  EXPECT_DOUBLE_EQ(easy.factor, 1.5);
  EXPECT_DOUBLE_EQ(easy.log_odds, -1.0);
  EXPECT_DOUBLE_EQ(easy.failure_probability, 1.0 / (1.0 + std::exp(4.0)));
  EXPECT_TRUE(easy.is_accepted);
  const ConformVerdict middle = judge.Judge(FeaturesWith(4.0, -6.5));
  EXPECT_EQ(middle.stratum, 1U);
  EXPECT_DOUBLE_EQ(middle.factor, 4.0);
  const ConformVerdict hard = judge.Judge(FeaturesWith(4.0, -5.0));
  EXPECT_EQ(hard.stratum, 2U);
  EXPECT_EQ(hard.factor, kInfinity);
  EXPECT_FALSE(hard.is_accepted);
}

// Of 21 calibration answers the one in the middle is as familiar as any; one beyond all of them has 1 / 22.
TEST(ConformJudge, NamesWhatIsStrange) {
  const ConformJudge judge(ExampleRule());
  EXPECT_DOUBLE_EQ(judge.Judge(FeaturesWith(4.0, -6.5)).familiarity, 1.0);
  const ConformVerdict strange = judge.Judge(FeaturesWith(9.0, -6.5));
  EXPECT_DOUBLE_EQ(strange.familiarity, 1.0 / 22.0);
  EXPECT_EQ(strange.strangest_feature, kAgreeingFeature);
  EXPECT_DOUBLE_EQ(judge.Judge(FeaturesWith(kNaN, -6.5)).familiarity, 1.0 / 22.0);
  // Two median distances (.5, 1) from the medians lie 10 answers, or more.
  EXPECT_DOUBLE_EQ(judge.Judge(FeaturesWith(4.0, -7.5)).familiarity, 13.0 / 22.0);
}

TEST(ConformJudge, AcceptsNothingWithoutAThreshold) {
  ConformRule rule = ExampleRule();
  rule.greatest_log_odds.reset();
  EXPECT_FALSE(ConformJudge(rule).Judge(FeaturesWith(4.0, -8.0)).is_accepted);
}

TEST(ConformJudge, RefusesWhatIsNoRule) {
  const std::vector<std::function<void(ConformRule*)>> faults = {
      [](ConformRule* r) { r->level = 1.0; },
      [](ConformRule* r) { r->edges.pop_back(); },
      [](ConformRule* r) {
        r->edges = {1.0, 0.0};
      },
      [](ConformRule* r) { r->edges[0] = -kInfinity; },
      [](ConformRule* r) { r->factors[0] = kNaN; },
      [](ConformRule* r) { r->factors[0] = -1.0; },
      [](ConformRule* r) { r->difficulty.terms[0].feature = kNumVisibleFeatures; },
      [](ConformRule* r) { r->failure.terms[0].scale = 0.0; },
      [](ConformRule* r) { r->failure.intercept = kNaN; },
      [](ConformRule* r) { r->log_odds_slope = kInfinity; },
      [](ConformRule* r) { r->greatest_log_odds = kNaN; },
      [](ConformRule* r) { r->familiar.pop_back(); },
      [](ConformRule* r) { r->familiar[3] = kInfinity; },
      [](ConformRule* r) { r->familiar_features[1] = kNumVisibleFeatures; },
      [](ConformRule* r) { r->familiar.clear(); }};
  for (size_t i = 0; i < faults.size(); ++i) {
    ConformRule rule = ExampleRule();
    faults[i](&rule);
    EXPECT_THROW(ConformJudge{rule}, std::invalid_argument) << i;
  }
}

TEST(CovarianceOfAllMotions, HoldsEveryMotionFromTheMedianOn) {
  RandomStream rng({.seed = 1, .purpose = 98});
  for (int i = 0; i < 1000; ++i) {
    const RelativePose a = RandomPose(rng, 180.0), b = RandomPose(rng, 180.0);
    EXPECT_LE(NormalizedErrorSquared(LocalCoordinates(a, b), CovarianceOfAllMotions()),
              ChiSquareQuantile(5, 0.5));
  }
}

class Apply : public testing::Test {
 protected:
  Apply() : problem_(ProblemFamily("uniform_volume", "sideways", 120, 0.2).Make(0)) {
    RandomStream rng({.seed = 1});
    estimate_ = MakeEstimator("standard")->Estimate(problem_, rng);
  }
  // With this log sd of the direction.
  MotionEstimate Answer(double log_sd) const {
    MotionEstimate estimate = estimate_;
    estimate.pose_cov = Matrix5d::Identity() * std::exp(2.0 * log_sd) / 2.0;
    return estimate;
  }

  MotionProblem problem_;
  MotionEstimate estimate_;
};

TEST_F(Apply, WidensTheCovarianceAndStatesTheProbability) {
  ASSERT_EQ(estimate_.status, MotionStatus::kOk);
  const MotionEstimate before = Answer(-6.5);
  const MotionEstimate after = ConformJudge(ExampleRule()).Apply(problem_, before, /*refuses=*/true);
  ASSERT_EQ(after.status, MotionStatus::kOk);
  EXPECT_EQ(after.cam2_from_cam1.R, before.cam2_from_cam1.R);
  EXPECT_EQ(after.inliers, before.inliers);
  EXPECT_TRUE(after.pose_cov.isApprox(4.0 * before.pose_cov, 1e-12));
  EXPECT_NEAR(after.failure_probability, 1.0 / (1.0 + std::exp(3.25)), 1e-9);
}

TEST_F(Apply, RefusesWhatIsNotAccepted) {
  const ConformJudge judge(ExampleRule());
  const MotionEstimate refused = judge.Apply(problem_, Answer(-5.0), /*refuses=*/true);
  EXPECT_EQ(refused.status, MotionStatus::kTooUncertain);
  EXPECT_THAT(refused.message, testing::HasSubstr("accept rule"));
  const MotionEstimate stated = judge.Apply(problem_, Answer(-5.0), /*refuses=*/false);
  ASSERT_EQ(stated.status, MotionStatus::kOk);
  EXPECT_EQ(stated.pose_cov, CovarianceOfAllMotions());
}

// Of 21 calibration answers nothing can be strange at 1 %: 1 / 22, so that the domain is not stated. With
// 210, 1 / 211.
TEST_F(Apply, SaysThatItIsStrangeAndRefusesIt) {
  ConformRule rule = ExampleRule();
  const std::vector<double> once = rule.familiar;
  EXPECT_EQ(ConformJudge(rule).Apply(problem_, Answer(-20.0), true).probability_domain,
            ProbabilityDomain::kNotStated);
  for (int i = 0; i < 9; ++i) rule.familiar.insert(rule.familiar.end(), once.begin(), once.end());
  const MotionEstimate strange = ConformJudge(rule).Apply(problem_, Answer(-20.0), false);
  EXPECT_EQ(strange.probability_domain, ProbabilityDomain::kExtrapolated);
  EXPECT_THAT(strange.message, testing::HasSubstr("(direction_sd)"));
  const MotionEstimate refused = ConformJudge(rule).Apply(problem_, Answer(-20.0), true);
  EXPECT_EQ(refused.status, MotionStatus::kTooUncertain);
  EXPECT_THAT(refused.message, testing::HasSubstr("unlike the problems"));
  const MotionEstimate usual = Answer(-6.5);
  EXPECT_EQ(ConformJudge(rule).Apply(problem_, usual, false).probability_domain,
            ProbabilityDomain::kVerified);
}

TEST_F(Apply, LeavesRefusalsAsTheyAre) {
  MotionEstimate refusal;
  refusal.status = MotionStatus::kNoCandidate;
  refusal.message = "none";
  const MotionEstimate after = ConformJudge(ExampleRule()).Apply(problem_, refusal, true);
  EXPECT_EQ(after.status, MotionStatus::kNoCandidate);
  EXPECT_EQ(after.message, "none");
}

}  // namespace
}  // namespace rcme
