// Part files and checkpoints of which bytes were changed: whoever merges them, or goes on with them, gets the
// very same tables as before, or a refusal that names the file. Also where the damage has right checksums, so
// that nothing but the arithmetic of counts is left to find it: then nothing else than a refusal or a table
// happens.
//
// RCME_DAMAGES=1000 sets how many random damages there are of the parts of each work; the seeds are 1 and 2.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "experiments/audit/claims/audit_output.h"
#include "experiments/audit/claims/audit_work.h"
#include "experiments/audit/model_choice/choice_output.h"
#include "experiments/audit/validity/map_work.h"
#include "experiments/core/table/render_table.h"
#include "experiments/rare/rare_output.h"
#include "experiments/real/truth_free/kept_answers.h"
#include "experiments/real/truth_free/twin_output.h"
#include "experiments/real/truth_free/twin_report.h"
#include "experiments/real/truth_free/validate_output.h"
#include "experiments/tuning/transfer.h"
#include "experiments/tuning/transfer_output.h"
#include "experiments/tuning/tune_json.h"
#include "experiments/tuning/tune_output.h"
#include "experiments/tuning/tuning_work.h"
#include "parameters/input_error.h"
#include "tests/test_support/changed_part.h"
#include "tests/test_support/temp_folder.h"
#include "tests/test_support/tuned_study.h"

namespace rcme {
namespace {

using Paths = std::vector<std::string>;
constexpr std::uint32_t kNumShards = 2;

int NumDamages() {
  const char* number = std::getenv("RCME_DAMAGES");
  return number ? std::atoi(number) : 25;
}

// The parts of a work, and all that is made of them.
struct DividedTables {
  std::string work;
  Paths parts;
  std::function<std::string()> tables;
};

class DamagedParts : public testing::Test {
 protected:
  Paths ListPaths(const std::string& work) const {
    Paths paths;
    for (std::uint32_t number = 1; number <= kNumShards; ++number)
      paths.push_back(folder_.Path(fmt::format("{}_{}.part", work, number)));
    return paths;
  }

  void TuningPart(const TuningWork& work, const WorkResults& merged, std::uint32_t n,
                  const Paths& paths) const {
    Runner runner = Runner::OfShard(work.items, {n, kNumShards}, paths[n - 1], 1);
    GetTuningShard(plan_, settings_, work, merged, &runner);
  }

  DividedTables Tuning() const {
    const TuningWork work = PlanTuningWork(plan_);
    const Paths paths = ListPaths("tuning");
    for (int round = 0; round < 2; ++round) {
      const WorkResults merged = round == 0 ? WorkResults{} : MergeParts(work.items, paths);
      for (std::uint32_t n = 1; n <= kNumShards; ++n) TuningPart(work, merged, n, paths);
    }
    const auto tables = [this, work, paths] {
      const WorkResults merged = MergeParts(work.items, paths);
      RequireWhole(work.items, merged);
      const TuneResult result =
          Tune(plan_, settings_, Unreached::kStop, CountsIn(plan_, settings_, work, merged));
      const auto rocs = ComputeRocs(plan_, EntropiesIn(plan_, work, merged));
      return TuneAsTable(plan_, result, rocs) + TuneAsJson(plan_, settings_, result, rocs);
    };
    return {"tuning", paths, tables};
  }

  DividedTables Transfer() const {
    const TuningWork work = PlanTransferWork(plan_);
    const Paths paths = ListPaths("transfer");
    for (std::uint32_t n = 1; n <= kNumShards; ++n) TuningPart(work, {}, n, paths);
    const auto tables = [this, work, paths] {
      const WorkResults merged = MergeParts(work.items, paths);
      RequireWhole(work.items, merged);
      const TransferResult result =
          MeasureTransfer(plan_, settings_, "", CountsIn(plan_, settings_, work, merged));
      const CommandResult transfer = MakeTransferResult(plan_, settings_, result);
      return transfer.text + transfer.json;
    };
    return {"transfer", paths, tables};
  }

  // A rate, and a mean within bounds, of numbers that are drawn.
  static std::vector<Claim> Claims() {
    Check check;
    check.targets = {ClaimedRate("rate", 0.3, {0.2, 0.4}, 0), ClaimedMean("mean", 0.5, {0.4, 0.6}, 1)};
    check.targets.back().kind = Target::Kind::kBoundedMean;
    check.targets.back().planned_spread = 0.29;
    check.limits = {200, 200, 200};
    check.trial = [](const StreamName& name) -> std::vector<double> {
      RandomStream rng(name);
      const double u = rng.Uniform();
      return {u < 0.3 ? 1.0 : 0.0, u};
    };
    Claim claim;
    claim.id = "drawn.numbers";
    claim.checks = {check};
    return {claim};
  }

