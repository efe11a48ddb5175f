#include "experiments/statistics/summarize_counts.h"

#include "experiments/run/store/parts.h"
#include "experiments/statistics/summary_quantities.h"
#include "experiments/statistics/truth_quality.h"

namespace rcme {
namespace {

void AppendCell(const RunDescription& run, std::uint32_t condition, const SummaryCell& cell,
                Summary* summary) {
  SummaryRow row;
  row.condition = condition;
  if (!summary->factor_names.empty()) row.levels = run.conditions[condition].levels;
  cell.AppendRows(run, row, &summary->rows);
}

}  // namespace

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

Summary SummarizeCounts(const RunCounts& counts, bool with_times, Pooling pooling) {
  const RunDescription& run = counts.run;
  Summary summary{run.study,
                  {},
                  {},
                  {},
                  counts.NumTrials(),
                  run.NumTrials(),
                  run.repeats_per_scene,
                  DescribeTruthQuality(run.identity)};
  for (const DescribedEstimator& estimator : run.estimators)
    summary.efforts.emplace_back(estimator.label, estimator.effort);
  if (pooling == Pooling::kPooled) {
    SummaryCell all(run.estimators.size());
    for (const ConditionCounts& condition : counts.conditions) all.Merge(condition.cell);
    AppendCell(run, 0, all, &summary);
  } else {
    summary.factor_names = run.factors;
    for (std::uint32_t c = 0; c < counts.conditions.size(); ++c)
      AppendCell(run, c, counts.conditions[c].cell, &summary);
  }
  LeaveOutRows(with_times, &summary);
  return summary;
}

}  // namespace rcme
