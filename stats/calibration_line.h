// Calibration slope and intercept (Cox 1958): logistic regression of the event on the stated log odds,
//   logit P(happens) = intercept + slope logit p.
// Right probabilities have slope 1 and intercept 0. A slope below 1: too sure either way; above 1: not sure
// enough. An intercept below 0 at slope 1: probabilities too great.
#pragma once

#include <span>

#include "stats/forecast.h"

namespace rcme {

// By maximum likelihood; probabilities clipped (kProbabilityClip), so that a forecast of 0 has log odds -9.2.
// Standard errors by clusters, from the influences H^-1 (y - mu) (1, logit p). All NaN (intervals unbounded)
// where no finite optimum exists: only one kind of outcome, probabilities all equal, or events wholly apart.
struct CalibrationLine {
  ClusteredEstimate intercept, slope;
  bool has_optimum = false;
};
CalibrationLine FitCalibrationLine(std::span<const Forecast> forecasts, double confidence = 0.95,
                                   double clip = kProbabilityClip);

}  // namespace rcme
