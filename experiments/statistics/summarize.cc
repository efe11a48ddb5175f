#include "experiments/statistics/summarize.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "experiments/core/text/pick_name.h"
#include "experiments/statistics/error_ranking.h"
#include "experiments/statistics/population_summary.h"
#include "experiments/statistics/scene_split.h"
#include "experiments/statistics/scenes_of_run.h"
#include "experiments/statistics/summary_cell.h"
#include "experiments/statistics/summary_quantities.h"
#include "experiments/study/population.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

template <typename Record>
void AppendHelp(const std::vector<Quantity<Record>>& quantities, std::vector<QuantityHelp>* rows) {
  for (const Quantity<Record>& q : quantities) {
    rows->push_back({q.name, KindName(q.kind), q.doc, q.base});
  }
}

// Collects cells of counts.
std::vector<SummaryCell> CollectDraws(const ReadableRun& run) {
  const TrialGroups groups = GroupByDraw(run.description);
  SummaryCell empty(run.description.estimators.size());
  empty.RankErrors();
  std::vector<SummaryCell> draws(groups.levels.size(), empty);
  run.for_each_trial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    draws[groups.group_of(problem)].Add(problem, records, run.description.failure);
  });
  return draws;
}

// Notes which conditions have a trial, and one that was simulated.
class ConditionWatch {
 public:
  explicit ConditionWatch(size_t num_conditions)
      : has_trial_(num_conditions), is_simulated_(num_conditions) {}

  // Returns a run that also notes what its readers visit. The watch and the run must outlive it.
  ReadableRun Watch(const ReadableRun& run) {
    return {run.description, [this, &run](const VisitTrial& visit) {
              run.for_each_trial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
                has_trial_[problem.condition] = true;
                if (WasSimulated(records.front())) is_simulated_[problem.condition] = true;
                visit(problem, records);
              });
            }};
  }

  void Report(Summary* summary) const {
    for (size_t c = 0; c < has_trial_.size(); ++c) {
      summary->num_conditions_with_trials += has_trial_[c];
      summary->num_conditions_not_simulated += has_trial_[c] && !is_simulated_[c];
    }
  }

 private:
  std::vector<bool> has_trial_, is_simulated_;
};

bool IsWeighted(const SummaryCell& cell) { return cell.of_problems().is_weighted; }

Summary SummarizePooled(const ReadableRun& run, bool with_times) {
  if (HasPopulationIntervals(run.description)) {
    const std::vector<SummaryCell> draws = CollectDraws(run);
    if (std::ranges::none_of(draws, IsWeighted))
      return SummarizePopulation(run.description, draws, with_times);
  }
  Summary summary = Summarize(run, with_times, OneGroup());
  summary.is_of_these_draws = IsSampleOfPopulation(run.description.identity);
  return summary;
}

// Appends the rows of a part of the run, which becomes a condition with these levels.
void AppendPart(Summary part, const std::vector<std::string>& factors, std::vector<std::string> levels,
                Summary* all) {
  for (SummaryRow& row : part.rows) row.condition = static_cast<std::uint32_t>(all->levels.size());
  if (all->levels.empty()) {
    *all = std::move(part);
    all->factor_names = factors;
    all->levels = {std::move(levels)};
    return;
  }
  all->num_trials_done += part.num_trials_done;
  all->rows.insert(all->rows.end(), part.rows.begin(), part.rows.end());
  all->levels.push_back(std::move(levels));
}

}  // namespace

const std::vector<QuantityHelp>& SummaryQuantities() {
  static const std::vector<QuantityHelp> help = [] {
    std::vector<QuantityHelp> rows;
    AppendHelp(TrialQuantities(), &rows);
    for (const QuantityHelp& area : ErrorRankingQuantities()) rows.push_back(area);
    for (const QuantityHelp& split : SceneSplitQuantities()) rows.push_back(split);
    AppendHelp(ProblemQuantities(), &rows);
    return rows;
  }();
  return help;
}

bool HasFailureProbabilities(const Summary& summary) {
  return std::ranges::any_of(
      summary.rows, [](const SummaryRow& row) { return row.quantity == "failure_probability" && row.n > 0; });
}

