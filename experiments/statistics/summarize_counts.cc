#include "experiments/statistics/summarize_counts.h"

#include "experiments/run/store/parts.h"
#include "experiments/statistics/population_summary.h"
#include "experiments/statistics/scenes_of_run.h"
#include "experiments/study/population.h"

namespace rcme {

RunCounts OpenCounts(const std::string& path) {
  const std::unique_ptr<ResultFile> file = OpenPart(path);
  return NamingFile(path, [&] { return ReadCounts(*file); });
}

bool KeepsCounts(const std::string& path) {
  try {
    return OpenPart(path)->description.keeps_counts;
  } catch (const InputError&) {
    return false;
  }
}

namespace {

Summary SummarizePooledCounts(const RunCounts& counts, bool with_times) {
  const RunDescription& run = counts.run;
  if (HasPopulationIntervals(run)) {
    const TrialGroups groups = GroupByDraw(run);
    std::vector<SummaryCell> draws(groups.levels.size(), SummaryCell(run.estimators.size()));
    ProblemRecord any_of;
    for (const ConditionCounts& condition : counts.conditions) {
      draws[groups.group_of(any_of)].Merge(condition.cell);
      ++any_of.condition;
    }
    return SummarizePopulation(run, draws, with_times);
  }
  SummaryCell all(run.estimators.size());
  for (const ConditionCounts& condition : counts.conditions) all.Merge(condition.cell);
  Summary summary = SummarizeCells(run, OneGroup(), {&all}, with_times);
  summary.is_of_these_draws = IsSampleOfPopulation(run.identity);
  return summary;
}

}  // namespace

Summary SummarizeCounts(const RunCounts& counts, bool with_times, Pooling pooling) {
  const RunDescription& run = counts.run;
  if (pooling == Pooling::kPooled) {
    CheckMayBePooled(run);
    Summary summary = SummarizePooledCounts(counts, with_times);
    for (const ConditionCounts& condition : counts.conditions) {
      summary.num_conditions_with_trials += condition.cell.num_trials() > 0;
      summary.num_conditions_not_simulated += condition.cell.IsNotSimulated();
    }
    return summary;
  }
  std::vector<const SummaryCell*> cells;
  for (const ConditionCounts& condition : counts.conditions) cells.push_back(&condition.cell);
  return SummarizeCells(run, GroupByCondition(run), cells, with_times);
}

}  // namespace rcme
