// Measures the quality of an estimator's failure probabilities.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/statistics/failure_forecasts.h"
#include "stats/area_under_curve.h"
#include "stats/calibration_error.h"
#include "stats/calibration_line.h"
#include "stats/clustered_estimate.h"
#include "stats/constants.h"
#include "stats/reliability.h"
#include "stats/thresholds.h"

namespace rcme {

inline constexpr int kNumCalibrationBins = 10;

// The measures of one estimator in one group, over its answers. Intervals are by scenes; if the conditions
// are draws of a population, they are by draws and for the population. If no answer has a probability, only
// the counts are valid.
struct ForecastMeasures {
  std::string estimator, group;
  ForecastSource source = ForecastSource::kStated;
  bool is_of_population = false;
  std::int64_t n = 0, num_refused = 0, num_without = 0;
  double mean_probability = 0.0;
  ClusteredEstimate failure;           // share of the n answers that failed
  ClusteredEstimate brier, log_score;  // stats/forecast.h
  BrierDecomposition parts;            // stats/reliability.h
  CalibrationCheck check;              // stats/reliability.h, with the band at BandProbabilities()
  std::vector<ReliabilityStep> curve;  // stats/reliability.h
  MeasuredCalibrationError error_of_equal_width, error_of_equal_mass;  // in kNumCalibrationBins bins
  Interval interval_of_equal_width = {kNaN, kNaN};                     // for the population; NaN by scenes
  std::vector<CalibrationBin> bins;                                    // of equal width
  std::vector<std::int64_t> histogram;  // of the probabilities, by HistogramEdges()
  CalibrationLine line;
  // P(a failure has the greater probability); NaN if no answer failed or all did.
  AreaUnderCurve area;
  // Over all trials with a known outcome. A refusal ranks as least sure and counts as a failure.
  ClusteredEstimate risk_coverage_area;
  std::vector<RiskCoveragePoint> risk_coverage;
  // The number of answers with a probability of at most kSureBelow, and how many of them failed.
  std::int64_t num_sure = 0, num_sure_failed = 0;
  // Intervals of num_sure_failed among num_sure, and of num_sure among all trials: for the population
  // or for repeated scenes with the trials of a draw or a scene as one cluster (population_rate.h), else
  // exact.
  Interval sure_failed_interval, sure_interval;

  std::int64_t num_trials() const { return n + num_refused; }
};

// Returns probabilities from 0 to 1, denser at small values.
std::vector<double> BandProbabilities();

// Returns (k / 20)^2, k = 0..20: bins of equal width in the square root of the probability. The last bin
// includes its upper end.
std::vector<double> HistogramEdges();

// `seed` is for simulated outcomes, which show what correct probabilities would give.
ForecastMeasures MeasureForecasts(const FailureForecasts& forecasts, std::uint64_t seed);

// The measures of every estimator in every group; all trials of several runs are pooled.
std::vector<ForecastMeasures> MeasureFailureForecasts(std::span<const ResultStore> runs,
                                                      const std::string& by = {});
std::vector<ForecastMeasures> MeasureFailureForecasts(const ResultStore& run, const std::string& by = {});

}  // namespace rcme
