// Coverage where answers look easy and where they look hard: by quarters of what is visible at run time, with
// how sharp the regions are there. A coverage that is right on average may be far too small among the answers
// of few matches, which their user can tell.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/core/table/table.h"
#include "experiments/run/store/result_store.h"

namespace rcme {

// How intervals are made, and of what.
enum class StrataIntervals {
  kClusters,   // exact where every answer is a cluster of its own, else by betting on the sums of clusters
  kAnytime,    // a confidence sequence: the number of trials depended on their outcomes; of clusters as above
  kPopulation  // of the population that the clusters are draws of (stats/population_rate.h)
};

// The answers of one estimator, or the regions of one kind, column by column.
struct VisibleAnswers {
  std::string label;
  double level = 0.95;  // of the regions; at no other there are verdicts
  std::vector<std::string> seen_names, sharpness_names;
  std::vector<std::int64_t> clusters;          // answers of different clusters are independent
  std::vector<bool> are_covered;               // the truth is within the region
  std::vector<std::vector<double>> seen;       // by name, then answer; NaN: the answer does not have it
  std::vector<std::vector<double>> sharpness;  // the same
};

// Of the answers in one quarter of one visible quantity.
struct CoverageStratum {
  std::string label, seen;
  int quarter = 0;                 // 1: the least values; 0: the quantity is unknown
  double least = 0.0, most = 0.0;  // of its values; NaN: unknown
  std::int64_t n = 0;
  Estimate coverage;
  std::vector<double> sharpness;  // medians
};

// Quarters hold equally many answers, but equal values are together: of few different values there are fewer
// quarters. A quantity that no answer has, or one value alone, has no stratum.
std::vector<CoverageStratum> MeasureCoverageStrata(const VisibleAnswers& answers, StrataIntervals intervals);

struct CoverageStrata {
  std::vector<std::string> sharpness_names;
  StrataIntervals intervals = StrataIntervals::kClusters;
  std::vector<CoverageStratum> rows;
};

// Of every estimator of a run: the returned motions whose NEES is known, by what is stored of them and
// visible at run time. Throws InputError for weighted trials.
CoverageStrata MeasureCoverageStrata(const ResultStore& run);

}  // namespace rcme
