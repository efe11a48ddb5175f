// The verdicts, causes and ranges of a validation in words, and the legend of its tables.
#pragma once

#include <string>

#include "experiments/real/truth_free/validate.h"

namespace rcme {

bool IsBounded(const Interval& interval);

// "2.1 [1.8, 2.5]", or "2.1 (too few for an interval)".
std::string FormatRange(double value, const Interval& interval);

// "data", "estimator" or "both"; empty without a cause.
const char* CauseName(FaultCause cause);

// "holds", "too small by 2.1 [1.8, 2.5] in variance", "undecided: 1.3 [0.9, 1.9]".
std::string DescribeVerdict(const TruthFreeTest& test);

// Whether the difference of the correlations has an interval.
bool IsKnown(const DistanceCorrelation& c);
std::string CorrelationVerdict(const DistanceCorrelation& c);

// In files a fault that is found is "wrong", whichever way.
std::string FaultVerdict(TruthFreeVerdict verdict);

// The lines above the table of a set: pairs and loops, the verdict on covariances, stated deviations.
std::string DescribeSet(const SetReport& report);

std::string DescribeValidationColumns();

}  // namespace rcme
