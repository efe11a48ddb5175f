#include "experiments/rare/rare_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/trial/simulate_draw.h"
#include "stats/moments.h"

namespace rcme {
namespace {

constexpr const char* kBruteForceLegend =
    "of brute force: calls, of those after which plain trials would have the same standard error.";

std::string DescribeDoubt(SplittingDoubt doubt, const RareCell& cell) {
  const SplittingRate& rate = cell.rate;
  switch (doubt) {
    case SplittingDoubt::kNoLevels:
      return fmt::format(
          "no levels lead to failure: the error came to {:.3g} of its bound{}", cell.pilot.last_level,
          cell.pilot.end == PilotEnd::kTooRare ? fmt::format(" at a rate below {:g}", kLeastSplittingRate)
                                               : ", which nothing exceeds");
    case SplittingDoubt::kReplicateLost:
      return "a replicate lost all its particles: more particles may do";
    case SplittingDoubt::kReplicatesDisagree:
      return fmt::format(
          "replicates disagree (relative standard deviation {:.2g}): a few hold most of the rate, "
          "as where failures come at once and no level leads to them",
          rate.relative_spread);
    case SplittingDoubt::kDrawsDisagree:
      return "the first particles, which are plain trials, hold more or fewer failures than the interval "
             "allows";
    case SplittingDoubt::kMovesStuck:
      return fmt::format("at some level only {:.2g} of the moves were accepted", rate.least_acceptance);
  }
  return "";
}

std::string DescribeDoubts(const RareCell& cell) {
  if (!cell.why_not_simulated.empty())
    return fmt::format("{}: {}", StatusName(MotionStatus::kNotSimulated), cell.why_not_simulated);
  std::vector<std::string> words;
  for (const SplittingDoubt doubt : cell.rate.doubts) words.push_back(DescribeDoubt(doubt, cell));
  return fmt::format("{}", fmt::join(words, "; "));
}

std::vector<std::string> MakeRowHead(const StudyPlan& plan, size_t condition, size_t estimator) {
  std::vector<std::string> head = plan.conditions[condition].levels;
  head.push_back(plan.study.estimators[estimator].label);
  return head;
}

std::vector<Column> HeadColumns(const StudyPlan& plan) {
  std::vector<Column> columns;
  for (const std::string& factor : plan.factor_names) columns.push_back(Column::Key(factor));
  columns.push_back(Column::Key("estimator"));
  return columns;
}

// NaN for a number that is not finite.
double KnownShare(const RareRow& row) {
  const double share = row.BruteForceShare();
  return std::isfinite(share) ? share : std::nan("");
}

// "failures", or "misleading_rotation (protection levels at the risk 1e-05)".
std::string DescribeEvents(const RareEvent& event) {
  if (event.kind == RareEvent::Kind::kFailure) return "failures";
  return fmt::format("{} (protection levels at the risk {:g})", Name(event.kind), event.risk);
}

// How many trials of all conditions could not be simulated. The estimators of a condition share its trials.
template <typename Cell>
std::string DescribeMissingCellTrials(const std::vector<Cell>& cells, std::int64_t num_of_condition) {
  std::int64_t num_not_simulated = 0, num_trials = 0;
  for (const Cell& cell : cells) {
    if (cell.estimator != 0) continue;
    num_not_simulated += cell.num_not_simulated;
    num_trials += num_of_condition;
  }
  return FormatParagraph(DescribeNotSimulated(num_not_simulated, num_trials));
}

std::int64_t NumDrawn(const std::vector<StratifiedCell>& cells) {
  std::int64_t num_trials = cells.front().num_not_simulated;
  for (const StratumCount& count : cells.front().strata) num_trials += count.num_trials;
  return num_trials;
}

// The table of rates, with the columns that both methods have.
Table MakeRateTable(const StudyPlan& plan, const RareEvent& event, const std::vector<RareRow>& rows) {
  Table table{HeadColumns(plan)};
  table.AddColumns({Column::Estimated(Name(event.kind), {1.0, "", ".2e"}), Column::Count("calls"),
                    Column::Number("of brute force", {100.0, "%", ".2g"}),
                    Column::Number("unseen up to", {1.0, "", ".1e"}), Column::Flag("trusted")});
  for (const RareRow& row : rows) {
    const std::vector<std::string> head = MakeRowHead(plan, row.condition, row.estimator);
    std::vector<Value>& values = table.rows.emplace_back(head.begin(), head.end());
    values.insert(values.end(), {Estimate{row.estimate, row.interval}, row.num_calls, KnownShare(row),
                                 row.unseen_up_to, row.doubts.empty()});
  }
  return table;
}

// The columns that identify a rate in files.
Table MakeKeyTable(const StudyPlan& plan) {
  Table table{{Column::Count("condition")}};
  for (const std::string& factor : plan.factor_names)
    table.columns.push_back({.name = factor, .group = "levels", .is_key = true});
  table.columns.push_back(Column::Key("estimator"));
  return table;
}

std::vector<Value> MakeKeyValues(const StudyPlan& plan, size_t condition, size_t estimator) {
  std::vector<Value> values = {static_cast<std::int64_t>(condition)};
  std::ranges::copy(MakeRowHead(plan, condition, estimator), std::back_inserter(values));
  return values;
}

// One row per level of the error: the rate of errors beyond it, and the share of moves accepted there, both
// as means of the replicates.
Table MakeLevelTable(const StudyPlan& plan, const std::vector<RareCell>& cells) {
  Table table = MakeKeyTable(plan);
  table.AddColumns({Column::Number("error_over_bound"), Column::Number("rate_beyond"),
                    Column::Number("standard_error"), Column::Number("acceptance")});
  for (const RareCell& cell : cells) {
    std::vector<double> levels = cell.pilot.levels.levels;
    levels.push_back(1.0);
    for (size_t k = 0; k < levels.size() && !cell.replicates.empty(); ++k) {
      Moments rates, acceptance;
      for (const SplittingReplicate& replicate : cell.replicates) {
        double rate = 1.0;
        for (size_t j = 0; j <= k; ++j) rate *= j < replicate.shares.size() ? replicate.shares[j] : 0.0;
        rates.Add(rate);
        if (k < replicate.acceptance.size()) acceptance.Add(replicate.acceptance[k]);
      }
      std::vector<Value>& row = table.rows.emplace_back(MakeKeyValues(plan, cell.condition, cell.estimator));
      row.insert(row.end(), {levels[k], rates.mean(), rates.standard_error(), acceptance.mean()});
    }
  }
  return table;
}

Table MakeReplicateTable(const StudyPlan& plan, const std::vector<RareCell>& cells) {
  Table table = MakeKeyTable(plan);
  table.AddColumns({Column::Count("replicate"), Column::Number("estimate"), Column::Count("ancestors")});
  for (const RareCell& cell : cells) {
    for (size_t r = 0; r < cell.replicates.size(); ++r) {
      std::vector<Value>& row = table.rows.emplace_back(MakeKeyValues(plan, cell.condition, cell.estimator));
      row.insert(row.end(), {static_cast<std::int64_t>(r), cell.replicates[r].estimate,
                             static_cast<std::int64_t>(cell.replicates[r].num_ancestors)});
    }
  }
  return table;
}

Table MakeStratumTable(const StudyPlan& plan, const std::vector<StratifiedCell>& cells) {
  Table table = MakeKeyTable(plan);
  table.AddColumns({Column::Count("one_in"), Column::Count("num_trials"), Column::Count("num_run"),
                    Column::Count("num_failed")});
  for (const StratifiedCell& cell : cells) {
    for (size_t k = 0; k < kNumStrata; ++k) {
      const StratumCount& count = cell.strata[k];
      std::vector<Value>& row = table.rows.emplace_back(MakeKeyValues(plan, cell.condition, cell.estimator));
      row.insert(row.end(), {std::int64_t{1} << k, count.num_trials, count.num_run, count.num_failed});
    }
  }
  return table;
}

template <typename Cell>
std::vector<RareRow> MakeRareRows(const std::vector<Cell>& cells) {
  std::vector<RareRow> rows;
  for (const Cell& cell : cells) rows.push_back(MakeRareRow(cell));
  return rows;
}

}  // namespace

double RareRow::BruteForceShare() const {
  const double relative_error = standard_error / estimate;
  return static_cast<double>(num_calls) * estimate * relative_error * relative_error / (1.0 - estimate);
}

RareRow MakeRareRow(const RareCell& cell) {
  const SplittingRate& rate = cell.rate;
  RareRow row{cell.condition,      cell.estimator,       rate.estimate,
              rate.standard_error, rate.interval,        rate.num_values,
              rate.unseen_up_to,   rate.relative_spread, {}};
  for (const SplittingDoubt doubt : rate.doubts) row.doubts.push_back(Name(doubt));
  if (!cell.why_not_simulated.empty()) row.doubts = {StatusName(MotionStatus::kNotSimulated)};
  return row;
}

RareRow MakeRareRow(const StratifiedCell& cell) {
  RareRow row{cell.condition,
              cell.estimator,
              cell.rate.estimate,
              cell.rate.standard_error,
              cell.rate.interval,
              cell.num_run,
              cell.rate.cautious_upper,
              std::numeric_limits<double>::quiet_NaN(),
              {}};
  if (cell.rate.num_effective_events < kLeastFailures) row.doubts.push_back("few_failures");
  if (cell.rate.cautious_upper > kMostUnseen * cell.rate.interval.upper)
    row.doubts.push_back("few_easy_trials");
  const auto has_trials = [](const StratumCount& count) { return count.num_trials > 0; };
  if (std::ranges::none_of(cell.strata, has_trials)) {
    row.estimate = std::nan("");
    row.interval = {0.0, 1.0};
    row.doubts = {StatusName(MotionStatus::kNotSimulated)};
  }
  return row;
}

std::string RareAsTable(const StudyPlan& plan, const RareEvent& event, const std::vector<RareCell>& cells) {
  const std::vector<RareRow> rows = MakeRareRows(cells);
  Table table = MakeRateTable(plan, event, rows);
  table.columns.push_back(Column::Number("spread", {1.0, "", ".2f"}));
  std::string doubts;
  for (size_t i = 0; i < cells.size(); ++i) {
    table.rows[i].emplace_back(cells[i].rate.relative_spread);
    if (cells[i].rate.IsTrusted()) continue;
    doubts += FormatParagraph(fmt::format(
        "{}: not trusted: {}", fmt::join(MakeRowHead(plan, rows[i].condition, rows[i].estimator), ", "),
        DescribeDoubts(cells[i])));
  }
  return fmt::format("{}: {} by multilevel splitting\n\n{}\n{}{}", plan.study.name, DescribeEvents(event),
                     RenderText(table), doubts, doubts.empty() ? "" : "\n") +
         FormatParagraph(
             "Mean of independent unbiased replicates with Cox's 95 % interval; spread: standard deviation "
             "of "
             "one over the mean.") +
         FormatParagraph(kBruteForceLegend) + DescribeMissingCellTrials(cells, FailingMotion::kNumTried) +
         FormatParagraph(
             "unseen up to: failures of a kind that comes at once, with no level before it, may have any "
             "rate "
             "up to this and be missed; the rate is that of failures to which levels lead.");
}

std::string StratifiedAsTable(const StudyPlan& plan, const std::vector<StratifiedCell>& cells) {
  Table table = MakeRateTable(plan, {}, MakeRareRows(cells));
  for (size_t k = 0; k < kNumStrata; ++k) {
    table.columns.push_back({fmt::format("1 in {}", 1 << k)});
    for (size_t i = 0; i < cells.size(); ++i) {
      const StratumCount& count = cells[i].strata[k];
      table.rows[i].emplace_back(fmt::format("{}/{}/{}", count.num_failed, count.num_run, count.num_trials));
    }
  }
  return fmt::format("{}: failures of trials stratified by the Cramer-Rao bound\n\n{}\n", plan.study.name,
                     RenderText(table)) +
         FormatParagraph(
             "Each trial that is run counts as many as its stratum stands for; 95 % interval of Fay and "
             "Feuer "
             "for weighted counts.") +
         FormatParagraph(kBruteForceLegend) + DescribeMissingCellTrials(cells, NumDrawn(cells)) +
         FormatParagraph(
             "unseen up to: the upper end if the next failure came from the easiest stratum that was run.") +
         FormatParagraph(
             fmt::format("trusted: the failures weigh as much as {:g} of equal weight or more, and the rate "
                         "unseen is at most {:g} times the interval's end.",
                         kLeastFailures, kMostUnseen)) +
         FormatParagraph("1 in k: of the trials of a stratum one in k is run: failed/run/drawn.");
}

Table MakeRareFileTable(const StudyPlan& plan, const RareEvent& event, const std::vector<RareRow>& rows) {
  Table table{{{.name = "study", .json_name = kNotInJson}}};
  table.AddColumns(MakeKeyTable(plan).columns);
  table.AddColumns({Column::Text("quantity"),
                    Column::Text("kind"),
                    Column::Number("value"),
                    {"lower,upper", ColumnType::kInterval},
                    Column::Number("standard_error"),
                    Column::Count("n"),
                    Column::Count("trusted"),
                    Column::Text("doubts"),
                    Column::Number("unseen_up_to"),
                    Column::Number("relative_spread"),
                    Column::Number("brute_force_share")});
  for (const RareRow& row : rows) {
    std::vector<Value>& values = table.rows.emplace_back(std::vector<Value>{plan.study.name});
    std::ranges::copy(MakeKeyValues(plan, row.condition, row.estimator), std::back_inserter(values));
    const std::int64_t is_trusted = row.doubts.empty() ? 1 : 0;
    values.insert(values.end(), {Name(event.kind), "rate", row.estimate, row.interval, row.standard_error,
                                 row.num_calls, is_trusted, fmt::format("{}", fmt::join(row.doubts, " ")),
                                 row.unseen_up_to, row.relative_spread, KnownShare(row)});
  }
  return table;
}

CommandResult MakeRareResult(const StudyPlan& plan, const RareEffort& effort,
                             const std::vector<RareCell>& cells) {
  const bool has_risk = effort.event.kind != RareEvent::Kind::kFailure;
  const Facts facts = {{"study", plan.study.name},
                       {"seed", static_cast<std::int64_t>(plan.study.seed)},
                       {"method", "splitting"},
                       {"risk", has_risk ? Value(effort.event.risk) : Value()},
                       {"num_particles", std::int64_t{effort.splitting.num_particles}},
                       {"num_moves", std::int64_t{effort.splitting.num_moves}},
                       {"kept_share", effort.splitting.kept_share},
                       {"num_replicates", std::int64_t{effort.num_replicates}}};
  return MakeResult(
      RareAsTable(plan, effort.event, cells), kRareFormat, facts,
      MakeRareFileTable(plan, effort.event, MakeRareRows(cells)),
      {{"error_levels", MakeLevelTable(plan, cells)}, {"replicates", MakeReplicateTable(plan, cells)}});
}

CommandResult MakeStratifiedResult(const StudyPlan& plan, const StratifiedEffort& effort,
                                   const std::vector<StratifiedCell>& cells) {
  const Facts facts = {{"study", plan.study.name},
                       {"seed", static_cast<std::int64_t>(plan.study.seed)},
                       {"method", "stratified"},
                       {"num_trials", std::int64_t{effort.num_trials}},
                       {"run_share", effort.run_share}};
  return MakeResult(StratifiedAsTable(plan, cells), kRareFormat, facts,
                    MakeRareFileTable(plan, {}, MakeRareRows(cells)),
                    {{"strata", MakeStratumTable(plan, cells)}});
}

}  // namespace rcme
