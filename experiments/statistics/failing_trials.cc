#include "experiments/statistics/failing_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/trial/trial_event.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

const TrialEvent& FindListedEvent(const std::string& name) {
  const auto event = std::ranges::find(TrialEvents(), name, &TrialEvent::name);
  if (event != TrialEvents().end()) return *event;
  throw InputError(fmt::format("--of: {} is not allowed{}; give one of: {}", Quoted(name),
                               DidYouMean(name, TrialEventNames()), fmt::join(TrialEventNames(), ", ")));
}

// For each estimator of the run, whether the query includes it.
std::vector<bool> MarkEstimators(const RunDescription& run, const std::vector<std::string>& labels) {
  std::vector<bool> is_chosen(run.estimators.size(), labels.empty());
  for (const std::string& label : labels)
    is_chosen[FindEstimator(run.estimators, label, "--estimators: the run")] = true;
  return is_chosen;
}

Table MakeFailingTable(const FailingTrials& trials, bool with_probability = true) {
  using R = const FailingTrial&;
  std::vector<ColumnOf<FailingTrial>> columns = {
      {{.name = "condition", .type = ColumnType::kCount, .is_key = true},
       [](R r) { return std::int64_t{r.condition}; }},
      {{.name = "trial", .type = ColumnType::kCount, .is_key = true},
       [](R r) { return std::int64_t{r.trial}; }},
      {Column::Key("estimator"), [](R r) { return r.estimator; }},
      {Column::Text("outcome"), [](R r) { return r.outcome; }},
      {{.name = "rotation_error_deg", .type = ColumnType::kNumber, .heading = "rotation (deg)"},
       [](R r) { return r.rotation_error_deg; }},
      {{.name = "direction_error_deg", .type = ColumnType::kNumber, .heading = "direction (deg)"},
       [](R r) { return r.direction_error_deg; }}};
  if (with_probability) {
    columns.push_back({{.name = "failure_probability", .type = ColumnType::kNumber, .heading = "stated P"},
                       [](R r) { return r.failure_probability; }});
  }
  for (ColumnOf<FailingTrial>& level : LevelColumns<FailingTrial>(trials.factors)) {
    level.column.is_key = false;
    columns.push_back(level);
  }
  return MakeTable(columns, trials.listed);
}

std::string FailingTrialsAsTable(const FailingTrials& trials, const std::string& run) {
  std::string text =
      fmt::format("Study {}: {} of {} answers\n", trials.study, trials.num_found, trials.num_looked_at);
  if (trials.listed.empty()) return text;
  const bool is_stated = std::ranges::any_of(
      trials.listed, [](const FailingTrial& trial) { return !std::isnan(trial.failure_probability); });
  text += "\n" + RenderText(MakeFailingTable(trials, is_stated)) + "\n";
  const auto num_listed = static_cast<std::int64_t>(trials.listed.size());
  if (num_listed < trials.num_found) text += fmt::format("The first {}; --limit 0 lists all.\n", num_listed);
  const FailingTrial& first = trials.listed.front();
  return text + fmt::format(
                    "Look at one: rcme show {0} --condition {1} --trial {2}\n"
                    "In full:     rcme replay {0} --condition {1} --trial {2}\n",
                    run, first.condition, first.trial);
}

}  // namespace

FailingTrials ListFailingTrials(const ResultStore& store, const FailureQuery& query) {
  const RunDescription run = store.Description();
  const TrialEvent& event = FindListedEvent(query.event);
  const std::vector<bool> is_chosen = MarkEstimators(run, query.estimators);
  if (query.condition && *query.condition >= run.conditions.size()) {
    throw InputError(fmt::format("--condition: {} is not allowed; the study has conditions 0 to {}",
                                 *query.condition, run.conditions.size() - 1));
  }
  FailingTrials trials{run.study, run.factors, {}, 0, 0};
  store.ForEachTrial(
      [&](const ProblemRecord&, const std::vector<TrialRecord>& records) {
        for (const TrialRecord& r : records) {
          if (!is_chosen[r.estimator] || !event.IsKnownFor(r)) continue;
          ++trials.num_looked_at;
          if (!event.has_happened(r, run.failure)) continue;
          if (++trials.num_found > query.limit && query.limit > 0) continue;
          trials.listed.push_back({r.condition, run.conditions[r.condition].levels, r.trial,
                                   run.estimators[r.estimator].label, OutcomeInFull(r, run.failure),
                                   r.rotation_error_deg, r.direction_error_deg, r.failure_probability});
        }
      },
      query.condition);
  return trials;
}

CommandResult MakeFailuresResult(const FailingTrials& trials, const std::string& run) {
  return MakeResult(
      FailingTrialsAsTable(trials, run), kFailuresFormat,
      {{"study", trials.study}, {"found", trials.num_found}, {"looked_at", trials.num_looked_at}},
      MakeFailingTable(trials));
}

}  // namespace rcme
