// The expected calibration error: forecasts are binned by their probability; in each bin the mean probability
// is compared with the share of events that happened.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/condition_bootstrap.h"
#include "stats/forecast.h"

namespace rcme {

struct CalibrationBin {
  double least = 0.0, greatest = 0.0;  // of the probabilities in it
  double mean_probability = 0.0, share = 0.0;
  Interval interval;  // of the share: exact, if all of the bin are independent
  std::int64_t n = 0, num_happened = 0;
};

enum class Binning {
  kEqualWidth,  // [0, 1/K), [1/K, 2/K), ..., [(K-1)/K, 1] (Naeini, Cooper & Hauskrecht 2015)
  kEqualMass    // n / K forecasts each, the least first; equal probabilities stay in one bin
};

// The non-empty bins, ascending. Throws std::invalid_argument for fewer than one bin, and like
// CheckForecasts.
std::vector<CalibrationBin> BinForecasts(std::span<const Forecast> forecasts, Binning binning, int num_bins);

// sum over the bins of n_b / n |mean probability - share|.
double ExpectedCalibrationError(std::span<const CalibrationBin> bins);

// Chance makes the error positive even for correct probabilities. It is therefore reported with its
// distribution in the same bins under correct probabilities, by drawn outcomes (DrawOutcomes).
struct MeasuredCalibrationError {
  double value = 0.0;
  double mean_if_calibrated = 0.0, upper_if_calibrated = 0.0;  // mean, and the 95 % quantile
  double p_value = 1.0;  // share of drawn samples with at least this error, as in reliability.h
};
MeasuredCalibrationError MeasureCalibrationError(std::span<const Forecast> forecasts, Binning binning,
                                                 int num_bins, int num_samples, RandomStream& rng);

// The error in the population of which the forecasts' clusters (conditions) are a random sample, with its
// interval by a bootstrap over clusters. The bins are those of all forecasts. Where fewer than five clusters
// had an event, or fewer a non-event, the spread of the samples does not show how many may have been missed:
// with [l, u] the interval of the event's rate r (population_rate.h) and s the mean probability, the interval
// then begins at the distance of s from [l, u] at the most (the error is at least |s - rate|) and ends at
// value + max(u - r, r - l) at the least. Measured coverage: results/population/README.md.
BootstrapEstimate MeasurePopulationCalibrationError(std::span<const Forecast> forecasts, Binning binning,
                                                    int num_bins, const BootstrapOptions& options,
                                                    RandomStream& rng);

}  // namespace rcme
