#include "experiments/statistics/comparison_output.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/statistics/population_summary.h"
#include "experiments/study/run_description.h"

namespace rcme {
namespace {

// The names of a test of no difference and of the interval, for files and for people.
struct Method {
  std::string test, interval, test_in_words, interval_in_words;
};

Method FindMethod(ComparedKind kind, bool is_anytime_valid) {
  if (kind == ComparedKind::kScore) {
    return {"betting", "betting", "test by betting, valid at every look",
            "anytime-valid 95 % interval (betting)"};
  }
  const bool is_error = kind == ComparedKind::kError;
  if (is_anytime_valid) {
    return {"discordant_sequence", is_error ? "" : "betting",
            fmt::format("likelihood ratio of the {}, valid at every look",
                        is_error ? "trials with a greater error" : "discordant trials"),
            is_error ? "no interval, which would hold for one look only"
                     : "anytime-valid 95 % interval (betting)"};
  }
  if (is_error) return {"sign", "order_statistics", "exact sign test", "distribution-free 95 % interval"};
  return {"mcnemar", "tango", "McNemar's exact test of equal rates", "Tango's 95 % interval"};
}
Method MethodOfPopulation(ComparedKind kind) {
  return {"population", "population",
          fmt::format("least level at which that interval{} leaves out 0",
                      kind == ComparedKind::kError ? ", of the share greater less the share less," : ""),
          "95 % interval of the population, over its draws"};
}
Method FindMethod(const ComparisonRow& row) {
  if (row.is_of_population) return MethodOfPopulation(row.kind);
  const bool is_by_means = row.is_of_scenes && row.kind == ComparedKind::kEvent;
  return FindMethod(is_by_means ? ComparedKind::kScore : row.kind, row.is_anytime_valid);
}

// Formats a difference in percentage points, or in the unit of an error.
NumberFormat DifferenceFormat(ComparedKind kind) {
  return kind == ComparedKind::kError ? NumberFormat{1.0, "", "+.3g"} : NumberFormat{100.0, "", "+.2f"};
}

// The counts of a kind: their headings and their fields.
std::vector<std::pair<std::string, std::int64_t PairedCounts::*>> ListPairedCounts(
    ComparedKind kind, const std::string& reference) {
  using P = PairedCounts;
  switch (kind) {
    case ComparedKind::kEvent:
      return {{"both", &P::both},
              {"estimator only", &P::first_only},
              {reference + " only", &P::second_only},
              {"neither", &P::neither}};
    case ComparedKind::kError:
      return {{"greater", &P::first_only}, {"less", &P::second_only}, {"equal", &P::neither}};
    case ComparedKind::kScore:
      break;
  }
  return {};
}

Estimate FindDifference(const ComparisonRow& row) {
  return row.n > 0 ? Estimate{row.difference, row.interval} : Estimate();
}

std::string RenderComparedTable(const Compared& compared, const Comparison& comparison) {
  using R = const ComparisonRow&;
  const bool is_error = compared.kind == ComparedKind::kError;
  auto columns = LevelColumns<ComparisonRow>(comparison.factor_names);
  columns.push_back({{.name = "estimator", .is_key = true}, [](R r) { return r.estimator; }});
  columns.push_back({{"n", ColumnType::kCount}, [](R r) { return r.n; }});
  for (const auto& [heading, count] : ListPairedCounts(compared.kind, comparison.reference))
    columns.push_back({{heading, ColumnType::kCount}, [count = count](R r) { return r.counts.*count; }});
  columns.push_back(
      {{is_error ? fmt::format("median difference ({})", compared.unit) : "difference (% points)",
        ColumnType::kEstimate, DifferenceFormat(compared.kind)},
       FindDifference});
  columns.push_back({{"p", ColumnType::kNumber}, [](R r) { return r.p_value; }});
  columns.push_back({{"Holm p", ColumnType::kNumber}, [](R r) { return r.holm_p_value; }});
  columns.push_back({{" "}, [](R r) { return std::string(r.holm_p_value < 0.05 ? "*" : ""); }});
  std::vector<ComparisonRow> rows = comparison.rows;
  std::erase_if(rows, [&](R r) { return r.event != compared.name; });
  return fmt::format("\n{}: {}\n\n{}", compared.name, compared.doc, RenderText(MakeTable(columns, rows)));
}

// Returns whether an event has trials that count and happened in none of them, to no estimator.
bool HappenedNever(const Compared& compared, const Comparison& comparison) {
  if (compared.kind != ComparedKind::kEvent) return false;
  bool has_trials = false, has_events = false;
  for (const ComparisonRow& row : comparison.rows) {
    if (row.event != compared.name) continue;
    const PairedCounts& counts = row.counts;
    has_trials = has_trials || row.n > 0;
    has_events = has_events || counts.both + counts.first_only + counts.second_only > 0;
  }
  return has_trials && !has_events;
}

// One line for the events that happened never, in place of their tables of zeros; empty if there are none.
std::string RenderEventsWithoutTrials(const Comparison& comparison) {
  std::vector<std::string> names;
  for (const Compared& compared : comparison.compared) {
    if (HappenedNever(compared, comparison)) names.push_back(compared.name);
  }
  if (names.empty()) return "";
  const bool is_all = names.size() == comparison.compared.size();
  return fmt::format("\n{}: in no trial of any estimator{}.\n", fmt::join(names, ", "),
                     is_all ? "; --of errors compares their errors" : "");
}

// Explains the numbers of a kind; empty if no table shows this kind.
std::string Legend(ComparedKind kind, const Comparison& comparison) {
  const bool has_table = std::ranges::any_of(comparison.compared, [&](const Compared& compared) {
    return compared.kind == kind && !HappenedNever(compared, comparison);
  });
  const auto row = std::ranges::find(comparison.rows, kind, &ComparisonRow::kind);
  if (!has_table || row == comparison.rows.end()) return "";
  const Method method = FindMethod(*row);
  const std::string tests = fmt::format("with {}.\np: {}.\n", method.interval_in_words, method.test_in_words);
  switch (kind) {
    case ComparedKind::kEvent:
      return fmt::format(
          "Events: trials in which the event happened to both, to one only, to neither.\n"
          "Difference: rate of the estimator minus rate of {},\n{}",
          comparison.reference, tests);
    case ComparedKind::kScore:
      return fmt::format("Scores: mean of the estimator minus mean of {},\n{}", comparison.reference, tests);
    case ComparedKind::kError:
      return fmt::format(
          "Errors: counts of trials in which the estimator's error is greater, less, equal (two refusals\n"
          "are). Difference: median over the trials of its error minus that of {},\n{}",
          comparison.reference, tests);
  }
  return "";
}

// For events and errors; scores have none.
ColumnOf<ComparisonRow> CountColumn(const std::string& name, std::int64_t PairedCounts::*count) {
  return {{name, ColumnType::kCount}, [count](const ComparisonRow& row) {
            return row.kind == ComparedKind::kScore ? Value(std::nan("")) : Value(row.counts.*count);
          }};
}

Table MakeRowTable(const Comparison& comparison) {
  using R = const ComparisonRow&;
  std::vector<ColumnOf<ComparisonRow>> columns = {
      {{.name = "study", .json_name = kNotInJson}, [&](R) { return comparison.study; }},
      {{"condition", ColumnType::kCount}, [](R r) { return std::int64_t{r.condition}; }}};
  const auto levels = LevelColumns<ComparisonRow>(comparison.factor_names);
  columns.insert(columns.end(), levels.begin(), levels.end());
  const std::vector<ColumnOf<ComparisonRow>> others = {
      {{"estimator"}, [](R r) { return r.estimator; }},
      {{.name = "reference", .json_name = kNotInJson}, [&](R) { return comparison.reference; }},
      {{"event"}, [](R r) { return r.event; }},
      {{"n", ColumnType::kCount}, [](R r) { return r.n; }},
      CountColumn("both", &PairedCounts::both),
      CountColumn("estimator_only", &PairedCounts::first_only),
      CountColumn("reference_only", &PairedCounts::second_only),
      CountColumn("neither", &PairedCounts::neither),
      {{"risk_difference", ColumnType::kNumber}, [](R r) { return r.difference; }},
      {{"lower,upper", ColumnType::kInterval}, [](R r) { return r.interval; }},
      {{"p_mcnemar", ColumnType::kNumber},
       [](R r) { return FindMethod(r).test == "mcnemar" ? r.p_value : std::nan(""); }},
      {{"p_holm", ColumnType::kNumber}, [](R r) { return r.holm_p_value; }},
      {{"kind"}, [](R r) { return Name(r.kind); }},
      {{"p_value", ColumnType::kNumber}, [](R r) { return r.p_value; }},
      {{"test"}, [](R r) { return FindMethod(r).test; }},
      {{.name = "interval", .json_name = "interval_kind"}, [](R r) { return FindMethod(r).interval; }}};
  columns.insert(columns.end(), others.begin(), others.end());
  return MakeTable(columns, comparison.rows);
}

// What a page needs of the rows: without what is the same in all of them or follows from the others.
Table MakePaperTable(const Comparison& comparison) {
  using R = const ComparisonRow&;
  auto columns = LevelColumns<ComparisonRow>(comparison.factor_names);
  columns.push_back({{.name = "estimator", .is_key = true}, [](R r) { return r.estimator; }});
  columns.push_back({{"compared"}, [](R r) { return r.event; }});
  columns.push_back({{"n", ColumnType::kCount}, [](R r) { return r.n; }});
  const auto add_differences = [&](bool are_errors, const std::string& name) {
    const auto is_shown = [are_errors](R r) { return (r.kind == ComparedKind::kError) == are_errors; };
    if (std::ranges::none_of(comparison.rows, is_shown)) return;
    const ComparedKind kind = are_errors ? ComparedKind::kError : ComparedKind::kEvent;
    columns.push_back({{name, ColumnType::kEstimate, DifferenceFormat(kind)},
                       [is_shown](R r) { return is_shown(r) ? FindDifference(r) : Estimate(); }});
  };
  add_differences(false, fmt::format("difference from {} (% points)", comparison.reference));
  add_differences(true, fmt::format("median difference from {}", comparison.reference));
  columns.push_back({{"Holm p", ColumnType::kNumber}, [](R r) { return r.holm_p_value; }});
  return MakeTable(columns, comparison.rows);
}

std::string ComparisonAsTable(const Comparison& comparison) {
  std::string text = fmt::format(
      "Study {} against {}: {}\n", comparison.study, comparison.reference,
      DescribeProgress(comparison.num_trials_done, comparison.num_trials_planned, comparison.is_target_open));
  if (!comparison.caution.empty()) text += fmt::format("Caution: {}.\n", comparison.caution);
  std::string tables;
  for (const Compared& compared : comparison.compared) {
    if (!HappenedNever(compared, comparison)) tables += RenderComparedTable(compared, comparison);
  }
  text += tables + RenderEventsWithoutTrials(comparison);
  if (tables.empty()) return text;
  text += "\n";
  for (const ComparedKind kind : {ComparedKind::kEvent, ComparedKind::kScore, ComparedKind::kError})
    text += Legend(kind, comparison);
  if (!comparison.rows.empty() && comparison.rows.front().is_of_scenes) {
    text +=
        "Scenes are repeated: n counts them; differences are of the means over a scene's\n"
        "trials, of errors in its first.\n";
  }
  if (comparison.is_of_these_draws) text += kOfTheseDraws;
  text += fmt::format(
      "Holm p: adjusted for all {} tests of this comparison (what is compared,\n"
      "estimators, conditions); *: below 0.05.\n",
      std::ranges::count_if(comparison.rows, [](const ComparisonRow& row) { return row.n > 0; }));
  return text;
}

}  // namespace

CommandResult MakeComparisonResult(const Comparison& comparison) {
  CommandResult result = MakeResult(ComparisonAsTable(comparison), kComparisonFormat,
                                    {{"study", comparison.study},
                                     {"reference", comparison.reference},
                                     {"trials_done", comparison.num_trials_done},
                                     {"trials_planned", comparison.num_trials_planned},
                                     {"caution", comparison.caution}},
                                    MakeRowTable(comparison));
  result.paper = MakePaperTable(comparison);
  return result;
}

}  // namespace rcme
