#include "experiments/statistics/comparison_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/core/text/columns.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"

namespace rcme {
namespace {

// A test of no difference and the interval of the difference, as files call them and in words.
struct Method {
  std::string test, interval, test_in_words, interval_in_words;
};

Method MethodOf(ComparedKind kind, bool is_anytime_valid) {
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
Method MethodOf(const ComparisonRow& row) {
  const bool is_by_means = row.is_of_scenes && row.kind == ComparedKind::kEvent;
  return MethodOf(is_by_means ? ComparedKind::kScore : row.kind, row.is_anytime_valid);
}

// Of a person's table: "+1.20 [-0.30, +2.70]", in percentage points or degrees.
std::string DifferenceInWords(const ComparisonRow& row) {
  const double scale = row.kind == ComparedKind::kError ? 1.0 : 100.0;
  const std::string value = row.kind == ComparedKind::kError ? fmt::format("{:+.3g}", row.difference)
                                                             : fmt::format("{:+.2f}", scale * row.difference);
  if (!std::isfinite(row.interval.lower) || !std::isfinite(row.interval.upper)) return value;
  if (row.kind == ComparedKind::kError)
    return fmt::format("{} [{:+.3g}, {:+.3g}]", value, row.interval.lower, row.interval.upper);
  return fmt::format("{} [{:+.2f}, {:+.2f}]", value, scale * row.interval.lower, scale * row.interval.upper);
}

// Names and numbers of the counts of a kind.
std::vector<std::string> CountHeadings(ComparedKind kind, const std::string& reference) {
  switch (kind) {
    case ComparedKind::kEvent:
      return {"both", "estimator only", reference + " only", "neither"};
    case ComparedKind::kError:
      return {"greater", "less", "equal"};
    case ComparedKind::kScore:
      break;
  }
  return {};
}
std::vector<std::int64_t> Counts(const ComparisonRow& row) {
  const PairedCounts& c = row.counts;
  switch (row.kind) {
    case ComparedKind::kEvent:
      return {c.both, c.first_only, c.second_only, c.neither};
    case ComparedKind::kError:
      return {c.first_only, c.second_only, c.neither};
    case ComparedKind::kScore:
      break;
  }
  return {};
}

// One line of a person's table: levels, estimator, n, the counts, difference, p-values.
std::vector<std::string> Cells(const ComparisonRow& row) {
  std::vector<std::string> cells = row.levels;
  cells.insert(cells.end(), {row.estimator, fmt::format("{}", row.n)});
  for (const std::int64_t count : Counts(row)) cells.push_back(fmt::format("{}", count));
  if (row.n == 0) {
    cells.insert(cells.end(), {"-", "-", "-"});
  } else {
    cells.push_back(DifferenceInWords(row));
    cells.push_back(fmt::format("{:.3g}", row.p_value));
    cells.push_back(fmt::format("{:.3g}{}", row.holm_p_value, row.holm_p_value < 0.05 ? " *" : ""));
  }
  return cells;
}

std::string TableOf(const Compared& compared, const Comparison& comparison) {
  const std::vector<std::string> counts = CountHeadings(compared.kind, comparison.reference);
  std::vector<std::vector<std::string>> rows = {comparison.factor_names};
  rows[0].insert(rows[0].end(), {"estimator", "n"});
  rows[0].insert(rows[0].end(), counts.begin(), counts.end());
  rows[0].insert(rows[0].end(),
                 {compared.kind == ComparedKind::kError ? "median difference (deg)" : "difference (% points)",
                  "p", "Holm p"});
  for (const ComparisonRow& row : comparison.rows) {
    if (row.event == compared.name) rows.push_back(Cells(row));
  }
  return fmt::format("\n{}: {}\n\n{}", compared.name, compared.doc, FormatColumns(rows));
}

// What the numbers of a kind are; nothing where none is compared.
std::string Legend(ComparedKind kind, const Comparison& comparison) {
  const auto row = std::ranges::find(comparison.rows, kind, &ComparisonRow::kind);
  if (row == comparison.rows.end()) return "";
  const Method method = MethodOf(*row);
  const std::string tests = fmt::format("with {}.\np: {}.\n", method.interval_in_words, method.test_in_words);
  switch (kind) {
    case ComparedKind::kEvent:
      return fmt::format(
          "Events: counts of trials in which the event happened to both, to one only, to neither.\n"
          "Difference: rate of the estimator minus rate of {}, {}",
          comparison.reference, tests);
    case ComparedKind::kScore:
      return fmt::format("Scores: mean of the estimator minus mean of {}, {}", comparison.reference, tests);
    case ComparedKind::kError:
      return fmt::format(
          "Errors: counts of trials in which the estimator's error is greater, less, equal (two refusals\n"
          "are). Difference: median over the trials of its error minus that of {}, {}",
          comparison.reference, tests);
  }
  return "";
}

std::string CsvCount(const ComparisonRow& row, std::int64_t count) {
  return row.kind == ComparedKind::kScore ? "" : fmt::format("{}", count);
}

}  // namespace

std::string ComparisonAsTable(const Comparison& comparison) {
  std::string text =
      fmt::format("Study {} against {}: {} of {} trials done\n", comparison.study, comparison.reference,
                  comparison.num_trials_done, comparison.num_trials_planned);
  if (!comparison.caution.empty()) text += fmt::format("Caution: {}.\n", comparison.caution);
  for (const Compared& compared : comparison.compared) text += TableOf(compared, comparison);
  text += "\n";
  for (const ComparedKind kind : {ComparedKind::kEvent, ComparedKind::kScore, ComparedKind::kError})
    text += Legend(kind, comparison);
  if (!comparison.rows.empty() && comparison.rows.front().is_of_scenes) {
    text +=
        "Scenes are repeated: n counts them; differences are of the means over a scene's trials, of errors "
        "in "
        "its first.\n";
  }
  text += fmt::format(
      "Holm p: adjusted for all {} tests of this comparison (what is compared, estimators, conditions); * "
      "below 0.05.\n",
      std::ranges::count_if(comparison.rows, [](const ComparisonRow& row) { return row.n > 0; }));
  return text;
}

std::string ComparisonAsCsv(const Comparison& comparison) {
  std::string text = "study,condition,";
  for (const std::string& factor : comparison.factor_names) text += CsvField(factor) + ",";
  text +=
      "estimator,reference,event,n,both,estimator_only,reference_only,neither,risk_difference,lower,upper,"
      "p_mcnemar,p_holm,kind,p_value,test,interval\n";
  for (const ComparisonRow& row : comparison.rows) {
    const PairedCounts& c = row.counts;
    const Method method = MethodOf(row);
    text += fmt::format("{},{},", CsvField(comparison.study), row.condition);
    for (const std::string& level : row.levels) text += CsvField(level) + ",";
    text +=
        fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", CsvField(row.estimator),
                    CsvField(comparison.reference), row.event, row.n, CsvCount(row, c.both),
                    CsvCount(row, c.first_only), CsvCount(row, c.second_only), CsvCount(row, c.neither),
                    CsvNumber(row.difference), CsvFinite(row.interval.lower), CsvFinite(row.interval.upper),
                    method.test == "mcnemar" ? CsvNumber(row.p_value) : "", CsvNumber(row.holm_p_value),
                    Name(row.kind), CsvNumber(row.p_value), method.test, method.interval);
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
    const Method method = MethodOf(row);
    nlohmann::ordered_json entry = {{"condition", row.condition}};
    for (size_t f = 0; f < row.levels.size(); ++f) {
      entry["levels"][comparison.factor_names[f]] = row.levels[f];
    }
    const auto count = [&](std::int64_t of_pairs) {
      return row.kind == ComparedKind::kScore ? nlohmann::ordered_json() : nlohmann::ordered_json(of_pairs);
    };
    entry["estimator"] = row.estimator;
    entry["event"] = row.event;
    entry["kind"] = Name(row.kind);
    entry["n"] = row.n;
    entry["both"] = count(row.counts.both);
    entry["estimator_only"] = count(row.counts.first_only);
    entry["reference_only"] = count(row.counts.second_only);
    entry["neither"] = count(row.counts.neither);
    entry["risk_difference"] = JsonNumber(row.difference);
    entry["interval"] = {JsonNumber(row.interval.lower), JsonNumber(row.interval.upper)};
    entry["interval_kind"] = method.interval;
    entry["p_mcnemar"] = method.test == "mcnemar" ? JsonNumber(row.p_value) : nlohmann::ordered_json();
    entry["p_value"] = JsonNumber(row.p_value);
    entry["test"] = method.test;
    entry["p_holm"] = JsonNumber(row.holm_p_value);
    json["rows"].push_back(std::move(entry));
  }
  return JsonText(kComparisonFormat, json);
}

}  // namespace rcme
