#include "experiments/ask/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/statistics/compare.h"
#include "experiments/statistics/failure_forecasts.h"
#include "experiments/statistics/quantity_table.h"
#include "experiments/statistics/summarize.h"
#include "parameters/input_error.h"
#include "stats/paired_sample_size.h"

namespace rcme {
namespace {

// Of which the accept rule takes one; chosen before any trial.
constexpr double kProbabilities[] = {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0};
constexpr double kDelta = 0.05;
constexpr double kDeltaOfEach = kDelta / static_cast<double>(std::size(kProbabilities));

// A quantity of an estimator; not known where the summary does not have it.
Estimate FindEstimate(const Summary& summary, const std::string& label, const std::string& quantity) {
  for (const SummaryRow& row : summary.rows) {
    if (row.estimator == label && row.quantity == quantity) return MakeEstimate(row, row.n);
  }
  return {};
}

// By success, the best first.
std::vector<AskedEstimator> RankEstimators(const RunDescription& run, const Summary& summary) {
  std::vector<AskedEstimator> ranked;
  for (const DescribedEstimator& estimator : run.estimators) {
    ranked.push_back({estimator.label, FindEstimate(summary, estimator.label, "success"),
                      FindEstimate(summary, estimator.label, "mean_time_ms").value});
  }
  std::ranges::stable_sort(ranked, std::ranges::greater{},
                           [](const AskedEstimator& estimator) { return estimator.success.value; });
  return ranked;
}

// Failure or refusal of the best and the next, turned into success.
std::optional<AskedDifference> CompareTwo(const ResultStore& run, const std::string& best,
                                          const std::string& next) {
  const Comparison comparison = Compare(run, best, {.compared = {"failure_or_refusal"}});
  for (const ComparisonRow& row : comparison.rows) {
    if (row.estimator != next || row.n == 0) continue;
    const auto n = static_cast<double>(row.n);
    return AskedDifference{{.value = row.difference, .interval = row.interval},
                           row.holm_p_value,
                           TrialsToTellApart(static_cast<double>(row.counts.first_only) / n,
                                             static_cast<double>(row.counts.second_only) / n)};
  }
  return std::nullopt;
}

// The answers of an estimator that state a probability and whose truth is known.
std::vector<StatedAnswer> CollectStated(const ResultStore& run, const std::string& label) {
  for (const FailureForecasts& of_one : CollectFailureForecasts(run)) {
    if (of_one.estimator != label || of_one.source != ForecastSource::kStated) continue;
    std::vector<StatedAnswer> answers;
    for (const Forecast& forecast : of_one.forecasts)
      answers.push_back({forecast.probability, forecast.happened});
    return answers;
  }
  return {};
}

Estimate EstimateFailed(const std::vector<StatedAnswer>& answers) {
  const auto n = static_cast<std::int64_t>(answers.size());
  const std::int64_t failed = std::ranges::count(answers, true, &StatedAnswer::has_failed);
  return {.value = static_cast<double>(failed) / static_cast<double>(n),
          .interval = ExactBinomialInterval(failed, n)};
}

// In lines of at most 80 columns.
using Lines = std::vector<std::pair<std::string, std::string>>;

Lines AnswerLines(const Answer& a, const std::string& folder) {
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
                                   100.0 * a.at_most, FewestCertifyingTrials(a.at_most, kDeltaOfEach)));
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
  Estimate coverage = a.coverage;
  coverage.note = coverage.note.substr(0, coverage.note.find(','));
  lines.emplace_back("Covariance", "95 % region holds the truth in " + percent(coverage));
  lines.emplace_back(
      "Time",
      fmt::format("{:.3g} ms a call{}", a.best.time_ms,
                  a.next ? fmt::format("; {}: {:.3g} ms", a.next->label, a.next->time_ms) : std::string()));
  lines.emplace_back("Trials", fmt::format("{} here; {}", a.num_trials,
                                           !a.difference || a.difference->trials_to_tell > 10'000'000
                                               ? "these two are as good as alike"
                                               : fmt::format("about {} tell the first two apart",
                                                             a.difference->trials_to_tell)));
  lines.emplace_back("Study, report",
                     fmt::format("{0}/study.yaml; rcme report {0}/run.sqlite --out {0}/report.html", folder));
  lines.emplace_back(
      "Next question",
      fmt::format("up to which share of wrong matches does this hold?\n{:<14} rcme solve {}/study.yaml "
                  "--over outlier_ratio --from 0.05 --to 0.9 --at {:g}",
                  "", folder, a.at_most));
  return lines;
}

