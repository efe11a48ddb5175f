#include "experiments/statistics/marginals.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "experiments/statistics/failure_forecasts.h"
#include "experiments/statistics/scenes_of_run.h"
#include "experiments/statistics/trial_groups.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/study/population.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "stats/distributions.h"
#include "stats/moments.h"
#include "stats/population_mean.h"
#include "stats/population_rate.h"

namespace rcme {
namespace {

constexpr size_t kNumQuantities = std::size(kMarginalQuantities);

// Returns the value of the quantity in a trial; nothing if the trial does not count for it.
std::optional<double> ValueIn(const TrialRecord& record, const FailureBounds& bounds, bool states,
                              MarginalQuantity quantity) {
  static const double nees_bound = ChiSquareQuantile(5, 0.95);
  const std::optional<double> stated = StatedFailureProbability(record);
  const bool has_failed = HasFailed(record, bounds);
  switch (quantity) {
    case MarginalQuantity::kFailedLessStated:
      return stated ? std::optional(has_failed - *stated) : std::nullopt;
    case MarginalQuantity::kSureFailed:
      return stated && *stated <= kSureBelow ? std::optional(has_failed - *stated) : std::nullopt;
    case MarginalQuantity::kSureCoverage: {
      const bool counts = states ? stated && *stated <= kCertainBelow : HasSucceeded(record, bounds);
      return counts && !std::isnan(record.nees) ? std::optional<double>(record.nees <= nees_bound)
                                                : std::nullopt;
    }
    case MarginalQuantity::kFailure:
      return IsScored(record) ? std::optional<double>(has_failed) : std::nullopt;
  }
  return std::nullopt;
}

double FindClaimedRate(MarginalQuantity quantity) {
  switch (quantity) {
    case MarginalQuantity::kSureCoverage:
      return 0.95;
    case MarginalQuantity::kFailure:
      return std::numeric_limits<double>::quiet_NaN();
    default:
      return 0.0;
  }
}

struct ConditionValues {
  Moments moments;
  std::int64_t num_failed = 0;  // number of these trials that failed
  Moments log_sd_over_crb;      // of those with a bound; only for a coverage
};

// By estimator, quantity and condition.
using Values = std::vector<std::vector<std::vector<ConditionValues>>>;

Values CollectValues(const ResultStore& run, const RunDescription& description) {
  const size_t num_estimators = description.estimators.size(), num_conditions = description.conditions.size();
  std::vector<bool> states(num_estimators);
  run.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    if (problem.weight != 1.0)
      throw InputError(
          "marginals: the trials of this run are weighted (tilted_to), which its intervals do not allow");
    for (size_t e = 0; e < records.size(); ++e)
      if (StatedFailureProbability(records[e])) states[e] = true;
  });
  Values values(num_estimators, {kNumQuantities, std::vector<ConditionValues>(num_conditions)});
  run.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    for (size_t e = 0; e < records.size(); ++e) {
      for (size_t q = 0; q < kNumQuantities; ++q) {
        const auto value = ValueIn(records[e], description.failure, states[e], kMarginalQuantities[q]);
        if (!value) continue;
        ConditionValues& of_condition = values[e][q][problem.condition];
        of_condition.moments.Add(*value);
        of_condition.num_failed += HasFailed(records[e], description.failure);
        const double sharpness = records[e].density.sd_over_crb;
        if (kMarginalQuantities[q] == MarginalQuantity::kSureCoverage && sharpness > 0.0)
          of_condition.log_sd_over_crb.Add(std::log(sharpness));
      }
    }
  });
  return values;
}

// A level of a factor, or a range of its levels.
struct Level {
  size_t factor = 0;
  Regime regime;
};

std::vector<std::string> LevelsOfFactor(const RunDescription& run, size_t factor) {
  std::vector<std::string> levels;
  for (const auto& condition : run.conditions) levels.push_back(condition.levels[factor]);
  return levels;
}

