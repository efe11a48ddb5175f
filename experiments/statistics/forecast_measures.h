// How good an estimator's probabilities of failure are.
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
inline constexpr int kNumCalibrationSamples = 399;

// Of one estimator in one group, over its answers; intervals by scenes, or, where the conditions are draws of
// a population, of that population and by draws. Without an answer that has a probability only the counts are
// meant.
struct ForecastMeasures {
  std::string estimator, group;
  ForecastSource source = ForecastSource::kStated;
  bool is_of_population = false;
  std::int64_t n = 0, num_refused = 0, num_without = 0;
  double mean_probability = 0.0;
  ClusteredEstimate failure;           // share of the n answers that failed
  ClusteredEstimate brier, log_score;  // stats/forecast.h
  BrierDecomposition parts;            // stats/reliability.h
  CalibrationCheck check;              // likewise, with the band at BandProbabilities()
  std::vector<ReliabilityStep> curve;  // likewise
  MeasuredCalibrationError error_of_equal_width, error_of_equal_mass;  // in kNumCalibrationBins bins
  Interval interval_of_equal_width = {kNaN, kNaN};  // of the population's error; NaN: by scenes there is none
  std::vector<CalibrationBin> bins;                 // of equal width
  std::vector<std::int64_t> histogram;              // of the probabilities: HistogramEdges()
  CalibrationLine line;
  // P(a failure has the greater probability): NaN where nothing failed, or everything.
  AreaUnderCurve area;
  // Of all trials whose outcome is known: a refusal is the least sure, and counts as a failure.
  ClusteredEstimate risk_coverage_area;
  std::vector<RiskCoveragePoint> risk_coverage;
  // Of the answers with a probability of at most kSureBelow, those that failed; and how many those answers
  // are.
  std::int64_t num_sure = 0, num_sure_failed = 0;
  // Of num_sure_failed among num_sure, and of num_sure among all trials: of the population
  // (population_rate.h) or exact; the latter of repeated scenes too narrow.
  Interval sure_failed_interval, sure_interval;

  std::int64_t num_trials() const { return n + num_refused; }
};

// 0 to 1, closer where probabilities are small.
std::vector<double> BandProbabilities();

// (k / 20)^2, k = 0..20: of equal width in the square root of the probability, the last bin with its end.
std::vector<double> HistogramEdges();

// `seed`: of the outcomes that are drawn to see what right probabilities would give.
ForecastMeasures MeasureForecasts(const FailureForecasts& forecasts, std::uint64_t seed);

// Of every estimator in every group; of several runs all trials together.
std::vector<ForecastMeasures> MeasureFailureForecasts(std::span<const ResultStore> runs,
                                                      const std::string& by = {});
std::vector<ForecastMeasures> MeasureFailureForecasts(const ResultStore& run, const std::string& by = {});

}  // namespace rcme
