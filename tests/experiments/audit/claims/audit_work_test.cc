// An audit in shards gives the bytes of one machine's; what does not belong together is refused.
#include "experiments/audit/claims/audit_work.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "experiments/audit/claims/audit_output.h"
#include "experiments/audit/claims/audit_page.h"
#include "experiments/audit/claims/outcomes_json.h"
#include "experiments/core/files/file_output.h"
#include "tests/test_support/changed_part.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/in_memory.h"
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

// Is decided soon, or late, or not at all, by its number.
Check EarlyCheck(int number) {
  Check check = MixedCheck(number);
  check.targets = {ClaimedRate("rate", 0.3, {0.25, 0.35}, 0), MeasuredMean("mean", 1),
                   ClaimedMean("bounded", 0.5, {0.4, 0.6}, 1)};
  check.targets.front().kind = Target::Kind::kAtMost;
  check.targets.front().threshold = 0.25 + 0.05 * number;
  check.targets.back().kind = Target::Kind::kBoundedMean;
  check.targets.back().planned_spread = 0.29;
  check.limits = {100, 5'000, 9'000};
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
  for (int k = 0; k < 6; ++k) claims[2].checks.push_back(EarlyCheck(k));
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
  const CommandResult result = MakeAuditResult(audit);
  return result.json + result.text + AuditAsMarkdown(audit);
}

class AuditParts : public testing::Test {
 protected:
  std::string MakePartPath(std::uint32_t number, std::uint32_t count) const {
    return folder_.Path(fmt::format("{}_of_{}.json", number, count));
  }
  std::string RoundPath() const { return folder_.Path("round.json"); }
  // A shard's blocks of the first round, or of the one in the file.
  std::string Part(std::uint32_t number, std::uint32_t count, bool is_first = true,
                   const AuditOptions& options = Options()) const {
    const Audit plan = PlanAudit(Claims(), options);
    Runner runner = Runner::OfShard(PlanAuditBlocks(plan), {number, count}, MakePartPath(number, count), 1);
    GetAuditRound(plan, is_first ? FirstRound(plan) : ReadRound(plan, RoundPath()), &runner);
    return MakePartPath(number, count);
  }
  // Of all shards, all rounds.
  Paths Parts(std::uint32_t count) const {
    Paths paths;
    for (std::uint32_t number = 1; number <= count; ++number) paths.push_back(Part(number, count));
    for (int num_rounds = 1; num_rounds <= 12; ++num_rounds) {
      const MergedAudit merged = MergeAuditParts(Claims(), Options(), paths);
      if (merged.missing.num_items == 0) {
        EXPECT_GE(num_rounds, 4);
        return paths;
      }
      WriteRound(merged.audit, merged.round, RoundPath());
      for (std::uint32_t number = 1; number <= count; ++number) Part(number, count, false);
    }
    ADD_FAILURE() << "rounds without end";
    return paths;
  }
  static bool IsRefused(const Paths& paths, const Paths& words, const AuditOptions& options = Options()) {
    return ThrowsInputError([&] { MergeAuditParts(Claims(), options, paths); }, words);
  }

  const TempFolder folder_;
};

TEST_F(AuditParts, OfAnyNumberInAnyOrderGiveTheSameBytes) {
  const Audit one = RunAuditInMemory(Claims(), Options());
  const std::string whole = Bytes(one);
  EXPECT_NE(whole.find("null"), std::string::npos);  // what JSON has no numbers for is tried too
  EXPECT_NE(whole.find("does not hold"), std::string::npos);
  EXPECT_NE(whole.find("inf"), std::string::npos);
  std::set<std::int64_t> trials;  // some checks end in each of several rounds
  for (const CheckResult& result : one.results[2].checks) trials.insert(result.num_trials);
  EXPECT_GE(trials.size(), 4);
  for (const std::uint32_t count : {1, 7, 64}) {
    Paths paths = Parts(count);
    for (int order = 0; order < 4; ++order) {
      const MergedAudit merged = MergeAuditParts(Claims(), Options(), paths);
      EXPECT_EQ(merged.missing.num_items, 0);
      EXPECT_EQ(Bytes(merged.audit), whole) << count << " shards, order " << order;
      if (order == 1) std::ranges::reverse(paths);
      std::ranges::rotate(paths, paths.begin() + 1 % static_cast<std::ptrdiff_t>(count));
    }
  }
}

