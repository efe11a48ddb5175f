// How well a score separates two classes, threshold by threshold (area under the curve: area_under_curve.h).
#pragma once

#include <vector>

namespace rcme {

// One threshold of the receiver operating characteristic: scores of at least `threshold` are called positive.
struct RocPoint {
  double threshold = 0.0;
  double false_positive_rate = 0.0, true_positive_rate = 0.0;
};

// From (0, 0), where nothing is called positive (threshold +infinity), to (1, 1), one point per distinct
// score; equal scores, also infinite ones, are one step. Throws std::invalid_argument if a sample is empty or
// contains a NaN.
std::vector<RocPoint> RocCurve(const std::vector<double>& negatives, const std::vector<double>& positives);

// A point of the risk-coverage curve: of the `coverage` share of the trials with the highest confidence, the
// share `risk` failed. One point per distinct score, most confident first; a refusal has the score -infinity
// and comes last.
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
