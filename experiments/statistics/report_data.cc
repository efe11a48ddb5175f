#include "experiments/statistics/report_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "experiments/core/files/file_output.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/statistics/comparison_output.h"
#include "experiments/statistics/forecast_output.h"
#include "experiments/statistics/marginals_output.h"
#include "experiments/statistics/population_summary.h"
#include "experiments/statistics/preregistration_output.h"
#include "experiments/statistics/report_findings.h"
#include "experiments/statistics/summary_output.h"
#include "experiments/trial/trial_event.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

// The first trials worth a replay, of one estimator in one condition.
struct FirstTrials {
  std::optional<std::uint32_t> failure, refusal;
};

struct ConditionProgress {
  std::int64_t num_trials_done = 0;
  std::int64_t trials_end = 0;     // after the last trial; an interrupted run may have gaps
  std::vector<FirstTrials> first;  // one per estimator
};

// Collects this in one pass.
std::vector<ConditionProgress> CountProgress(const ResultStore& store, const RunDescription& run) {
  std::vector<ConditionProgress> progress(run.conditions.size(),
                                          {0, 0, std::vector<FirstTrials>(run.estimators.size())});
  store.ForEachRecord([&](const TrialRecord& record) {
    ConditionProgress& condition = progress.at(record.condition);
    if (record.estimator == 0) ++condition.num_trials_done;
    condition.trials_end = record.trial + 1;
    FirstTrials& first = condition.first.at(record.estimator);
    if (HasFailed(record, run.failure) && !first.failure) first.failure = record.trial;
    if (HasRefused(record) && !first.refusal) first.refusal = record.trial;
  });
  return progress;
}

Json TrialOrNull(const std::optional<std::uint32_t>& trial) { return trial ? Json(*trial) : Json(); }

// Returns the conditions with their levels, their progress, and each estimator's first failure and refusal.
Json RenderConditionProgress(const ResultStore& store, const RunDescription& run) {
  Json conditions = Json::array();
  const std::vector<ConditionProgress> progress = CountProgress(store, run);
  for (size_t c = 0; c < run.conditions.size(); ++c) {
    const ConditionProgress& done = progress[c];
    Json first = Json::array();
    for (const FirstTrials& trials : done.first) {
      first.push_back({{"failure", TrialOrNull(trials.failure)}, {"refusal", TrialOrNull(trials.refusal)}});
    }
    conditions.push_back({{"index", c},
                          {"levels", run.conditions[c].levels},
                          {"trials_done", done.num_trials_done},
                          {"trials_end", done.trials_end},
                          {"trials_planned", run.conditions[c].num_trials},
                          {"first", first}});
  }
  return conditions;
}

// Returns a list of [key, text].
Json AsPairs(const Settings& settings) {
  Json pairs = Json::array();
  for (const auto& [key, text] : settings) pairs.push_back({key, text});
  return pairs;
}

Json RunAsJson(const std::string& path, const ResultStore& store) {
  const RunDescription run = store.Description();
  Json estimators = Json::array(), quantities = Json::array(), events = Json::array(), bounds = Json::array();
  for (const DescribedEstimator& estimator : run.estimators) estimators.push_back(estimator.label);
  for (const QuantityHelp& q : SummaryQuantities()) {
    quantities.push_back({{"name", q.name}, {"kind", q.kind}, {"doc", q.doc + ", of " + q.base}});
  }
  for (const TrialEvent& event : TrialEvents()) {
    events.push_back({{"name", event.name}, {"doc", event.doc}});
  }
  FailureBounds failure = run.failure;
  for (const Parameter& p : Parameters(failure)) {
    bounds.push_back({{"name", p.name()}, {"value", p.Value()}, {"unit", p.unit()}});
  }
  return {{"run", path},
          {"rcme_version", RCME_VERSION},
          {"name", run.study},
          {"description", run.description},
          {"ademp", AsPairs(run.ademp)},
          {"seed", run.seed},
          {"trials_planned", run.NumTrials()},
          {"until", run.until_options},
          {"study_yaml", run.study_yaml},
          {"factors", run.factors},
          {"estimators", estimators},
          {"conditions", RenderConditionProgress(store, run)},
          {"failure_bounds", bounds},
          {"quantities", quantities},
          {"events", events}};
}

// Returns whether the run has regimes of a population.
bool HasMarginals(const RunDescription& run) {
  return HasPopulationIntervals(run) && GroupByDraw(run).levels.size() >= kLeastConditions;
}

void WriteFiles(const std::string& run, const std::string& against, const std::string& folder) {
  const ResultStore store = ResultStore::OpenForReading(run);
  const bool is_of_population = HasPopulationIntervals(store.Description());
  const Pooling pooling = is_of_population ? Pooling::kPooled : Pooling::kPerCondition;
  const Summary summary = Summarize(store, /*with_times=*/false, pooling);
  if (summary.num_trials_done == 0) {
    throw InputError(fmt::format("{}: holds no trial yet; `rcme run` with --out {} adds them", run, run));
  }
  CompareOptions options;
  options.pooling = pooling;
  const Comparison comparison = Compare(store, against, options);
  Json json = RunAsJson(run, store);
  json["trials_done"] = summary.num_trials_done;
  json["reference"] = comparison.reference;
  json["caution"] = comparison.caution;
  json["is_of_population"] = is_of_population;
  const bool is_weighted = std::ranges::any_of(
      summary.rows, [](const SummaryRow& row) { return row.interval_kind == IntervalKind::kWeighted; });
  const std::vector<ForecastMeasures> forecasts = HasFailureProbabilities(summary) && !is_weighted
                                                      ? MeasureFailureForecasts(store)
                                                      : std::vector<ForecastMeasures>();
  json["findings"] = ListFindings(summary, comparison, forecasts);
  if (const auto preregistration = DecidePreregistered(store, run))
    json["preregistration"] = PreregistrationAsJson(*preregistration);
  WriteFileWhole(folder + "/run.json", JsonText(kReportFormat, json));
  FileInPieces table(folder + "/summary.csv");
  WriteSummaryCsv(summary, [&](const std::string& text) { table.Write(text); });
  table.Finish();
  if (!forecasts.empty())
    WriteFileWhole(folder + "/reliability.json", MakeForecastResult(summary.study, "", forecasts).json);
  if (comparison.caution.empty() && HasMarginals(store.Description())) {
    WriteFileWhole(
        folder + "/marginals.csv",
        RenderCsv(MakeMarginalsTable(MeasureMarginals(store, {.with_pairs = false, .estimators = {}}))));
  }
  if (!comparison.rows.empty())
    WriteFileWhole(folder + "/comparison.csv", RenderCsv(MakeComparisonResult(comparison).rows));
}

}  // namespace

void WriteReportData(const std::string& run, const std::string& against, const std::string& folder) {
  try {
    WriteFiles(run, against, folder);
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (message.find(run) != std::string::npos) throw;
    throw InputError(fmt::format("{}: {}", run, message));  // names one of several runs
  }
}

}  // namespace rcme
