#include <fmt/format.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "experiments/core/table/render_table.h"
#include "experiments/run/run_study.h"
#include "experiments/statistics/comparison_output.h"
#include "experiments/statistics/forecast_output.h"
#include "experiments/statistics/summarize_counts.h"
#include "experiments/statistics/summary_output.h"
#include "experiments/statistics/trial_table.h"
#include "experiments/study/command_permission.h"
#include "experiments/trial/trial_columns.h"
#include "experiments/trial/trial_outcome.h"
#include "parameters/input_error.h"
#include "python/bindings.h"
#include "python/stoppable.h"
#include "python/study_source.h"

namespace rcme {
namespace {

namespace py = pybind11;
using namespace py::literals;

py::dict Run(const StudySource& source, const Functions& functions, int threads, const std::string& out) {
  const FunctionsOfRun of_run(MakeFunctions(functions));
  const StudyPlan plan = MakeSourcePlan(AddFunctions(source, functions), PlanEstimators::kMade);
  const RunReport report = RunStoppable([&] {
    ResultStore store = ResultStore::OpenForRun(out, plan);
    return RunStudy(plan, threads, &store);
  });
  return py::dict("num_trials"_a = report.num_trials, "num_run_now"_a = report.num_run_now,
                  "seconds"_a = report.seconds);
}

// A dict of each estimator: its columns, and `same`, whether the record in the file is equal; None: not
// there.
py::list Replay(const std::string& run, std::uint32_t condition, std::uint32_t trial,
                const Functions& functions, bool allow_process) {
  const FunctionsOfRun of_run(MakeFunctions(functions));
  const ResultStore store = ResultStore::OpenForReading(run);
  Study study = store.StoredStudy();
  if (allow_process) AllowCommands(&study.estimators);
  const StudyPlan plan = store.Plan(study);
  if (condition >= plan.conditions.size())
    throw InputError(fmt::format("condition: {} is not allowed; expected a number from 0 to {}", condition,
                                 plan.conditions.size() - 1));
  const std::vector<TrialRecord> stored = store.ReadTrialRecords(condition, trial);
  const TrialResult result = RunStoppable([&] { return RunTrial(plan, plan.conditions[condition], trial); });
  py::list rows;
  for (size_t e = 0; e < result.records.size(); ++e) {
    const TrialRecord& record = result.records[e];
    py::dict row("estimator"_a = plan.study.estimators[e].label,
                 "outcome"_a = Name(ClassifyOutcome(record, plan.study.failure)),
                 "message"_a = result.estimates[e].message);
    VisitColumns(record, [&](const StoredColumn& column, const auto& field) {
      if (column.role == StoredColumn::Role::kKey) return;
      if constexpr (std::is_same_v<std::decay_t<decltype(field)>, MotionStatus>) {
        row[column.name] = StatusName(field);
      } else {
        row[column.name] = field;
      }
    });
    row["R"] = MakeArray(result.estimates[e].cam2_from_cam1.R);
    row["t"] = MakeArray(result.estimates[e].cam2_from_cam1.t);
    row["same"] = e < stored.size() ? py::cast(AreEqualButForTime(stored[e], record)) : py::none();
    rows.append(row);
  }
  return rows;
}

std::string SummaryCsv(const std::string& run, bool with_times, bool is_pooled) {
  const Pooling pooling = is_pooled ? Pooling::kPooled : Pooling::kPerCondition;
  const py::gil_scoped_release unlocked;
  return SummaryAsCsv(KeepsCounts(run) ? SummarizeCounts(OpenCounts(run), with_times, pooling)
                                       : Summarize(ResultStore::OpenForReading(run), with_times, pooling));
}

std::string TrialsCsv(const std::string& run, bool with_times) {
  const py::gil_scoped_release unlocked;
  if (KeepsCounts(run)) throw InputError(run + ": it keeps counts, no trials (rcme run --keep all)");
  std::string csv;
  WriteTrialTable(ResultStore::OpenForReading(run), with_times,
                  [&](const std::string& rows) { csv += rows; });
  return csv;
}

std::string ComparisonCsv(const std::string& run, const std::string& against,
                          const std::vector<std::string>& of, bool is_anytime_valid, bool is_pooled) {
  const py::gil_scoped_release unlocked;
  const CompareOptions options{of, is_pooled ? Pooling::kPooled : Pooling::kPerCondition, is_anytime_valid};
  const Comparison comparison = Compare(ResultStore::OpenForReading(run), against, options);
  if (comparison.rows.empty()) {
    throw InputError(comparison.caution.empty() ? run + ": one estimator; a comparison needs two"
                                                : run + ": " + comparison.caution);
  }
  return RenderCsv(MakeComparisonResult(comparison).rows);
}

std::string ReliabilityJson(const std::string& run, const std::string& by) {
  const py::gil_scoped_release unlocked;
  std::vector<ResultStore> runs;
  runs.push_back(ResultStore::OpenForReading(run));
  return MakeForecastResult(runs.front().Description().study, by, MeasureFailureForecasts(runs, by)).json;
}

}  // namespace

void BindRuns(py::module_& module) {
  module.def("run", &Run);
  module.def("replay", &Replay);
  module.def("summary_csv", &SummaryCsv);
  module.def("trials_csv", &TrialsCsv);
  module.def("comparison_csv", &ComparisonCsv);
  module.def("reliability_json", &ReliabilityJson);
}

}  // namespace rcme
