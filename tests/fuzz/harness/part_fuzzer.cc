#include "experiments/audit/claims/outcomes_json.h"
#include "experiments/audit/validity/map_work.h"
#include "experiments/core/work/runner.h"
#include "experiments/tuning/tuning_work.h"
#include "tests/fuzz/harness/file_in_memory.h"
#include "tests/fuzz/harness/only_input_error.h"
#include "tests/test_support/tuned_study.h"

namespace rcme {
namespace {

// A work all of whose pieces gave the same.
WorkResults GiveEachPiece(const WorkPlan& plan, const std::string& json) {
  WorkResults merged;
  for (size_t group = 0; group < plan.groups.size(); ++group) {
    for (size_t piece = 0; piece < plan.groups[group].num_items; ++piece) {
      merged.results[{group, piece}] = {json, 0.0};
      merged.paths[{group, piece}] = "part";
    }
  }
  return merged;
}

void CountTuning(const std::string& json) {
  static const StudyPlan plan = TunedPlan(
      "  target: failure\n  at_most: 0.3\n  explore: 3\n  calibrate: 5\n  verify: 3\n  options: {mu: [1, "
      "2]}\n");
  static const SettingPlan settings = MakeTunedSettings(plan);
  static const TuningWork work = PlanTuningWork(plan);
  const WorkResults merged = GiveEachPiece(work.items, json);
  OnlyInputError([&] { CountsIn(plan, settings, work, merged).count({0, 3}); });
  OnlyInputError([&] { CountsIn(plan, settings, work, merged).verify(0); });
  OnlyInputError([&] { EntropiesIn(plan, work, merged); });
}

void CountMap(const std::string& json) {
  static const MapWork work = [] {
    MapWork small;
    small.map.sigmas_px = {0.1};
    small.map.nums_points = {8};
    small.map.trials = 3;
    small.reference = ValidityReferenceOptions{.num_samples = 2};
    return small;
  }();
  static const WorkPlan plan = PlanMapWork(work);
  const WorkResults merged = GiveEachPiece(plan, json);
  OnlyInputError([&] { TrialsIn(work, plan, merged)(0); });
  OnlyInputError([&] { CountsIn(work, plan, merged)(0); });
}

void CountAudit(const std::string& json) {
  static const Check check = [] {
    Check two;
    two.targets = {ClaimedRate("rate", 0.3, {0.25, 0.35}, 0), ClaimedMean("mean", 0.5, {0.49, 0.55}, 1)};
    return two;
  }();
  static const WorkPlan plan{"audit", "block", "", {{"check", 1}}};
  OnlyInputError([&] {
    ReadResults(plan, GiveEachPiece(plan, json), 0, 1,
                [&](const ItemPlace&, const std::string& text) { OutcomesFrom(check, text, 3); });
  });
}

}  // namespace
}  // namespace rcme

// A part as it is; and what a piece of each kind of work gave, behind every checksum.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace rcme;
  static const FileInMemory file;
  file.Write(data, size);
  OnlyInputError([&] { ReadPart(file.path()); });
  const std::string json = AsText(data, size);
  CountTuning(json);
  CountMap(json);
  CountAudit(json);
  return 0;
}
