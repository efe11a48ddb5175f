// Do events happen as often as their stated probabilities say? The reliability curve by isotonic regression
// (CORP: Dimitriadis, Gneiting & Jordan 2021), which needs no bins and so no choice of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/forecast.h"

namespace rcme {

// Neighbouring probabilities whose events happened, as far as a rising curve can tell, equally often.
struct ReliabilityStep {
  double first = 0.0, last = 0.0;  // the least and the greatest of them
  double recalibrated = 0.0;       // the share of their events that happened
  std::int64_t n = 0, num_happened = 0;
};

// The steps of the isotonic regression of the outcomes on the probabilities, rising.
std::vector<ReliabilityStep> ReliabilityCurve(std::span<const Forecast> forecasts);

// brier = miscalibration - discrimination + uncertainty. With S the mean Brier score of the forecasts, S_C
// that of the recalibrated ones (the curve in the place of the probabilities) and S_R that of the one number
// that is the events' share:
struct BrierDecomposition {
  double brier = 0.0;           // S
  double miscalibration = 0.0;  // S - S_C >= 0: what recalibration would gain
  double discrimination = 0.0;  // S_R - S_C >= 0: what knowing the forecasts is worth
  double uncertainty = 0.0;     // S_R = share (1 - share): no matter of the forecasts
};
BrierDecomposition DecomposeBrierScore(std::span<const Forecast> forecasts);

// Where the curve of a calibrated forecaster would be: pointwise.
struct ConsistencyPoint {
  double probability = 0.0, lower = 0.0, upper = 0.0;
};
struct CalibrationCheck {
  // At those of the probabilities asked for that lie between the least and the greatest forecast. The curve
  // of right probabilities is outside at one point in 1 - confidence of the samples; somewhere, more often.
  std::vector<ConsistencyPoint> band;
  // The mean miscalibration of right probabilities, which is above 0, and the share of samples of such that
  // have as much or more: (1 + number) / (1 + num_samples), an exact test of the whole curve for independent
  // forecasts, cautious for clusters (DrawOutcomes).
  double miscalibration_if_calibrated = 0.0, p_value = 1.0;
};

// By `num_samples` samples of outcomes drawn from the probabilities themselves (the paper draws the forecasts
// anew too; here they are given, so that the test is exact).
CalibrationCheck CheckCalibration(std::span<const Forecast> forecasts, std::span<const double> probabilities,
                                  int num_samples, RandomStream& rng, double confidence = 0.95);

}  // namespace rcme
