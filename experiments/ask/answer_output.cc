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
  return is_right ? fmt::format("failures are within {:g} percentage points of it", 100.0 * margin)
                  : "undecided";
}

bool StatesBest(const Answer& a) { return a.stating == a.best.label; }

// What can be promised of the accepted answers of the estimator that states P.
std::string DescribeCertified(const Answer& a) {
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

std::string DescribeAcceptRule(const Answer& a) {
  if (!a.has_direction)
    return "no P is judged: it is of rotation and direction, and the motion has no direction";
  return StatesBest(a) ? DescribeCertified(a) : a.best.label + " states no P: nothing to accept by";
}

std::string DescribeTrust(const Answer& a) {
  return fmt::format("{} states {:.2f} % on average, {} fail: {}", a.stating, 100.0 * a.stated.value,
                     FormatEstimate(a.failed, kPercent), JudgeStated(a.failed, a.stated.value, a.at_most));
}

// The estimator that states P, where the best does not.
std::string DescribeAlternative(const Answer& a) {
  return fmt::format("{}, whose success these trials cannot tell from that of {}, states P: {}{}; {}",
                     a.stating, a.best.label, a.rule ? "accept if " : "", DescribeCertified(a),
                     DescribeTrust(a));
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

// The numbers of trials that tell the first two apart, and that show a difference of kPlainDifference. More
// trials of the same seed would be a second look at the first ones, of which the p value knows nothing.
std::string DescribeTrialsToTell(const Answer& a) {
  if (!a.difference) return "";
  const AskedDifference& d = *a.difference;
  const bool is_known = d.trials_to_tell <= 10'000'000;
  if (is_known && d.p_value < 0.05)
    return fmt::format("; about {} of another --seed tell the first two apart",
                       RoundTrials(d.trials_to_tell));
  const std::string plain = fmt::format("to tell a {:g} % difference in success takes about {}",
                                        100.0 * kPlainDifference, RoundTrials(d.trials_of_plain_difference));
  return "; " +
         (is_known ? fmt::format("about {} of another --seed tell the first two apart, ",
                                 RoundTrials(d.trials_to_tell))
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

// A number of trials is given only for a coverage that may be the nominal one.
std::string DescribeAskedVerdict(const Answer& a) {
  if (a.coverage_verdict != RegionVerdict::kUndecided) return Name(a.coverage_verdict);
  const Interval& interval = a.coverage.interval;
  if (interval.Contains(kNominalCoverage))
    return fmt::format("undecided, about {} trials would show it if it is {:g} %",
                       RoundTrials(std::llround(a.trials_to_confirm_coverage)), 100.0 * kNominalCoverage);
  return fmt::format("{} than {:g} %, but undecided whether by more than {:g} %",
                     interval.upper < kNominalCoverage ? "less" : "more", 100.0 * kNominalCoverage,
                     100.0 * kCoverageMargin);
}

std::string DescribeCoverage(const Answer& a) {
  if (!a.has_direction) return "coverage is of rotation and direction, and the motion has no direction";
  const std::string sharpness = a.sharpness.IsKnown() ? "; " + DescribeSharpness(a.sharpness) : "";
  if (std::isnan(a.coverage.value)) return "coverage of " + a.best.label + " is not known" + sharpness;
  std::vector<std::string> others;
  for (const AskedEstimator& other : a.alike)
    if (!std::isnan(other.coverage))
      others.push_back(fmt::format("{} {:.0f} %", other.label, 100.0 * other.coverage));
  return fmt::format("the 95 % region of {} contains the truth in {}: {}{}{}{}", a.best.label,
                     FormatEstimate(a.coverage, kPercent), DescribeAskedVerdict(a), sharpness,
                     others.empty() ? "" : "; regions of the others: ", fmt::join(others, ", "));
}

// What the simulated estimators are told rightly, and so the answer takes for granted.
std::string DescribeTakenAsExact(const Answer& a) {
  if (a.focal_error == 0.0)
    return "K, the noise level and the noise model: with errors of them P and covariances can be far too sure; "
           "--focal-error 0.01 asks what a focal length that is 1 % too great does";
  return "the principal point, the noise level and the noise model, not the focal length (--focal-error)";
}

std::string DescribeBest(const Answer& a) {
  const std::string success = FormatEstimate(a.best.success, kPercent);
  if (a.works) return fmt::format("{}: success {}", a.best.label, success);
  return fmt::format("none works here: the best of {}, {}, has a success of {}, less than {:g} %",
                     a.num_estimators, a.best.label, success, 100.0 * kLeastSuccess);
}

// What to try where no estimator works.
constexpr const char* kTry =
    "fewer wrong matches (--wrong), such as by a stricter ratio test; more matches (--matches); sensors "
    "(prior_rotation_sd_deg, prior_gravity_sd_deg in the study); `rcme solve`, below, finds the share of wrong "
    "matches up to which it works";

// The thresholds of the best and of all that are not told apart from it.
void AddThresholds(const Answer& a, Lines* lines) {
  std::vector<AskedEstimator> usable = {a.best};
  usable.insert(usable.end(), a.alike.begin(), a.alike.end());
  for (const AskedEstimator& each : usable) {
    const std::string& words = each.inlier_threshold.words;
    if (!words.empty()) lines->emplace_back("Inlier threshold", each.label + ": " + words);
  }
}

Lines DescribeAnswer(const Answer& a) {
  Lines lines = {{"Estimator", DescribeBest(a)}};
  if (!a.works) lines.emplace_back("Try", kTry);
  if (!a.alike.empty()) lines.emplace_back("Ties", DescribeTies(a));
  if (a.next) lines.emplace_back("Next best", DescribeNext(a));
  lines.emplace_back("Accept if", DescribeAcceptRule(a));
  if (StatesBest(a)) lines.emplace_back("Trust in P", DescribeTrust(a));
  if (a.works) AddThresholds(a, &lines);
  lines.emplace_back("Covariance", DescribeCoverage(a));
  if (!a.stating.empty() && !StatesBest(a)) lines.emplace_back("Alternative", DescribeAlternative(a));
  lines.emplace_back("Taken as exact", DescribeTakenAsExact(a));
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
          {"median_error_deg", JsonNumber(estimator.median_error_deg)},
          {"threshold_px", JsonNumber(estimator.inlier_threshold.px)},
          {"threshold", estimator.inlier_threshold.words}};
}

// The best estimator, those that are not told apart from it, and the next.
Table MakeAskedTable(const Answer& answer) {
  struct Placed {
    const char* place;
    AskedEstimator of;
  };
  std::vector<Placed> placed = {{"best", answer.best}};
  for (const AskedEstimator& other : answer.alike) placed.push_back({"tied", other});
  if (answer.next && std::ranges::count(answer.alike, answer.next->label, &AskedEstimator::label) == 0)
    placed.push_back({"next", *answer.next});
  using P = const Placed&;
  return MakeTable<Placed>(
      {{Column::Key("estimator"), [](P p) { return p.of.label; }},
       {Column::Text("place"), [](P p) { return std::string(p.place); }},
       {Column::Number("success"), [](P p) { return p.of.success.value; }},
       {{"lower,upper", ColumnType::kInterval}, [](P p) { return p.of.success.interval; }},
       {Column::Number("time_ms"), [](P p) { return p.of.time_ms; }},
       {Column::Number("threshold_px"), [](P p) { return p.of.inlier_threshold.px; }},
       {Column::Text("threshold"), [](P p) { return p.of.inlier_threshold.words; }}},
      placed);
}

// What is judged of a stated probability, below `stating` where it is not the best estimator's.
void AddStated(const Answer& a, nlohmann::ordered_json* json) {
  nlohmann::ordered_json& stated = StatesBest(a) ? *json : (*json)["stating"];
  if (!StatesBest(a)) stated["label"] = a.stating;
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
                                 {"focal_error", a.focal_error},
                                 {"works", a.works},
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
  json["coverage_verdict"] = Name(a.coverage_verdict);
  json["sd_over_crb"] = JsonNumber(a.sharpness.sd_over_crb);
  json["rotation_sd_deg"] = JsonNumber(a.sharpness.rotation_sd_deg);
  json["direction_sd_deg"] = JsonNumber(a.sharpness.direction_sd_deg);
  return JsonText(kAnswerFormat, json);
}

CommandResult MakeAnswerResult(const Answer& answer, const std::string& question, const std::string& folder) {
  return {AnswerAsText(answer, question, folder), MakeAskedTable(answer), AnswerAsJson(answer, question)};
}

}  // namespace rcme
