// How well a score separates two kinds, over all thresholds at once.
#pragma once

#include <vector>

#include "stats/intervals.h"

namespace rcme {

// One threshold of the receiver operating characteristic: what scores at least `threshold` is called
// positive.
struct RocPoint {
  double threshold = 0.0;
  double false_positive_rate = 0.0, true_positive_rate = 0.0;
};

// From (0, 0) at threshold +infinity to (1, 1), one point per different score: equal scores are one step,
// whatever their kinds. Throws std::invalid_argument if a sample is empty or holds a NaN.
std::vector<RocPoint> RocCurve(const std::vector<double>& negatives, const std::vector<double>& positives);

struct AreaUnderCurve {
  double value = 0.0;  // P(positive > negative) + P(equal) / 2 (Mann-Whitney); 1/2 is chance
  double standard_error = 0.0;
  // value +- z standard_error (DeLong, DeLong & Clarke-Pearson 1988), kept to [0, 1]. A perfect separation
  // has no standard error: then min(m, n) disjoint pairs were all in order, which has probability at most
  // AUC^min(m, n), and the interval ends at (alpha / 2)^(1 / min(m, n)); likewise at 0.
  Interval interval;
};
// Throws as RocCurve.
AreaUnderCurve MeasureAreaUnderCurve(const std::vector<double>& negatives,
                                     const std::vector<double>& positives, double confidence = 0.95);

// What is risked by answering only where one is sure: of the `coverage` share of the trials with the highest
// confidence scores, the share `risk` that failed. One point per different score, most confident first; a
// refusal has the score -infinity and comes last.
struct RiskCoveragePoint {
  double threshold = 0.0;  // answered if the score is at least this
  double coverage = 0.0, risk = 0.0;
};
struct ScoredOutcome {
  double score = 0.0;
  bool failed = false;
};
// Throws std::invalid_argument on a NaN score.
std::vector<RiskCoveragePoint> RiskCoverageCurve(std::vector<ScoredOutcome> outcomes);

}  // namespace rcme
