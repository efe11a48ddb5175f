#include "experiments/statistics/failure_forecasts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/statistics/population_summary.h"
#include "experiments/statistics/trial_groups.h"
#include "experiments/study/population.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"
#include "stats/isotonic_regression.h"

namespace rcme {
namespace {

// The data kept of one estimator's trial.
struct Answer {
  double stated = 0.0;        // NaN: none, or not to be judged
  double inlier_share = 0.0;  // accepted share of the matches
  std::int64_t cluster = 0, scene = 0;
  size_t group = 0;
  bool states = false, refused = false, failed = false, is_in_even_half = false;
};

// The group of each condition.
struct Groups {
  std::vector<std::string> names;
  std::vector<size_t> of_condition;
};

Groups GroupsBy(const std::string& factor, const RunDescription& run) {
  if (factor.empty()) return {{""}, std::vector<size_t>(run.conditions.size(), 0)};
  const auto place = std::ranges::find(run.factors, factor);
  if (place == run.factors.end()) {
    throw InputError(fmt::format("--by: study '{}' has no factor {}{}; allowed: {}", run.study,
                                 Quoted(factor), DidYouMean(factor, run.factors),
                                 fmt::join(run.factors, ", ")));
  }
  Groups groups;
  for (const DescribedCondition& condition : run.conditions) {
    const std::string& level = condition.levels[static_cast<size_t>(place - run.factors.begin())];
    const auto known = std::ranges::find(groups.names, level);
    groups.of_condition.push_back(static_cast<size_t>(known - groups.names.begin()));
    if (known == groups.names.end()) groups.names.push_back(level);
  }
  return groups;
}

Answer ReadAnswer(const TrialRecord& record, const FailureBounds& bounds) {
  Answer answer;
  answer.stated = StatedFailureProbability(record).value_or(std::nan(""));
  answer.inlier_share = record.num_matches > 0 ? 1.0 * record.num_inliers / record.num_matches : 0.0;
  answer.states = !std::isnan(record.failure_probability);
  answer.refused = HasRefused(record);
  answer.failed = HasFailed(record, bounds);
  return answer;
}

// Returns the answers by estimator, in order of condition and trial. Throws InputError if trials are
// weighted.
std::vector<std::vector<Answer>> AnswersIn(const ResultStore& store, const RunDescription& run,
                                           const Groups& groups) {
  std::vector<std::vector<Answer>> answers(run.estimators.size());
  const TrialClusters clusters(run);
  store.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    if (problem.weight != 1.0)
      throw InputError(run.study +
                       ": its trials are weighted (tilted_to); shares of its answers are no rates");
    const std::int64_t scene = problem.trial / static_cast<std::uint32_t>(run.repeats_per_scene);
    for (size_t e = 0; e < records.size(); ++e) {
      if (!IsScored(records[e])) continue;
      answers[e].push_back(ReadAnswer(records[e], run.failure));
      answers[e].back().cluster = clusters.Find(problem);
      answers[e].back().scene = clusters.FindScene(problem);
      answers[e].back().group = groups.of_condition[problem.condition];
      answers[e].back().is_in_even_half = scene % 2 == 0;
    }
  });
  return answers;
}

// Fits failure as an increasing function of the share of outliers to the answers of one half.
IsotonicFit FailureOverOutliers(const std::vector<Answer>& answers, bool of_even_half) {
  std::vector<double> outlier_shares, failed;
  for (const Answer& answer : answers) {
    if (answer.refused || answer.is_in_even_half != of_even_half) continue;
    outlier_shares.push_back(1.0 - answer.inlier_share);
    failed.push_back(answer.failed ? 1.0 : 0.0);
  }
  return failed.empty() ? IsotonicFit() : FitIsotonic(outlier_shares, failed);
}

// Returns a probability per answer; NaN: none.
std::vector<double> ProbabilitiesFromInliers(const std::vector<Answer>& answers) {
  const std::array<IsotonicFit, 2> of_other_half = {FailureOverOutliers(answers, true),
                                                    FailureOverOutliers(answers, false)};
  std::vector<double> probabilities;
  for (const Answer& answer : answers) {
    const IsotonicFit& fit = of_other_half[answer.is_in_even_half ? 1 : 0];
    probabilities.push_back(fit.x.empty() ? std::nan("") : fit.At(1.0 - answer.inlier_share));
  }
  return probabilities;
}

