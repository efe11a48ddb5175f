#include "experiments/statistics/summary_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "experiments/core/text/columns.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"

namespace rcme {

std::string IntervalKindInWords(IntervalKind kind) {
  switch (kind) {
    case IntervalKind::kExact:
      return "exact 95 % (Clopper-Pearson)";
    case IntervalKind::kAnytimeValid:
      return "anytime-valid 95 % (confidence sequence)";
    case IntervalKind::kWeighted:
      return "weighted 95 % (Fay-Feuer, cautious upper end)";
    case IntervalKind::kBetting:
      return "anytime-valid 95 % (betting)";
    case IntervalKind::kLogStudent:
      return "approximate 95 % (Student on the logarithm)";
  }
  return "";
}

std::string IntervalKindsIn(const Summary& summary) {
  std::set<std::string> kinds;
  for (const SummaryRow& row : summary.rows) {
    if (row.kind == SummaryRow::Kind::kRate && row.estimator != kSceneLabel &&
        !row.quantity.ends_with("_flips"))
      kinds.insert(IntervalKindInWords(row.interval_kind));
  }
  return fmt::format("{}", fmt::join(kinds, " and "));
}

namespace {

bool HasKindOfInterval(const SummaryRow& row) {
  return row.kind != SummaryRow::Kind::kMean && row.kind != SummaryRow::Kind::kMedian;
}

// "12.34 % [10.10, 14.80]", "1.23 +- 0.04" or "1.23 [1.20, 1.31]"; with its n where that is not all of the
// trials, and a coverage with its verdict.
std::string CellText(const SummaryRow& row, std::int64_t num_trials) {
  if (row.n == 0) return "-";
  const std::string of = row.n == num_trials ? "" : fmt::format(" (n {})", row.n);
  if (row.interval_kind == IntervalKind::kWeighted) {
    return fmt::format("{:.3g} % +- {:.2g} [{:.2g}, {:.2g}]{}", 100.0 * row.value, 100.0 * row.standard_error,
                       100.0 * row.interval.lower, 100.0 * row.interval.upper, of);
  }
  if (HasKindOfInterval(row)) {
    const std::string verdict =
        row.coverage_verdict ? ": " + CoverageVerdictInWords(*row.coverage_verdict) : "";
    return fmt::format("{:.2f} % [{:.2f}, {:.2f}]{}{}", 100.0 * row.value, 100.0 * row.interval.lower,
                       100.0 * row.interval.upper, of, verdict);
  }
  if (row.kind == SummaryRow::Kind::kMedian) {
    const bool is_bounded = std::isfinite(row.interval.lower) && std::isfinite(row.interval.upper);
    return is_bounded ? fmt::format("{:.3g} [{:.3g}, {:.3g}]{}", row.value, row.interval.lower,
                                    row.interval.upper, of)
                      : fmt::format("{:.3g}{}", row.value, of);
  }
  if (std::isnan(row.standard_error))
    return fmt::format("{:.3g}{}", row.value, of);  // of one trial, or infinite
  return fmt::format("{:.3g} +- {:.2g}{}", row.value, row.standard_error, of);
}

// One word.
std::string IntervalKindName(IntervalKind kind) {
  switch (kind) {
    case IntervalKind::kExact:
      return "exact";
    case IntervalKind::kAnytimeValid:
      return "anytime_valid";
    case IntervalKind::kWeighted:
      return "weighted";
    case IntervalKind::kBetting:
      return "betting";
    case IntervalKind::kLogStudent:
      return "log_student";
  }
  return "";
}

// The last two columns: the verdict of a coverage, and how many trials would decide it.
std::string VerdictFields(const SummaryRow& row) {
  if (!row.coverage_verdict) return ",";
  const bool is_undecided = row.coverage_verdict->verdict == RegionVerdict::kUndecided;
  return fmt::format("{},{}", Name(row.coverage_verdict->verdict),
                     is_undecided ? CsvFinite(row.coverage_verdict->trials_to_decide) : "");
}

// How hard the problems were: one row per condition. Empty where nothing was measured.
std::string SeverityAsTable(const Summary& summary) {
  const std::vector<std::string> shown = {"impossible",          "image_coverage",   "inlier_clark_evans",
                                          "parallax_median_deg", "homography_share", "crb_rotation_deg",
                                          "crb_direction_deg"};
  std::vector<std::vector<std::string>> rows = {summary.factor_names};
  rows[0].insert(rows[0].end(), shown.begin(), shown.end());
  std::int64_t num_measured = 0;
  for (const SummaryRow& row : summary.rows) {
    if (row.estimator != kSceneLabel) continue;
    if (row.quantity == "impossible") {  // the first of each condition
      rows.push_back(row.levels);
      num_measured += row.n;
    }
    if (std::count(shown.begin(), shown.end(), row.quantity) > 0) rows.back().push_back(CellText(row, row.n));
  }
  if (num_measured == 0) return "";
  return fmt::format("The problems themselves (impossible: Cramer-Rao bound beyond a failure bound)\n\n{}\n",
                     FormatColumns(rows));
}

// One line per estimator whose effort is known.
std::string EffortsInWords(const Summary& summary) {
  std::string text;
  for (const auto& [label, effort] : summary.efforts) {
    if (!effort.empty()) text += fmt::format("  {}: {}\n", label, effort);
  }
  return text.empty() ? text : "Effort of a call:\n" + text;
}

// One row per condition and estimator with the shown quantities that there are.
std::string EstimatorsAsTable(const Summary& summary, const std::vector<std::string>& shown) {
  std::vector<std::vector<std::string>> rows = {summary.factor_names};
  rows[0].insert(rows[0].end(), {"estimator", "n"});
  const auto is_present = [&](const std::string& quantity) {
    return std::any_of(summary.rows.begin(), summary.rows.end(),
                       [&](const SummaryRow& row) { return row.quantity == quantity; });
  };
  for (const std::string& quantity : shown) {
    if (is_present(quantity)) rows[0].push_back(quantity);
  }
  std::int64_t num_trials = 0;
  for (const SummaryRow& row : summary.rows) {
    if (row.quantity == "not_scored") {  // the first quantity of each condition and estimator
      num_trials = row.n;
      rows.push_back(row.levels);
      rows.back().insert(rows.back().end(), {row.estimator, fmt::format("{}", row.n)});
    }
    if (std::count(shown.begin(), shown.end(), row.quantity) > 0 && row.estimator != kSceneLabel)
      rows.back().push_back(CellText(row, num_trials));
  }
  return FormatColumns(rows);
}

// The field's measures.
std::string AccuracyAsTable(const Summary& summary) {
  return fmt::format(
      "Accuracy (error: the greater of rotation and direction; a refusal is as wrong as can be)\n\n{}\n",
      EstimatorsAsTable(summary,
                        {"auc_5_deg", "auc_10_deg", "auc_20_deg", "maa_10_deg", "rotation_error_median_deg",
                         "direction_error_median_deg", "max_error_median_deg"}));
}

// The estimators of which a verdict depends on the sampler's seed, each with the condition where it does most
// often, and those of which none did.
std::string FlipsInWords(const Summary& summary) {
  std::vector<const SummaryRow*> most;  // one per estimator
  for (const SummaryRow& row : summary.rows) {
    if (row.quantity != "failure_flips" || row.n == 0) continue;
    const auto known = std::ranges::find(most, row.estimator, &SummaryRow::estimator);
    if (known == most.end()) {
      most.push_back(&row);
    } else if (row.value > (*known)->value) {
      *known = &row;
    }
  }
  std::string text;
  for (const SummaryRow* row : most) {
    std::vector<std::string> place;
    for (size_t f = 0; f < row->levels.size(); ++f)
      place.push_back(summary.factor_names[f] + " " + row->levels[f]);
    text +=
        fmt::format("  {}: {}{}\n", row->estimator,
                    row->value == 0.0 ? "no scene" : CellText(*row, row->n) + " of the scenes",
                    row->value == 0.0 || place.empty() ? "" : fmt::format(" at {}", fmt::join(place, ", ")));
  }
  return "Whether a motion fails depends on the sampler's seed, at most:\n" + text;
}

// What the scene and what the sampler decides; empty without repeats.
std::string SplitAsTable(const Summary& summary) {
  if (summary.repeats_per_scene == 1) return "";
  return fmt::format(
      "Scene and sampler: shares of the variance of a failure, and scenes with both outcomes ({} trials per "
      "scene)\n\n{}\n{}\n",
      summary.repeats_per_scene,
      EstimatorsAsTable(summary, {"failure_between_scenes", "failure_within_scenes", "failure_flips"}),
      FlipsInWords(summary));
}

}  // namespace

std::string SummaryAsTable(const Summary& summary) {
  std::string text =
      fmt::format("Study {}: {} of {} trials done\n\n{}\n", summary.study, summary.num_trials_done,
                  summary.num_trials_planned,
                  EstimatorsAsTable(summary, {"failure", "failure_or_refusal", "no_candidate",
                                              "other_refusal", "kappa_flag", "nees_coverage", "nees_median",
                                              "rotation_error_deg", "direction_error_deg", "time_ms"}));
  text += AccuracyAsTable(summary) + SplitAsTable(summary);
  text += SeverityAsTable(summary);
  text += fmt::format(
      "Rates with {} intervals; means of successes +- Monte-Carlo standard error;\n"
      "medians with distribution-free 95 % intervals; auc and maa with {} intervals\n",
      IntervalKindsIn(summary), IntervalKindInWords(IntervalKind::kBetting));
  if (summary.repeats_per_scene > 1) {
    text += fmt::format(
        "n is of scenes: rates, scores and means are of the means over a scene's {} trials, medians of its "
        "first.\nShares have {} intervals, scenes with both outcomes {}.\n",
        summary.repeats_per_scene, IntervalKindInWords(IntervalKind::kLogStudent),
        IntervalKindInWords(IntervalKind::kExact));
  }
  text +=
      "(n ...) where a number is not of all trials: without a known truth a motion neither fails nor "
      "succeeds.\n"
      "failure: motion beyond a bound. no_candidate: the paper's detect-fail. kappa_flag: the paper's own "
      "flag.\n"
      "nees_coverage: truth inside the reported 95 % region; covers: the whole interval within 95 +- 1 %, "
      "too\n"
      "narrow: wholly below, too wide: wholly above. nees_median: 4.35 expected.\n"
      "auc_T_deg: mean of max(0, 1 - error / T).\n"
      "maa_10_deg: mean share of errors up to 1, 2, ..., 10 deg. All quantities, those with refusals left\n"
      "out among them: --format csv or json.\n";
  if (!summary.truth_quality.empty()) text += summary.truth_quality + "\n";
  if (summary.num_retried > 0) {
    text += fmt::format("{} trials were run again because an answer was missing (rcme run --retry).\n",
                        summary.num_retried);
  }
  return text + EffortsInWords(summary);
}

std::string SummaryAsCsv(const Summary& summary) {
  std::string text = "study,condition,";
  for (const std::string& factor : summary.factor_names) text += CsvField(factor) + ",";
  text += "estimator,quantity,kind,value,lower,upper,standard_error,n,interval,verdict,trials_to_decide\n";
  for (const SummaryRow& row : summary.rows) {
    text += fmt::format("{},{},", CsvField(summary.study), row.condition);
    for (const std::string& level : row.levels) text += CsvField(level) + ",";
    const bool is_rate = row.kind == SummaryRow::Kind::kRate;
    const bool has_interval = row.kind != SummaryRow::Kind::kMean;
    const bool has_standard_error = is_rate ? row.interval_kind == IntervalKind::kWeighted : !has_interval;
    text += fmt::format(
        "{},{},{},{},{},{},{},{},{},{}\n", CsvField(row.estimator), row.quantity, KindName(row.kind),
        CsvNumber(row.value), has_interval ? CsvFinite(row.interval.lower) : "",
        has_interval ? CsvFinite(row.interval.upper) : "",
        has_standard_error ? CsvNumber(row.standard_error) : "", row.n,
        HasKindOfInterval(row) ? IntervalKindName(row.interval_kind) : "", VerdictFields(row));
  }
  return text;
}

std::string SummaryAsJson(const Summary& summary) {
  nlohmann::ordered_json json = {{"study", summary.study},
                                 {"trials_done", summary.num_trials_done},
                                 {"trials_planned", summary.num_trials_planned},
                                 {"repeats_per_scene", summary.repeats_per_scene},
                                 {"efforts", nlohmann::ordered_json(nlohmann::ordered_json::value_t::object)},
                                 {"rows", nlohmann::ordered_json::array()}};
  for (const auto& [label, effort] : summary.efforts) json["efforts"][label] = effort;
  if (!summary.truth_quality.empty()) json["truth"] = summary.truth_quality;
  if (summary.num_retried > 0) json["retried_trials"] = summary.num_retried;
  for (const SummaryRow& row : summary.rows) {
    nlohmann::ordered_json entry = {{"condition", row.condition}};
    for (size_t f = 0; f < row.levels.size(); ++f) entry["levels"][summary.factor_names[f]] = row.levels[f];
    entry["estimator"] = row.estimator;
    entry["quantity"] = row.quantity;
    entry["value"] = JsonNumber(row.value);
    entry["kind"] = KindName(row.kind);
    if (row.kind == SummaryRow::Kind::kMean) {
      entry["standard_error"] = JsonNumber(row.standard_error);
    } else {
      entry["interval"] = {JsonNumber(row.interval.lower), JsonNumber(row.interval.upper)};
    }
    if (HasKindOfInterval(row)) entry["interval_kind"] = IntervalKindName(row.interval_kind);
    entry["n"] = row.n;
    if (row.coverage_verdict) {
      entry["verdict"] = Name(row.coverage_verdict->verdict);
      entry["trials_to_decide"] = row.coverage_verdict->verdict == RegionVerdict::kUndecided
                                      ? JsonNumber(row.coverage_verdict->trials_to_decide)
                                      : nlohmann::ordered_json();
    }
    json["rows"].push_back(std::move(entry));
  }
  return JsonText(kSummaryFormat, json);
}

}  // namespace rcme