  DividedTables Audit() const {
    const Paths paths = ListPaths("audit");
    const rcme::Audit plan = PlanAudit(Claims(), {});
    for (std::uint32_t n = 1; n <= kNumShards; ++n) {
      Runner runner = Runner::OfShard(PlanAuditBlocks(plan), {n, kNumShards}, paths[n - 1], 1);
      GetAuditRound(plan, FirstRound(plan), &runner);
    }
    const auto tables = [paths] {
      const MergedAudit merged = MergeAuditParts(Claims(), {}, paths);
      if (merged.missing.num_items > 0) throw InputError("blocks are missing");
      const CommandResult result = MakeAuditResult(merged.audit);
      return result.json + result.text;
    };
    return {"audit", paths, tables};
  }

  DividedTables Map() const {
    MapWork work;
    work.map.trials = 20;
    work.map.sigmas_px = {0.5, 1.0};
    work.map.nums_points = {8};
    work.map.conditions = AtBaselines({0.5});
    work.reference.emplace();
    work.reference->sigmas_px = {0.5};
    work.reference->nums_points = {8};
    work.reference->num_samples = 4;
    work.reference->num_draws = 10;
    work.reference->num_noises = 20;
    const Paths paths = ListPaths("map");
    for (std::uint32_t n = 1; n <= kNumShards; ++n) {
      Runner runner = Runner::OfShard(PlanMapWork(work), {n, kNumShards}, paths[n - 1], 1);
      GetMapResults(work, &runner);
    }
    const auto tables = [work, paths] {
      const WorkPlan pieces = PlanMapWork(work);
      const WorkResults merged = MergeParts(pieces, paths);
      RequireWhole(pieces, merged);
      return RenderCsv(MakeValidityMapTable(work.map, TrialsIn(work, pieces, merged))) +
             RenderCsv(MakeValidityReferenceTable(*work.reference, CountsIn(work, pieces, merged)));
    };
    return {"map", paths, tables};
  }

  // What is kept until a work is done; `tables` goes on with it.
  DividedTables Checkpoint(const std::string& work, const WorkPlan& plan,
                           const std::function<std::string(Runner*)>& tables) const {
    const Paths paths = {folder_.Path(work + ".part")};
    const auto go_on = [plan, paths, tables] {
      Runner runner = Runner::WithCheckpoint(plan, paths[0], 1);
      return tables(&runner);
    };
    Runner runner = Runner::WithCheckpoint(plan, paths[0], 1);
    tables(&runner);
    runner.Get({}, nullptr);  // writes the file also where the work is one of steps
    return {work, paths, go_on};
  }

  DividedTables Splitting() const {
    const RareEffort effort{{20, 2, 0.2}, 6};
    return Checkpoint("splitting", PlanSplitting(plan_, 1, effort), [this, effort](Runner* runner) {
      return MakeRareResult(plan_, effort, SplitFailures(plan_, 1, effort, runner)).json;
    });
  }

  DividedTables Strata() const {
    const StratifiedEffort effort{600, 0.1};
    return Checkpoint("strata", PlanStrata(plan_, effort), [this, effort](Runner* runner) {
      return MakeStratifiedResult(plan_, effort, StratifyFailures(plan_, effort, runner)).json;
    });
  }

  DividedTables Choices() const {
    return Checkpoint("choices", PlanChoices(plan_), [this](Runner* runner) {
      return MakeChoiceResult(plan_, CountChoices(plan_, {}, runner)).json;
    });
  }

  DividedTables AuditChecks() const {
    return Checkpoint("checks", PlanAuditChecks(PlanAudit(Claims(), {})), [](Runner* runner) {
      const rcme::Audit audit = RunAudit(Claims(), {}, runner);
      const CommandResult result = MakeAuditResult(audit);
      return result.json + result.text;
    });
  }

  static WorkPlan Steps() { return {"steps", "step", "the same\n", {}, true}; }

  DividedTables Validation() const {
    return Checkpoint("validation", Steps(), [this](Runner* runner) {
      KeptSteps steps(runner);
      const PairSet set = PairSetsOfStudy(plan_).front();
      return MakeValidationResult({Validate(set, *plan_.estimators.back(), {1, 1}, &steps)}).json;
    });
  }

  DividedTables Twins() const {
    return Checkpoint("twins", Steps(), [this](Runner* runner) {
      KeptSteps steps(runner);
      const MotionEstimator& estimator = *plan_.estimators.back();
      const TwinSource source = AnswerScene("made", *plan_.conditions[0].source, {}, estimator, 1, &steps);
      return MakeTwinsResult({MakeTwinReport(source, estimator, "pairs", 0.5, 1, 1, &steps)}).json;
    });
  }

  std::vector<DividedTables> AllWorks() const {
    return {Tuning(), Transfer(), Audit(),       Map(),        Splitting(),
            Strata(), Choices(),  AuditChecks(), Validation(), Twins()};
  }

