// How well a score separates two kinds, threshold by threshold (the area under the curve:
// area_under_curve.h).
#pragma once

#include <vector>

namespace rcme {

// One threshold of the receiver operating characteristic: what scores at least `threshold` is called
// positive.
struct RocPoint {
  double threshold = 0.0;
  double false_positive_rate = 0.0, true_positive_rate = 0.0;
};

// From (0, 0), where nothing is called positive (written as threshold +infinity), to (1, 1), one point per
// different score: equal scores, infinite ones too, are one step, whatever their kinds. Throws
// std::invalid_argument if a sample is empty or holds a NaN.
std::vector<RocPoint> RocCurve(const std::vector<double>& negatives, const std::vector<double>& positives);

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
