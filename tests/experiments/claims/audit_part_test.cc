// An audit in shards gives the bytes of one machine's; what does not belong together is refused.
#include "experiments/claims/audit_part.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "experiments/base/file_output.h"
#include "experiments/claims/audit_output.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

using Paths = std::vector<std::string>;
using Json = nlohmann::ordered_json;

std::atomic<int> num_trials_run = 0;

// A rate, a mean, a target of which no trial says anything, and difficulties that may be infinite.
Check MixedCheck(int number) {
  Check check;
  check.conditions = {{"number", std::to_string(number)}};
  check.sigma_px = 0.1 * (number + 1);
  check.targets = {ClaimedRate("rate", 0.3, {0.25, 0.35}, 0), ClaimedMean("mean", 0.5, {0.49, 0.55}, 1),
                   MeasuredRate("of nothing", 2), MeasuredMean("infinite", 3)};
  check.targets.front().kind = Target::Kind::kAtMost;
  check.targets.front().threshold = 0.3 + 0.03 * number;
  check.targets.at(1).planned_spread = 0.29;
  check.limits = {100, 700, 900};
  check.difficulty_statistic = 4;
  check.trial = [](const StreamName& name) -> Outcome {
    ++num_trials_run;
    RandomStream rng(name);
    const double u = rng.Uniform(), infinity = std::numeric_limits<double>::infinity();
    return {u, rng.Uniform(), std::nan(""), infinity, u > 0.9 ? infinity : u / 3.0};
  };
  return check;
}

Check ImpossibleCheck() {
  Check check;
  check.conditions = {{"number", "impossible"}};
  check.not_possible = "there is nothing";
  return check;
}

std::vector<Claim> Claims() {
  std::vector<Claim> claims(3);
  const char* ids[] = {"mixed.several", "mixed.one", "other.one"};
  for (size_t i = 0; i < claims.size(); ++i) {
    claims[i].id = ids[i];
    for (int k = 0; k < (i == 0 ? 8 : 1); ++k) claims[i].checks.push_back(MixedCheck(k));
  }
  claims[1].checks.push_back(ImpossibleCheck());
  return claims;
}

AuditOptions Options() {
  AuditOptions options;
  options.num_threads = 1;
  options.conditions = {{"num_matches", "20"}};
  options.study_identity = "name: mine\n";
  return options;
}

std::string Bytes(const Audit& audit) {
  return AuditAsJson(audit) + AuditAsTable(audit) + AuditAsMarkdown(audit);
}

Json JsonOf(const std::string& path) { return Json::parse(std::ifstream(path)); }

class AuditParts : public testing::Test {
 protected:
  std::string Part(std::uint32_t number, std::uint32_t count, const AuditOptions& options = Options()) const {
    const std::string path = folder_.Path(fmt::format("{}_of_{}.json", number, count));
    RunAuditPart(Claims(), options, {number, count}, path);
    return path;
  }
  Paths Parts(std::uint32_t count) const {
    Paths paths;
    for (std::uint32_t number = 1; number <= count; ++number) paths.push_back(Part(number, count));
    return paths;
  }
  // A copy of a part with something changed in it.
  std::string Changed(const std::string& part, const std::function<void(Json*)>& change) const {
    Json json = JsonOf(part);
    change(&json);
    std::string path = part;
    path += ".changed";
    WriteFileWhole(path, json.dump());
    return path;
  }
  static bool IsRefused(const Paths& paths, const Paths& words, const AuditOptions& options = Options()) {
    return ThrowsInputError([&] { MergeAuditParts(Claims(), options, paths); }, words);
  }

  const TempFolder folder_;
};

TEST_F(AuditParts, OfAnyNumberInAnyOrderGiveTheSameBytes) {
  const std::string whole = Bytes(RunAudit(Claims(), Options()));
  EXPECT_NE(whole.find("nan"), std::string::npos);  // what JSON has no numbers for is tried too
  EXPECT_NE(whole.find("does not hold"), std::string::npos);
  EXPECT_NE(whole.find("inf"), std::string::npos);
  for (const std::uint32_t count : {1, 3, 7}) {
    Paths paths = Parts(count);
    for (int order = 0; order < 4; ++order) {
      const MergedAudit merged = MergeAuditParts(Claims(), Options(), paths);
      EXPECT_EQ(merged.num_missing, 0);
      EXPECT_EQ(Bytes(merged.audit), whole) << count << " shards, order " << order;
      if (order == 1) std::ranges::reverse(paths);
      std::ranges::rotate(paths, paths.begin() + 1 % static_cast<std::ptrdiff_t>(count));
    }
  }
}

TEST_F(AuditParts, EveryCheckIsInOneShardAndThoseOfAClaimAreDividedEvenly) {
  const Audit plan = PlanAudit(Claims(), Options());
  for (const std::uint32_t count : {1, 3, 7, 64}) {
    std::set<CheckPlace> seen;
    for (std::uint32_t number = 1; number <= count; ++number) {
      size_t num_of_first = 0;
      for (const CheckPlace& place : PlacesOf(plan, {number, count})) {
        EXPECT_TRUE(seen.insert(place).second);
        num_of_first += place.claim == 0;
      }
      EXPECT_GE(num_of_first, 8 / count);
      EXPECT_LE(num_of_first, (8 + count - 1) / count);
    }
    EXPECT_EQ(seen.size(), PlacesOf(plan).size());
  }
}

