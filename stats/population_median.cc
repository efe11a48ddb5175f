#include "stats/population_median.h"

#include <vector>

#include "stats/constants.h"
#include "stats/population_rate.h"

namespace rcme {

PopulationMedian MeasurePopulationMedian(std::span<const StreamMedian* const> draws) {
  StreamMedian all;
  for (const StreamMedian* draw : draws) all.Merge(*draw);
  if (all.n() == 0) return {kNaN, {kNaN, kNaN}, {kNaN, kNaN}, kNaN};
  std::vector<ConditionCount> up_to;
  for (const StreamMedian* draw : draws) up_to.push_back({draw->CountUpTo(all.median()), draw->n()});
  const PopulationRate share = MeasurePopulationRate(up_to, ConditionWeights::kByTrials);
  return {all.median(),
          all.IntervalOfQuantiles(0.5 - (share.interval.upper - share.value),
                                  0.5 + (share.value - share.interval.lower)),
          all.interval(), share.effective_n};
}

}  // namespace rcme
