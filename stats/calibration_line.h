// Calibration slope and intercept (Cox 1958): logistic regression of the event on the stated log odds,
//   logit P(happens) = intercept + slope logit p.
// Correct probabilities have slope 1 and intercept 0. A slope below 1 means overconfidence, above 1
// underconfidence. An intercept below 0 at slope 1 means that probabilities are too large.
#pragma once

#include <span>

#include "stats/forecast.h"

namespace rcme {

// Maximum likelihood; probabilities are clipped (kProbabilityClip), so a forecast of 0 has log odds -9.2.
// Standard errors and 95 % intervals are clustered, from the influences H^-1 (y - mu) (1, logit p). All NaN
// (intervals unbounded) if there is no finite optimum: only one kind of outcome, all probabilities equal, or
// perfect separation.
struct CalibrationLine {
  ClusteredEstimate intercept, slope;
};
CalibrationLine FitCalibrationLine(std::span<const Forecast> forecasts);

}  // namespace rcme
