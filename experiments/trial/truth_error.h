// How far the errors of answers may be off because the given truth has an error of its own.
#pragma once

#include <string>

#include "experiments/data/data_source.h"

namespace rcme {

// The greatest error of the truth that is allowed for, in its standard deviations.
inline constexpr double kTruthErrorSds = 2.0;

// An angle between answer and truth may be too small or too great by this much: kTruthErrorSds standard
// deviations of the truth's own error (Truth::sd), along the axis on which they are greatest. 0: the truth is
// exact, or its error is not known.
struct TruthErrorDeg {
  double rotation = 0.0, direction = 0.0;
};
TruthErrorDeg ComputeTruthErrorDeg(const Truth& truth);

// How the truth of real pairs is taken, as sentences of a report. `is_sd_stated`: some pair states truth_sd.
std::string DescribeRealTruth(bool is_sd_stated);

}  // namespace rcme