nlohmann::ordered_json EstimateAsJson(const Estimate& estimate) {
  return {{"value", estimate.value}, {"interval", {estimate.interval.lower, estimate.interval.upper}}};
}

}  // namespace

std::optional<AcceptRule> CertifyAcceptRule(const std::vector<StatedAnswer>& answers, std::int64_t num_trials,
                                            double at_most) {
  std::optional<AcceptRule> greatest;
  for (const double probability : kProbabilities) {
    ErrorCount accepted;
    for (const StatedAnswer& answer : answers) {
      if (answer.failure_probability > probability) continue;
      ++accepted.n;
      accepted.errors += answer.has_failed;
    }
    if (ExcessPValue(accepted, at_most) <= kDeltaOfEach)
      greatest = AcceptRule{probability, accepted, num_trials};
  }
  return greatest;
}

Answer AnswerQuestion(const ResultStore& run, double at_most) {
  const RunDescription description = run.Description();
  if (description.conditions.size() != 1)
    throw InputError(fmt::format("ask: {}: has {} conditions; an answer is of one", description.study,
                                 description.conditions.size()));
  const Summary summary = Summarize(run, /*with_times=*/true);
  const std::vector<AskedEstimator> ranked = RankEstimators(description, summary);
  Answer answer;
  answer.num_trials = summary.num_trials_done;
  answer.at_most = at_most;
  answer.best = ranked.front();
  if (ranked.size() > 1) {
    answer.next = ranked[1];
    answer.difference = CompareTwo(run, answer.best.label, answer.next->label);
  }
  const std::string& best = answer.best.label;
  const std::vector<StatedAnswer> stated = CollectStated(run, best);
  answer.states_probability = !stated.empty();
  if (answer.states_probability) {
    answer.rule = CertifyAcceptRule(stated, answer.num_trials, at_most);
    answer.stated = FindEstimate(summary, best, "failure_probability");
    answer.failed = EstimateFailed(stated);
  }
  answer.coverage = FindEstimate(summary, best, "nees_coverage");
  return answer;
}

std::string AnswerAsText(const Answer& answer, const std::string& question, const std::string& folder) {
  std::string text = question + "\n\n";
  for (const auto& [name, words] : AnswerLines(answer, folder))
    text += fmt::format("{:<14} {}\n", name, words);
  return text + fmt::format(
                    "\nRates with 95 % intervals. The threshold keeps failures below {:g} % of the accepted\n"
                    "answers, except with probability 0.05.\n",
                    100.0 * answer.at_most);
}

std::string AnswerAsJson(const Answer& a, const std::string& question) {
  const auto estimator = [](const AskedEstimator& one) {
    return nlohmann::ordered_json{
        {"label", one.label}, {"success", EstimateAsJson(one.success)}, {"time_ms", one.time_ms}};
  };
  nlohmann::ordered_json json = {
      {"question", question}, {"trials", a.num_trials}, {"at_most", a.at_most}, {"best", estimator(a.best)}};
  if (a.next) json["next"] = estimator(*a.next);
  if (a.difference) {
    json["difference"] = EstimateAsJson(a.difference->difference);
    json["difference"]["p_value"] = a.difference->p_value;
    json["difference"]["trials_to_tell"] = a.difference->trials_to_tell;
  }
  if (a.rule) {
    json["accept"] = {{"max_failure_probability", a.rule->greatest_probability},
                      {"accepted", a.rule->accepted.n},
                      {"failed", a.rule->accepted.errors}};
  }
  if (a.states_probability) {
    json["stated"] = EstimateAsJson(a.stated);
    json["failed"] = EstimateAsJson(a.failed);
  }
  json["coverage"] = EstimateAsJson(a.coverage);
  return JsonText(kAnswerFormat, json);
}

}  // namespace rcme
