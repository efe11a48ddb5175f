#include "experiments/ask/answer_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"

namespace rcme {
namespace {

// A wider interval that holds what is stated says nothing.
constexpr double kWidestThatDecides = 0.06;
// The rate of failure that one would like to see shown where nothing failed.
constexpr double kRareRate = 0.001;

// The parts of the answer: what a line is about, and what it says.
using Lines = std::vector<std::pair<std::string, std::string>>;

// A region covers as often as it likes if it is wide enough.
std::string DescribeSharpness(const Answer& a) {
  if (!std::isnan(a.sd_over_crb))
    return fmt::format("; stated sd {:.3g} times the least possible", a.sd_over_crb);
  if (std::isnan(a.rotation_sd_deg)) return "";
  return fmt::format("; stated sd {:.2g} deg of rotation, {:.2g} deg of direction", a.rotation_sd_deg,
                     a.direction_sd_deg);
}

// Whether an interval holds what is stated; `below` and `above` say what is wrong if all of it lies there.
std::string JudgeStated(const Estimate& measured, double stated, const char* below, const char* above) {
  const double width = measured.interval.upper - measured.interval.lower;
  if (std::isnan(stated) || std::isnan(width)) return "undecided";
  if (measured.interval.upper < stated) return below;
  if (measured.interval.lower > stated) return above;
  return width > kWidestThatDecides ? "undecided" : "right";
}

// What can be promised of accepted answers.
std::string DescribeAcceptRule(const Answer& a) {
  if (!a.states_probability) return a.best.label + " states no probability: nothing to accept by";
  if (!a.rule) {
    return fmt::format("no rule promises failures below {:g} % yet: that takes {} trials without a failure",
                       100.0 * a.at_most, FewestCertifyingAnswers(a.at_most, a.num_estimators));
  }
  const ErrorCount& accepted = a.rule->accepted;
  const bool is_all = a.rule->greatest_probability >= 1.0;
  if (is_all) return fmt::format("every answer: {} of {} failed", accepted.errors, accepted.n);
  return fmt::format("P <= {:g}: keeps {:.1f} % of the trials, {} of {} failed", a.rule->greatest_probability,
                     100.0 * static_cast<double>(accepted.n) / static_cast<double>(a.rule->num_trials),
                     accepted.errors, accepted.n);
}

// The ties of the ranking, which the order of the estimators must not hide.
std::string DescribeTies(const Answer& a) {
  const double n = static_cast<double>(a.best.success.n.value_or(a.num_trials));
  const std::string share = fmt::format("{} of {}", std::llround(a.best.success.value * n), std::llround(n));
  const std::string who = a.num_alike < a.num_estimators
                              ? fmt::format("{} of {} estimators", a.num_alike, a.num_estimators)
                          : a.num_alike == 2 ? std::string("both")
                                             : fmt::format("all {}", a.num_alike);
  return fmt::format(
      "{}: {}; ranked by median error ({}: {:.3g} deg{})", who, share, a.best.label, a.best.median_error_deg,
      a.next ? fmt::format(", {}: {:.3g} deg", a.next->label, a.next->median_error_deg) : std::string());
}

// 2994 -> 3000: two digits.
std::int64_t RoundToTwoDigits(double value) {
  const double step = std::pow(10.0, std::max(0.0, std::floor(std::log10(value)) - 1.0));
  return std::llround(step * std::round(value / step));
}

// Without a failure in n trials a rate above 1 - 0.05^(1/n) is refuted at 95 % (the "rule of three").
std::string DescribeTrials(const Answer& a) {
  if (a.difference && a.difference->trials_to_tell <= 10'000'000)
    return fmt::format("{} here; about {} tell the first two apart", a.num_trials,
                       a.difference->trials_to_tell);
  std::string text = fmt::format("{} here; the first two are as good as alike", a.num_trials);
  if (a.best.success.value < 1.0 || a.num_trials < 1) return text;
  const double shown = -std::expm1(std::log(0.05) / static_cast<double>(a.num_trials));
  text += fmt::format("; a failure rate below {:.2g} % is shown by these", 100.0 * shown);
  if (shown > kRareRate)
    text += fmt::format("; below {:g} % needs about {}", 100.0 * kRareRate,
                        RoundToTwoDigits(std::log(0.05) / std::log1p(-kRareRate)));
  return text;
}

Lines DescribeAnswer(const Answer& a) {
  const auto percent = [](const Estimate& estimate) { return FormatEstimate(estimate, kPercent); };
  Lines lines = {{"Estimator", fmt::format("{}: success {}", a.best.label, percent(a.best.success))}};
  if (a.num_alike > 1) lines.emplace_back("Ties", DescribeTies(a));
  if (a.next) lines.emplace_back("Next best", fmt::format("{}: {}", a.next->label, percent(a.next->success)));
  if (a.difference) {
    const bool is_sure = a.difference->p_value < 0.05;
    lines.emplace_back("Difference", fmt::format("{}; {}", percent(a.difference->difference),
                                                 is_sure ? "more than chance" : "may be chance"));
  }
  lines.emplace_back("Failure",
                     fmt::format("an error above {:g} deg of rotation or {:g} deg of direction",
                                 a.failure.max_rotation_error_deg, a.failure.max_direction_error_deg));
  lines.emplace_back("Accept if", DescribeAcceptRule(a));
  if (!a.best.inlier_threshold.empty()) lines.emplace_back("Inlier threshold", a.best.inlier_threshold);
  if (a.states_probability) {
    lines.emplace_back("Trust in P",
                       fmt::format("{}: states {:.2f} % on average; fail: {}",
                                   JudgeStated(a.failed, a.stated.value, "too pessimistic", "too sure"),
                                   100.0 * a.stated.value, percent(a.failed)));
  }
  lines.emplace_back("Covariance",
                     fmt::format("{}: 95 % region contains the truth in {}{}",
                                 JudgeStated(a.coverage, kNominalCoverage, "too sure", "too pessimistic"),
                                 percent(a.coverage), DescribeSharpness(a)));
  lines.emplace_back(
      "Time",
      fmt::format("{:.3g} ms a call{}", a.best.time_ms,
                  a.next ? fmt::format("; {}: {:.3g} ms", a.next->label, a.next->time_ms) : std::string()));
  lines.emplace_back("Trials", DescribeTrials(a));
  return lines;
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

}  // namespace

std::string AnswerAsText(const Answer& answer, const std::string& question, const std::string& folder) {
  Table table{{Column::Key("part"), Column::Text("answer")}};
  for (const auto& [part, words] : DescribeAnswer(answer)) table.rows.push_back({part, words});
  const std::string promise = answer.rule ? fmt::format(
                                                "Accepted answers fail in less than {:g} %,\n"
                                                "except with probability 0.05, that choice included.",
                                                100.0 * answer.at_most)
                                          : std::string("Nothing is promised of accepted answers.");
  return question + "\n\n" + RenderText(table) +
         fmt::format(
             "\nIntervals hold with 95 % for the estimator that leads, although the same trials\n"
             "chose it among {}. {}\n\n"
             "The study is {}/study.yaml. Next, all of it on one page, and up to which share of\n"
             "wrong matches it holds:\n"
             "  rcme report {}/run.sqlite --out {}/report.html\n"
             "  rcme solve {}/study.yaml --over outlier_ratio --from 0.05 --to 0.9 --at {:g} \\\n"
             "    --out {}/solve --max-time 5m\n",
             answer.num_estimators, promise, folder, folder, folder, folder, answer.at_most, folder);
}

std::string AnswerAsJson(const Answer& a, const std::string& question) {
  nlohmann::ordered_json json = {{"question", question},
                                 {"trials", a.num_trials},
                                 {"estimators", a.num_estimators},
                                 {"at_most", a.at_most},
                                 {"best", EstimatorAsJson(a.best)},
                                 {"alike", a.num_alike},
                                 {"rows", RenderJson(MakeAskedTable(a))}};
  if (a.next) json["next"] = EstimatorAsJson(*a.next);
  if (a.difference) {
    json["difference"] = RenderJson(a.difference->difference);
    json["difference"]["p_value"] = a.difference->p_value;
    const std::int64_t to_tell = a.difference->trials_to_tell;
    const bool is_known = to_tell < std::numeric_limits<std::int64_t>::max();
    json["difference"]["trials_to_tell"] = is_known ? nlohmann::ordered_json(to_tell) : nullptr;
  }
  if (a.rule) {
    json["accept"] = {{"max_failure_probability", a.rule->greatest_probability},
                      {"accepted", a.rule->accepted.n},
                      {"failed", a.rule->accepted.errors}};
  }
  if (a.states_probability) {
    json["stated"] = RenderJson(a.stated);
    json["failed"] = RenderJson(a.failed);
  }
  json["coverage"] = RenderJson(a.coverage);
  json["sd_over_crb"] = JsonNumber(a.sd_over_crb);
  json["rotation_sd_deg"] = JsonNumber(a.rotation_sd_deg);
  json["direction_sd_deg"] = JsonNumber(a.direction_sd_deg);
  return JsonText(kAnswerFormat, json);
}

CommandResult MakeAnswerResult(const Answer& answer, const std::string& question, const std::string& folder) {
  return {AnswerAsText(answer, question, folder), MakeAskedTable(answer), AnswerAsJson(answer, question)};
}

}  // namespace rcme
