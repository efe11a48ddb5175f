#include "experiments/statistics/population_summary.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/statistics/summary_quantities.h"
#include "experiments/study/population.h"
#include "stats/constants.h"
#include "stats/population_mean.h"
#include "stats/population_median.h"
#include "stats/population_rate.h"

namespace rcme {
namespace {

Moments ComputeMoments(const ExactMoments& exact) {
  return Moments::FromStatistics(exact.n(), exact.mean(), exact.variance());
}

PopulationRate MeasureRate(const std::vector<ConditionCount>& counts) {
  return MeasurePopulationRate(counts, ConditionWeights::kByTrials);
}

void TakeRate(const std::vector<const QuantityCounts*>& draws, SummaryRow* row) {
  std::vector<ConditionCount> counts;
  for (const QuantityCounts* draw : draws) {
    const auto& events = std::get<WeightedEvents>(*draw);
    counts.push_back({std::llround(events.sum_weights), events.num_trials});
  }
  const PopulationRate rate = MeasureRate(counts);
  row->interval = rate.interval;
  row->of_population = PopulationPart{rate.of_these_conditions, rate.effective_n};
  if (!row->coverage_verdict) return;
  CoverageVerdict verdict = JudgeCoverage(row->value, row->interval, row->n, row->n, true);
  verdict.trials_to_decide = kNaN;  // more conditions would decide, not more trials
  row->coverage_verdict = verdict;
}

void TakeMean(const std::vector<Moments>& draws, SummaryRow* row) {
  const PopulationMean mean = MeasurePopulationMean(draws, ConditionWeights::kByTrials);
  PopulationPart part{.effective_n = mean.effective_n};
  if (row->kind == SummaryRow::Kind::kMean) {
    row->standard_error = mean.standard_error;
    row->of_population = part;
    return;
  }
  row->interval = {std::max(mean.interval.lower, 0.0), std::min(mean.interval.upper, 1.0)};
  part.of_these_conditions = {std::max(mean.of_these_conditions.lower, 0.0),
                              std::min(mean.of_these_conditions.upper, 1.0)};
  row->of_population = part;
}

void TakeMedian(const std::vector<const QuantityCounts*>& draws, SummaryRow* row) {
  std::vector<const StreamMedian*> medians;
  for (const QuantityCounts* draw : draws) medians.push_back(&std::get<StreamMedian>(*draw));
  const PopulationMedian median = MeasurePopulationMedian(medians);
  row->interval = median.interval;
  row->of_population = PopulationPart{median.of_these_conditions, median.effective_n};
}

// Returns the counts of every draw for the row's quantity, of its estimator or of the problems.
std::vector<const QuantityCounts*> ListDrawCounts(const RunDescription& run,
                                                  std::span<const SummaryCell> draws, const SummaryRow& row) {
  const auto place = [&](const auto& quantities) {
    return static_cast<size_t>(
        std::ranges::find_if(quantities,
                             [&](const auto& quantity) { return quantity.name == row.quantity; }) -
        quantities.begin());
  };
  const bool is_of_problems = row.estimator == kSceneLabel;
  const size_t quantity = is_of_problems ? place(ProblemQuantities()) : place(TrialQuantities());
  const auto estimator = static_cast<size_t>(
      std::ranges::find(run.estimators, row.estimator.text(), &DescribedEstimator::label) -
      run.estimators.begin());
  std::vector<const QuantityCounts*> counts;
  for (const SummaryCell& draw : draws) {
    const QuantitySums& sums = is_of_problems ? draw.of_problems() : draw.of_estimator(estimator);
    counts.push_back(&sums.counts.at(quantity));
  }
  return counts;
}

void TakeIntervalOfPopulation(const std::vector<const QuantityCounts*>& draws, SummaryRow* row) {
  row->interval_kind = IntervalKind::kPopulation;
  if (row->n == 0) return;
  if (row->kind == SummaryRow::Kind::kRate) return TakeRate(draws, row);
  if (row->kind == SummaryRow::Kind::kMedian) return TakeMedian(draws, row);
  std::vector<Moments> moments;
  for (const QuantityCounts* draw : draws) {
    moments.push_back(row->kind == SummaryRow::Kind::kScore
                          ? ComputeMoments(std::get<ExactScores>(*draw).moments())
                          : ComputeMoments(std::get<ExactMoments>(*draw)));
  }
  TakeMean(moments, row);
}

}  // namespace

bool HasPopulationIntervals(const RunDescription& run) {
  return IsSampleOfPopulation(run.identity) && run.repeats_per_scene == 1 && run.stopping_rule.empty();
}

Summary SummarizePopulation(const RunDescription& run, std::span<const SummaryCell> draws, bool with_times) {
  SummaryCell all(run.estimators.size());
  if (std::ranges::all_of(draws, &SummaryCell::ranks_errors)) all.RankErrors();
  for (const SummaryCell& draw : draws) all.Merge(draw);
  Summary summary = SummarizeCells(run, OneGroup(), {&all}, with_times);
  summary.is_of_population = true;
  for (SummaryRow& row : summary.rows) {
    if (row.kind == SummaryRow::Kind::kArea) {
      row.interval_kind = IntervalKind::kPopulation;  // its clusters are the draws
    } else {
      TakeIntervalOfPopulation(ListDrawCounts(run, draws, row), &row);
    }
  }
  return summary;
}

}  // namespace rcme
