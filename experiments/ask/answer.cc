#include "experiments/ask/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "experiments/statistics/compare.h"
#include "experiments/statistics/failure_forecasts.h"
#include "experiments/statistics/quantity_table.h"
#include "experiments/statistics/summarize.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "stats/paired_sample_size.h"

namespace rcme {
namespace {

// A quantity of an estimator, with its n; not known where the summary does not have it.
Estimate FindEstimate(const Summary& summary, const std::string& label, const std::string& quantity) {
  for (const SummaryRow& row : summary.rows) {
    if (row.estimator == label && row.quantity == quantity) return MakeEstimate(row, /*num_trials=*/-1);
  }
  return {};
}

// A share of n, with the exact interval that holds together with those of all estimators (Bonferroni); a
// verdict by a narrower one is left out.
Estimate WidenForChoice(Estimate share, int num_estimators) {
  const std::int64_t n = share.n.value_or(0);
  if (n == 0 || std::isnan(share.value)) return share;
  share.interval = ExactBinomialInterval(std::llround(share.value * static_cast<double>(n)), n,
                                         1.0 - 0.05 / num_estimators);
  share.note.clear();
  return share;
}

// The best first.
std::vector<AskedEstimator> ListRanked(const RunDescription& run, const Summary& summary, double sigma_px) {
  const auto num_estimators = static_cast<int>(run.estimators.size());
  std::vector<AskedEstimator> ranked;
  for (const DescribedEstimator& estimator : run.estimators) {
    const std::string& label = estimator.label;
    ranked.push_back({label, WidenForChoice(FindEstimate(summary, label, "success"), num_estimators),
                      FindEstimate(summary, label, "mean_time_ms").value,
                      FindEstimate(summary, label, "max_error_median_deg").value,
                      DescribeInlierThreshold(estimator.options, sigma_px)});
  }
  RankEstimators(&ranked);
  return ranked;
}

// The value of an option; empty: there is none.
std::string FindValue(const Settings& options, const std::string& name) {
  const auto found = std::ranges::find(options, name, &Settings::value_type::first);
  return found == options.end() ? "" : found->second;
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
  return {.value = static_cast<double>(failed) / static_cast<double>(n), .n = n};
}

}  // namespace

void RankEstimators(std::vector<AskedEstimator>* estimators) {
  const auto last_if_nan = [](double value) {
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
  };
  std::ranges::stable_sort(*estimators, {}, [&](const AskedEstimator& estimator) {
    return std::array{last_if_nan(-estimator.success.value), last_if_nan(estimator.median_error_deg),
                      last_if_nan(estimator.time_ms)};
  });
}

std::string DescribeInlierThreshold(const Settings& options, double sigma_px) {
  double number = 0.0;
  if (ParseReal(FindValue(options, "threshold_sigma"), &number))
    return fmt::format("{:g} sigma = {:.3g} px", number, number * sigma_px);
  const std::string sigma = FindValue(options, "sigma");  // of rcme_calibrated
  if (sigma == "estimated")
    return fmt::format("none: it weighs each match by sigma, estimated from {:g} px on", sigma_px);
  if (sigma == "assumed") return fmt::format("none: it weighs each match by sigma = {:g} px", sigma_px);
  const std::string level = FindValue(options, "significance_level");
  if (ParseReal(level, &number))
    return fmt::format("a test that refuses {:g} % of the true matches, sigma = {:g} px", 100.0 * number,
                       sigma_px);
  return {};
}

Answer AnswerQuestion(const ResultStore& run, double at_most, double sigma_px) {
  const RunDescription description = run.Description();
  if (description.conditions.size() != 1)
    throw InputError(fmt::format("ask: {}: has {} conditions; an answer is of one", description.study,
                                 description.conditions.size()));
  const Summary summary = Summarize(run, /*with_times=*/true);
  const std::vector<AskedEstimator> ranked = ListRanked(description, summary, sigma_px);
  Answer answer;
  answer.num_trials = summary.num_trials_done;
  answer.num_estimators = static_cast<int>(ranked.size());
  answer.at_most = at_most;
  answer.failure = description.failure;
  answer.num_alike = static_cast<int>(std::ranges::count(
      ranked, ranked.front().success.value, [](const AskedEstimator& e) { return e.success.value; }));
  answer.best = ranked.front();
  if (ranked.size() > 1) {
    answer.next = ranked[1];
    answer.difference = CompareTwo(run, answer.best.label, answer.next->label);
  }
  const std::string& best = answer.best.label;
  const std::vector<StatedAnswer> stated = CollectStated(run, best);
  answer.states_probability = !stated.empty();
  if (answer.states_probability) {
    answer.rule = CertifyAcceptRule(stated, answer.num_trials, at_most, answer.num_estimators);
    answer.stated = FindEstimate(summary, best, "failure_probability");
    answer.failed = WidenForChoice(EstimateFailed(stated), answer.num_estimators);
  }
  answer.sd_over_crb = FindEstimate(summary, best, "sd_over_crb").value;
  answer.rotation_sd_deg = FindEstimate(summary, best, "rotation_sd_deg").value;
  answer.direction_sd_deg = FindEstimate(summary, best, "direction_sd_deg").value;
  answer.coverage = WidenForChoice(FindEstimate(summary, best, "nees_coverage"), answer.num_estimators);
  return answer;
}

}  // namespace rcme
