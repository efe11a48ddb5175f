// A tuning and a transfer in shards give what one machine gives; what is damaged is named.
#include "experiments/tuning/tuning_work.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "experiments/tuning/transfer.h"
#include "experiments/tuning/transfer_output.h"
#include "experiments/tuning/tune_json.h"
#include "experiments/tuning/tune_output.h"
#include "tests/test_support/changed_part.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/in_memory.h"
#include "tests/test_support/temp_folder.h"
#include "tests/test_support/tuned_study.h"

namespace rcme {
namespace {

using Paths = std::vector<std::string>;
using PartJson = nlohmann::ordered_json;

std::string Bytes(const StudyPlan& plan, const TuneResult& result, const std::vector<EntropyRoc>& rocs) {
  return TuneAsTable(plan, result, rocs) + TuneAsJson(plan, MakeTunedSettings(plan), result, rocs);
}

std::string Bytes(const CommandResult& result) { return result.text + result.json; }

class TuneParts : public testing::Test {
 protected:
  MissingItems Part(const TuningWork& work, const WorkResults& merged, const Shard& shard,
                    const std::string& path) const {
    Runner runner = Runner::OfShard(work.items, shard, path, 2);
    return GetTuningShard(plan_, settings_, work, merged, &runner);
  }
  // Both rounds of a tuning, the one of a transfer.
  Paths ListParts(const TuningWork& work, std::uint32_t count) const {
    Paths paths;
    for (std::uint32_t number = 1; number <= count; ++number)
      paths.push_back(folder_.Path(fmt::format("{}_of_{}", number, count)));
    const bool has_rounds = work.num_first < work.items.groups.size();
    for (int round = 0; round < (has_rounds ? 2 : 1); ++round) {
      const WorkResults merged = round == 0 ? WorkResults{} : MergeParts(work.items, paths);
      for (std::uint32_t number = 1; number <= count; ++number) {
        const MissingItems missing = Part(work, merged, {number, count}, paths[number - 1]);
        EXPECT_EQ(missing.num_items > 0, has_rounds && round == 0);
      }
    }
    return paths;
  }
  std::string RenderMerged(const TuningWork& work, const WorkResults& merged) const {
    const TuneResult result =
        Tune(plan_, settings_, Unreached::kStop, CountsIn(plan_, settings_, work, merged));
    return Bytes(plan_, result, ComputeRocs(plan_, EntropiesIn(plan_, work, merged)));
  }

