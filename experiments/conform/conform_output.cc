#include "experiments/conform/conform_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"
#include "stats/clustered_estimate.h"
#include "stats/conformal.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/forecast.h"
#include "stats/intervals.h"
#include "stats/median_ratio.h"
#include "stats/risk_control.h"

namespace rcme {
namespace {

using Judged = std::vector<JudgedAnswer>;

constexpr double kWholeSpaceDeg = 180.0;
const NumberFormat kShare{100.0, "%", ".1f", ".2g"};

// A region of each answer: the factor of the stated covariance, or a ball.
struct RegionKind {
  std::string name;
  std::function<bool(const JudgedAnswer&)> covers;
  std::function<double(const JudgedAnswer&)> size_deg;  // geometric mean of the semi-axes
};

double SizeOf(const JudgedAnswer& answer, double factor) {
  const double radius = std::sqrt(factor * ChiSquareQuantile(5, answer.level));
  const double size_deg = kDegPerRad * radius * std::exp(answer.row.log_det / 10.0);
  return std::isfinite(factor) ? std::min(size_deg, kWholeSpaceDeg) : kWholeSpaceDeg;
}

RegionKind RegionOfFactor(const std::string& name, const std::function<double(const JudgedAnswer&)>& factor) {
  return {name,
          [factor](const JudgedAnswer& a) { return a.row.nees <= factor(a) * ChiSquareQuantile(5, a.level); },
          [factor](const JudgedAnswer& a) { return SizeOf(a, factor(a)); }};
}

std::vector<RegionKind> RegionKinds(bool is_check) {
  std::vector<RegionKind> kinds = {RegionOfFactor("stated", [](const JudgedAnswer&) { return 1.0; })};
  if (!is_check) {
    kinds.push_back({"one bound", [](const JudgedAnswer& a) { return a.row.max_error_deg <= a.ball_deg; },
                     [](const JudgedAnswer& a) { return std::min(a.ball_deg, kWholeSpaceDeg); }});
    kinds.push_back(RegionOfFactor("one factor", [](const JudgedAnswer& a) { return a.one_factor; }));
  }
  kinds.push_back(RegionOfFactor("conformed", [](const JudgedAnswer& a) { return a.verdict.factor; }));
  return kinds;
}

Estimate MeasureShare(const Judged& judged, const std::function<bool(const JudgedAnswer&)>& holds) {
  std::vector<double> numbers;
  std::vector<std::int64_t> groups;
  std::set<std::int64_t> different;
  std::int64_t count = 0;
  for (const JudgedAnswer& answer : judged) {
    const bool is_one = holds(answer);
    count += is_one;
    numbers.push_back(is_one ? 1.0 : 0.0);
    groups.push_back(answer.row.group);
    different.insert(answer.row.group);
  }
  const std::int64_t n = std::ssize(judged);
  if (n == 0) return {};
  const double share = static_cast<double>(count) / static_cast<double>(n);
  const Interval interval = std::ssize(different) == n
                                ? ExactBinomialInterval(count, n)
                                : MeasureBoundedClusteredMean(numbers, 1.0, groups).interval;
  return {.value = share, .interval = interval};
}

double MedianSize(const Judged& judged, const RegionKind& kind) {
  std::vector<double> sizes;
  for (const JudgedAnswer& answer : judged) sizes.push_back(kind.size_deg(answer));
  return MedianOf(std::move(sizes));
}

// The quarter of the answers that looks hardest at run time: by difficulty, where the rule has none by the
// number of agreeing matches.
Judged HardestQuarter(Judged judged) {
  const auto hardness = [](const JudgedAnswer& a) {
    return std::pair(a.difficulty, -a.row.features[static_cast<size_t>(VisibleFeature::kAgreeing)]);
  };
  std::ranges::stable_sort(
      judged, [&](const JudgedAnswer& a, const JudgedAnswer& b) { return hardness(a) > hardness(b); });
  judged.resize((judged.size() + 3) / 4);
  return judged;
}

Table MakeRegionTable(const ConformReport& report) {
  const Judged hardest = HardestQuarter(report.judged);
  const std::vector<ColumnOf<RegionKind>> columns = {
      {Column::Key("region"), [](const RegionKind& kind) { return kind.name; }},
      {Column::Estimated("coverage", kShare),
       [&](const RegionKind& kind) { return MeasureShare(report.judged, kind.covers); }},
      {Column::Estimated("hardest_quarter", kShare),
       [&](const RegionKind& kind) { return MeasureShare(hardest, kind.covers); }},
      {Column::Number("size_deg"), [&](const RegionKind& kind) { return MedianSize(report.judged, kind); }},
      {Column::Number("hardest_deg"), [&](const RegionKind& kind) { return MedianSize(hardest, kind); }},
      {Column::Number("all_motions", kShare), [&](const RegionKind& kind) {
         return MeasureShare(report.judged,
                             [&](const JudgedAnswer& a) { return kind.size_deg(a) >= kWholeSpaceDeg; })
             .value;
       }}};
  return MakeTable(columns, RegionKinds(report.is_check));
}

struct AcceptKind {
  std::string name;
  std::function<bool(const JudgedAnswer&)> accepts;
};

Table MakeAcceptTable(const ConformReport& report) {
  std::vector<AcceptKind> kinds = {{"all", [](const JudgedAnswer&) { return true; }}};
  if (!report.is_check)
    kinds.push_back({"by matches", [](const JudgedAnswer& a) { return a.is_accepted_by_count; }});
  kinds.push_back({"by the rule", [](const JudgedAnswer& a) { return a.verdict.is_accepted; }});
  const auto among = [&](const std::function<bool(const JudgedAnswer&)>& holds) {
    Judged some;
    std::ranges::copy_if(report.judged, std::back_inserter(some), holds);
    return some;
  };
  const std::vector<ColumnOf<AcceptKind>> columns = {
      {Column::Key("accepted"), [](const AcceptKind& kind) { return kind.name; }},
      {Column::Estimated("share", kShare),
       [&](const AcceptKind& kind) { return MeasureShare(report.judged, kind.accepts); }},
      {Column::Estimated("wrong_and_accepted", kShare),
       [&](const AcceptKind& kind) {
         return MeasureShare(report.judged,
                             [&](const JudgedAnswer& a) { return a.row.is_wrong && kind.accepts(a); });
       }},
      {Column::Estimated("wrong_among_accepted", kShare),
       [&](const AcceptKind& kind) {
         return MeasureShare(among(kind.accepts), [](const JudgedAnswer& a) { return a.row.is_wrong; });
       }},
      {Column::Estimated("accepted_among_right", kShare), [&](const AcceptKind& kind) {
         return MeasureShare(among([](const JudgedAnswer& a) { return !a.row.is_wrong; }), kind.accepts);
       }}};
  return MakeTable(columns, kinds);
}

struct ProbabilityKind {
  std::string name;
  std::vector<Forecast> forecasts;
};

Table MakeProbabilityTable(const ConformReport& report) {
  ProbabilityKind stated{"stated", {}}, corrected{"corrected", {}};
  bool is_stated = true;
  for (const JudgedAnswer& answer : report.judged) {
    const double log_odds = answer.row.features[static_cast<size_t>(VisibleFeature::kStatedOdds)];
    is_stated = is_stated && (!std::isnan(log_odds) || !std::isfinite(answer.row.max_error_deg));
    const double p = std::isnan(log_odds) ? 1.0 : 1.0 / (1.0 + std::exp(-log_odds));
    stated.forecasts.push_back({p, answer.row.is_wrong, answer.row.group});
    corrected.forecasts.push_back(
        {answer.verdict.failure_probability, answer.row.is_wrong, answer.row.group});
  }
  std::vector<ProbabilityKind> kinds;
  if (is_stated) kinds.push_back(std::move(stated));
  kinds.push_back(std::move(corrected));
  const auto estimate = [](const ClusteredEstimate& e) {
    return Estimate{.value = e.value, .interval = e.interval};
  };
  const std::vector<ColumnOf<ProbabilityKind>> columns = {
      {Column::Key("probability"), [](const ProbabilityKind& kind) { return kind.name; }},
      {Column::Number("mean", kShare),
       [](const ProbabilityKind& kind) {
         double sum = 0.0;
         for (const Forecast& forecast : kind.forecasts) sum += forecast.probability;
         return sum / static_cast<double>(kind.forecasts.size());
       }},
      {Column::Estimated("wrong", kShare),
       [&](const ProbabilityKind& kind) { return estimate(MeasureShareHappened(kind.forecasts)); }},
      {Column::Estimated("brier"),
       [&](const ProbabilityKind& kind) { return estimate(MeasureBrierScore(kind.forecasts)); }},
      {Column::Estimated("log_score"),
       [&](const ProbabilityKind& kind) { return estimate(MeasureLogScore(kind.forecasts)); }}};
  return MakeTable(columns, kinds);
}

// For files: the interval of each estimate in a column of its own.
Table WithIntervalColumns(const Table& table) {
  Table wide;
  wide.rows.resize(table.rows.size());
  for (size_t c = 0; c < table.columns.size(); ++c) {
    wide.columns.push_back(table.columns[c]);
    for (size_t r = 0; r < table.rows.size(); ++r) wide.rows[r].push_back(table.rows[r][c]);
    if (table.columns[c].type != ColumnType::kEstimate) continue;
    const std::string& name = table.columns[c].name;
    wide.columns.push_back({.name = fmt::format("{0}_lower,{0}_upper", name),
                            .type = ColumnType::kInterval,
                            .json_name = name + "_interval"});
    for (size_t r = 0; r < table.rows.size(); ++r)
      wide.rows[r].push_back(std::get<Estimate>(table.rows[r][c]).interval);
  }
  return wide;
}

std::string DescribeGroups(const ConformOrigin& origin) {
  return origin.new_groups
             ? fmt::format("{} answers in {} conditions or scenes", origin.num_answers, origin.num_groups)
             : fmt::format("{} answers, {} of them independent", origin.num_answers, origin.num_groups);
}

std::string DescribeShift(const ShiftFinding& shift, const ConformRule& rule) {
  std::string text =
      shift.noticed_after
          ? fmt::format(
                "Shift: these problems are not like those of the calibration (p = {:.2g}, noticed after {} "
                "of {} "
                "answers; {} differs most). None of the promises above is for them.",
                shift.p_value, *shift.noticed_after, shift.num_looked_at, shift.feature)
          : fmt::format("No shift is seen in {} answers (p = {:.2g}).", shift.num_looked_at, shift.p_value);
  text += fmt::format(" Called strange are {:.1f} %, {:.0f} % if nothing differs.",
                      100.0 * shift.strange_share, 100.0 * kStrangeLevel);
  if (rule.origin.new_groups) text += " One answer of each condition or scene is looked at.";
  return text;
}

}  // namespace

std::vector<std::string> DescribePromises(const ConformRule& rule) {
  const ConformOrigin& origin = rule.origin;
  const std::string population =
      origin.new_groups ? "a problem of a new condition or scene, drawn as those of the calibration were"
                        : "another problem of the conditions of the calibration, in their shares";
  std::vector<std::string> promises = {
      fmt::format("Region: the ellipsoid of the conformed covariance at {:.3g} % (chi-square, 5 degrees of "
                  "freedom) holds the truth "
                  "with probability at least {:.3g} %, in each of {} strata of visible difficulty, for {}.",
                  100.0 * rule.level, 100.0 * rule.level, rule.factors.size(), population)};
  const auto num_all = std::ranges::count_if(rule.factors, [](double x) { return !std::isfinite(x); });
  if (num_all > 0)
    promises.push_back(
        fmt::format("In {} of the strata no factor keeps that: the region is all motions.", num_all));
  promises.push_back(
      rule.greatest_log_odds
          ? fmt::format("Accept rule: wrong and accepted are at most {:.3g} % of the answers (more than "
                        "{:.3g} deg of "
                        "rotation or {:.3g} deg of direction), with confidence {:.3g} % over calibrations.",
                        100.0 * rule.wrong_and_accepted, rule.max_rotation_error_deg,
                        rule.max_direction_error_deg, 100.0 * (1.0 - rule.risk))
          : fmt::format(
                "Accept rule: none keeps wrong and accepted answers at {:.3g} % at confidence {:.3g} %; "
                "nothing is accepted. See rcme conform --needs.",
                100.0 * rule.wrong_and_accepted, 100.0 * (1.0 - rule.risk)));
  promises.push_back(
      fmt::format("Both hold on average over calibrations such as this one ({}), and only for problems "
                  "exchangeable with it; "
                  "`rcme conform --check` tests whether new ones are.",
                  DescribeGroups(origin)));
  return promises;
}

std::string DescribeNeeds(const ConformPromise& promise) {
  const auto with_training = [](std::int64_t n) {
    return static_cast<std::int64_t>(std::ceil(static_cast<double>(n) / (1.0 - kTrainedShare)));
  };
  const std::int64_t for_bound = FewestGroupsForBound(promise.level),
                     for_rule = FewestCertifyingTrials(promise.wrong_and_accepted, promise.risk);
  return FormatParagraph(
             fmt::format("Regions at {:.3g} %: {} answers, and {} for each stratum of difficulty.",
                         100.0 * promise.level, for_bound, with_training(3 * for_bound))) +
         FormatParagraph(fmt::format("Accept rule at {:.3g} %, risk {:.3g} %: {} answers of which none is "
                                     "wrong and accepted, {} once "
                                     "models are trained (from {} answers on); more where some are.",
                                     100.0 * promise.wrong_and_accepted, 100.0 * promise.risk, for_rule,
                                     with_training(for_rule), kLeastAnswers)) +
         FormatParagraph(
             "Counted are independent answers: trials, or, where the promise is for new conditions or "
             "scenes, as "
             "many of these.");
}

std::string ConformAsText(const ConformReport& report) {
  const ConformRule& rule = report.rule;
  std::string text = FormatParagraph(fmt::format(
      "{}: {} answers, {} refusals{}. {}", report.label, report.judged.size(), report.num_refusals,
      report.num_unscored > 0 ? fmt::format(", {} trials without a known truth", report.num_unscored) : "",
      report.is_check ? "New answers, judged by the file:"
                      : "Cross-validated, each answer judged by a rule of other groups:"));
  for (const Table& table : {MakeRegionTable(report), MakeAcceptTable(report), MakeProbabilityTable(report)})
    text += "\n" + RenderText(table);
  text +=
      "\n" +
      FormatParagraph(fmt::format("size_deg: median of the geometric mean of the region's semi-axes; "
                                  "hardest: the {} answers that look "
                                  "hardest; all_motions: regions that exclude nothing. Intervals are 95 %.",
                                  (report.judged.size() + 3) / 4)) +
      "\n";
  for (const std::string& promise : DescribePromises(rule)) text += FormatParagraph(promise);
  if (report.shift) text += FormatParagraph(DescribeShift(*report.shift, rule));
  return text;
}

std::string ConformAsJson(const ConformReport& report) {
  nlohmann::ordered_json json = {
      {"estimator", report.label},
      {"is_check", report.is_check},
      {"answers", report.judged.size()},
      {"refusals", report.num_refusals},
      {"without_truth", report.num_unscored},
      {"level", report.rule.level},
      {"strata", report.rule.factors.size()},
      {"promises", DescribePromises(report.rule)},
      {"regions", RenderJson(WithIntervalColumns(MakeRegionTable(report)))},
      {"accept", RenderJson(WithIntervalColumns(MakeAcceptTable(report)))},
      {"probabilities", RenderJson(WithIntervalColumns(MakeProbabilityTable(report)))}};
  if (report.shift) {
    const ShiftFinding& shift = *report.shift;
    json["shift"] = {{"answers", shift.num_looked_at},
                     {"p_value", shift.p_value},
                     {"noticed_after", shift.noticed_after ? nlohmann::ordered_json(*shift.noticed_after)
                                                           : nlohmann::ordered_json()},
                     {"feature", shift.feature},
                     {"strange_share", shift.strange_share}};
  }
  return JsonText(kConformReportFormat, json);
}

}  // namespace rcme
