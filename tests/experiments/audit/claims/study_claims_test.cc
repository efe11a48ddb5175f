#include "experiments/audit/claims/study_claims.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "experiments/audit/claims/decide_check.h"
#include "experiments/audit/claims/families.h"
#include "experiments/audit/claims/study_cases.h"
#include "experiments/audit/validity/study_samples.h"
#include "experiments/study/study_file.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/in_memory.h"

namespace rcme {
namespace {

StudyPlan PlanWith(const std::string& data, const std::string& factors = "{}") {
  return MakePlan(ParseStudy(fmt::format("name: test\ndata: {{scene: uniform_volume, {}}}\nfactors: {}\n"
                                         "estimators: [{{name: standard, label: mine}}]\n",
                                         data, factors),
                             "test.yaml"));
}

const Claim& Find(const std::vector<Claim>& claims, const std::string& id) {
  const auto found = std::ranges::find(claims, id, &Claim::id);
  if (found == claims.end()) throw std::logic_error("no claim " + id);
  return *found;
}

TEST(KeepTrueMatches, KeepsThemInTheirOrderWithTheirPoints) {
  const StudyPlan plan = PlanWith("num_matches: 40, outlier_ratio: 0.5");
  Case made = StudyCases(plan, plan.conditions[0])({1, 0, 0, 0});
  const TrialData whole = made.data;
  KeepTrueMatches(&made.data);
  ASSERT_EQ(made.data.problem.matches.size(), 20);
  size_t kept = 0;
  for (size_t k = 0; k < 40; ++k) {
    if (!whole.truth.is_inlier_true[k]) continue;
    EXPECT_EQ(made.data.problem.matches[kept].x2_px, whole.problem.matches[k].x2_px);
    EXPECT_EQ(made.data.scene_point[kept], whole.scene_point[k]);
    EXPECT_TRUE(made.data.truth.is_inlier_true[kept++]);
  }
  EXPECT_EQ(kept, 20);
}

// A study of the built-in scene gives the numbers of the built-in claims: the statistics are the same, and so
// are the cases. Without this a statistic could be fed other matches, cameras or another sigma.
TEST(StudyClaims, OnTheBuiltInSceneYieldTheBuiltInNumbers) {
  const StudyPlan plan = PlanWith("num_matches: 8, sigma_px: 0.5, outlier_ratio: 0");
  const std::vector<Claim> on_study = StudyClaims(plan);
  std::vector<Claim> built_in = SigmaFClaims();
  for (const std::vector<Claim>& family : {SigmaPClaims(), InlierClaims(), SampleTestClaims()}) {
    built_in.insert(built_in.end(), family.begin(), family.end());
  }
  int num_compared = 0;
  for (const Claim& claim : built_in) {
    for (const Check& check : claim.checks) {
      const Settings same = {{"num_matches", "8"}, {"sigma_px", "0.5"}};
      const auto twin = std::ranges::find(on_study, claim.id, &Claim::id);
      if (check.conditions != same || twin == on_study.end()) continue;
      for (std::uint32_t trial = 0; trial < 5; ++trial) {
        EXPECT_EQ(twin->checks.at(0).trial({7, 3, trial, 0}), check.trial({7, 3, trial, 0})) << claim.id;
      }
      ++num_compared;
    }
  }
  EXPECT_EQ(num_compared, 8);  // f, p by two Jacobians, four own points, the joint sample test
}

// Where first order holds, on a problem with more matches than a sample takes: a statistic that took others
// than its sample's into its covariance would be far off.
TEST(StudyClaims, OfSamplesHoldInTheSmallNoiseLimit) {
  const std::vector<Claim> claims = StudyClaims(PlanWith("num_matches: 40, sigma_px: 0.000001"));
  for (const char* id : {"sigma_f.eight_point", "sigma_f.seven_point", "sigma_f.five_point", "sigma_p.theta",
                         "inlier.fresh_point.rank_aware", "mle.sampson"}) {
    Check check = Find(claims, id).checks[0];
    check.limits = {600, 600, 600};
    CheckRun run;
    run.confidence = 1.0 - 1e-4;
    const CheckResult result = DecideCheck(check, run);
    EXPECT_NE(result.verdict, Verdict::kDoesNotHold) << id << " " << result.targets[0].measured;
    EXPECT_NEAR(result.targets[0].measured, 0.95, 0.05) << id;  // 5 standard deviations and more
  }
}

TEST(StudyClaims, HaveOneCheckPerConditionNamedByItsLevels) {
  const StudyPlan plan = PlanWith("num_matches: 20", "{outlier_ratio: [0, 0.25], sigma_px: [0.5, 1]}");
  const std::vector<Claim> claims = StudyClaims(plan);
  std::set<std::string> ids;
  for (const Claim& claim : claims) {
    EXPECT_TRUE(ids.insert(claim.id).second) << claim.id;
    ASSERT_EQ(claim.checks.size(), 4) << claim.id;
    EXPECT_EQ(claim.checks[1].conditions, (Settings{{"outlier_ratio", "0"}, {"sigma_px", "1"}})) << claim.id;
    for (const Check& check : claim.checks) {
      EXPECT_EQ(check.not_possible, "") << claim.id;
      EXPECT_FALSE(check.sigma_px) << claim.id;  // no noise levels: "holds" is for all conditions
      const Outcome outcome = check.trial({1, 2, 3, 0});
      for (const Target& target : check.targets) EXPECT_LT(target.statistic, outcome.size()) << claim.id;
    }
  }
  for (const char* claim : {"coverage", "failures", "sigma"})
    EXPECT_TRUE(ids.contains(fmt::format("estimator.{}.mine", claim))) << "whatever the estimator's name";
}

TEST(StudyClaims, SayWhichConditionCannotGiveAStatistic) {
  const StudyPlan plan =
      PlanWith("num_matches: 20", "{motion: [general, pure_rotation], outlier_ratio: [0, 0.7]}");
  const std::vector<Claim> claims = StudyClaims(plan);
  const auto reasons = [&](const std::string& id) {
    std::vector<std::string> all;
    for (const Check& check : Find(claims, id).checks) {
      all.push_back(check.not_possible);
      EXPECT_EQ(check.targets.empty(), !check.not_possible.empty()) << id;
      EXPECT_EQ(DecideCheck(check, {}).num_trials == 0, !check.not_possible.empty()) << id;
    }
    return all;
  };
  const std::string few = "fewer than 8 true matches",
                    still = "the true motion has no direction of translation";
  using Texts = std::vector<std::string>;
  EXPECT_EQ(reasons("sigma_f.eight_point"), (Texts{"", few, still, still}));
  EXPECT_EQ(reasons("inlier.true_pose.rank_aware"), (Texts{"", "", still, still}));
  EXPECT_EQ(reasons("sample_test.size.joint"), (Texts{"", few, "", few}));
}

TEST(StudyClaims, ATrialWithTooFewTrueMatchesIsNotInTheN) {
  const StudyPlan plan = PlanWith("num_matches: 16, outlier_ratio: 0.5, outlier_count: bernoulli");
  Check check = Find(StudyClaims(plan), "sigma_f.eight_point").checks[0];  // 60 % of the trials have eight
  check.limits = {200, 200, 200};
  const CheckResult result = DecideCheck(check, {});
  EXPECT_EQ(result.num_trials, 200);
  EXPECT_GT(result.targets[0].n, 60);
  EXPECT_LT(result.targets[0].n, 170);
}

// The inlier test of a known motion, decided for a study that assumes the sigma it has and for one that is
// 20 % off, on the same seeds.
TEST(StudyClaims, ASigmaThatIsWrongDoesNotHoldAndARightOneIsNotCalledFaulty) {
  const auto verdict_of = [](const std::string& assumed_sigma, std::uint64_t seed) {
    const StudyPlan plan = PlanWith("num_matches: 10, sigma_px: 0.8, outlier_ratio: 0.2" + assumed_sigma);
    const Claim claim = Find(StudyClaims(plan), "inlier.true_pose.rank_aware");
    CheckRun run;
    run.seed = seed;
    run.confidence = 1.0 - 0.05 / 100.0;
    return DecideCheck(claim.checks[0], run).verdict;
  };
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    EXPECT_NE(verdict_of("", seed), Verdict::kDoesNotHold) << seed;
    EXPECT_EQ(verdict_of(", assumed_sigma_px: 0.96", seed), Verdict::kDoesNotHold) << seed;
    EXPECT_EQ(verdict_of(", assumed_sigma_px: 0.64", seed), Verdict::kDoesNotHold) << seed;
  }
}

TEST(StudyClaims, RefuseMoreConditionsThanAnAuditCanTake) {
  std::string levels;
  for (int i = 0; i < 1'001; ++i) levels += fmt::format("{}{}", i > 0 ? ", " : "", 1 + i);
  const StudyPlan plan = PlanWith("num_matches: 8", "{focal_px: [" + levels + "]}");
  EXPECT_TRUE(ThrowsInputError([&] { StudyClaims(plan); }, {"1001", "1000", "--set"}));
  EXPECT_TRUE(ThrowsInputError([&] { ListMapConditions(plan); }, {"1001", "1000", "--set"}));
}

// Samples of the map.

// A study of the built-in scene gives the built-in map's samples, to the last bit.
TEST(ListMapConditions, OnTheBuiltInSceneDrawTheBuiltInSamples) {
  const StudyPlan plan = PlanWith("num_matches: 13, baseline_m: 0.1, outlier_ratio: 0");
  const MapSampler draw = ListMapConditions(plan).at(0).sampler(12, 0.2);
  const MapSampler built_in = AtBaselines({0.1}).at(0).sampler(12, 0.2);
  for (std::uint32_t trial = 0; trial < 5; ++trial) {
    const MapSample a = draw({1, 2, trial}).value(), b = built_in({1, 2, trial}).value();
    EXPECT_EQ(a.pose_true.R, b.pose_true.R);
    EXPECT_EQ(a.observed.problem.sigma_px, b.observed.problem.sigma_px);
    EXPECT_EQ(a.observed.fresh_match.x1_px, b.observed.fresh_match.x1_px);
    ASSERT_EQ(a.observed.problem.matches.size(), 12);
    for (size_t k = 0; k < 12; ++k) {
      EXPECT_EQ(a.observed.problem.matches[k].x2_px, b.observed.problem.matches[k].x2_px);
      EXPECT_EQ(a.exact.problem.matches[k].x2_px, b.exact.problem.matches[k].x2_px);
    }
  }
}

TEST(ListMapConditions, AreThoseThatDifferInMoreThanTheNoiseLevel) {
  const StudyPlan plan = PlanWith("num_matches: 20", "{outlier_ratio: [0, 0.5], sigma_px: [0.3, 2]}");
  const std::vector<MapCondition> conditions = ListMapConditions(plan);
  ASSERT_EQ(conditions.size(), 2);
  EXPECT_EQ(conditions[1].level, "outlier_ratio = 0.5");
  EXPECT_EQ(ListSigmas(plan), (std::vector<double>{0.3, 2.0}));
  EXPECT_TRUE(conditions[1].sampler(9, 0.3)({1, 2, 3}));
  EXPECT_FALSE(conditions[1].sampler(10, 0.3)({1, 2, 3}));  // ten true matches: none is left as the fresh one
}

TEST(ListMapConditions, KeepTheRatioOfTheAssumedSigma) {
  const StudyPlan plan = PlanWith("num_matches: 20, sigma_px: 0.5, assumed_sigma_px: 0.75");
  EXPECT_DOUBLE_EQ(ListMapConditions(plan).at(0).sampler(8, 0.2)({1, 2, 3})->observed.problem.sigma_px, 0.3);
}

// Cameras of different focal lengths: exchanged, a true match would lie far off its line.
TEST(MapOfAStudy, EachImageHasItsOwnCamera) {
  const StudyPlan plan = PlanWith("cameras: euroc_and_office, num_matches: 40");
  const MapSampler draw = ListMapConditions(plan).at(0).sampler(20, 1e-4);
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const std::optional<MapSample> sample = draw({1, 0, trial});
    ASSERT_TRUE(sample);
    EXPECT_LT(RunValidityTrial(*sample).fresh_point_d2, 40.0);  // of chi2_1 with probability 1 - 3e-10
  }
}

TEST(MapOfAStudy, CountsOnlyTrialsWithASample) {
  const StudyPlan plan = PlanWith("num_matches: 20", "{motion: [general, pure_rotation]}");
  ValidityMapOptions options{.sigmas_px = {0.5},
                             .nums_points = {8, 50},
                             .condition_key = "condition",
                             .conditions = ListMapConditions(plan),
                             .trials = 6};
  const std::string csv = MapCsvInMemory(options);
  EXPECT_NE(csv.find("0.5,8,motion = general,"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",all,,f,0,0,,,\n"), std::string::npos) << csv;  // 50 points of 20
  EXPECT_NE(csv.find("0.5,8,motion = pure_rotation,,all,,pose,0,0,,,\n"), std::string::npos) << csv;
}

}  // namespace
}  // namespace rcme
