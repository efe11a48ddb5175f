#include "experiments/statistics/compared_pairs.h"

#include <cmath>
#include <functional>
#include <vector>

#include "stats/constants.h"
#include "stats/population_mean.h"
#include "stats/population_median.h"
#include "stats/population_rate.h"

namespace rcme {
namespace {

// Finds, by bisection, the least level (to 1e-6) at which an interval does not contain 0. `interval_at`
// returns the interval of a confidence; these intervals are nested.
double FindPValue(double value, const std::function<Interval(double)>& interval_at) {
  if (value == 0.0) return 1.0;
  double excluded = 1.0, included = 1e-6;  // at level 1 the interval is the value itself
  if (!interval_at(1.0 - included).Contains(0.0)) return included;
  while (excluded - included > 1e-6 + 1e-3 * excluded) {
    const double level = std::sqrt(excluded * included);
    (interval_at(1.0 - level).Contains(0.0) ? included : excluded) = level;
  }
  return excluded;
}

constexpr ConditionWeights kWeights = ConditionWeights::kByTrials;

}  // namespace

void ComparedPairs::Add(double first, double second, bool is_first_of_scene) {
  if (kind_ == ComparedKind::kEvent) counts_.Add(first != 0.0, second != 0.0);
  if (kind_ != ComparedKind::kError) {
    scene_.Add(first - second);
  } else if (is_first_of_scene) {
    counts_.Add(first > second, second > first);
    error_difference_.Add(first == second ? 0.0 : first - second);  // two infinite errors are equal
  }
}

void ComparedPairs::EndScene() {
  const std::optional<double> mean = scene_.Take();
  if (!mean || !IsByMeans()) return;
  mean_difference_.Add(*mean);
  difference_.Add(*mean);
}

void ComparedPairs::Fill(bool is_anytime_valid, ComparisonRow* row) const {
  row->kind = kind_;
  row->is_anytime_valid = is_anytime_valid || IsByMeans();
  row->is_of_scenes = has_repeats_;
  row->counts = counts_;
  if (IsByMeans()) {
    FillMeans(row);
  } else if (kind_ == ComparedKind::kEvent) {
    FillEvent(row);
  } else {
    FillError(row);
  }
  if (row->n == 0) row->p_value = std::nan("");
  row->holm_p_value = row->p_value;
}

double ComparedPairs::PValueOfCounts(bool is_anytime_valid) const {
  return is_anytime_valid ? AnytimeMcNemarPValue(counts_) : McNemarExactPValue(counts_);
}

void ComparedPairs::FillEvent(ComparisonRow* row) const {
  row->n = counts_.n();
  row->difference = row->n > 0 ? counts_.RiskDifference() : std::nan("");
  row->p_value = PValueOfCounts(row->is_anytime_valid);
  row->interval = row->is_anytime_valid ? AnytimeRiskDifferenceInterval() : RiskDifferenceInterval(counts_);
}

void ComparedPairs::FillMeans(ComparisonRow* row) const {
  row->n = mean_difference_.n();
  row->difference = mean_difference_.mean();
  row->p_value = mean_difference_.PValue(0.0);
  row->interval = mean_difference_.Sequence();
}

// The sign test is McNemar's test of the event "greater than the other". The interval of the median requires
// a fixed number of trials.
void ComparedPairs::FillError(ComparisonRow* row) const {
  row->n = error_difference_.n();
  row->difference = error_difference_.median();
  row->p_value = PValueOfCounts(row->is_anytime_valid);
  row->interval = row->is_anytime_valid || row->n == 0 ? Interval{std::nan(""), std::nan("")}
                                                       : error_difference_.interval();
}

Interval ComparedPairs::AnytimeRiskDifferenceInterval() const {
  ScoreMean difference({-1.0, 1.0});
  difference.Add(1.0, counts_.first_only);
  difference.Add(-1.0, counts_.second_only);
  difference.Add(0.0, counts_.both + counts_.neither);
  return difference.Sequence();
}

void ComparedPairs::Merge(const ComparedPairs& other) {
  counts_.Merge(other.counts_);
  difference_.Merge(other.difference_);
  error_difference_.Merge(other.error_difference_);
}

void ComparedPairs::FillOfPopulation(std::span<const ComparedPairs> draws, ComparisonRow* row) {
  ComparedPairs all(draws.front().kind_, false);
  std::vector<ConditionPair> counts;
  std::vector<Moments> differences;
  for (const ComparedPairs& draw : draws) {
    all.Merge(draw);
    counts.push_back({draw.counts_.first_only, draw.counts_.second_only, draw.counts_.n()});
    differences.push_back(draw.difference_);
  }
  row->kind = all.kind_;
  row->is_of_population = true;
  row->counts = all.counts_;
  row->n = all.IsByMeans() ? all.difference_.n() : all.counts_.n();
  row->difference = row->p_value = row->holm_p_value = kNaN;
  row->interval = {kNaN, kNaN};
  if (row->n == 0) return;
  const auto interval_at = [&](double confidence) {
    return all.IsByMeans() ? MeasurePopulationMean(differences, kWeights, confidence).interval
                           : MeasurePopulationDifference(counts, kWeights, confidence).interval;
  };
  row->difference = all.IsByMeans() ? all.difference_.mean() : all.counts_.RiskDifference();
  row->interval = interval_at(0.95);
  row->p_value = FindPValue(row->difference, interval_at);
  if (all.kind_ == ComparedKind::kError) {
    std::vector<const StreamMedian*> medians;
    for (const ComparedPairs& draw : draws) medians.push_back(&draw.error_difference_);
    row->difference = all.error_difference_.median();
    row->interval = MeasurePopulationMedian(medians).interval;
  }
  row->holm_p_value = row->p_value;
}

}  // namespace rcme
