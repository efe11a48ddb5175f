#include "experiments/analysis/comparison_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/base/columns.h"
#include "experiments/base/field_text.h"
#include "experiments/base/json_output.h"

namespace rcme {
namespace {

// One line of a person's table: levels, estimator, n, the four counts, difference, p-values.
std::vector<std::string> Cells(const ComparisonRow& row) {
  std::vector<std::string> cells = row.levels;
  const PairedCounts& c = row.counts;
  cells.push_back(row.estimator);
  for (const std::int64_t count : {c.n(), c.both, c.first_only, c.second_only, c.neither}) {
    cells.push_back(fmt::format("{}", count));
  }
  if (c.n() == 0) {
    cells.insert(cells.end(), {"-", "-", "-"});
  } else {
    cells.push_back(fmt::format("{:+.2f} [{:+.2f}, {:+.2f}]", 100.0 * row.risk_difference,
                                100.0 * row.interval.lower, 100.0 * row.interval.upper));
    cells.push_back(fmt::format("{:.3g}", row.p_value));
    cells.push_back(fmt::format("{:.3g}{}", row.holm_p_value, row.holm_p_value < 0.05 ? " *" : ""));
  }
  return cells;
}

}  // namespace

std::string ComparisonAsTable(const Comparison& comparison) {
  std::string text =
      fmt::format("Study {} against {}: {} of {} trials done\n", comparison.study, comparison.reference,
                  comparison.num_trials_done, comparison.num_trials_planned);
  if (!comparison.caution.empty()) text += fmt::format("Caution: {}.\n", comparison.caution);
  for (const TrialEvent& event : TrialEvents()) {
    std::vector<std::vector<std::string>> rows = {comparison.factor_names};
    rows[0].insert(rows[0].end(), {"estimator", "n", "both", "estimator only", comparison.reference + " only",
                                   "neither", "difference (% points)", "p", "Holm p"});
    for (const ComparisonRow& row : comparison.rows) {
      if (row.event == event.name) rows.push_back(Cells(row));
    }
    text += fmt::format("\n{}: {}\n\n{}", event.name, event.doc, FormatColumns(rows));
  }
  text += fmt::format(
      "\nCounts of trials in which the event happened to both, to one only, to neither.\n"
      "Difference: rate of the estimator minus rate of {}, with Tango's 95 % interval.\n"
      "p: McNemar's exact test of equal rates.\n"
      "Holm p: adjusted for all {} tests of this comparison (events, estimators, conditions); * below "
      "0.05.\n",
      comparison.reference,
      std::ranges::count_if(comparison.rows, [](const ComparisonRow& row) { return row.counts.n() > 0; }));
  return text;
}

std::string ComparisonAsCsv(const Comparison& comparison) {
  std::string text = "study,condition,";
  for (const std::string& factor : comparison.factor_names) text += CsvField(factor) + ",";
  text +=
      "estimator,reference,event,n,both,estimator_only,reference_only,neither,risk_difference,lower,upper,"
      "p_mcnemar,p_holm\n";
  for (const ComparisonRow& row : comparison.rows) {
    const PairedCounts& c = row.counts;
    text += fmt::format("{},{},", CsvField(comparison.study), row.condition);
    for (const std::string& level : row.levels) text += CsvField(level) + ",";
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", CsvField(row.estimator),
                        CsvField(comparison.reference), row.event, c.n(), c.both, c.first_only, c.second_only,
                        c.neither, CsvNumber(row.risk_difference), CsvNumber(row.interval.lower),
                        CsvNumber(row.interval.upper), CsvNumber(row.p_value), CsvNumber(row.holm_p_value));
  }
  return text;
}

std::string ComparisonAsJson(const Comparison& comparison) {
  nlohmann::ordered_json json = {{"study", comparison.study},
                                 {"reference", comparison.reference},
                                 {"trials_done", comparison.num_trials_done},
                                 {"trials_planned", comparison.num_trials_planned},
                                 {"caution", comparison.caution},
                                 {"rows", nlohmann::ordered_json::array()}};
  for (const ComparisonRow& row : comparison.rows) {
    nlohmann::ordered_json entry = {{"condition", row.condition}};
    for (size_t f = 0; f < row.levels.size(); ++f) {
      entry["levels"][comparison.factor_names[f]] = row.levels[f];
    }
    entry["estimator"] = row.estimator;
    entry["event"] = row.event;
    entry["n"] = row.counts.n();
    entry["both"] = row.counts.both;
    entry["estimator_only"] = row.counts.first_only;
    entry["reference_only"] = row.counts.second_only;
    entry["neither"] = row.counts.neither;
    entry["risk_difference"] = JsonNumber(row.risk_difference);
    entry["interval"] = {row.interval.lower, row.interval.upper};
    entry["p_mcnemar"] = JsonNumber(row.p_value);
    entry["p_holm"] = JsonNumber(row.holm_p_value);
    json["rows"].push_back(std::move(entry));
  }
  return JsonText(kComparisonFormat, json);
}

}  // namespace rcme
