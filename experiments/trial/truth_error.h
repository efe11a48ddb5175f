// How far errors may be off because the given truth is.
#pragma once

#include "experiments/data/data_source.h"

namespace rcme {

inline constexpr double kTruthErrorSds = 2.0;  // an error of the truth that is to be reckoned with

// kTruthErrorSds standard deviations of the truth's own error (Truth::sd) along the axis on which it is
// greatest: by so much may an angle between answer and truth be too small or too great. 0: the truth is
// exact, or nobody says.
struct TruthErrorDeg {
  double rotation = 0.0, direction = 0.0;
};
TruthErrorDeg ComputeTruthErrorDeg(const Truth& truth);

}  // namespace rcme