  const TempFolder folder_;
  const StudyPlan plan_ = PlanInPieces();
  const SettingPlan settings_ = MakeTunedSettings(plan_);
};

TEST_F(TuneParts, OfAnyNumberInAnyOrderGiveTheBytesOfOneMachine) {
  const TuneResult one = TuneInMemory(plan_, settings_, Unreached::kStop, 2);
  ASSERT_TRUE(one.choice.setting.has_value());
  const std::vector<EntropyRoc> rocs =
      ComputeRocs(plan_, MeasureEntropies(plan_, TuningTrials(*plan_.study.tuning).verify));
  ASSERT_FALSE(rocs.empty());
  const std::string whole = Bytes(plan_, one, rocs);
  const TuningWork work = PlanTuningWork(plan_);
  EXPECT_EQ(ListItems(work.items, {}).size(), 2 * (3 + 5 + 4 + 4 + 4));
  for (const std::uint32_t count : {1, 7, 64}) {
    Paths paths = ListParts(work, count);
    for (int order = 0; order < 2; ++order) {
      EXPECT_EQ(RenderMerged(work, MergeParts(work.items, paths)), whole) << count << " shards";
      std::ranges::reverse(paths);
    }
    if (count == 1) continue;
    std::filesystem::remove(paths[2]);  // lost, and made again from the others
    Paths others = paths;
    others.erase(others.begin() + 2);
    const WorkResults lost = MergeParts(work.items, others);
    const MissingItems missing = FindMissingIn(work.items, lost, 0, work.items.groups.size());
    const Shard shard{3, count};
    EXPECT_EQ(missing.num_items, ListItems(work.items, shard).size());
    if (missing.num_items > 0) {
      EXPECT_EQ(missing.shards, std::vector<std::uint32_t>{3});
      const MissingItems of_round_one = Part(work, lost, shard, paths[2]);
      EXPECT_GT(of_round_one.num_items, 0);
      Part(work, MergeParts(work.items, paths), shard, paths[2]);
    }
    EXPECT_EQ(RenderMerged(work, MergeParts(work.items, paths)), whole);
  }
}

TEST_F(TuneParts, OfATransferGiveTheBytesOfOneMachine) {
  const TransferResult one = MeasureTransferInMemory(plan_, settings_, "", 2);
  const std::string whole = Bytes(MakeTransferResult(plan_, settings_, one));
  const TuningWork work = PlanTransferWork(plan_);
  for (const std::uint32_t count : {1, 7, 64}) {
    const WorkResults merged = MergeParts(work.items, ListParts(work, count));
    EXPECT_EQ(FindMissingIn(work.items, merged, 0, work.num_first).num_items, 0);
    const TransferResult result =
        MeasureTransfer(plan_, settings_, "", CountsIn(plan_, settings_, work, merged));
    EXPECT_EQ(Bytes(MakeTransferResult(plan_, settings_, result)), whole);
  }
}

TEST_F(TuneParts, OfOtherLevelsAreRefused) {
  const std::string path = ListParts(PlanTransferWork(plan_), 1).front();
  StudyPlan other = plan_;
  other.study.tuning->options.front().levels.back() = "5";
  EXPECT_TRUE(ThrowsInputError([&] { MergeParts(PlanTransferWork(other).items, {path}); },
                               {path, "tune: mu: 1, 2, 3, 6' there", "tune: mu: 1, 2, 3, 5' here"}));
}

TEST_F(TuneParts, DamageIsNamed) {
  const TuningWork work = PlanTuningWork(plan_);
  const std::string path = ListParts(work, 1).front();
  // Whether a change of the first piece of a group is found when it is read.
  const auto is_refused = [&](size_t group, const std::function<void(PartJson*)>& change,
                              const std::string& word) {
    const std::string changed = ChangedPart(path, [&](PartJson* part) {
      for (PartJson& piece : part->at("pieces")) {
        if (piece["group"] == group && piece["piece"] == 0) change(&piece["result"]);
      }
    });
    return ThrowsInputError([&] { RenderMerged(work, MergeParts(work.items, {changed})); },
                            {changed, "damaged: block 0 of " + work.items.groups[group].name, word});
  };
  const auto erase = [](PartJson* result) { result->erase(0); };
  EXPECT_TRUE(is_refused(0, erase, "no list of 4"));
  EXPECT_TRUE(is_refused(
      3, [](PartJson* r) { r->at(0).erase(1); }, "no list of 5"));
  EXPECT_TRUE(is_refused(
      3, [](PartJson* r) { r->at(0).at(1) = 11; }, "a count of 11, not of 0 to 10"));
  EXPECT_TRUE(is_refused(
      4, [](PartJson* r) { r->at(0).at(1) = -1; }, "a count of -1, not of 0 to 10"));
  EXPECT_TRUE(is_refused(
      4, [](PartJson* r) { r->at(0).at(1) = "x"; }, "number"));
  // [trials, failures, refusals, good, false refusals]; the first is what a random damage made of [10, 0, 7,
  // 3, 0].
  const auto counts = [&](const PartJson& of_setting, const std::string& word) {
    return is_refused(
        3, [&](PartJson* r) { r->at(0) = of_setting; }, word);
  };
  EXPECT_TRUE(counts({10, 0, 7, 3, 7}, "more false refusals than good trials"));
  EXPECT_TRUE(counts({10, 6, 5, 0, 0}, "more failures and refusals than trials"));
  EXPECT_TRUE(counts({10, 0, 2, 9, 3}, "more false refusals than refusals"));
  EXPECT_TRUE(counts({10, 0, 7, 9, 0}, "more good trials than were refused or not"));
  EXPECT_TRUE(counts({9, 0, 2, 7, 0}, "fewer trials than there are"));
  EXPECT_TRUE(is_refused(6, erase, "no list of 2"));
  EXPECT_TRUE(is_refused(
      7,
      [](PartJson* r) {
        r->at(1).at(0) = {nullptr, nullptr, 1.0, 2.0};
      },
      "a trial has two winners"));
  EXPECT_TRUE(is_refused(
      6, [](PartJson* r) { r->at(1).erase(0); }, "no list of 10"));
  EXPECT_TRUE(is_refused(
      7, [](PartJson* r) { r->at(1).at(0) = 5; }, "no list of 4"));
  EXPECT_TRUE(is_refused(8, erase, "no list of 3"));
  EXPECT_TRUE(is_refused(
      9, [](PartJson* r) { r->at(2).erase(0); }, "no list of 7"));
  EXPECT_TRUE(is_refused(
      9, [](PartJson* r) { r->at(2).at(6) = 11; }, "a count of 11, not of 0 to 10"));
  // [failures, refusals, either, both, first only, second only, neither] of ten trials.
  const auto plain = [&](const PartJson& of_estimator, const std::string& word) {
    return is_refused(
        9, [&](PartJson* r) { r->at(0) = {0, 0, 0, 0, 0, 0, 10}, r->at(1) = of_estimator; }, word);
  };
  EXPECT_TRUE(plain({1, 0, 0, 0, 0, 0, 10}, "failures and refusals are not their sum"));
  EXPECT_TRUE(plain({0, 0, 0, 0, 0, 0, 9}, "the pairs are not the trials"));
  EXPECT_TRUE(plain({1, 0, 1, 0, 0, 0, 10}, "the pairs have other failures and refusals"));
  EXPECT_TRUE(plain({0, 0, 0, 0, 1, 0, 9}, "other failures and refusals of the first estimator"));
}

}  // namespace
}  // namespace rcme