  static void RequireWhole(const WorkPlan& pieces, const WorkResults& merged) {
    if (FindMissingIn(pieces, merged, 0, pieces.groups.size()).num_items > 0)
      throw InputError("pieces are missing");
  }

  const TempFolder folder_;
  const StudyPlan plan_ = PlanInPieces();
  const SettingPlan settings_ = MakeTunedSettings(plan_);
};

// Other bytes than these: a bit, a byte, a digit or a run of bytes changed, lost, doubled or moved, or the
// end cut off.
std::string Damaged(const std::string& bytes, std::mt19937* rng, std::string* what) {
  std::string damaged = bytes;
  while (damaged == bytes) {
    const size_t place = (*rng)() % bytes.size(), length = 1 + (*rng)() % 64, to = (*rng)() % bytes.size();
    const auto kind = (*rng)() % 8;
    *what = fmt::format("damage of kind {} at byte {}", kind, place);
    if (kind == 0) damaged[place] = static_cast<char>(damaged[place] ^ (1 << (*rng)() % 8));
    if (kind == 1) damaged[place] = static_cast<char>((*rng)() % 256);
    if (kind == 2) {
      const size_t digit = bytes.find_first_of("0123456789", place);
      if (digit != std::string::npos) damaged[digit] = static_cast<char>('0' + (*rng)() % 10);
    }
    if (kind == 3) damaged.erase(place, length);
    if (kind == 4) damaged.insert(place, bytes.substr(place, length));
    if (kind == 5) damaged.replace(place, length, bytes.substr(to, length));
    if (kind == 6) damaged.resize(place);
    if (kind == 7) {  // whole lines change places, which no line's own checksum tells
      const size_t begin = bytes.rfind('\n', place) + 1, end = bytes.find('\n', place) + 1;
      damaged.erase(begin, end - begin);
      damaged.insert(damaged.find('\n', std::min(to, damaged.size())) + 1, bytes.substr(begin, end - begin));
    }
  }
  return damaged;
}

// Damage of a part of several machines is refused. Damage of a checkpoint is named on standard error and what
// is lost is made again, unless its first line is damaged.
TEST_F(DamagedParts, NoneChangesATableInSilence) {
  std::mt19937 rng(1);
  for (const DividedTables& work : AllWorks()) {
    const std::string sound = work.tables();
    int num_refused = 0, num_named = 0, num_same = 0;
    for (int i = 0; i < NumDamages(); ++i) {
      const std::string& path = work.parts[rng() % work.parts.size()];
      const std::string bytes = ReadBytes(path);
      std::string what;
      folder_.Write(std::filesystem::path(path).filename(), Damaged(bytes, &rng, &what));
      testing::internal::CaptureStderr();
      try {
        EXPECT_EQ(work.tables() == sound, true) << work.work << ": " << what << ": changed in silence";
        const bool is_named = testing::internal::GetCapturedStderr().find(path) != std::string::npos;
        ++(is_named ? num_named : num_same);
      } catch (const InputError& error) {
        testing::internal::GetCapturedStderr();
        EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << what << ": " << error.what();
        ++num_refused;
      }
      folder_.Write(std::filesystem::path(path).filename(), bytes);
    }
    fmt::print("{}: {} damages: {} refused, {} named and mended, {} without effect\n", work.work,
               NumDamages(), num_refused, num_named, num_same);
    EXPECT_GT(num_refused + num_named, NumDamages() * 9 / 10) << work.work;
    if (work.parts.size() > 1) {
      EXPECT_EQ(num_named, 0) << work.work;
    }
  }
}

// One number of one piece replaced, with right checksums, by whoever can compute them.
TEST_F(DamagedParts, ImpossibleCountsAreRefusedAndNothingElseHappens) {
  std::mt19937 rng(2);
  for (const DividedTables& work : AllWorks()) {
    int num_refused = 0;
    for (int i = 0; i < NumDamages(); ++i) {
      const std::string& path = work.parts[rng() % work.parts.size()];
      const std::string bytes = ReadBytes(path);
      nlohmann::ordered_json part = PartAsJson(path);
      nlohmann::ordered_json* value = &part["pieces"][rng() % part["pieces"].size()]["result"];
      while (value->is_array() && !value->empty()) value = &(*value)[rng() % value->size()];
      if (value->is_number_integer())
        *value = value->get<std::int64_t>() + (rng() % 2 == 0 ? 1'000'000 : -1'000'000);
      else
        *value = nlohmann::ordered_json::array({"x", 1e300});
      WriteJsonAsPart(path, part);
      try {
        work.tables();
        ADD_FAILURE() << work.work << ": an impossible number was counted";
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
        ++num_refused;
      }
      folder_.Write(std::filesystem::path(path).filename(), bytes);
    }
    fmt::print("{}: {} impossible numbers with right checksums: {} refused\n", work.work, NumDamages(),
               num_refused);
  }
}

}  // namespace
}  // namespace rcme
