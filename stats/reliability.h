// The reliability curve: whether events happen as often as their stated probabilities say. By isotonic
// regression (CORP: Dimitriadis, Gneiting & Jordan 2021), which needs no choice of bins.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/forecast.h"

namespace rcme {

// Neighbouring probabilities with a common fitted event rate.
struct ReliabilityStep {
  double first = 0.0, last = 0.0;  // the least and the greatest probability
  double recalibrated = 0.0;       // share of their events that happened
  std::int64_t n = 0, num_happened = 0;
};

// The steps of the isotonic regression of the outcomes on the probabilities, ascending.
std::vector<ReliabilityStep> ReliabilityCurve(std::span<const Forecast> forecasts);

// brier = miscalibration - discrimination + uncertainty. S is the mean Brier score of the forecasts, S_C that
// of the recalibrated forecasts (the curve in the place of the probabilities), S_R that of the constant
// forecast with the overall share of events:
struct BrierDecomposition {
  double brier = 0.0;           // S
  double miscalibration = 0.0;  // S - S_C >= 0: the gain by recalibration
  double discrimination = 0.0;  // S_R - S_C >= 0: the gain of the recalibrated forecasts over the constant
  double uncertainty = 0.0;     // S_R = share (1 - share): independent of the forecasts
};
BrierDecomposition DecomposeBrierScore(std::span<const Forecast> forecasts);

// Pointwise range of the curve of a calibrated forecaster.
struct ConsistencyPoint {
  double probability = 0.0, lower = 0.0, upper = 0.0;
};
struct CalibrationCheck {
  // At the requested probabilities that lie between the least and the greatest forecast. At a single point
  // the curve of correct probabilities is outside in 5 % of the samples; at some point, more
  // often.
  std::vector<ConsistencyPoint> band;
  // The mean miscalibration of correct probabilities, which is above 0. The p-value is the share of their
  // samples with at least the observed miscalibration, (1 + number) / (1 + num_samples): a test of the whole
  // curve that is exact for independent forecasts, conservative for clusters (DrawOutcomes).
  double miscalibration_if_calibrated = 0.0, p_value = 1.0;
};

// By `num_samples` samples of outcomes drawn from the probabilities themselves. (The paper also redraws the
// forecasts; here they are fixed, so the test is exact.)
CalibrationCheck CheckCalibration(std::span<const Forecast> forecasts, std::span<const double> probabilities,
                                  int num_samples, RandomStream& rng);

}  // namespace rcme
