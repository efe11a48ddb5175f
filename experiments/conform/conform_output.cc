#include "experiments/conform/conform_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>

#include "experiments/conform/conform_strata.h"
#include "experiments/conform/fit_rule.h"
#include "experiments/conform/region_kinds.h"
#include "experiments/conform/test_promises.h"
#include "experiments/core/table/interval_columns.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"
#include "experiments/statistics/coverage_strata_output.h"
#include "experiments/statistics/share_of_clusters.h"
#include "experiments/trial/truth_error.h"
#include "stats/clustered_estimate.h"
#include "stats/conformal.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/forecast.h"
#include "stats/median_ratio.h"
#include "stats/risk_control.h"

namespace rcme {
namespace {

using Judged = std::vector<JudgedAnswer>;

constexpr std::int64_t kFewAnswers = 30;  // fewer answers cannot show a moderate shift

const NumberFormat kShare{100.0, "%", ".1f", ".2g"};

// The share of answers for which `holds` is true, with an interval by groups. `more`: the groups of further
// problems, which count as false.
Estimate MeasureShare(const Judged& judged, const std::function<bool(const JudgedAnswer&)>& holds,
                      const std::vector<std::int64_t>& more = {}) {
  std::vector<bool> numbers(more.size(), false);
  std::vector<std::int64_t> groups = more;
  for (const JudgedAnswer& answer : judged) {
    numbers.push_back(holds(answer));
    groups.push_back(answer.row.group);
  }
  if (numbers.empty()) return {};
  const ClusteredShare share = MeasureShareOfClusters(numbers, groups);
  return {.value = share.value(), .interval = share.interval};
}

double MedianSize(const Judged& judged, const RegionKind& kind) {
  std::vector<double> sizes;
  for (const JudgedAnswer& answer : judged) sizes.push_back(kind.size_deg(answer));
  return ComputeMedian(std::move(sizes));
}

// The quarter of the answers that is hardest by its visible features: by difficulty, then by the number of
// agreeing matches.
Judged HardestQuarter(Judged judged) {
  const auto hardness = [](const JudgedAnswer& a) {
    const double agreeing = a.row.features[static_cast<size_t>(VisibleFeature::kAgreeing)];
    return std::pair(a.difficulty, std::isnan(agreeing) ? kInfinity : -agreeing);
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
  return MakeTable(columns, ListRegionKinds(report.is_check));
}

bool IsAcceptedByRule(const JudgedAnswer& answer) { return answer.verdict.is_accepted; }

// As the estimator of a conform file decides: it refuses strange answers too.
bool IsAcceptedInUse(const JudgedAnswer& answer) {
  return answer.verdict.is_accepted && answer.verdict.familiarity > kStrangeLevel;
}

// A share of all problems, refused ones included, as in the promise.
Estimate MeasureWrongAndAccepted(const ConformReport& report,
                                 const std::function<bool(const JudgedAnswer&)>& accepts) {
  std::vector<std::int64_t> refused;
  for (const AskedProblem& problem : report.problems)
    if (problem.is_refused) refused.push_back(problem.group);
  return MeasureShare(
      report.judged, [&](const JudgedAnswer& a) { return a.row.is_wrong && accepts(a); }, refused);
}

struct AcceptKind {
  std::string name;
  std::function<bool(const JudgedAnswer&)> accepts;
};

Table MakeAcceptTable(const ConformReport& report) {
  std::vector<AcceptKind> kinds = {{"all", [](const JudgedAnswer&) { return true; }}};
  if (!report.is_check)
    kinds.push_back({"by matches", [](const JudgedAnswer& a) { return a.is_accepted_by_count; }});
  kinds.push_back({"by the rule", IsAcceptedByRule});
  kinds.push_back({"in use", IsAcceptedInUse});
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
      {Column::Estimated("wrong_of_problems", kShare),
       [&](const AcceptKind& kind) { return MeasureWrongAndAccepted(report, kind.accepts); }},
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

// Explains what the intervals of a cross-validation estimate (cross_validate.h); empty for a check.
std::string DescribeRules(const ConformReport& report) {
  if (report.is_check || report.judged.empty()) return "";
  const auto [least, greatest] = std::ranges::minmax_element(report.judged, {}, &JudgedAnswer::rule_accepts);
  return FormatParagraph(
      fmt::format("Each answer is judged by the rule of one fold, and the intervals are of the mean of these "
                  "rules for new "
                  "problems. The rule of the file is another one: those of the folds accept from {:.1f} to "
                  "{:.1f} % of the "
                  "answers. What the file's own rule does is measured by --check on new problems.",
                  100.0 * least->rule_accepts, 100.0 * greatest->rule_accepts));
}

std::string Counted(std::int64_t n, const std::string& one, const std::string& many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

std::string DescribeGroups(const ConformOrigin& origin) {
  return fmt::format("{}, {}", Counted(origin.num_answers, "answer", "answers"),
                     origin.new_groups
                         ? Counted(origin.num_groups, "condition or scene", "conditions or scenes")
                         : Counted(origin.num_groups, "independent problem", "independent problems"));
}

std::string DescribeShift(const ShiftFinding& shift, const ConformRule& rule) {
  const std::string looked = Counted(shift.num_looked_at, "answer", "answers");
  std::string text =
      shift.noticed_after ? fmt::format(
                                "Shift: these problems are not like those of the calibration (p = {:.2g}, "
                                "noticed after {} of {}; "
                                "what differs most: {}). None of the promises is for them.",
                                shift.p_value, *shift.noticed_after, looked, shift.feature)
      : !shift.could_notice ? fmt::format("Whether there is a shift cannot be told: {} are too few.", looked)
                            : fmt::format("No shift is seen in {} (p = {:.2g}).", looked, shift.p_value);
  if (!shift.noticed_after && shift.could_notice && shift.num_looked_at < kFewAnswers)
    text += " So few can show none but a great one.";
  text += fmt::format(" Called strange are {:.1f} %, {:.0f} % if nothing differs.",
                      100.0 * shift.strange_share, 100.0 * kStrangeLevel);
  if (rule.origin.new_groups) text += " One answer of each condition or scene is looked at.";
  return text;
}

std::string ShareAsText(const Estimate& share) {
  return fmt::format("{:.1f} % [{:.1f}, {:.1f}]", 100.0 * share.value, 100.0 * share.interval.lower,
                     100.0 * share.interval.upper);
}

// Coverage of the stated and the conformed region if the covariance includes the error of the truth.
std::string DescribeCoverageByTruth(const Judged& judged) {
  Judged moved = judged;
  for (JudgedAnswer& answer : moved) {
    if (!std::isnan(answer.row.nees_of_inexact_truth)) answer.row.nees = answer.row.nees_of_inexact_truth;
  }
  std::string text;
  for (const RegionKind& kind : ListRegionKinds(/*is_check=*/true))
    text += fmt::format("{}{} {:.1f} % instead of {:.1f} %", text.empty() ? "" : ", ", kind.name,
                        100.0 * MeasureShare(moved, kind.covers).value,
                        100.0 * MeasureShare(judged, kind.covers).value);
  return text;
}

// Empty where every truth is exact.
std::string DescribeTruth(const ConformReport& report) {
  if (!report.has_real_truth || report.judged.empty()) return "";
  const std::string text =
      "The truth of real pairs is taken as exact: its errors count as errors of the estimator.";
  const auto num_inexact = std::ranges::count_if(
      report.judged, [](const JudgedAnswer& a) { return !std::isnan(a.row.nees_of_inexact_truth); });
  if (num_inexact == 0) return FormatParagraph(text + " How good it is, no pair says (truth_sd).");
  const auto num_open =
      std::ranges::count_if(report.judged, [](const JudgedAnswer& a) { return a.row.is_wrong_by_truth; });
  return FormatParagraph(fmt::format(
      "{} With its own error (truth_sd, of {} of {} answers) in the covariances the regions would cover: {}. "
      "{} {:g} of its standard deviations from being wrong instead of right, or right instead of wrong.",
      text, num_inexact, report.judged.size(), DescribeCoverageByTruth(report.judged),
      Counted(num_open, "answer is within", "answers are within"), kTruthErrorSds));
}

// Begins with what is refuted, or says that nothing is.
std::vector<std::string> DescribeKept(const ConformReport& report) {
  const PromiseFinding& kept = *report.kept;
  const ConformRule& rule = report.rule;
  std::vector<std::string> sentences;
  if (kept.IsCoverageRefuted()) {
    const Estimate coverage = MeasureShare(report.judged, ListRegionKinds(true).back().covers);
    sentences.push_back(fmt::format(
        "The promise of the regions does not hold on these problems: coverage {} of a promised {:.3g} %, by "
        "regions of {:.2g} deg in the median (p = {:.2g}).",
        ShareAsText(coverage), 100.0 * rule.level, MedianSize(report.judged, ListRegionKinds(true).back()),
        kept.coverage_p_value));
  }
  if (kept.IsAcceptRefuted()) {
    const Estimate wrong = MeasureWrongAndAccepted(report, IsAcceptedByRule);
    sentences.push_back(fmt::format(
        "The promise of the accept rule does not hold on these problems: wrong and accepted are {} of them, "
        "promised are at most {:.3g} % (p = {:.2g}).",
        ShareAsText(wrong), 100.0 * rule.wrong_and_accepted, kept.accept_p_value));
  }
  if (!kept.IsAnyRefuted())
    sentences.push_back(fmt::format(
        "No promise is refuted: coverage p = {:.2g} by {}, wrong and accepted p = {:.2g} by {}.",
        kept.coverage_p_value, Counted(kept.num_answers, "answer", "answers"), kept.accept_p_value,
        rule.origin.new_groups ? Counted(kept.num_problems, "condition or scene", "conditions or scenes")
                               : Counted(kept.num_problems, "problem", "problems")));
  return sentences;
}

// The findings on promises and shift.
std::string DescribeVerdicts(const ConformReport& report) {
  std::string text;
  if (report.kept)
    for (const std::string& sentence : DescribeKept(report)) text += FormatParagraph(sentence);
  if (report.shift) text += FormatParagraph(DescribeShift(*report.shift, report.rule));
  return text.empty() ? text : text + "\n";
}

}  // namespace

std::vector<std::string> DescribePromises(const ConformRule& rule) {
  const ConformOrigin& origin = rule.origin;
  const std::string population = origin.new_groups
                                     ? "of a new condition or scene, drawn as those of the calibration were"
                                     : "of the conditions of the calibration, in their shares";
  const std::string strata =
      rule.factors.size() == 1
          ? ""
          : fmt::format(", also in each of {} strata of visible difficulty", rule.factors.size());
  std::vector<std::string> promises = {fmt::format(
      "Region: for another problem {}, the ellipsoid of the conformed covariance at {:.3g} % (chi-square, 5 "
      "degrees "
      "of freedom) contains the truth with probability at least {:.3g} %{}. It is an average over "
      "calibrations.",
      population, 100.0 * rule.level, 100.0 * rule.level, strata)};
  const auto num_all = std::ranges::count_if(rule.factors, [](double x) { return !std::isfinite(x); });
  if (num_all > 0)
    promises.push_back(
        rule.factors.size() == 1
            ? "No factor keeps that: the region is all motions."
            : fmt::format("In {} of the strata no factor keeps that: the region is all motions.", num_all));
  promises.push_back(
      rule.greatest_log_odds
          ? fmt::format(
                "Accept rule: at most {:.3g} % of such problems are answered wrongly (more than {:.3g} deg "
                "of "
                "rotation or {:.3g} deg of direction) and accepted. It holds for {:.3g} % of calibrations.",
                100.0 * rule.wrong_and_accepted, rule.max_rotation_error_deg, rule.max_direction_error_deg,
                100.0 * (1.0 - rule.risk))
          : fmt::format("Accept rule: none keeps wrong and accepted answers at {:.3g} % of the problems for "
                        "{:.3g} % of "
                        "calibrations; nothing is accepted. See rcme conform --needs.",
                        100.0 * rule.wrong_and_accepted, 100.0 * (1.0 - rule.risk)));
  promises.push_back(
      fmt::format("The calibration: {}. Only for problems exchangeable with these; `rcme conform --check` "
                  "tests whether new "
                  "ones are.",
                  DescribeGroups(origin)));
  return promises;
}

std::string DescribeNeeds(const ConformPromise& promise) {
  const auto with_training = [](std::int64_t n) {
    return static_cast<std::int64_t>(std::ceil(static_cast<double>(n) / (1.0 - kTrainedShare)));
  };
  const std::int64_t for_bound = FewestGroupsForBound(promise.level),
                     for_rule = FewestCertifyingTrials(promise.wrong_and_accepted, promise.risk),
                     mostly = TrialsToCertify(0.25 * promise.wrong_and_accepted, promise.wrong_and_accepted,
                                              promise.risk, 0.9);
  return FormatParagraph(fmt::format("Regions at {:.3g} %: {} answers, and {} for each stratum of difficulty "
                                     "once models are trained.",
                                     100.0 * promise.level, for_bound, with_training(3 * for_bound))) +
         FormatParagraph(
             fmt::format("Accept rule at {:.3g} %, risk {:.3g} %: {} problems if none is answered wrongly "
                         "and accepted; {} for "
                         "success in nine of ten calibrations if a quarter of what is allowed is.",
                         100.0 * promise.wrong_and_accepted, 100.0 * promise.risk, for_rule, mostly)) +
         FormatParagraph(fmt::format("Models are trained on three tenths of the problems, from {} answers "
                                     "on, and where the accept rule is "
                                     "within reach from {} on.",
                                     kLeastAnswers, with_training(for_rule))) +
         FormatParagraph(
             "Counted are independent problems: trials, or, where the promise is for new conditions or "
             "scenes, as "
             "many of these.");
}

std::string ConformAsText(const ConformReport& report, bool by_strata) {
  const ConformRule& rule = report.rule;
  const std::int64_t num_refusals = std::ranges::count(report.problems, true, &AskedProblem::is_refused);
  std::string text = DescribeVerdicts(report);
  text += FormatParagraph(fmt::format(
      "{}: {}, {}{}. {}", report.label, Counted(std::ssize(report.judged), "answer", "answers"),
      Counted(num_refusals, "refusal", "refusals"),
      report.num_unscored > 0
          ? fmt::format(", {} without a known truth", Counted(report.num_unscored, "trial", "trials"))
          : "",
      report.is_check ? "New answers, judged by the file:"
                      : "Cross-validated, each answer judged by a rule of other groups:"));
  if (report.judged.empty()) return text;
  text += DescribeTruth(report);
  for (const Table& table : {MakeRegionTable(report), MakeAcceptTable(report), MakeProbabilityTable(report)})
    text += "\n" + RenderText(table);
  text += "\n" +
          FormatParagraph(fmt::format(
              "size_deg: median of the geometric mean of the region's semi-axes; "
              "hardest: the {} answers that look "
              "hardest; all_motions: regions that exclude nothing. in use: by the rule and not strange, as "
              "an estimator of the file accepts. wrong_of_problems: wrong and accepted of all problems, also "
              "the refused ones, as it is promised; the other shares are of the answers. Intervals are 95 %.",
              (report.judged.size() + 3) / 4)) +
          DescribeRules(report) + "\n";
  for (const std::string& promise : DescribePromises(rule)) text += FormatParagraph(promise);
  if (report.shares_images)
    text += FormatParagraph(
        "Pairs of one scene share images and are counted as if they were independent: the promises say too "
        "much.");
  if (by_strata)
    text += "\n" + StrataAsText({"size_deg"}, MeasureConformStrata(report)) +
            DescribeStrata(StrataIntervals::kClusters);
  return text;
}

std::string ConformAsJson(const ConformReport& report, bool by_strata) {
  nlohmann::ordered_json json = {
      {"estimator", report.label},
      {"is_check", report.is_check},
      {"answers", report.judged.size()},
      {"refusals", std::ranges::count(report.problems, true, &AskedProblem::is_refused)},
      {"without_truth", report.num_unscored},
      {"level", report.rule.level},
      {"strata", report.rule.factors.size()},
      {"intervals_are_of", report.is_check ? "the rule of the file" : "the mean of the folds' rules"},
      {"promises", DescribePromises(report.rule)},
      {"regions", RenderJson(WithIntervalColumns(MakeRegionTable(report)))},
      {"accept", RenderJson(WithIntervalColumns(MakeAcceptTable(report)))},
      {"probabilities", RenderJson(WithIntervalColumns(MakeProbabilityTable(report)))}};
  if (report.shift) {
    const ShiftFinding& shift = *report.shift;
    json["shift"] = {{"answers", shift.num_looked_at},
                     {"could_notice", shift.could_notice},
                     {"p_value", shift.p_value},
                     {"noticed_after", shift.noticed_after ? nlohmann::ordered_json(*shift.noticed_after)
                                                           : nlohmann::ordered_json()},
                     {"feature", shift.feature},
                     {"strange_share", shift.strange_share}};
  }
  if (report.kept) {
    const PromiseFinding& kept = *report.kept;
    json["promise_test"] = {{"holds", !kept.IsAnyRefuted()},
                            {"answers", kept.num_answers},
                            {"coverage_p_value", kept.coverage_p_value},
                            {"problems", kept.num_problems},
                            {"wrong_and_accepted_p_value", kept.accept_p_value}};
  }
  if (by_strata) {
    const Table strata = MakeStrataTable("region", {"size_deg"}, MeasureConformStrata(report));
    json["by_strata"] = RenderJson(WithIntervalColumns(strata));
  }
  return JsonText(kConformReportFormat, json);
}

CommandResult MakeConformResult(const ConformReport& report, bool by_strata) {
  return {ConformAsText(report, by_strata), WithIntervalColumns(MakeRegionTable(report)),
          ConformAsJson(report, by_strata)};
}

}  // namespace rcme
