// Coverage and sharpness of regions in strata of what is visible at run time: quarters of the number of
// matches, of the stated uncertainty and so on. A coverage that is right on average may be far too small for
// answers from few matches, which a user can recognize.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/core/table/table.h"
#include "experiments/run/store/result_store.h"
#include "stats/intervals.h"

namespace rcme {

// A share of answers with its interval, for answers that depend on each other within clusters.
struct ClusteredShare {
  std::int64_t count = 0, n = 0;
  bool has_shared_clusters = false;  // some cluster has several answers
  Interval interval;

  double value() const { return static_cast<double>(count) / static_cast<double>(n); }
};

// `holds` and `clusters` have an element per answer, at least one. The interval is exact if every answer is
// a cluster of its own; otherwise it is by betting on the sums of clusters (stats/clustered_estimate.h).
ClusteredShare MeasureShareOfClusters(const std::vector<bool>& holds,
                                      const std::vector<std::int64_t>& clusters);

// How the intervals of strata are computed.
enum class StrataIntervals {
  kClusters,  // exact if every answer is a cluster of its own, otherwise by betting on the sums of clusters
  kAnytime,   // a confidence sequence, as the number of trials depended on outcomes; shared clusters as above
  kPopulation  // of the population from which the clusters are drawn (stats/population_rate.h)
};

// The answers of one estimator, or the regions of one kind, column by column.
struct VisibleAnswers {
  std::string label;
  double level = 0.95;  // of the regions; only 0.95 gets verdicts
  std::vector<std::string> seen_names, sharpness_names;
  std::vector<std::int64_t> clusters;          // answers of different clusters are independent
  std::vector<bool> are_covered;               // the region contains the truth
  std::vector<std::vector<double>> seen;       // by name, then answer; NaN: the answer does not have it
  std::vector<std::vector<double>> sharpness;  // as `seen`
};

// The answers in one quarter of one visible quantity.
struct CoverageStratum {
  std::string label, seen;
  int quarter = 0;                 // 1: the least values; 0: the quantity is unknown
  double least = 0.0, most = 0.0;  // range of the quantity; NaN: unknown
  std::int64_t n = 0;
  Estimate coverage;
  std::vector<double> sharpness;  // medians
};

// Divides the answers into quarters with equally many answers. Equal values stay together, so a quantity
// with few different values may have fewer quarters. A quantity that is unknown for all answers or has only
// one value has no stratum.
std::vector<CoverageStratum> MeasureCoverageStrata(const VisibleAnswers& answers, StrataIntervals intervals);

struct CoverageStrata {
  std::vector<std::string> sharpness_names;
  StrataIntervals intervals = StrataIntervals::kClusters;
  std::vector<CoverageStratum> rows;
};

// The strata of every estimator of a run: returned motions with a known NEES, by those stored numbers that
// are visible at run time. Throws InputError for weighted trials.
CoverageStrata MeasureCoverageStrata(const ResultStore& run);

}  // namespace rcme
