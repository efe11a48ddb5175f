// An audit in shards gives the bytes of one machine's; what does not belong together is refused.
#include "experiments/claims/audit_part.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "experiments/base/file_output.h"
#include "experiments/claims/audit_output.h"
#include "tests/test_support/changed_json.h"
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
  for (const std::uint32_t count : {1, 3, 7, 64}) {
    Paths paths = Parts(count);
    for (int order = 0; order < 4; ++order) {
      const MergedAudit merged = MergeAuditParts(Claims(), Options(), paths);
      EXPECT_EQ(merged.missing.num_pieces, 0);
      EXPECT_EQ(Bytes(merged.audit), whole) << count << " shards, order " << order;
      if (order == 1) std::ranges::reverse(paths);
      std::ranges::rotate(paths, paths.begin() + 1 % static_cast<std::ptrdiff_t>(count));
    }
  }
}

TEST_F(AuditParts, EveryCheckIsInOneShardAndThoseOfAClaimAreDividedEvenly) {
  const Audit plan = PlanAudit(Claims(), Options());
  const PiecePlan pieces = PiecesOfAudit(plan);
  EXPECT_EQ(pieces.NumPieces(), PlacesOf(plan).size());
  for (const std::uint32_t count : {1, 3, 7, 64}) {
    std::set<PiecePlace> seen;
    for (std::uint32_t number = 1; number <= count; ++number) {
      size_t num_of_first = 0;
      for (const PiecePlace& place : PiecesOf(pieces, {number, count})) {
        EXPECT_TRUE(seen.insert(place).second);
        num_of_first += place.group == 0;
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
  EXPECT_EQ(lost.missing.num_pieces, PiecesOf(PiecesOfAudit(lost.audit), {2, 3}).size());
  EXPECT_EQ(lost.missing.shards, std::vector<std::uint32_t>{2});
  EXPECT_EQ(lost.parts.num_shards, 3);

  paths.push_back(ChangedJson(Part(2, 3), [](Json* part) { part->at("pieces").erase(0); }));
  const MergedAudit cut = MergeAuditParts(Claims(), Options(), paths);
  EXPECT_EQ(cut.missing.num_pieces, 1);
  EXPECT_EQ(cut.missing.shards, std::vector<std::uint32_t>{2});
}

TEST_F(AuditParts, APartGoesOnWhereItWas) {
  const auto results_of = [](const std::string& path) {
    Json part = JsonOf(path);
    for (Json& piece : part["pieces"]) EXPECT_EQ(piece.erase("seconds"), 1);
    return part.dump();
  };
  const std::string path = Part(1, 3), whole = results_of(path);
  num_trials_run = 0;
  Part(1, 3);
  EXPECT_EQ(num_trials_run, 0);
  Json part = JsonOf(path);
  part["pieces"].erase(1);
  WriteFileWhole(path, part.dump());
  Part(1, 3);
  EXPECT_GT(num_trials_run, 0);
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
  EXPECT_TRUE(IsRefused({part}, {"'claim mixed.several: 8 checks' there"}, only));
  EXPECT_TRUE(IsRefused({part}, {"'num_matches: 20' there, 'num_matches: 30' here"}, data));
  EXPECT_TRUE(IsRefused({part}, {"'name: mine' there, 'name: yours' here"}, study));
  EXPECT_TRUE(ThrowsInputError([&] { RunAuditPart(Claims(), seed, {1, 3}, part); }, {part, "seed: 1"}));
}

TEST_F(AuditParts, DamageIsNamed) {
  const std::string part = Part(1, 1);
  const auto is_refused = [&](const std::function<void(Json*)>& change, const std::string& word) {
    return IsRefused({ChangedJson(part, change)}, {part, "damaged: check 0 of claim mixed.several", word});
  };
  const auto result_of = [](Json* p) -> Json& { return p->at("pieces").at(0).at("result"); };
  EXPECT_TRUE(is_refused([&](Json* p) { result_of(p).at("targets").erase(0); }, "has 3 targets, not 4"));
  EXPECT_TRUE(is_refused([&](Json* p) { result_of(p).at("verdict") = "perhaps"; }, "a verdict that is none"));
  EXPECT_TRUE(is_refused([&](Json* p) { result_of(p).at("targets").at(0).at("measured") = "x"; }, "number"));
  EXPECT_TRUE(is_refused([&](Json* p) { result_of(p).erase("num_trials"); }, "num_trials"));
}

}  // namespace
}  // namespace rcme