TEST_F(AuditParts, FewTrialsAreRunForNothing) {
  std::int64_t needed = 0, least = 0;
  for (const ClaimResult& claim : RunAuditInMemory(Claims(), Options()).results) {
    for (const CheckResult& check : claim.checks) {
      needed += check.num_trials;
      least += check.num_trials < 5'000 ? check.num_trials : 0;
    }
  }
  num_trials_run = 0;
  Parts(7);
  EXPECT_GT(num_trials_run, needed);
  EXPECT_LT(static_cast<double>(num_trials_run - needed),
            (1.25 * kRoundGrowth - 1.0) * static_cast<double>(least));
}

TEST_F(AuditParts, EveryBlockIsInOneShardAndThoseOfACheckAreDividedEvenly) {
  const Audit plan = PlanAudit(Claims(), Options());
  const WorkPlan pieces = PlanAuditBlocks(plan);
  EXPECT_EQ(pieces.groups.size(), ListCheckPlaces(plan).size());
  EXPECT_EQ(pieces.groups.at(9).num_items, 0);  // not possible
  for (const std::uint32_t count : {1, 3, 7, 64}) {
    std::set<ItemPlace> seen;
    for (std::uint32_t number = 1; number <= count; ++number) {
      size_t num_of_first = 0;
      for (const ItemPlace& place : ListItems(pieces, {number, count})) {
        EXPECT_TRUE(seen.insert(place).second);
        num_of_first += place.group == 0;
      }
      EXPECT_GE(num_of_first, 64 / count);
      EXPECT_LE(num_of_first, (64 + count - 1) / count);
    }
    EXPECT_EQ(seen.size(), ListItems(pieces, {}).size());
  }
}

TEST(TrialBlocks, CoverAllTrialsInRoundsThatEndAtLooks) {
  const auto expect = [](const Check& check, const std::vector<std::int64_t>& round_ends) {
    const TrialBlocks blocks(check, Budget::kQuick);
    std::vector<std::int64_t> ends;
    for (size_t block = 0; block < blocks.NumBlocks();) {
      const size_t end = blocks.RoundEnd(block);
      const std::int64_t length = blocks.End(end - 1) - blocks.Begin(block);
      EXPECT_EQ(end - block, std::min<size_t>(64, static_cast<size_t>(length)));
      const auto num_blocks = static_cast<std::int64_t>(end - block);
      for (; block < end; ++block) {
        EXPECT_EQ(blocks.RoundEnd(block), end);
        EXPECT_EQ(blocks.Begin(block), block == 0 ? 0 : blocks.End(block - 1));
        EXPECT_GE(blocks.End(block) - blocks.Begin(block), length / num_blocks);
        EXPECT_LE(blocks.End(block) - blocks.Begin(block), length / num_blocks + 1);
      }
      ends.push_back(blocks.End(end - 1));
    }
    EXPECT_EQ(ends, round_ends);
  };
  // Looks at 64, 128, ..., 320, 400, 500, 625, 781, 976, 1220, ... and at the end.
  Check early = EarlyCheck(0);
  expect(early, {128, 192, 320, 500, 781, 1220, 1906, 2977, 4651, 5000});
  early.limits = {0, 100, 100};
  expect(early, {64, 100});
  early.limits = {40, 40, 40};
  expect(early, {40});
  expect(MixedCheck(0), {700});  // a mean is claimed: nothing ends it before
  Check measured = EarlyCheck(0);
  measured.targets = {MeasuredRate("rate")};
  expect(measured, {5000});
  expect(ImpossibleCheck(), {});
}

TEST(OutcomesJson, ComeBackToTheLastBit) {
  Check check = EarlyCheck(0);
  check.targets = {MeasuredRate("rate", 1), MeasuredMean("mean", 3)};
  check.difficulty_statistic = 4;
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  const std::vector<Outcome> outcomes = {
      {7.0, 1.0, 7.0, 0.1, 0.0}, {7.0, 0.0, 7.0, -infinity, -0.0}, {7.0, nan, 7.0, nan, 1e-320}};
  const std::string text = OutcomesAsJson(check, outcomes);
  EXPECT_EQ(text, R"(["10n",[0.1,"-inf","nan"],[0.0,-0.0,1e-320]])");
  const std::vector<Outcome> read = OutcomesFrom(check, text, 3);
  for (size_t i = 0; i < outcomes.size(); ++i) {
    for (const size_t statistic : {1, 3, 4}) {
      const double was = outcomes[i][statistic], is = read.at(i).at(statistic);
      EXPECT_TRUE(std::isnan(was) ? std::isnan(is) : was == is && std::signbit(was) == std::signbit(is));
    }
  }
}