// Divides the conditions into fifths by a number; conditions without it are in none.
std::vector<Level> DivideIntoFifths(const std::string& name, size_t factor,
                                    const std::vector<double>& numbers) {
  constexpr size_t kNumParts = 5;
  std::vector<double> sorted;
  for (const double x : numbers)
    if (!std::isnan(x)) sorted.push_back(x);
  std::ranges::sort(sorted);
  std::vector<Level> parts;
  for (size_t part = 0; part < kNumParts; ++part) {
    const double low = sorted[part * sorted.size() / kNumParts];
    const bool is_last = part + 1 == kNumParts;
    const double high = is_last ? sorted.back() : sorted[(part + 1) * sorted.size() / kNumParts];
    Level level{factor, {fmt::format("{} {:.3g} to {:.3g}", name, low, high), {}}};
    for (const double x : numbers) level.regime.has.push_back(x >= low && (is_last || x < high));
    parts.push_back(std::move(level));
  }
  return parts;
}

std::vector<Level> ListLevels(const RunDescription& run, size_t factor) {
  const std::string& name = run.factors[factor];
  const std::vector<std::string> levels = LevelsOfFactor(run, factor);
  std::vector<std::string> distinct;
  std::vector<double> numbers;
  bool are_numbers = true;
  for (const std::string& level : levels) {
    double number = std::numeric_limits<double>::quiet_NaN();
    are_numbers = are_numbers && (level == kNotDrawn || ParseReal(level, &number));
    numbers.push_back(number);
    if (level != kNotDrawn && std::ranges::count(distinct, level) == 0) distinct.push_back(level);
  }
  if (are_numbers && distinct.size() > kMaxLevels) return DivideIntoFifths(name, factor, numbers);
  std::vector<Level> all;
  for (const std::string& one : distinct) {
    Level level{factor, {fmt::format("{} = {}", name, one), {}}};
    for (const std::string& of_condition : levels) level.regime.has.push_back(of_condition == one);
    all.push_back(std::move(level));
  }
  return all;
}

bool IsRegime(const std::vector<bool>& has) {
  const auto number = static_cast<size_t>(std::ranges::count(has, true));
  return number >= kLeastConditions && number < has.size();
}

// Selects the conditions of a regime that have trials, and merges the conditions of a draw. `draws`: the
// draw of each condition.
std::vector<ConditionValues> Select(const std::vector<ConditionValues>& conditions,
                                    const std::vector<bool>& has, const std::vector<size_t>& draws) {
  std::map<size_t, ConditionValues> of_draw;
  for (size_t c = 0; c < conditions.size(); ++c) {
    if (!has[c] || conditions[c].moments.n() == 0) continue;
    of_draw[draws[c]].moments.Merge(conditions[c].moments);
    of_draw[draws[c]].num_failed += conditions[c].num_failed;
    of_draw[draws[c]].log_sd_over_crb.Merge(conditions[c].log_sd_over_crb);
  }
  std::vector<ConditionValues> selected;
  for (const auto& [draw, values] : of_draw) selected.push_back(values);
  return selected;
}

bool IsShare(MarginalQuantity quantity) {
  return quantity == MarginalQuantity::kFailure || quantity == MarginalQuantity::kSureCoverage;
}

