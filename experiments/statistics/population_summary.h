// The pooled summary of a run whose conditions are draws of a population: the values are those of all trials
// together, the intervals are of the population.
//
// Rates and scores have the intervals of stats/population_rate.h and population_mean.h, means the latter's
// standard error; weights are by trials, so that the value is the share or mean over all trials. Medians:
// population_median.h.
#pragma once

#include <span>

#include "experiments/statistics/summary_cell.h"

namespace rcme {

// Whether pooled numbers of the run have such intervals: its conditions are draws of a population, not chosen
// ones, each trial has a scene of its own, and their number was fixed beforehand. Weighted trials have none
// either.
bool HasPopulationIntervals(const RunDescription& run);

// `draws`: a cell of counts for each group of GroupByDraw.
Summary SummarizePopulation(const RunDescription& run, std::span<const SummaryCell> draws, bool with_times);

}  // namespace rcme