std::string KindName(SummaryRow::Kind kind) {
  return PickName(kind, {"rate", "mean", "median", "score", "share", "area"});
}

Summary Summarize(const ReadableRun& run, bool with_times, Pooling pooling) {
  const RunDescription& description = run.description;
  if (pooling == Pooling::kPerCondition) return Summarize(run, with_times, GroupByCondition(description));
  CheckMayBePooled(description);
  ConditionWatch watch(description.conditions.size());
  Summary summary = SummarizePooled(watch.Watch(run), with_times);
  watch.Report(&summary);
  return summary;
}

Summary Summarize(const ResultStore& store, bool with_times, Pooling pooling) {
  return Summarize(ReadRun(store), with_times, pooling);
}

Summary SummarizeBy(const ReadableRun& run, bool with_times, const std::string& factor) {
  const std::vector<std::string>& factors = run.description.factors;
  const auto found = std::ranges::find(factors, factor);
  if (found == factors.end())
    throw InputError(fmt::format("--by: {} is not a factor of the run; it has: {}", Quoted(factor),
                                 factors.empty() ? "none" : fmt::format("{}", fmt::join(factors, ", "))));
  std::vector<std::string> levels;
  for (const DescribedCondition& condition : run.description.conditions) {
    const std::string& level = condition.levels.at(static_cast<size_t>(found - factors.begin()));
    if (std::ranges::count(levels, level) == 0) levels.push_back(level);
  }
  Summary all;
  for (const std::string& level : levels)
    AppendPart(Summarize(SelectLevel(run, factor, level), with_times, Pooling::kPooled), {factor}, {level},
               &all);
  return all;
}

Summary SummarizeFifths(const ReadableRun& run, bool with_times, const TrialGroups& fifths) {
  CheckMayBePooled(run.description);
  if (!IsSampleOfPopulation(run.description.identity)) return Summarize(run, with_times, fifths);
  Summary all;
  for (size_t i = 0; i < fifths.levels.size(); ++i) {
    const ReadableRun fifth =
        SelectTrials(run, [&](const ProblemRecord& problem) { return fifths.group_of(problem) == i; });
    AppendPart(SummarizePooled(fifth, with_times), fifths.factor_names, fifths.levels[i], &all);
  }
  return all;
}

std::vector<std::string> FindAlwaysRefusing(const Summary& summary) {
  std::vector<std::string> found;
  for (const auto& [label, effort] : summary.efforts) {
    // Both kinds of refusal are rates over all trials and exclude each other.
    std::map<std::uint32_t, double> refused;
    for (const SummaryRow& row : summary.rows) {
      const bool is_refusal = row.quantity == "no_candidate" || row.quantity == "other_refusal";
      if (row.estimator == label && is_refusal && row.n > 0) refused[row.condition] += row.value;
    }
    const auto is_all = [](const auto& of_condition) { return of_condition.second > 1.0 - 1e-9; };
    if (!refused.empty() && std::ranges::all_of(refused, is_all)) found.push_back(label);
  }
  return found;
}

Summary Summarize(const ReadableRun& run, bool with_times, const TrialGroups& groups) {
  const RunDescription& description = run.description;
  const SummaryCell empty(description.estimators.size(), description.repeats_per_scene);
  GroupSummarizer summary(description, groups);
  std::map<size_t, SummaryCell> cells;  // of groups that have trials and may get more
  size_t num_finished = 0;
  const auto finish_before = [&](size_t group) {
    for (; num_finished < group; ++num_finished) {
      const auto cell = cells.extract(num_finished);
      summary.Append(cell ? cell.mapped() : empty);
    }
  };
  SummaryCell* of_scene = nullptr;
  ForEachTrialByScene(
      run,
      [&](const ProblemRecord& problem, const std::vector<TrialRecord>& records, bool is_first) {
        const size_t group = groups.group_of(problem);
        if (groups.is_in_order) finish_before(group);
        of_scene = &cells.try_emplace(group, empty).first->second;
        of_scene->Add(problem, records, description.failure, is_first);
      },
      [&](std::uint32_t) { of_scene->EndScene(); });
  finish_before(groups.levels.size());
  return summary.Finish(with_times);
}

}  // namespace rcme
