// The expected calibration error: forecasts in bins by their probability, in each the distance between the
// mean probability and the share that happened.
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

// The bins that are not empty, rising. Throws std::invalid_argument below one bin, and as CheckForecasts
// does.
std::vector<CalibrationBin> BinForecasts(std::span<const Forecast> forecasts, Binning binning, int num_bins);

// sum over the bins of n_b / n |mean probability - share|.
double ExpectedCalibrationError(std::span<const CalibrationBin> bins);

// The error is above 0 for right probabilities too: chance alone moves every share. So it comes with what
// right probabilities would give in the same bins, by drawn outcomes (DrawOutcomes).
struct MeasuredCalibrationError {
  double value = 0.0;
  double mean_if_calibrated = 0.0, upper_if_calibrated = 0.0;  // mean, and the 95 % quantile
  double p_value = 1.0;  // the share of drawn samples with as great an error, as in reliability.h
};
MeasuredCalibrationError MeasureCalibrationError(std::span<const Forecast> forecasts, Binning binning,
                                                 int num_bins, int num_samples, RandomStream& rng);

// The error in the population that the forecasts' clusters are a random sample of (conditions), with its
// interval by a bootstrap over clusters; the bins are those of all forecasts. Measured coverage:
// results/population/README.md.
BootstrapEstimate MeasurePopulationCalibrationError(std::span<const Forecast> forecasts, Binning binning,
                                                    int num_bins, const BootstrapOptions& options,
                                                    RandomStream& rng);

}  // namespace rcme
