#include "experiments/conform/conform_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/conform/conform_tables.h"
#include "experiments/conform/fit_rule.h"
#include "experiments/conform/test_promises.h"
#include "experiments/core/text/columns.h"
#include "experiments/trial/truth_error.h"
#include "stats/conformal.h"
#include "stats/risk_control.h"

namespace rcme {
namespace {

using Judged = std::vector<JudgedAnswer>;

constexpr std::int64_t kFewAnswers = 30;  // fewer answers cannot show a moderate shift

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
      shift.noticed_after
          ? fmt::format(
                "Shift: these problems are not like those of the calibration (p = {:.2g}, noticed after {} of {}; what differs most: {}). "
                "None of the promises is for them.",
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

// Begins with what is refuted, or says that nothing is.
std::vector<std::string> DescribeKept(const ConformReport& report) {
  const PromiseFinding& kept = *report.kept;
  const ConformRule& rule = report.rule;
  std::vector<std::string> sentences;
  if (kept.IsCoverageRefuted()) {
    const Estimate coverage = MeasureShare(report.judged, ListRegionKinds(true).back().covers);
    sentences.push_back(fmt::format(
        "The promise of the regions does not hold on these problems: coverage {} of a promised {:.3g} %, by regions of {:.2g} deg in the median (p = {:.2g}).",
        ShareAsText(coverage), 100.0 * rule.level,
        MeasureMedianSize(report.judged, ListRegionKinds(true).back()), kept.coverage_p_value));
  }
  if (kept.IsAcceptRefuted()) {
    const Estimate wrong = MeasureWrongAndAccepted(report, IsAcceptedByRule);
    sentences.push_back(fmt::format(
        "The promise of the accept rule does not hold on these problems: wrong and accepted are {} of them, promised are at most {:.3g} % (p = {:.2g}).",
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

// What the intervals of a cross-validation estimate; empty for a check.
std::string DescribeRules(const ConformReport& report) {
  if (report.is_check || report.judged.empty()) return "";
  const auto [least, greatest] = std::ranges::minmax_element(report.judged, {}, &JudgedAnswer::rule_accepts);
  return FormatParagraph(fmt::format(
      "Each answer is judged by the rule of one fold, and the intervals are of the mean of these rules for new problems. "
      "The rule of the file is another one: those of the folds accept from {:.1f} to {:.1f} % of the answers. "
      "What the file's own rule does is measured by --check on new problems.",
      100.0 * least->rule_accepts, 100.0 * greatest->rule_accepts));
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
      "Region: for another problem {}, the ellipsoid of the conformed covariance at {:.3g} % (chi-square, 5 degrees of freedom) contains the truth with probability at least {:.3g} %{}. "
      "It is an average over calibrations.",
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
                "Accept rule: at most {:.3g} % of such problems are answered wrongly (more than {:.3g} deg of rotation or {:.3g} deg of direction) and accepted. "
                "It holds for {:.3g} % of calibrations.",
                100.0 * rule.wrong_and_accepted, rule.max_rotation_error_deg, rule.max_direction_error_deg,
                100.0 * (1.0 - rule.risk))
          : fmt::format(
                "Accept rule: none keeps wrong and accepted answers at {:.3g} % of the problems for {:.3g} % of calibrations; nothing is accepted. "
                "See rcme conform --needs.",
                100.0 * rule.wrong_and_accepted, 100.0 * (1.0 - rule.risk)));
  promises.push_back(fmt::format(
      "The calibration: {}. "
      "Only for problems exchangeable with these; `rcme conform --check` tests whether new ones are.",
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
  return FormatParagraph(fmt::format(
             "Regions at {:.3g} %: {} answers, and {} for each stratum of difficulty once models are trained.",
             100.0 * promise.level, for_bound, with_training(3 * for_bound))) +
         FormatParagraph(fmt::format(
             "Accept rule at {:.3g} %, risk {:.3g} %: {} problems if none is answered wrongly and accepted; "
             "{} for success in nine of ten calibrations if a quarter of what is allowed is.",
             100.0 * promise.wrong_and_accepted, 100.0 * promise.risk, for_rule, mostly)) +
         FormatParagraph(fmt::format(
             "Models are trained on three tenths of the problems, from {} answers on, and where the accept rule is within reach from {} on.",
             kLeastAnswers, with_training(for_rule))) +
         FormatParagraph(
             "Counted are independent problems: trials, or, where the promise is for new conditions or scenes, as many of these.");
}

std::string DescribeConformFindings(const ConformReport& report) {
  std::string text;
  if (report.kept)
    for (const std::string& sentence : DescribeKept(report)) text += FormatParagraph(sentence);
  if (report.shift) text += FormatParagraph(DescribeShift(*report.shift, report.rule));
  return text.empty() ? text : text + "\n";
}

std::string DescribeJudgedAnswers(const ConformReport& report) {
  const std::int64_t num_refusals = std::ranges::count(report.problems, true, &AskedProblem::is_refused);
  return FormatParagraph(fmt::format(
      "{}: {}, {}{}. {}", report.label, Counted(std::ssize(report.judged), "answer", "answers"),
      Counted(num_refusals, "refusal", "refusals"),
      report.num_unscored > 0
          ? fmt::format(", {} without a known truth", Counted(report.num_unscored, "trial", "trials"))
          : "",
      report.is_check ? "New answers, judged by the file:"
                      : "Cross-validated, each answer judged by a rule of other groups:"));
}

std::string DescribeConformTruth(const ConformReport& report) {
  if (!report.has_real_truth || report.judged.empty()) return "";
  const auto num_inexact = std::ranges::count_if(
      report.judged, [](const JudgedAnswer& a) { return !std::isnan(a.row.nees_of_inexact_truth); });
  const std::string text = DescribeRealTruth(num_inexact > 0);
  if (num_inexact == 0) return FormatParagraph(text);
  const auto num_open =
      std::ranges::count_if(report.judged, [](const JudgedAnswer& a) { return a.row.is_wrong_by_truth; });
  return FormatParagraph(fmt::format(
      "{} With its own error (truth_sd, of {} of {} answers) in the covariances the regions would cover: {}. "
      "{} {:g} of its standard deviations from being wrong instead of right, or right instead of wrong.",
      text, num_inexact, report.judged.size(), DescribeCoverageByTruth(report.judged),
      Counted(num_open, "answer is within", "answers are within"), kTruthErrorSds));
}

std::string DescribeConformColumns(const ConformReport& report) {
  return FormatParagraph(fmt::format(
             "size_deg: median of the geometric mean of the region's semi-axes; "
             "hardest: the {} answers that look hardest; "
             "all_motions: regions that exclude nothing. "
             "in use: by the rule and not strange, as an estimator of the file accepts. "
             "wrong_of_problems: wrong and accepted of all problems, also the refused ones, as it is promised; "
             "the other shares are of the answers. "
             "Intervals are 95 %.",
             CountHardest(report.judged))) +
         DescribeRules(report);
}

}  // namespace rcme
