// The works of commands, computed in memory: results without the files that commands keep them in.
#pragma once

#include "experiments/audit/claims/audit_work.h"
#include "experiments/audit/model_choice/choice_counts.h"
#include "experiments/audit/validity/map_work.h"
#include "experiments/core/table/render_table.h"
#include "experiments/rare/split_failures.h"
#include "experiments/rare/stratified_failures.h"
#include "experiments/tuning/transfer.h"
#include "experiments/tuning/tuning_work.h"

namespace rcme {

inline TuneResult TuneInMemory(const StudyPlan& plan, const SettingPlan& settings, Unreached unreached,
                               int num_threads) {
  const TuningWork work = PlanTuningWork(plan);
  Runner runner = Runner::InMemory(work.items, num_threads);
  GetTuningResults(plan, settings, work, unreached, &runner);
  return Tune(plan, settings, unreached, CountsIn(plan, settings, work, runner.results()));
}

inline TransferResult MeasureTransferInMemory(const StudyPlan& plan, const SettingPlan& settings,
                                              const std::string& by, int num_threads) {
  ListFamilies(plan, by);
  const TuningWork work = PlanTransferWork(plan);
  Runner runner = Runner::InMemory(work.items, num_threads);
  GetTuningResults(plan, settings, work, Unreached::kVerifyAll, &runner);
  return MeasureTransfer(plan, settings, by, CountsIn(plan, settings, work, runner.results()));
}

inline std::string MapCsvInMemory(const ValidityMapOptions& options, int num_threads = 2) {
  const MapWork work{options, std::nullopt, ""};
  Runner runner = Runner::InMemory(PlanMapWork(work), num_threads);
  GetMapResults(work, &runner);
  return RenderCsv(MakeValidityMapTable(options, TrialsIn(work, runner.plan(), runner.results())));
}

inline std::string ReferenceCsvInMemory(const ValidityReferenceOptions& options, int num_threads = 2) {
  MapWork work{{}, options, ""};
  work.map.conditions.clear();  // no map
  Runner runner = Runner::InMemory(PlanMapWork(work), num_threads);
  GetMapResults(work, &runner);
  return RenderCsv(MakeValidityReferenceTable(options, CountsIn(work, runner.plan(), runner.results())));
}

inline Audit RunAuditInMemory(const std::vector<Claim>& all, const AuditOptions& options) {
  Runner runner = Runner::InMemory(PlanAuditChecks(PlanAudit(all, options)), 1);
  return RunAudit(all, options, &runner);
}

inline ChoiceCounts CountChoicesInMemory(const StudyPlan& plan, const std::vector<std::string>& by,
                                         int num_threads) {
  Runner runner = Runner::InMemory(PlanChoices(plan), num_threads);
  return CountChoices(plan, by, &runner);
}

inline std::vector<RareCell> SplitInMemory(const StudyPlan& plan, std::uint64_t seed,
                                           const RareEffort& effort, int num_threads) {
  Runner runner = Runner::InMemory(PlanSplitting(plan, seed, effort), num_threads);
  return SplitFailures(plan, seed, effort, &runner);
}

inline std::vector<StratifiedCell> StratifyInMemory(const StudyPlan& plan, const StratifiedEffort& effort,
                                                    int num_threads) {
  Runner runner = Runner::InMemory(PlanStrata(plan, effort), num_threads);
  return StratifyFailures(plan, effort, &runner);
}

}  // namespace rcme
