#include "experiments/real/paper_table/paper_table_output.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"
#include "experiments/real/paper_table/printed_table.h"

namespace rcme {
namespace {

struct CellQuantity {
  const char* name;     // in files
  const char* heading;  // for people
  SharedMemberRate TableCell::*rate;
};
constexpr CellQuantity kQuantities[] = {
    {"detect_fail", "Detect-fail %", &TableCell::detect_fail},
    {"other_refusal", "other refusal %", &TableCell::other_refusal},
    {"kappa_failure", "Failure % (kappa)", &TableCell::kappa_failure},
    {"true_failure", "Failure % (truth)", &TableCell::true_failure},
    {"flag_of_failed", "flagged of the failed", &TableCell::flag_of_failed},
    {"flag_of_right", "flagged of the right", &TableCell::flag_of_right},
};

std::string PercentText(double rate, const Interval& interval) {
  return FormatEstimate({rate, interval}, {100.0, "", ".2f"});
}

std::string CellText(const SharedMemberRate& rate, bool is_of_subset) {
  if (rate.n == 0) return "-";
  const std::string percent = PercentText(rate.rate, rate.interval);
  return is_of_subset ? fmt::format("{} of {}: {}", rate.num_events, rate.n, percent) : percent;
}

std::string EstimatorAsText(const PaperTable& table, size_t estimator) {
  std::vector<std::vector<std::string>> rows = {{table.estimators[estimator], "pairs", "apart"}};
  for (const CellQuantity& quantity : kQuantities) rows[0].push_back(quantity.heading);
  for (const TableRow& row : table.rows) {
    const TableCell& cell = row.cells[estimator];
    rows.push_back({row.is_group ? "= " + row.name : row.name, fmt::format("{}", cell.detect_fail.n),
                    fmt::format("{}", cell.detect_fail.num_apart)});
    for (const CellQuantity& quantity : kQuantities) {
      const bool is_of_subset =
          quantity.rate == &TableCell::flag_of_failed || quantity.rate == &TableCell::flag_of_right;
      rows.back().push_back(CellText(cell.*quantity.rate, is_of_subset));
    }
  }
  return FormatColumns(rows) + "\n";
}

std::string PrintedAsText() {
  std::vector<std::vector<std::string>> rows = {{"printed in the paper", "pairs"}};
  const std::vector<PrintedRate> rates = PrintedRates();
  for (const PrintedRate& rate : rates) {
    const bool is_first_row = rate.row == rates.front().row;
    if (is_first_row)
      rows[0].push_back(rate.method + (rate.quantity == "failure" ? " Failure % (kappa)" : " Detect-fail %"));
    if (rows.back()[0] != rate.row) rows.push_back({rate.row, fmt::format("{}", rate.n)});
    rows.back().push_back(
        PercentText(static_cast<double>(rate.count) / static_cast<double>(rate.n), rate.interval));
  }
  std::string text = FormatColumns(rows) + "\n";
  for (const PrintedComparison& c : PrintedComparisons()) {
    text += fmt::format(
        "{}: {} fails on {} of {} pairs, {} on {}; McNemar's p between {:.2g} and {:.2g}, as many of these "
        "pairs as\npossible being the same or none{}\n",
        c.row, c.first, c.first_failures, c.n, c.second, c.second_failures, c.least_p, c.greatest_p,
        c.least_p > 0.05 ? ": not significant" : "");
  }
  return text;
}

std::string QuantityOf(const PrintedRate& rate) {
  return rate.quantity == "failure" ? "kappa_failure" : rate.quantity;
}

}  // namespace

std::string PaperTableAsText(const PaperTable& table) {
  std::string text = fmt::format(
      "{}: refusals and failures, % of the pairs, 95 % intervals that respect what pairs have in common\n\n",
      table.study);
  for (size_t e = 0; e < table.estimators.size(); ++e) text += EstimatorAsText(table, e);
  text += fmt::format(
      "Failure (kappa): the paper's flag, half or fewer of the consistent matches being left after the "
      "refinement; a dash\nwhere an estimator has none. Failure (truth): rotation error above {:g} or "
      "direction error above {:g} degrees, of pairs\nwhose motion is known. Refusals are no failures. apart: "
      "pairs of which no two have anything in common. A group's\ninterval is of these scenes, not of all "
      "scenes of the kind.\n\n",
      table.bounds.max_rotation_error_deg, table.bounds.max_direction_error_deg);
  return text + PrintedAsText();
}

std::string PaperTableAsCsv(const PaperTable& table) {
  std::string text = "source,scene,estimator,quantity,kind,value,lower,upper,n,count,apart,design_effect\n";
  for (const TableRow& row : table.rows) {
    for (size_t e = 0; e < table.estimators.size(); ++e) {
      for (const CellQuantity& quantity : kQuantities) {
        const SharedMemberRate& rate = row.cells[e].*quantity.rate;
        if (rate.n == 0) continue;
        text += fmt::format("run,{},{},{},rate,{},{},{},{},{},{},{}\n", CsvField(row.name),
                            CsvField(table.estimators[e]), quantity.name, CsvNumber(rate.rate),
                            CsvNumber(rate.interval.lower), CsvNumber(rate.interval.upper), rate.n,
                            rate.num_events, rate.num_apart, CsvNumber(rate.design_effect));
      }
    }
  }
  for (const PrintedRate& rate : PrintedRates()) {
    text += fmt::format("paper,{},{},{},rate,{},{},{},{},{},{},\n", rate.row, rate.method, QuantityOf(rate),
                        CsvNumber(static_cast<double>(rate.count) / static_cast<double>(rate.n)),
                        CsvNumber(rate.interval.lower), CsvNumber(rate.interval.upper), rate.n, rate.count,
                        rate.n);
  }
  return text;
}

std::string PaperTableAsJson(const PaperTable& table) {
  nlohmann::ordered_json json = {{"study", table.study},
                                 {"max_rotation_error_deg", table.bounds.max_rotation_error_deg},
                                 {"max_direction_error_deg", table.bounds.max_direction_error_deg},
                                 {"rates", nlohmann::ordered_json::array()},
                                 {"printed", nlohmann::ordered_json::array()}};
  for (const TableRow& row : table.rows) {
    for (size_t e = 0; e < table.estimators.size(); ++e) {
      for (const CellQuantity& quantity : kQuantities) {
        const SharedMemberRate& rate = row.cells[e].*quantity.rate;
        if (rate.n == 0) continue;
        json["rates"].push_back(
            {{"scene", row.name},
             {"is_group", row.is_group},
             {"estimator", table.estimators[e]},
             {"quantity", quantity.name},
             {"value", JsonNumber(rate.rate)},
             {"interval", {JsonNumber(rate.interval.lower), JsonNumber(rate.interval.upper)}},
             {"n", rate.n},
             {"count", rate.num_events},
             {"apart", rate.num_apart},
             {"design_effect", JsonNumber(rate.design_effect)}});
      }
    }
  }
  for (const PrintedRate& rate : PrintedRates()) {
    json["printed"].push_back({{"scene", rate.row},
                               {"method", rate.method},
                               {"quantity", QuantityOf(rate)},
                               {"value", static_cast<double>(rate.count) / static_cast<double>(rate.n)},
                               {"interval", {rate.interval.lower, rate.interval.upper}},
                               {"n", rate.n},
                               {"count", rate.count}});
  }
  return JsonText(kPaperTableFormat, json);
}

}  // namespace rcme
