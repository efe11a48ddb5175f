#include "experiments/ask/answer_output.h"

#include <fmt/format.h>

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

Lines DescribeAnswer(const Answer& a) {
  const auto percent = [](const Estimate& estimate) { return FormatEstimate(estimate, kPercent); };
  Lines lines = {{"Estimator", fmt::format("{}: success {}", a.best.label, percent(a.best.success))}};
  if (a.next) lines.emplace_back("Next best", fmt::format("{}: {}", a.next->label, percent(a.next->success)));
  if (a.difference) {
    const bool is_sure = a.difference->p_value < 0.05;
    lines.emplace_back("Difference", fmt::format("{}; {}", percent(a.difference->difference),
                                                 is_sure ? "more than chance" : "may be chance"));
  }
  if (!a.states_probability) {
    lines.emplace_back("Threshold", a.best.label + " states no probability: nothing to accept by");
  } else if (!a.rule) {
    lines.emplace_back("Threshold",
                       fmt::format("none is sure to keep failures below {:g} %; {} answers may do, all right",
                                   100.0 * a.at_most, FewestCertifyingAnswers(a.at_most, a.num_estimators)));
  } else {
    lines.emplace_back(
        "Threshold",
        fmt::format("accept P <= {:g}: keeps {:.1f} % of the trials, {} of {} fail",
                    a.rule->greatest_probability,
                    100.0 * static_cast<double>(a.rule->accepted.n) / static_cast<double>(a.rule->num_trials),
                    a.rule->accepted.errors, a.rule->accepted.n));
  }
  if (a.states_probability) {
    lines.emplace_back("Trust in P", fmt::format("states {:.2f} % on average; fail: {}",
                                                 100.0 * a.stated.value, percent(a.failed)));
  }
  lines.emplace_back("Covariance",
                     "95 % region contains the truth in " + percent(a.coverage) + DescribeSharpness(a));
  lines.emplace_back(
      "Time",
      fmt::format("{:.3g} ms a call{}", a.best.time_ms,
                  a.next ? fmt::format("; {}: {:.3g} ms", a.next->label, a.next->time_ms) : std::string()));
  lines.emplace_back("Trials", fmt::format("{} here; {}", a.num_trials,
                                           !a.difference || a.difference->trials_to_tell > 10'000'000
                                               ? "these two are as good as alike"
                                               : fmt::format("about {} tell the first two apart",
                                                             a.difference->trials_to_tell)));
  return lines;
}

nlohmann::ordered_json EstimatorAsJson(const AskedEstimator& estimator) {
  return {
      {"label", estimator.label}, {"success", RenderJson(estimator.success)}, {"time_ms", estimator.time_ms}};
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
  return question + "\n\n" + RenderText(table) +
         fmt::format(
             "\nIntervals hold with 95 % for the estimator that leads, although the same trials\n"
             "chose it among {}. The threshold keeps failures below {:g} % of the accepted answers,\n"
             "except with probability 0.05, that choice included.\n\n"
             "The study is {}/study.yaml. Next, all of it on one page, and up to which share of\n"
             "wrong matches it holds:\n"
             "  rcme report {}/run.sqlite --out {}/report.html\n"
             "  rcme solve {}/study.yaml --over outlier_ratio --from 0.05 --to 0.9 --at {:g}\n",
             answer.num_estimators, 100.0 * answer.at_most, folder, folder, folder, folder, answer.at_most);
}

std::string AnswerAsJson(const Answer& a, const std::string& question) {
  nlohmann::ordered_json json = {
      {"question", question}, {"trials", a.num_trials},          {"estimators", a.num_estimators},
      {"at_most", a.at_most}, {"best", EstimatorAsJson(a.best)}, {"rows", RenderJson(MakeAskedTable(a))}};
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
