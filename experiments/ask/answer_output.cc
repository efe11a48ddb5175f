#include "experiments/ask/answer_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"
#include "experiments/core/text/shell_word.h"
#include "stats/equivalence.h"
#include "stats/risk_control.h"

namespace rcme {
namespace {

// The failure rate to demonstrate if no trial failed.
constexpr double kRareRate = 0.001;

// The parts of the answer: what a line is about, and what it says.
using Lines = std::vector<std::pair<std::string, std::string>>;

// Compares a measured rate with the stated one: wrong if the interval excludes the stated rate, right if the
// whole interval lies within `margin` of it.
std::string JudgeStated(const Estimate& measured, double stated, double margin) {
  const Interval& interval = measured.interval;
  if (interval.upper < stated) return "too pessimistic";
  if (interval.lower > stated) return "too sure";
  const bool is_right = DecideEquivalence(interval, Around(stated, margin)) == Verdict::kHolds;
  return is_right ? fmt::format("right to within {:g} %", 100.0 * margin) : "undecided";
}

// What can be promised of accepted answers.
std::string DescribeAcceptRule(const Answer& a) {
  if (!a.has_direction)
    return "no P is judged: it is of rotation and direction, and the motion has no direction";
  if (a.stating.empty()) return a.best.label + " states no P: nothing to accept by";
  if (!a.rule) {
    return fmt::format(
        "no bound on the P of {} keeps failures below {:g} % yet: that takes at least {} answers without a "
        "failure",
        a.stating, 100.0 * a.at_most, FewestCertifyingAnswers(a.at_most, a.num_estimators));
  }
  const ErrorCount& accepted = a.rule->accepted;
  const std::string rule = a.rule->greatest_probability >= 1.0
                               ? "answers, whatever its P"
                               : fmt::format("states P <= {:g}", a.rule->greatest_probability);
  return fmt::format("{} {}: {:.1f} % of the trials, {} of {} failed", a.stating, rule,
                     100.0 * static_cast<double>(accepted.n) / static_cast<double>(a.rule->num_trials),
                     accepted.errors, accepted.n);
}

std::string DescribeTrust(const Answer& a) {
  return fmt::format("{} states {:.2f} % on average, {} fail: {}", a.stating, 100.0 * a.stated.value,
                     FormatEstimate(a.failed, kPercent), JudgeStated(a.failed, a.stated.value, a.at_most));
}

std::int64_t CountSuccesses(const AskedEstimator& estimator) {
  return std::llround(estimator.success.value * static_cast<double>(estimator.success.n.value_or(0)));
}

bool IsTied(const AskedEstimator& a, const AskedEstimator& b) { return a.success.value == b.success.value; }

// Why the best ranks before an estimator with the same success rate.
std::string DescribeTieBreak(const Answer& a) {
  if (!a.next || !IsTied(a.best, *a.next)) return "";
  const Estimate& error = a.error_difference;
  if (error.interval.lower > 0.0) {
    return fmt::format("; {} leads: the errors of {} are greater by {:.2g} deg [{:.2g}, {:.2g}]",
                       a.best.label, a.next->label, error.value, error.interval.lower, error.interval.upper);
  }
  const char* const reason =
      a.best.time_ms <= a.next->time_ms ? "it is faster" : "it states P and is as fast";
  return fmt::format("; {} leads: {}, the errors of {} are alike", a.best.label, reason, a.next->label);
}

// Names the estimators that are not significantly worse than the best.
std::string DescribeTies(const Answer& a) {
  const std::int64_t n = a.best.success.n.value_or(0);
  if (CountSuccesses(a.best) == 0)
    return fmt::format("none of the {} succeeds in any of {} trials: the order says nothing",
                       a.num_estimators, n);
  const size_t num = a.alike.size() + 1;
  const std::string who = static_cast<int>(num) == a.num_estimators
                              ? (num == 2 ? std::string("both") : fmt::format("all {}", num))
                              : fmt::format("{} of {}", num, a.num_estimators);
  const bool all_tied =
      std::ranges::all_of(a.alike, [&](const auto& other) { return IsTied(a.best, other); });
  if (all_tied)
    return fmt::format("{} succeed in {} of {}{}", who, CountSuccesses(a.best), n, DescribeTieBreak(a));
  std::vector<std::string> counts;
  for (const AskedEstimator& other : a.alike)
    counts.push_back(fmt::format("{} {}", other.label, CountSuccesses(other)));
  return fmt::format("{} of {}; not told apart from it: {}{}", CountSuccesses(a.best), n,
                     fmt::join(counts, ", "), DescribeTieBreak(a));
}

// Rounds to two significant digits.
std::int64_t RoundTrials(std::int64_t trials) {
  const auto number = static_cast<double>(trials);
  if (number <= 0.0) return trials;
  const double step = std::pow(10.0, std::floor(std::log10(number)) - 1.0);
  return std::llround(step * std::round(number / step));
}

// The numbers of trials that tell the first two apart, and that show a difference of kPlainDifference.
std::string DescribeTrialsToTell(const Answer& a) {
  if (!a.difference) return "";
  const AskedDifference& d = *a.difference;
  const bool is_known = d.trials_to_tell <= 10'000'000;
  if (is_known && d.p_value < 0.05)
    return fmt::format("; about {} tell the first two apart", RoundTrials(d.trials_to_tell));
  const std::string plain = fmt::format("to tell a {:g} % difference in success takes about {}",
                                        100.0 * kPlainDifference, RoundTrials(d.trials_of_plain_difference));
  return "; " +
         (is_known ? fmt::format("about {} tell the first two apart, ", RoundTrials(d.trials_to_tell))
                   : std::string()) +
         plain;
}

// The interval of `success` without a failure in n trials begins at (0.025 / estimators)^(1/n).
std::string DescribeTrials(const Answer& a) {
  std::string text = fmt::format("{}{}", a.num_trials, DescribeTrialsToTell(a));
  if (a.best.success.value < 1.0 || a.num_trials == 0) return text;
  const std::int64_t needed = FewestCertifyingTrials(kRareRate, 0.025 / a.num_estimators);
  if (needed > a.num_trials)
    text += fmt::format("; to show a failure rate below {:g} % about {} without a failure", 100.0 * kRareRate,
                        RoundTrials(needed));
  return text;
}

std::string DescribeNext(const Answer& a) {
  std::string text = fmt::format("{}: {}", a.next->label, FormatEstimate(a.next->success, kPercent));
  if (!a.difference || a.difference->difference.value == 0.0) return text;
  return text + fmt::format("; {} less, {}", FormatEstimate(a.difference->difference, kPercent),
                            a.difference->p_value < 0.05 ? "more than chance" : "may be chance");
}

std::string DescribeCoverage(const Answer& a) {
  if (!a.has_direction) return "coverage is of rotation and direction, and the motion has no direction";
  const std::string sharpness = a.sharpness.IsKnown() ? "; " + DescribeSharpness(a.sharpness) : "";
  if (std::isnan(a.coverage.value)) return "coverage of " + a.best.label + " is not known" + sharpness;
  return fmt::format("the 95 % region of {} contains the truth in {}: {}{}", a.best.label,
                     FormatEstimate(a.coverage, kPercent), DescribeCoverageVerdict(a.coverage_verdict),
                     sharpness);
}

Lines DescribeAnswer(const Answer& a) {
  const auto percent = [](const Estimate& estimate) { return FormatEstimate(estimate, kPercent); };
  Lines lines = {{"Estimator", fmt::format("{}: success {}", a.best.label, percent(a.best.success))}};
  if (!a.alike.empty()) lines.emplace_back("Ties", DescribeTies(a));
  if (a.next) lines.emplace_back("Next best", DescribeNext(a));
  lines.emplace_back("Accept if", DescribeAcceptRule(a));
  if (!a.stating.empty()) lines.emplace_back("Trust in P", DescribeTrust(a));
  if (!a.best.inlier_threshold.empty())
    lines.emplace_back("Inlier threshold", a.best.label + ": " + a.best.inlier_threshold);
  lines.emplace_back("Covariance", DescribeCoverage(a));
  lines.emplace_back(
      "Time",
      fmt::format("{}: {:.3g} ms a call{}", a.best.label, a.best.time_ms,
                  a.next ? fmt::format("; {}: {:.3g} ms", a.next->label, a.next->time_ms) : std::string()));
  lines.emplace_back("Trials", DescribeTrials(a));
  return lines;
}

std::string DescribeSuccess(const Answer& a) {
  const std::string rotation =
      fmt::format("Success: an error of at most {:g} deg of rotation", a.failure.max_rotation_error_deg);
  if (!a.has_direction)
    return rotation +
           ". The motion has no direction, so\n"
           "an answer that refuses to give one succeeds by its rotation. Intervals hold\n";
  return fmt::format(
      "{} and {:g} deg of direction. P: the\n"
      "probability of failure that an estimator states with its answer. Intervals hold\n",
      rotation, a.failure.max_direction_error_deg);
}

// What the words of the table mean.
std::string DescribeTerms(const Answer& a) {
  const std::string promise =
      a.rule ? fmt::format(
                   "\nAccepted answers fail in less than {:g} %, except with probability 0.05, that\n"
                   "choice included.",
                   100.0 * a.at_most)
             : std::string();
  return DescribeSuccess(a) +
         fmt::format("with 95 % although the same trials chose the estimator among {}.{}\n", a.num_estimators,
                     promise);
}

std::string DescribeNextCommands(const Answer& a, const std::string& folder) {
  const auto in_folder = [&](const char* name) { return QuoteForShell(folder + name); };
  const std::string study = FormatParagraph(
      fmt::format("The study is {}/study.yaml. Next, all of it on one page, and up to which share of wrong "
                  "matches it holds:",
                  folder));
  return fmt::format(
      "\n{}"
      "  rcme report {} --out {}\n"
      "  rcme solve {} --estimators {} --over outlier_ratio \\\n"
      "    --from 0.05 --to 0.9 --at {:g} --trials 2000 --out {} --max-time 5m\n",
      study, in_folder("/run.sqlite"), in_folder("/report.html"), in_folder("/study.yaml"),
      QuoteForShell(a.best.label), a.at_most, in_folder("/solve"));
}

nlohmann::ordered_json EstimatorAsJson(const AskedEstimator& estimator) {
  return {{"label", estimator.label},
          {"success", RenderJson(estimator.success)},
          {"time_ms", estimator.time_ms},
          {"median_error_deg", JsonNumber(estimator.median_error_deg)}};
}

// The best estimator and the next.
Table MakeAskedTable(const Answer& answer) {
  std::vector<AskedEstimator> asked = {answer.best};
  if (answer.next) asked.push_back(*answer.next);
  using A = const AskedEstimator&;
  return MakeTable<AskedEstimator>(
      {{Column::Key("estimator"), [](A a) { return a.label; }},
       {Column::Number("success"), [](A a) { return a.success.value; }},
       {{"lower,upper", ColumnType::kInterval}, [](A a) { return a.success.interval; }},
       {Column::Number("time_ms"), [](A a) { return a.time_ms; }}},
      asked);
}

// What is judged of a stated probability, below `stating` where it is not the best estimator's.
void AddStated(const Answer& a, nlohmann::ordered_json* json) {
  const bool is_of_best = a.stating == a.best.label;
  nlohmann::ordered_json& stated = is_of_best ? *json : (*json)["stating"];
  if (!is_of_best) stated["label"] = a.stating;
  if (a.rule) {
    stated["accept"] = {{"max_failure_probability", a.rule->greatest_probability},
                        {"accepted", a.rule->accepted.n},
                        {"failed", a.rule->accepted.errors}};
  }
  stated["stated"] = RenderJson(a.stated);
  stated["failed"] = RenderJson(a.failed);
}

}  // namespace

std::string AnswerAsText(const Answer& answer, const std::string& question, const std::string& folder) {
  Table table{{Column::Key("part"), Column::Text("answer")}};
  for (const auto& [part, words] : DescribeAnswer(answer)) table.rows.push_back({part, words});
  return FormatParagraph(question) + "\n" + RenderText(table) + "\n" + DescribeTerms(answer) +
         DescribeNextCommands(answer, folder);
}

std::string AnswerAsJson(const Answer& a, const std::string& question) {
  nlohmann::ordered_json json = {{"question", question},
                                 {"trials", a.num_trials},
                                 {"estimators", a.num_estimators},
                                 {"at_most", a.at_most},
                                 {"best", EstimatorAsJson(a.best)},
                                 {"alike", nlohmann::ordered_json::array()},
                                 {"rows", RenderJson(MakeAskedTable(a))}};
  for (const AskedEstimator& other : a.alike) json["alike"].push_back(EstimatorAsJson(other));
  if (a.next) json["next"] = EstimatorAsJson(*a.next);
  if (a.difference) {
    json["difference"] = RenderJson(a.difference->difference);
    json["difference"]["p_value"] = a.difference->p_value;
    const std::int64_t to_tell = a.difference->trials_to_tell;
    const bool is_known = to_tell < std::numeric_limits<std::int64_t>::max();
    json["difference"]["trials_to_tell"] = is_known ? nlohmann::ordered_json(to_tell) : nullptr;
    json["difference"]["trials_to_tell_1_percent"] = a.difference->trials_of_plain_difference;
  }
  if (!a.stating.empty()) AddStated(a, &json);
  json["coverage"] = RenderJson(a.coverage);
  json["sd_over_crb"] = JsonNumber(a.sharpness.sd_over_crb);
  json["rotation_sd_deg"] = JsonNumber(a.sharpness.rotation_sd_deg);
  json["direction_sd_deg"] = JsonNumber(a.sharpness.direction_sd_deg);
  return JsonText(kAnswerFormat, json);
}

CommandResult MakeAnswerResult(const Answer& answer, const std::string& question, const std::string& folder) {
  return {AnswerAsText(answer, question, folder), MakeAskedTable(answer), AnswerAsJson(answer, question)};
}

}  // namespace rcme