// Measures the share of failures minus the mean stated probability. If fewer than kLeastConditions
// conditions had a failure, or fewer had a non-failure, the spread between conditions does not show how many
// failures may have been missed. The interval is then extended by that of the failure rate. For instance, an
// estimator that states P = 0.001 and did not fail in 100 trials is not too cautious. For these very
// conditions the trials take the place of the conditions: Student's law needs kLeastEvents of both kinds.
PopulationMean MeasureDifference(const std::vector<ConditionValues>& conditions, bool is_of_these,
                                 double confidence) {
  constexpr std::int64_t kLeastEvents = 50;
  std::vector<Moments> moments;
  std::vector<ConditionCount> failures;
  size_t num_with_failures = 0, num_with_others = 0;
  for (const ConditionValues& one : conditions) {
    moments.push_back(one.moments);
    failures.push_back({one.num_failed, one.moments.n()});
    num_with_failures += one.num_failed > 0;
    num_with_others += one.num_failed < one.moments.n();
  }
  PopulationMean mean = MeasurePopulationMean(moments, ConditionWeights::kByTrials, confidence);
  const PopulationRate rate = MeasurePopulationRate(failures, ConditionWeights::kByTrials, confidence);
  if (is_of_these) mean.interval = mean.of_these_conditions;
  const bool has_few = is_of_these ? std::min(rate.num_events, rate.n - rate.num_events) < kLeastEvents
                                   : std::min(num_with_failures, num_with_others) < kLeastConditions;
  if (has_few) {
    const Interval& of_rate = is_of_these ? rate.of_these_conditions : rate.interval;
    const double stated = rate.value - mean.value;
    mean.interval.lower = std::min(mean.interval.lower, of_rate.lower - stated);
    mean.interval.upper = std::max(mean.interval.upper, of_rate.upper - stated);
  }
  return mean;
}

Marginal Measure(const std::vector<ConditionValues>& conditions, MarginalQuantity quantity, bool is_of_these,
                 double confidence) {
  Marginal marginal;
  marginal.quantity = quantity;
  marginal.claimed = FindClaimedRate(quantity);
  if (IsShare(quantity)) {
    std::vector<ConditionCount> counts;
    Moments log_sd_over_crb;
    for (const auto& [moments, num_failed, of_condition] : conditions) {
      counts.push_back({std::llround(moments.mean() * static_cast<double>(moments.n())), moments.n()});
      log_sd_over_crb.Merge(of_condition);
    }
    if (log_sd_over_crb.n() > 0) marginal.sd_over_crb = std::exp(log_sd_over_crb.mean());
    const PopulationRate rate = MeasurePopulationRate(counts, ConditionWeights::kByTrials, confidence);
    marginal.value = rate.value, marginal.n = rate.n;
    marginal.interval = is_of_these ? rate.of_these_conditions : rate.interval;
  } else {
    const PopulationMean mean = MeasureDifference(conditions, is_of_these, confidence);
    marginal.value = mean.value, marginal.interval = mean.interval, marginal.n = mean.n;
  }
  marginal.num_conditions = std::ssize(conditions);
  const double beyond =
      std::max({0.0, marginal.interval.lower - marginal.claimed, marginal.claimed - marginal.interval.upper});
  if (beyond > 0.0) marginal.excess = beyond / (0.5 * (marginal.interval.upper - marginal.interval.lower));
  return marginal;
}

// Intervals need numbers of trials that the outcomes did not choose and, unless the conditions are a random
// sample of a population, conditions that do not depend on each other. Those for chosen draws are of these
// very conditions, so their trials must not depend on each other either.
void CheckTrialsAreIndependent(const RunDescription& run) {
  const bool are_chosen = HasChosenDraws(run.identity);
  const char* why = !run.stopping_rule.empty()                 ? "ended by a stopping rule (--until)"
                    : HasCommonScenes(run)                     ? "share their scenes (common_scenes: true)"
                    : are_chosen && run.repeats_per_scene != 1 ? "repeat their scenes (repeats_per_scene)"
                                                               : nullptr;
  if (why == nullptr) return;
  throw InputError(fmt::format(
      "marginals: the conditions {}, which the intervals over conditions do not allow; run the study without this",
      why));
}

std::vector<size_t> ChooseEstimators(const RunDescription& run, const std::vector<std::string>& labels) {
  std::vector<size_t> chosen;
  for (const std::string& label : labels)
    chosen.push_back(FindEstimator(run.estimators, label, "--estimators: the run"));
  for (size_t e = 0; labels.empty() && e < run.estimators.size(); ++e) chosen.push_back(e);
  std::ranges::sort(chosen);
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

}  // namespace

