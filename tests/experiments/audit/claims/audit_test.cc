#include "experiments/audit/claims/audit.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "experiments/audit/claims/audit_output.h"
#include "experiments/audit/claims/audit_page.h"
#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/claim_table.h"
#include "experiments/audit/claims/design.h"
#include "stats/distributions.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/in_memory.h"

namespace rcme {
namespace {

// A claim whose statistic is exactly chi-square distributed: what a correct Gaussian estimator would show.
Claim GaussianClaim(const std::string& id, int degrees_of_freedom) {
  Claim claim;
  claim.id = id;
  claim.figure_x = "sigma_px";
  Check check;
  check.conditions = {{"sigma_px", "0.5"}};
  check.targets = CoverageTargets(degrees_of_freedom);
  check.limits = {0, kSampleCoverage.limits.quick, kSampleCoverage.limits.quick};
  check.trial = [degrees_of_freedom](const StreamName& name) -> Outcome {
    RandomStream rng(name);
    double sum = 0.0;
    for (int i = 0; i < degrees_of_freedom; ++i) {
      const double normal = rng.Normal();
      sum += normal * normal;
    }
    return {sum};
  };
  claim.checks = {check};
  return claim;
}

std::vector<Claim> GaussianClaims() {
  std::vector<Claim> claims;
  for (const int dof : {1, 2, 5}) {
    claims.push_back(GaussianClaim("gauss.a" + std::to_string(dof), dof));
    claims.push_back(GaussianClaim("gauss.b" + std::to_string(dof), dof));
  }
  return claims;
}

// The upper limit of 75 audits lies below 5 % if none has a false alarm. If 5 % of audits had one, that would
// be seen with probability .979; if 10 %, with .9996.
TEST(Audit, ACorrectGaussianEstimatorPassesAtTheStatedErrorRate) {
  const std::vector<Claim> claims = {GaussianClaim("gauss.1", 1), GaussianClaim("gauss.2", 2),
                                     GaussianClaim("gauss.5", 5)};
  CoverageCount alarms, all_hold;
  for (std::uint64_t seed = 1; seed <= 75; ++seed) {
    AuditOptions options;
    options.seed = seed;
    bool is_alarm = false, holds = true;
    for (const ClaimResult& result : RunAuditInMemory(claims, options).results) {
      is_alarm |= result.verdict != ClaimVerdict::kHolds && result.verdict != ClaimVerdict::kUndecided;
      holds &= result.verdict == ClaimVerdict::kHolds;
    }
    alarms.Add(is_alarm);
    all_hold.Add(holds);
  }
  EXPECT_LE(alarms.interval(0.95).upper, kAuditErrorRate) << alarms;
  EXPECT_GE(all_hold.rate(), 0.95) << all_hold;  // and it is not all "undecided"
  std::cout << "audits with a false alarm: " << alarms << "\nall claims hold: " << all_hold << "\n";
}

TEST(Audit, IsTheSameBytesForAnyNumberOfThreads) {
  AuditOptions one, three;
  one.num_threads = 1, three.num_threads = 3;
  const std::string json = MakeAuditResult(RunAuditInMemory(GaussianClaims(), one)).json;
  EXPECT_EQ(MakeAuditResult(RunAuditInMemory(GaussianClaims(), three)).json, json);
  AuditOptions other_seed = one;
  other_seed.seed = 2;
  EXPECT_NE(MakeAuditResult(RunAuditInMemory(GaussianClaims(), other_seed)).json, json);
}

TEST(Audit, AClaimsResultDoesNotDependOnTheOthersThatAreRun) {
  AuditOptions all, some;
  some.only = {"gauss.b2"};
  const Audit whole = RunAuditInMemory(GaussianClaims(), all),
              part = RunAuditInMemory(GaussianClaims(), some);
  ASSERT_EQ(part.claims.size(), 1);
  EXPECT_EQ(part.num_targets, 36);
  EXPECT_EQ(part.confidence, whole.confidence);
  for (size_t i = 0; i < whole.claims.size(); ++i) {
    if (whole.claims[i].id != "gauss.b2") continue;
    EXPECT_EQ(whole.results[i].checks[0].targets[0].measured, part.results[0].checks[0].targets[0].measured);
    EXPECT_EQ(whole.results[i].checks[0].num_trials, part.results[0].checks[0].num_trials);
  }
}

TEST(SelectClaims, ByIdOrByFamilyOrAWordThatFitsNone) {
  const std::vector<Claim> all = {GaussianClaim("a.b", 1), GaussianClaim("a.b.c", 1),
                                  GaussianClaim("ab.c", 1)};
  EXPECT_EQ(SelectClaims(all, {}).size(), 3);
  EXPECT_EQ(SelectClaims(all, {"a"}).size(), 2);
  EXPECT_EQ(SelectClaims(all, {"a.b.c", "ab"}).size(), 2);
  EXPECT_TRUE(ThrowsInputError([&] { SelectClaims(all, {"a", "b"}); }, {"--only", "'b'", "list claims"}));
}

TEST(AuditOutput, SaysEverythingOfAClaim) {
  AuditOptions options;
  options.only = {"gauss.a1"};
  const Audit audit = RunAuditInMemory(GaussianClaims(), options);
  const auto json = nlohmann::json::parse(MakeAuditResult(audit).json);
  EXPECT_EQ(json["format"], "rcme audit 1");
  EXPECT_EQ(json["num_targets"], 36);
  const auto& claim = json["claims"].at(0);
  EXPECT_EQ(claim["id"], "gauss.a1");
  EXPECT_EQ(claim["family"], "gauss");
  EXPECT_EQ(claim["verdict"], "holds");
  const auto& evidence = claim["evidence"].at(0);
  EXPECT_EQ(evidence["conditions"]["sigma_px"], "0.5");
  EXPECT_EQ(evidence["targets"].size(), 6);
  const auto& target = evidence["targets"].at(0);
  EXPECT_EQ(target["quantity"], "coverage at alpha 0.05");
  EXPECT_EQ(target["nominal"], 0.95);
  EXPECT_LT(target["interval"].at(0).get<double>(), target["measured"].get<double>());
  EXPECT_EQ(target["n"], evidence["num_trials"]);
  EXPECT_GT(target["power"]["holds_at_nominal"].get<double>(), 0.9);
  EXPECT_LT(target["power"]["found_outside"].at(0).get<double>(), target["low"].get<double>());
  EXPECT_GT(claim["holds_at_nominal"].get<double>(), 0.9);
  EXPECT_NE(MakeAuditResult(audit).text.find("gauss.a1"), std::string::npos);
  EXPECT_NE(AuditAsMarkdown(audit).find("| gauss.a1 |"), std::string::npos);
}

TEST(AuditOutput, NamesTheWorstFifthOfDifficulty) {
  Claim claim = GaussianClaim("gauss.a1", 1);
  claim.checks[0].limits = {1'000, 1'000, 1'000};
  claim.checks[0].difficulty_statistic = 1;
  claim.checks[0].trial = [](const StreamName& name) -> Outcome {
    const bool is_hardest = name.trial % 5 == 0;
    return {is_hardest ? 100.0 : 0.1, is_hardest ? 9.0 : 0.001 * name.trial};
  };
  const Audit audit = RunAuditInMemory({claim}, {});
  const std::vector<DifficultyFifth>& fifths = audit.results[0].checks[0].fifths;
  ASSERT_EQ(fifths.size(), 5);
  EXPECT_EQ(fifths[4].measured, 0.0);
  EXPECT_EQ(fifths[4].easiest, 9.0);
  EXPECT_EQ(fifths[3].measured, 1.0);
  EXPECT_EQ(fifths[0].n, 200);
  EXPECT_NE(AuditAsMarkdown(audit).find("| 5 (worst) | 9 to 9 | 0 "), std::string::npos);
}

TEST(MakePlanResult, SaysWhatIsFoundBeforeAnyTrial) {
  const std::string table = MakePlanResult(PlanAudit(GaussianClaims(), {})).text;
  EXPECT_NE(table.find("gauss.b5"), std::string::npos);
  EXPECT_NE(table.find("sigma off by"), std::string::npos);
}

// The table of claims itself.

TEST(ClaimTable, IdsAreUniqueAndEveryClaimSaysWhatItIs) {
  std::set<std::string> ids;
  for (const Claim& claim : AllClaims(EstimatorRegistry())) {
    EXPECT_TRUE(ids.insert(claim.id).second) << claim.id;
    for (const std::string& text : {claim.label, claim.reading, claim.sentence, claim.statistic}) {
      EXPECT_FALSE(text.empty()) << claim.id;
    }
    EXPECT_NE(claim.family(), claim.id);
    EXPECT_FALSE(claim.checks.empty()) << claim.id;
  }
}

TEST(ClaimTable, EveryCheckCanRunAndYieldsWhatItsTargetsAskFor) {
  for (const Claim& claim : AllClaims(EstimatorRegistry())) {
    for (const Check& check : claim.checks) {
      ASSERT_TRUE(check.trial) << claim.id;
      EXPECT_LE(check.limits.min, check.limits.quick) << claim.id;
      EXPECT_LE(check.limits.quick, check.limits.full) << claim.id;
      const StreamName name{3, 5, 7, 0};
      const Outcome outcome = check.trial(name);
      for (const Target& target : check.targets) {
        ASSERT_LT(target.statistic, outcome.size()) << claim.id;
        EXPECT_LE(target.allowed.lower, target.allowed.upper) << claim.id;
        if (!std::isnan(target.nominal) && target.IsClaimed()) {
          EXPECT_TRUE(target.allowed.Contains(target.nominal)) << claim.id << ": " << target.quantity;
        }
      }
      if (check.is_timed) continue;
      const Outcome again = check.trial(name);  // a pure function of the name
      for (size_t i = 0; i < outcome.size(); ++i) {
        EXPECT_TRUE(outcome[i] == again[i] || (std::isnan(outcome[i]) && std::isnan(again[i]))) << claim.id;
      }
    }
  }
}

TEST(ClaimTable, ChecksDifferInTheirConditions) {
  for (const Claim& claim : AllClaims(EstimatorRegistry())) {
    std::set<Settings> conditions;
    for (const Check& check : claim.checks) {
      EXPECT_TRUE(conditions.insert(check.conditions).second)
          << claim.id << " has two checks of one condition";
    }
  }
}

}  // namespace
}  // namespace rcme