TEST_F(AuditParts, MissingShardsAreNamed) {
  const MergedAudit first = MergeAuditParts(Claims(), Options(), {Part(1, 3), Part(3, 3)});
  EXPECT_EQ(first.missing.shards, std::vector<std::uint32_t>{2});
  EXPECT_EQ(first.parts.num_shards, 3);
  EXPECT_EQ(first.round, FirstRound(first.audit));
  Paths paths = Parts(3);
  std::filesystem::remove(paths[1]);  // lost in the last round; one call makes it again
  const MergedAudit lost = MergeAuditParts(Claims(), Options(), {paths[0], paths[2]});
  EXPECT_EQ(lost.missing.shards, std::vector<std::uint32_t>{2});
  Part(2, 3, false);
  EXPECT_EQ(MergeAuditParts(Claims(), Options(), paths).missing.num_items, 0);
}

TEST_F(AuditParts, APartGoesOnWhereItWas) {
  const auto results_of = [](const std::string& path) {
    Json part = PartAsJson(path);
    for (Json& piece : part["pieces"]) EXPECT_EQ(piece.erase("seconds"), 1);
    return part.dump();
  };
  const Paths paths = Parts(3);
  const std::string path = paths[0], whole = results_of(path);
  num_trials_run = 0;
  Part(1, 3, false);
  EXPECT_EQ(num_trials_run, 0);
  Json part = PartAsJson(path);
  part["pieces"].erase(1);
  WriteJsonAsPart(path, part);
  const MergedAudit cut = MergeAuditParts(Claims(), Options(), paths);
  EXPECT_EQ(cut.missing.shards, std::vector<std::uint32_t>{1});
  Part(1, 3, false);
  EXPECT_EQ(num_trials_run, 11);  // one block
  EXPECT_EQ(results_of(path), whole);
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
  EXPECT_TRUE(IsRefused({part}, {"'check 0 of claim mixed.several: 64 blocks' there"}, only));
  EXPECT_TRUE(IsRefused({part}, {"'num_matches: 20' there, 'num_matches: 30' here"}, data));
  EXPECT_TRUE(IsRefused({part}, {"'name: mine' there, 'name: yours' here"}, study));
  EXPECT_TRUE(ThrowsInputError([&] { Part(1, 3, true, seed); }, {part, "seed: 1"}));
}

TEST_F(AuditParts, ARoundOfAnotherAuditIsRefused) {
  Part(1, 3);
  const Audit plan = PlanAudit(Claims(), Options());
  WriteRound(plan, FirstRound(plan), RoundPath());
  EXPECT_EQ(ReadRound(plan, RoundPath()), FirstRound(plan));
  AuditOptions seed = Options();
  seed.seed = 2;
  const auto is_refused = [](const Audit& audit, const std::string& path, const std::string& word) {
    return ThrowsInputError([&] { ReadRound(audit, path); }, {path, word});
  };
  EXPECT_TRUE(is_refused(PlanAudit(Claims(), seed), RoundPath(), "'seed: 1' there"));
  EXPECT_TRUE(is_refused(plan, MakePartPath(1, 3), "'audit' there, 'round of an audit' here"));
  const auto changed = [&](const std::function<void(Json*)>& change) {
    return ChangedPart(RoundPath(), change);
  };
  EXPECT_TRUE(is_refused(plan, changed([](Json* p) { p->at("pieces").erase(2); }), "lacks checks"));
  EXPECT_TRUE(is_refused(plan, changed([](Json* p) { p->at("pieces").at(0).at("result") = 65; }),
                         "a count of 65, not of 0 to 64"));
}

TEST_F(AuditParts, DamageIsNamed) {
  const std::string part = Part(1, 1);
  const auto is_refused = [&](const std::function<void(Json*)>& change, const std::string& word) {
    return IsRefused({ChangedPart(part, change)},
                     {part, "damaged: block 0 of check 0 of claim mixed.several", word});
  };
  const auto result_of = [](Json* p) -> Json& { return p->at("pieces").at(0).at("result"); };
  EXPECT_TRUE(is_refused([&](Json* p) { result_of(p).erase(0); }, "has 4 statistics, not 5"));
  EXPECT_TRUE(is_refused([&](Json* p) { result_of(p).at(0).erase(0); }, "has 9 trials, not 10"));
  EXPECT_TRUE(is_refused([&](Json* p) { result_of(p).at(0).at(1) = "x"; }, "number"));
  EXPECT_TRUE(is_refused([&](Json* p) { result_of(p).at(2) = "0101x01010"; }, "an outcome that is none"));
  EXPECT_TRUE(is_refused([&](Json* p) { result_of(p) = 3; }, "statistics"));
}

}  // namespace
}  // namespace rcme