std::string Name(MarginalQuantity quantity) {
  switch (quantity) {
    case MarginalQuantity::kFailedLessStated:
      return "failed - P";
    case MarginalQuantity::kSureFailed:
      return fmt::format("failed - P at P <= {}", kSureBelow);
    case MarginalQuantity::kSureCoverage:
      return "coverage";
    case MarginalQuantity::kFailure:
      return "failure";
  }
  return {};
}

std::vector<ConditionMoments> CollectConditionMoments(const ResultStore& run, size_t estimator,
                                                      MarginalQuantity quantity) {
  const Values values = CollectValues(run, run.Description());
  const auto place = std::ranges::find(kMarginalQuantities, quantity) - std::begin(kMarginalQuantities);
  std::vector<ConditionMoments> moments;
  for (const ConditionValues& one : values[estimator][static_cast<size_t>(place)])
    moments.push_back({one.moments, one.log_sd_over_crb});
  return moments;
}

std::vector<Regime> ListRegimes(const RunDescription& run, bool with_pairs) {
  std::vector<Regime> regimes = {{"", std::vector<bool>(run.conditions.size(), true)}};
  std::vector<Level> levels;
  for (size_t f = 0; f < run.factors.size(); ++f) {
    if (run.factors[f] == kDrawFactor) continue;
    for (Level& level : ListLevels(run, f))
      if (IsRegime(level.regime.has)) levels.push_back(std::move(level));
  }
  for (const Level& level : levels) regimes.push_back(level.regime);
  for (size_t i = 0; with_pairs && i < levels.size(); ++i) {
    for (size_t j = i + 1; j < levels.size(); ++j) {
      if (levels[j].factor == levels[i].factor) continue;
      std::vector<bool> both;
      for (size_t c = 0; c < levels[i].regime.has.size(); ++c)
        both.push_back(levels[i].regime.has[c] && levels[j].regime.has[c]);
      // A regime that contains the other adds nothing.
      if (IsRegime(both) && both != levels[i].regime.has && both != levels[j].regime.has)
        regimes.push_back({levels[i].regime.text + ", " + levels[j].regime.text, std::move(both)});
    }
  }
  return regimes;
}

Marginals MeasureMarginals(const ResultStore& run, const MarginalOptions& options) {
  const RunDescription description = run.Description();
  if (description.conditions.size() < kLeastConditions)
    throw InputError(fmt::format("marginals: the run has {} conditions; at least {} are needed",
                                 description.conditions.size(), kLeastConditions));
  Marginals marginals;
  marginals.is_of_these_conditions = HasChosenDraws(description.identity);
  CheckTrialsAreIndependent(description);
  const Values values = CollectValues(run, description);
  const std::vector<size_t> draws = NumberDraws(description);
  const std::vector<Regime> regimes = ListRegimes(description, options.with_pairs);
  struct Question {
    size_t estimator, quantity;
    const Regime* regime;
    std::vector<ConditionValues> conditions;
  };
  std::vector<Question> questions;
  for (const size_t e : ChooseEstimators(description, options.estimators)) {
    for (const Regime& regime : regimes) {
      for (size_t q = 0; q < kNumQuantities; ++q) {
        std::vector<ConditionValues> conditions = Select(values[e][q], regime.has, draws);
        if (conditions.size() >= kLeastConditions)
          questions.push_back({e, q, &regime, std::move(conditions)});
      }
    }
  }
  marginals.num_intervals = questions.size();
  const double confidence = 1.0 - (1.0 - marginals.confidence) / static_cast<double>(questions.size());
  for (const Question& question : questions) {
    Marginal row = Measure(question.conditions, kMarginalQuantities[question.quantity],
                           marginals.is_of_these_conditions, confidence);
    row.estimator = description.estimators[question.estimator].label;
    row.regime = question.regime->text;
    marginals.rows.push_back(std::move(row));
  }
  std::ranges::stable_sort(marginals.rows, std::ranges::greater(), &Marginal::excess);
  return marginals;
}

}  // namespace rcme
