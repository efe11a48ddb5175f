#include "experiments/statistics/summary_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/core/text/pick_name.h"
#include "experiments/statistics/population_summary.h"
#include "experiments/statistics/preregistration_output.h"
#include "experiments/statistics/quantity_table.h"
#include "experiments/study/run_description.h"
#include "peers/outside_answer.h"

namespace rcme {

std::string DescribeIntervalKind(IntervalKind kind) {
  return PickName(kind,
                  {"exact 95 % (Clopper-Pearson)", "anytime-valid 95 % (confidence sequence)",
                   "weighted 95 % (Fay-Feuer, cautious upper end)", "anytime-valid 95 % (betting)",
                   "approximate 95 % (Student on the logarithm)", "95 % of the population, over its draws"});
}

std::string IntervalKindsIn(const Summary& summary) {
  std::set<IntervalKind> kinds;
  for (const SummaryRow& row : summary.rows) {
    if (row.kind == SummaryRow::Kind::kRate && row.estimator != kSceneLabel && !row.is_of_split)
      kinds.insert(row.interval_kind);
  }
  std::set<std::string> texts;
  for (const IntervalKind kind : kinds) texts.insert(DescribeIntervalKind(kind));
  return fmt::format("{}", fmt::join(texts, " and "));
}

namespace {

// The kinds that are shown in per cent.
bool IsShare(SummaryRow::Kind kind) {
  return kind != SummaryRow::Kind::kMean && kind != SummaryRow::Kind::kMedian &&
         kind != SummaryRow::Kind::kArea;
}

// Returns the name of an interval kind as one word.
std::string IntervalKindName(IntervalKind kind) {
  return PickName(kind, {"exact", "anytime_valid", "weighted", "betting", "log_student", "population"});
}

bool HasStandardError(const SummaryRow& row) {
  const bool is_rate = row.kind == SummaryRow::Kind::kRate;
  if (is_rate) return row.interval_kind == IntervalKind::kWeighted;
  return row.kind == SummaryRow::Kind::kMean || row.kind == SummaryRow::Kind::kArea;
}

// NaN if the verdict is known or no number of trials can decide it.
double TrialsToDecide(const CoverageVerdict& verdict) {
  const bool is_known =
      verdict.verdict == RegionVerdict::kUndecided && std::isfinite(verdict.trials_to_decide);
  return is_known ? verdict.trials_to_decide : std::nan("");
}

PopulationPart PartOfPopulation(const SummaryRow& row) {
  return row.of_population ? *row.of_population : PopulationPart();
}

// The columns of a table with a row for every quantity. `summary` must outlive them.
std::vector<ColumnOf<SummaryRow>> MakeRowColumns(const Summary& summary) {
  using R = const SummaryRow&;
  std::vector<ColumnOf<SummaryRow>> columns = {
      {{.name = "study", .json_name = kNotInJson}, [&](R) { return summary.study; }},
      {{"condition", ColumnType::kCount}, [](R r) { return std::int64_t{r.condition}; }}};
  const auto levels_of = [&](R r) -> const auto& { return summary.levels.at(r.condition); };
  for (const ColumnOf<SummaryRow>& level : LevelColumns<SummaryRow>(summary.factor_names, levels_of))
    columns.push_back(level);
  const std::vector<ColumnOf<SummaryRow>> others = {
      {{"estimator"}, [](R r) { return r.estimator.text(); }},
      {{"quantity"}, [](R r) { return r.quantity.text(); }},
      {{"kind"}, [](R r) { return KindName(r.kind); }},
      {{"value", ColumnType::kNumber}, [](R r) { return r.value; }},
      {{"lower,upper", ColumnType::kInterval},
       [](R r) { return r.kind == SummaryRow::Kind::kMean ? Value() : Value(r.interval); }},
      {{"standard_error", ColumnType::kNumber},
       [](R r) { return HasStandardError(r) ? Value(r.standard_error) : Value(); }},
      {{"n", ColumnType::kCount}, [](R r) { return r.n; }},
      {{.name = "interval", .json_name = "interval_kind"},
       [](R r) { return IsShare(r.kind) ? Value(IntervalKindName(r.interval_kind)) : Value(); }},
      {{"verdict"},
       [](R r) {
         return r.coverage_verdict ? Value(std::string(Name(r.coverage_verdict->verdict))) : Value();
       }},
      {{"trials_to_decide", ColumnType::kNumber},
       [](R r) { return r.coverage_verdict ? Value(TrialsToDecide(*r.coverage_verdict)) : Value(); }}};
  columns.insert(columns.end(), others.begin(), others.end());
  if (summary.is_of_population) {
    columns.push_back(
        {{"effective_n", ColumnType::kNumber}, [](R r) { return PartOfPopulation(r).effective_n; }});
    columns.push_back({{.name = "these_lower,these_upper",
                        .type = ColumnType::kInterval,
                        .json_name = "interval_of_these_conditions"},
                       [](R r) {
                         return r.kind == SummaryRow::Kind::kMean
                                    ? Value()
                                    : Value(PartOfPopulation(r).of_these_conditions);
                       }});
  }
  return columns;
}

// Returns a line per estimator whose effort is known.
std::string DescribeEfforts(const Summary& summary) {
  std::string text;
  for (const auto& [label, effort] : summary.efforts) {
    if (!effort.empty()) text += fmt::format("  {}: {}\n", label, effort);
  }
  return text.empty() ? text : "Effort of a call:\n" + text;
}

// The usual measures of accuracy.
std::string FormatAccuracy(const Summary& summary) {
  return fmt::format(
      "Accuracy (error: the greater of rotation and direction; a refusal has the\ngreatest)\n\n{}\n",
      RenderQuantityTable(summary,
                          {"auc_5_deg", "auc_10_deg", "auc_20_deg", "maa_10_deg", "rotation_error_median_deg",
                           "direction_error_median_deg", "max_error_median_deg"}));
}

bool HasErrorRanking(const Summary& summary) {
  return std::ranges::any_of(summary.rows,
                             [](const SummaryRow& row) { return row.kind == SummaryRow::Kind::kArea; });
}

// The ranking of errors by stated uncertainty; empty if no uncertainty is stated, and for counts.
std::string FormatErrorRanking(const Summary& summary) {
  if (!HasErrorRanking(summary)) return "";
  return fmt::format(
      "Ranking of errors by the stated sd (AUSE: area between the sparsification curves\n"
      "of this order and of the oracle's, by the errors themselves, over the mean\n"
      "error; 0 best. random: of a random order)\n\n{}\n",
      RenderText(MakeQuantityTable(
          summary, {"rotation_ause", "rotation_ause_random", "direction_ause", "direction_ause_random"})));
}

// Names the estimators whose outcome depends on the sampler's seed, each with the condition where it depends
// most, and those for which it never does.
std::string DescribeFlips(const Summary& summary) {
  std::vector<const SummaryRow*> most;  // one per estimator
  for (const SummaryRow& row : summary.rows) {
    if (row.quantity != "failure_flips" || row.n == 0) continue;
    const auto known =
        std::ranges::find_if(most, [&](const SummaryRow* of) { return of->estimator == row.estimator; });
    if (known == most.end()) {
      most.push_back(&row);
    } else if (row.value > (*known)->value) {
      *known = &row;
    }
  }
  std::string text;
  for (const SummaryRow* row : most) {
    std::vector<std::string> place;
    for (size_t f = 0; f < summary.factor_names.size(); ++f)
      place.push_back(summary.factor_names[f] + " " + summary.levels.at(row->condition).at(f));
    text += fmt::format(
        "  {}: {}{}\n", row->estimator.text(),
        row->value == 0.0 ? "no scene"
                          : FormatEstimate(MakeEstimate(*row, row->n), kPercent) + " of the scenes",
        row->value == 0.0 || place.empty() ? "" : fmt::format(" at {}", fmt::join(place, ", ")));
  }
  return "Whether a motion fails depends on the sampler's seed, at most:\n" + text;
}

// The difficulty of the problems; empty if it was not measured.
std::string FormatSeverity(const Summary& summary) {
  const bool is_measured = std::ranges::any_of(
      summary.rows, [](const SummaryRow& row) { return row.estimator == kSceneLabel && row.n > 0; });
  if (!is_measured) return "";
  return fmt::format("The problems themselves (impossible: Cramer-Rao bound beyond a failure bound)\n\n{}\n",
                     RenderProblemTable(summary, {"impossible", "image_coverage", "inlier_clark_evans",
                                                  "parallax_median_deg", "homography_share",
                                                  "crb_rotation_deg", "crb_direction_deg"}));
}

// The split between scene and sampler; empty without repeats.
std::string FormatSplit(const Summary& summary) {
  if (summary.repeats_per_scene == 1) return "";
  return fmt::format(
      "Scene and sampler: shares of the variance of a failure, and scenes with both\n"
      "outcomes ({} trials per scene)\n\n{}\n{}\n",
      summary.repeats_per_scene,
      RenderQuantityTable(summary, {"failure_between_scenes", "failure_within_scenes", "failure_flips"}),
      DescribeFlips(summary));
}

// Explains the intervals for a population, with the effective number of trials of the failure rates.
std::string FormatPopulation(const Summary& summary) {
  std::vector<double> effective;
  for (const SummaryRow& row : summary.rows)
    if (row.quantity == "failure" && std::isfinite(PartOfPopulation(row).effective_n))
      effective.push_back(row.of_population->effective_n);
  std::string text =
      "All intervals are 95 % of the population that the conditions are a sample of, so\n"
      "are the standard errors of means. Trials of one condition are alike";
  if (!effective.empty()) {
    const auto [least, greatest] = std::ranges::minmax(effective);
    text += fmt::format(":\n{:.0f} to {:.0f} independent trials would tell as much of the rates of failure",
                        least, greatest);
  }
  return text + ".\n--format csv holds effective_n and the intervals of these very conditions.\n";
}

// The study, its progress, and these quantities.
std::string FormatQuantities(const Summary& summary, const std::vector<std::string>& quantities) {
  return fmt::format(
      "Study {}: {}\n\n{}\n", summary.study,
      DescribeProgress(summary.num_trials_done, summary.num_trials_planned, summary.is_target_open),
      RenderQuantityTable(summary, quantities));
}

// Explains the intervals of the tables.
std::string DescribeIntervals(const Summary& summary) {
  std::string text =
      summary.is_of_population
          ? FormatPopulation(summary)
          : fmt::format(
                "Rates: intervals {}.\n"
                "Means of successes: +- Monte-Carlo standard error. Medians: distribution-free\n"
                "95 % intervals; of an even n the lower of the two middle numbers.\n"
                "auc and maa: {}.\n",
                IntervalKindsIn(summary), DescribeIntervalKind(IntervalKind::kBetting));
  if (summary.is_of_these_draws) text += kOfTheseDraws;
  if (HasErrorRanking(summary) && !summary.is_of_population)
    text += "ause: Student's 95 % intervals, each scene a cluster.\n";
  if (summary.repeats_per_scene > 1) {
    text += fmt::format(
        "n counts scenes: rates, scores and means are of the means over a scene's\n"
        "{} trials, medians of its first. Intervals of shares: {}; of scenes with both\n"
        "outcomes: {}.\n",
        summary.repeats_per_scene, DescribeIntervalKind(IntervalKind::kLogStudent),
        DescribeIntervalKind(IntervalKind::kExact));
  }
  return text;
}

std::vector<std::string> ChooseQuantities(const Summary& summary) {
  return AddSharpness(
      summary, {"failure", "failure_or_refusal", "no_candidate", "other_refusal", "kappa_flag",
                "nees_coverage", "nees_median", "energy_score_deg", "log_score", "available", "misleading",
                "rotation_error_deg", "direction_error_deg", "time_ms"});
}

}  // namespace

std::string QuantitiesAsTable(const Summary& summary, const std::vector<std::string>& quantities) {
  CheckAreQuantities(summary, quantities);
  return FormatQuantities(summary, quantities) + DescribeIntervals(summary);
}

std::string SummaryAsTable(const Summary& summary) {
  std::string text = summary.preregistration ? PreregistrationAsText(*summary.preregistration) + "\n" : "";
  text += FormatQuantities(summary, ChooseQuantities(summary));
  text += FormatAccuracy(summary) + FormatErrorRanking(summary) + FormatSplit(summary) +
          FormatSeverity(summary) + DescribeIntervals(summary);
  text +=
      "(n ...): the trials of a number that is not of all of them; without a known\n"
      "truth a motion neither fails nor succeeds.\n"
      "failure: motion beyond a bound. no_candidate: the paper's detect-fail.\n"
      "kappa_flag: the paper's own flag.\n"
      "nees_coverage: truth inside the reported 95 % region. covers: the whole\n"
      "interval is within 95 +- 1 %; too narrow: below it; too wide: above it.\n"
      "sd_over_crb: sharpness, the stated sd over its Cramer-Rao bound; not right below\n"
      "1; rotation_sd_deg, direction_sd_deg: the stated sd, where no bound is known.\n"
      "energy_score_deg, log_score: of the stated density, the less the better. The\n"
      "second leaves out singular_covariance (in --format csv).\n"
      "available: protection levels at the risk 0.01 within the failure bounds;\n"
      "misleading: an error beyond its level, at most 2 % where levels hold (rcme\n"
      "integrity: other risks).\n"
      "nees_median: 4.35 expected. auc_T_deg: mean of max(0, 1 - error / T).\n"
      "maa_10_deg: mean share of errors up to 1, 2, ..., 10 deg. --format csv and json\n"
      "hold all quantities, also those that leave refusals out.\n";
  if (!summary.truth_quality.empty()) text += summary.truth_quality + "\n";
  if (!summary.population.empty()) text += summary.population + "\n";
  if (summary.num_conditions_not_simulated > 0) {
    text += FormatParagraph(
        fmt::format("{} of {} conditions have no trial that counts: the simulator cannot make them ({}). The "
                    "warning of `rcme run` counts the reasons.",
                    summary.num_conditions_not_simulated, summary.num_conditions_with_trials,
                    StatusName(MotionStatus::kNotSimulated)));
  }
  if (!summary.outside.empty()) {
    text += FormatParagraph(fmt::format("{}: where an answer states none, the coverage is of a {}.",
                                        fmt::join(summary.outside, ", "), kCovarianceOfRcme));
  }
  if (summary.num_retried > 0) {
    text += fmt::format("{} trials were run again because an answer was missing (rcme run --retry).\n",
                        summary.num_retried);
  }
  return text + DescribeEfforts(summary);
}

std::string SummaryAsCsv(const Summary& summary) {
  std::string text;
  WriteSummaryCsv(summary, [&](const std::string& piece) { text += piece; });
  return text;
}

std::string SummaryAsJson(const Summary& summary) {
  std::string text;
  WriteSummaryJson(summary, [&](const std::string& piece) { text += piece; });
  return text;
}

void WriteSummaryCsv(const Summary& summary, const WriteText& write) {
  WriteCsv(MakeRowColumns(summary), summary.rows, write);
}

void WriteSummaryJson(const Summary& summary, const WriteText& write) {
  nlohmann::ordered_json json = {{"study", summary.study},
                                 {"trials_done", summary.num_trials_done},
                                 {"trials_planned", summary.num_trials_planned},
                                 {"repeats_per_scene", summary.repeats_per_scene},
                                 {"efforts", nlohmann::ordered_json::object()},
                                 {"rows", nlohmann::ordered_json::array()}};
  for (const auto& [label, effort] : summary.efforts) json["efforts"][label] = effort;
  if (!summary.truth_quality.empty()) json["truth"] = summary.truth_quality;
  if (!summary.population.empty()) json["population"] = summary.population;
  if (summary.num_retried > 0) json["retried_trials"] = summary.num_retried;
  if (summary.preregistration) json["preregistration"] = PreregistrationAsJson(*summary.preregistration);
  constexpr size_t kRowsAtOnce = 1000;
  const std::vector<ColumnOf<SummaryRow>> columns = MakeRowColumns(summary);
  std::span<const SummaryRow> left = summary.rows;
  const auto next_rows = [&] {
    const std::span<const SummaryRow> some = left.first(std::min(kRowsAtOnce, left.size()));
    left = left.subspan(some.size());
    return RenderJson(MakeTable(columns, some));
  };
  WriteJson(kSummaryFormat, json, "rows", next_rows, write);
}

}  // namespace rcme
