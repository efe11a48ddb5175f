// The pooled summary of a run whose conditions are draws of a population. Values are those of all trials
// together; intervals are for the population.
//
// Rates and scores have the intervals of stats/population_rate.h and population_mean.h; means have the
// standard error of the latter; medians use population_median.h. Draws are weighted by their trials, so a
// value is the share or mean over all trials.
#pragma once

#include <span>

#include "experiments/statistics/summary_cell.h"

namespace rcme {

// Returns whether pooled numbers of the run have such intervals: its conditions are a sample of draws (not
// chosen ones), each trial has its own scene, and the number of trials was fixed beforehand. Weighted trials
// do not have them either.
bool HasPopulationIntervals(const RunDescription& run);

// Said of pooled draws without them.
inline constexpr const char* kOfTheseDraws =
    "All intervals are of these draws, not of their population: that needs one trial for\n"
    "each scene and a number of trials fixed beforehand.\n";

// `draws`: a cell of counts for each group of GroupByDraw.
Summary SummarizePopulation(const RunDescription& run, std::span<const SummaryCell> draws, bool with_times);

}  // namespace rcme
