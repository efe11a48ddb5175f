#include "experiments/real/paper_table/paper_table_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/real/paper_table/printed_table.h"

namespace rcme {
namespace {

struct CellQuantity {
  const char* name;     // in files
  const char* heading;  // for people
  SharedMemberRate TableCell::*rate;
  bool is_of_subset = false;  // of a subset of the pairs, whose number the table then shows
};
constexpr CellQuantity kQuantities[] = {
    {"detect_fail", "Detect-fail %", &TableCell::detect_fail},
    {"other_refusal", "other refusal %", &TableCell::other_refusal},
    {"kappa_failure", "Failure % (kappa)", &TableCell::kappa_failure},
    {"true_failure", "Failure % (truth)", &TableCell::true_failure},
    {"flag_of_failed", "flagged of the failed %", &TableCell::flag_of_failed, true},
    {"flag_of_right", "flagged of the right %", &TableCell::flag_of_right, true},
};
const NumberFormat kPercentOfHeading{100.0, "", ".2f"};

// Decimals for a rate of n pairs in per cent: enough to distinguish one pair from none.
int CountDecimals(std::int64_t n) { return n <= 100 ? 0 : n <= 1000 ? 1 : 2; }

bool HasDoubts(const PaperTable& paper_table) {
  return std::ranges::any_of(paper_table.rows, [](const TableRow& row) { return row.num_in_doubt > 0; });
}

Table MakeEstimatorTable(const PaperTable& paper_table, size_t estimator) {
  Table table{
      {Column::Key(paper_table.estimators[estimator]), Column::Count("pairs"), Column::Count("apart")}};
  const bool has_doubts = HasDoubts(paper_table);
  if (has_doubts) table.columns.push_back(Column::Count("in doubt"));
  for (const CellQuantity& quantity : kQuantities)
    table.columns.push_back(Column::Estimated(quantity.heading, kPercentOfHeading));
  for (const TableRow& row : paper_table.rows) {
    const TableCell& cell = row.cells[estimator];
    table.rows.push_back(
        {(row.is_group ? "= " : "") + row.name, cell.detect_fail.n, cell.detect_fail.num_apart});
    if (has_doubts) table.rows.back().emplace_back(row.num_in_doubt);
    for (const CellQuantity& quantity : kQuantities) {
      const SharedMemberRate& rate = cell.*quantity.rate;
      const std::string counts = fmt::format("{} of {}", rate.num_events, rate.n);
      table.rows.back().emplace_back(Estimate{.value = rate.rate,
                                              .interval = rate.interval,
                                              .note = quantity.is_of_subset ? counts : "",
                                              .decimals = CountDecimals(rate.n)});
    }
  }
  return table;
}

Estimate MakeEstimate(const SharedMemberRate& rate) {
  return {.value = rate.rate, .interval = rate.interval, .decimals = CountDecimals(rate.n)};
}

// The outcomes at one bound: a row per estimator for each scene and group.
Table MakeOutcomeTable(const PaperTable& paper_table, size_t bound) {
  const NumberFormat milliseconds{1e3, "", ".3g"};
  Table table{{Column::Key("scene"), Column::Key("estimator"), Column::Count("pairs"),
               Column::Estimated("refusal %", kPercentOfHeading),
               Column::Estimated("failure %", kPercentOfHeading),
               Column::Estimated("success %", kPercentOfHeading),
               Column::Estimated("AUC %", kPercentOfHeading), Column::Number("median ms", milliseconds)}};
  for (const TableRow& row : paper_table.rows) {
    for (size_t e = 0; e < paper_table.estimators.size(); ++e) {
      const BoundOutcomes& outcomes = row.cells[e].outcomes[bound];
      table.rows.push_back({(row.is_group ? "= " : "") + row.name, paper_table.estimators[e],
                            outcomes.success.n, MakeEstimate(outcomes.refusal),
                            MakeEstimate(outcomes.failure), MakeEstimate(outcomes.success),
                            Estimate{.value = outcomes.area.value,
                                     .interval = outcomes.area.interval,
                                     .decimals = CountDecimals(outcomes.area.n)},
                            row.cells[e].median_seconds});
    }
  }
  return table;
}

std::string OutcomesAsText(const PaperTable& paper_table) {
  std::string text;
  const std::vector<BoundOutcomes>& bounds = paper_table.rows.front().cells.front().outcomes;
  for (size_t b = 0; b < bounds.size(); ++b) {
    text += "\n" +
            FormatParagraph(fmt::format(
                "Outcomes at {:g} deg: failure is an error of rotation or direction above it, or an answer "
                "that is not valid, of pairs whose motion is known; AUC@{:g}",
                bounds[b].bound_deg, bounds[b].bound_deg)) +
            "\n" + RenderText(MakeOutcomeTable(paper_table, b));
  }
  return text;
}

double ComputeShare(const PrintedRate& rate) {
  return static_cast<double>(rate.count) / static_cast<double>(rate.n);
}

// The printed rates by row; the first row has all columns.
Table MakePrintedTable(const std::vector<PrintedRate>& rates) {
  Table table{{Column::Key("printed in the paper"), Column::Count("pairs")}};
  for (const PrintedRate& rate : rates) {
    if (rate.row == rates.front().row) {
      table.columns.push_back(
          {rate.method + (rate.quantity == "failure" ? " Failure % (kappa)" : " Detect-fail %"),
           ColumnType::kEstimate, kPercentOfHeading});
    }
    if (table.rows.empty() || std::get<std::string>(table.rows.back()[0]) != rate.row)
      table.rows.push_back({rate.row, std::int64_t{rate.n}});
    table.rows.back().emplace_back(Estimate{ComputeShare(rate), rate.interval});
  }
  return table;
}

std::string DescribeComparisons() {
  std::string text;
  for (const PrintedComparison& c : PrintedComparisons()) {
    text += FormatParagraph(fmt::format(
        "{}: {} fails on {} of {} pairs, {} on {}; McNemar's p between {:.2g} and {:.2g}, as many of these "
        "pairs as possible being the same or none{}",
        c.row, c.first, c.first_failures, c.n, c.second, c.second_failures, c.least_p, c.greatest_p,
        c.least_p > 0.05 ? ": not significant" : ""));
  }
  return text;
}

// The rows for files. In JSON printed rates are a list of their own.
std::vector<Column> RateColumns(bool is_printed) {
  return {{.name = "source", .json_name = kNotInJson},
          Column::Text("scene"),
          {.name = "", .type = ColumnType::kFlag, .json_name = "is_group"},
          {.name = "estimator", .json_name = is_printed ? "method" : ""},
          Column::Text("quantity"),
          {.name = "kind", .json_name = kNotInJson},
          Column::Number("value"),
          {"lower,upper", ColumnType::kInterval},
          Column::Count("n"),
          Column::Count("count"),
          {.name = "apart", .type = ColumnType::kCount, .json_name = is_printed ? kNotInJson : ""},
          Column::Number("design_effect")};
}

// The outcomes of a cell: refusal_5_deg, failure_5_deg, success_5_deg, auc_5_deg, ..., median_seconds.
void AppendOutcomes(const TableRow& row, const TableCell& cell, const std::string& estimator, Table* table) {
  for (const BoundOutcomes& outcomes : cell.outcomes) {
    if (outcomes.success.n == 0) continue;
    const auto name = [&](const char* what) { return fmt::format("{}_{:g}_deg", what, outcomes.bound_deg); };
    const auto add = [&](const char* what, const SharedMemberRate& rate) {
      table->rows.push_back({"run", row.name, row.is_group, estimator, name(what), "rate", rate.rate,
                             rate.interval, rate.n, rate.num_events, rate.num_apart, rate.design_effect});
    };
    add("refusal", outcomes.refusal);
    add("failure", outcomes.failure);
    add("success", outcomes.success);
    table->rows.push_back({"run",
                           row.name,
                           row.is_group,
                           estimator,
                           name("auc"),
                           "score",
                           outcomes.area.value,
                           outcomes.area.interval,
                           outcomes.area.n,
                           {},
                           {},
                           {}});
  }
  if (!cell.outcomes.empty())
    table->rows.push_back({"run",
                           row.name,
                           row.is_group,
                           estimator,
                           "median_seconds",
                           "median",
                           cell.median_seconds,
                           {},
                           cell.detect_fail.n,
                           {},
                           {},
                           {}});
}

// The pairs in doubt of a row, if the table has any; they belong to no estimator.
void AppendDoubts(const PaperTable& paper_table, Table* table) {
  if (!HasDoubts(paper_table)) return;
  for (const TableRow& row : paper_table.rows) {
    const std::int64_t n = row.cells.front().detect_fail.n + row.num_in_doubt;
    table->rows.push_back({"run",
                           row.name,
                           row.is_group,
                           "",
                           "truth_in_doubt",
                           "rate",
                           static_cast<double>(row.num_in_doubt) / static_cast<double>(n),
                           {},
                           n,
                           row.num_in_doubt,
                           {},
                           {}});
  }
}

Table MakeRunTable(const PaperTable& paper_table) {
  Table table{RateColumns(/*is_printed=*/false)};
  for (const TableRow& row : paper_table.rows) {
    for (size_t e = 0; e < paper_table.estimators.size(); ++e) {
      for (const CellQuantity& quantity : kQuantities) {
        const SharedMemberRate& rate = row.cells[e].*quantity.rate;
        if (rate.n == 0) continue;
        table.rows.push_back({"run", row.name, row.is_group, paper_table.estimators[e], quantity.name, "rate",
                              rate.rate, rate.interval, rate.n, rate.num_events, rate.num_apart,
                              rate.design_effect});
      }
      AppendOutcomes(row, row.cells[e], paper_table.estimators[e], &table);
    }
  }
  AppendDoubts(paper_table, &table);
  return table;
}

Table MakePaperRateTable() {
  Table table{RateColumns(/*is_printed=*/true)};
  for (const PrintedRate& rate : PrintedRates()) {
    const std::int64_t n = rate.n, count = rate.count;
    table.rows.push_back({"paper",
                          rate.row,
                          {},
                          rate.method,
                          rate.quantity == "failure" ? "kappa_failure" : rate.quantity,
                          "rate",
                          ComputeShare(rate),
                          rate.interval,
                          n,
                          count,
                          n,
                          {}});
  }
  return table;
}

std::string PaperTableAsText(const PaperTable& table) {
  std::string text =
      FormatParagraph(fmt::format("{}: refusals and failures, % of the pairs, 95 % intervals "
                                  "that respect what pairs have in common",
                                  table.study));
  for (size_t e = 0; e < table.estimators.size(); ++e)
    text += "\n" + RenderText(MakeEstimatorTable(table, e));
  text += OutcomesAsText(table);
  if (HasDoubts(table))
    text += "\n" + FormatParagraph(
                       "in doubt: pairs whose truth is listed as wrong (truth_in_doubt of the "
                       "study); they are in no other column.");
  text += "\n" +
          FormatParagraph(fmt::format(
              "Failure (kappa): the paper's flag, half or fewer of the consistent matches being left after "
              "the refinement; a dash where an estimator has none. Failure (truth): rotation error above "
              "{:g} or direction error above {:g} degrees, of pairs whose motion is known. Refusals are no "
              "failures. apart: pairs of which no two have anything in common. A group's interval is of "
              "these scenes, not of all scenes of the kind.",
              table.bounds.max_rotation_error_deg, table.bounds.max_direction_error_deg));
  return text + "\n" + RenderText(MakePrintedTable(PrintedRates())) + "\n" + DescribeComparisons();
}

Table MakePaperFileTable(const PaperTable& table) {
  Table all = MakeRunTable(table);
  std::ranges::copy(MakePaperRateTable().rows, std::back_inserter(all.rows));
  return all;
}

}  // namespace

CommandResult MakePaperResult(const PaperTable& table) {
  return {PaperTableAsText(table), MakePaperFileTable(table),
          RenderDocument(kPaperTableFormat,
                         {{"study", table.study},
                          {"max_rotation_error_deg", table.bounds.max_rotation_error_deg},
                          {"max_direction_error_deg", table.bounds.max_direction_error_deg}},
                         {{"rates", MakeRunTable(table)}, {"printed", MakePaperRateTable()}})};
}

}  // namespace rcme
