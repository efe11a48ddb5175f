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
  module.def("summary_csv", &SummaryCsv);
  module.def("trials_csv", &TrialsCsv);
  module.def("comparison_csv", &ComparisonCsv);
  module.def("reliability_json", &ReliabilityJson);
}

}  // namespace rcme