TEST_F(AuditParts, MissingShardsAreNamed) {
  Paths paths = Parts(3);
  paths.erase(paths.begin() + 1);
  const MergedAudit lost = MergeAuditParts(Claims(), Options(), paths);
  EXPECT_EQ(lost.num_missing, PlacesOf(lost.audit, {2, 3}).size());
  EXPECT_EQ(lost.missing_shards, std::vector<std::uint32_t>{2});
  EXPECT_EQ(lost.num_shards, 3);

  paths.push_back(Changed(Part(2, 3), [](Json* part) { part->at("checks").erase(0); }));
  const MergedAudit cut = MergeAuditParts(Claims(), Options(), paths);
  EXPECT_EQ(cut.num_missing, 1);
  EXPECT_EQ(cut.missing_shards, std::vector<std::uint32_t>{2});
}

TEST_F(AuditParts, APartGoesOnWhereItWas) {
  const std::string path = Part(1, 3), whole = JsonOf(path).dump();
  num_trials_run = 0;
  Part(1, 3);
  EXPECT_EQ(num_trials_run, 0);
  Json part = JsonOf(path);
  part["checks"].erase(1);
  WriteFileWhole(path, part.dump());
  Part(1, 3);
  EXPECT_GT(num_trials_run, 0);
  EXPECT_EQ(JsonOf(path).dump(), whole);
}

TEST_F(AuditParts, OfAnotherAuditAreRefusedWithWhatDiffers) {
  const std::string part = Part(1, 3);
  AuditOptions seed = Options(), budget = Options(), only = Options(), data = Options(), study = Options();
  seed.seed = 2;
  budget.budget = Budget::kFull;
  only.only = {"mixed.one"};
  data.conditions = {{"num_matches", "30"}};
  study.study_identity = "name: yours\n";
  EXPECT_TRUE(IsRefused({part}, {part, "'seed: 1' there, 'seed: 2' here"}, seed));
  EXPECT_TRUE(IsRefused({part}, {"'budget: quick' there, 'budget: full' here"}, budget));
  EXPECT_TRUE(IsRefused({part}, {"'claim: mixed.several, 8 checks' there"}, only));
  EXPECT_TRUE(IsRefused({part}, {"'num_matches: 20' there, 'num_matches: 30' here"}, data));
  EXPECT_TRUE(IsRefused({part}, {"'name: mine' there, 'name: yours' here"}, study));
  EXPECT_TRUE(ThrowsInputError([&] { RunAuditPart(Claims(), seed, {1, 3}, part); }, {part, "seed: 1"}));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        RunAuditPart(Claims(), Options(), {2, 3}, part);
      },
      {part, "another shard", "'1/3' there, '2/3' here"}));
}

TEST_F(AuditParts, OfAnotherProgramMachineOrNumberOfShardsAreRefused) {
  const std::string first = Part(1, 3), second = Part(2, 3);
  const std::string program = Changed(first, [](Json* part) { part->at("program") = "rcme 0.0.1"; });
  EXPECT_TRUE(IsRefused({second, program}, {program, "another program, 'rcme 0.0.1' there"}));
  const std::string machine = Changed(first, [](Json* part) { part->at("instruction_set") = "abacus"; });
  EXPECT_TRUE(IsRefused({second, machine}, {machine, second, "another instruction set, 'abacus' there"}));
  const std::string of_seven = Part(1, 7);
  EXPECT_TRUE(IsRefused({second, of_seven}, {of_seven, "number of shards, '7' there, '3' here"}));
}

TEST_F(AuditParts, ACheckThatIsThereTwiceCountsOnceOrIsRefused) {
  Paths paths = Parts(3);
  paths.push_back(Changed(paths[0], [](Json*) {}));
  const MergedAudit merged = MergeAuditParts(Claims(), Options(), paths);
  EXPECT_EQ(Bytes(merged.audit), Bytes(RunAudit(Claims(), Options())));

  paths.back() = Changed(paths[0], [](Json* part) {
    part->at("checks").at(0).at("result").at("targets").at(0).at("measured") = 0.25;
  });
  EXPECT_TRUE(IsRefused(paths, {paths.back(), "check 0 of claim mixed.several is not equal", paths[0]}));
}

TEST_F(AuditParts, DamageIsNamed) {
  const std::string part = Part(1, 1);
  const auto is_refused = [&](const std::function<void(Json*)>& change, const std::string& word) {
    return IsRefused({Changed(part, change)}, {part, word});
  };
  EXPECT_TRUE(is_refused([](Json* p) { p->at("format") = "rcme audit 1"; }, "its format is 'rcme audit 1'"));
  EXPECT_TRUE(is_refused([](Json* p) { p->erase("checks"); }, "not a whole part"));
  EXPECT_TRUE(is_refused([](Json* p) { p->at("shard") = 2; }, "there is no shard 2 of 1"));
  EXPECT_TRUE(is_refused([](Json* p) { p->at("checks").at(0).at("claim") = 99; }, "claim 99"));
  EXPECT_TRUE(is_refused([](Json* p) { p->at("checks").at(0).at("check") = 1; }, "twice"));
  const auto result_of = [](Json* p) -> Json& { return p->at("checks").at(0).at("result"); };
  EXPECT_TRUE(is_refused([&](Json* p) { result_of(p).at("targets").erase(0); }, "has 3 targets, not 4"));
  EXPECT_TRUE(is_refused([&](Json* p) { result_of(p).at("verdict") = "perhaps"; }, "a verdict that is none"));
  EXPECT_TRUE(is_refused([&](Json* p) { result_of(p).at("targets").at(0).at("measured") = "x"; }, "number"));

  std::ostringstream text;
  text << std::ifstream(part).rdbuf();
  const std::string cut = folder_.Path("cut.json");
  WriteFileWhole(cut, text.str().substr(0, text.str().size() / 2));
  EXPECT_TRUE(IsRefused({cut}, {cut, "not a whole part"}));
  EXPECT_TRUE(IsRefused({folder_.Path("none.json")}, {"none.json", "no such part of an audit"}));
}

}  // namespace
}  // namespace rcme