std::vector<double> StatedProbabilities(const std::vector<Answer>& answers) {
  std::vector<double> probabilities;
  for (const Answer& answer : answers) probabilities.push_back(answer.stated);
  return probabilities;
}

bool StatesAny(const std::vector<Answer>& answers) {
  return std::ranges::any_of(answers, [](const Answer& a) { return !a.refused && a.states; });
}

}  // namespace

std::optional<double> StatedFailureProbability(const TrialRecord& record) {
  if (HasRefused(record) || !IsScored(record) || std::isnan(record.failure_probability)) return std::nullopt;
  if (!IsInvalid(record) && std::isnan(record.direction_error_deg)) return std::nullopt;
  return record.failure_probability;
}

std::optional<double> BrierOfStated(const TrialRecord& record, const FailureBounds& bounds) {
  const std::optional<double> stated = StatedFailureProbability(record);
  return stated ? std::optional<double>(BrierScore(*stated, HasFailed(record, bounds))) : std::nullopt;
}

std::string Name(ForecastSource source) {
  return source == ForecastSource::kStated ? "stated" : "inlier_share";
}

std::vector<FailureForecasts> CollectFailureForecasts(const ResultStore& store, const std::string& by) {
  const RunDescription run = store.Description();
  const Groups groups = GroupsBy(by, run);
  const std::vector<std::vector<Answer>> answers = AnswersIn(store, run, groups);
  std::vector<FailureForecasts> all;
  for (size_t e = 0; e < run.estimators.size(); ++e) {
    const ForecastSource source =
        StatesAny(answers[e]) ? ForecastSource::kStated : ForecastSource::kInlierShare;
    const std::vector<double> probabilities = source == ForecastSource::kStated
                                                  ? StatedProbabilities(answers[e])
                                                  : ProbabilitiesFromInliers(answers[e]);
    const size_t first = all.size();
    for (const std::string& group : groups.names)
      all.push_back({run.estimators[e].label, group, source, HasPopulationIntervals(run), {}, {}, 0});
    for (size_t i = 0; i < answers[e].size(); ++i) {
      const Answer& answer = answers[e][i];
      FailureForecasts& of_group = all[first + answer.group];
      if (answer.refused) {
        of_group.refused_clusters.push_back(answer.cluster);
      } else if (std::isnan(probabilities[i])) {
        ++of_group.num_without;
      } else {
        of_group.forecasts.push_back({probabilities[i], answer.failed, answer.cluster});
        of_group.scenes.push_back(answer.scene);
      }
    }
  }
  return all;
}

void AddForecastsOfRun(std::vector<FailureForecasts> run, std::vector<FailureForecasts>* all) {
  std::int64_t next_cluster = 0;
  for (const FailureForecasts& known : *all) {
    for (const Forecast& forecast : known.forecasts)
      next_cluster = std::max(next_cluster, forecast.cluster + 1);
    for (const std::int64_t cluster : known.refused_clusters)
      next_cluster = std::max(next_cluster, cluster + 1);
  }
  for (FailureForecasts& added : run) {
    for (Forecast& forecast : added.forecasts) forecast.cluster += next_cluster;
    for (std::int64_t& cluster : added.refused_clusters) cluster += next_cluster;
    const auto same = std::ranges::find_if(*all, [&](const FailureForecasts& known) {
      return known.estimator == added.estimator && known.group == added.group;
    });
    if (same == all->end()) {
      all->push_back(std::move(added));
      continue;
    }
    if (same->is_of_population != added.is_of_population) {
      throw InputError(
          "the draws of a population and other conditions cannot be pooled; give their runs one at a time");
    }
    if (same->source != added.source) {
      throw InputError(fmt::format("{}: its probabilities of failure are {} in one run and {} in another",
                                   added.estimator, Name(same->source), Name(added.source)));
    }
    same->forecasts.insert(same->forecasts.end(), added.forecasts.begin(), added.forecasts.end());
    same->scenes.insert(same->scenes.end(), added.scenes.begin(), added.scenes.end());
    same->refused_clusters.insert(same->refused_clusters.end(), added.refused_clusters.begin(),
                                  added.refused_clusters.end());
    same->num_without += added.num_without;
  }
}

}  // namespace rcme
