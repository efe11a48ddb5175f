// The area under the ROC curve, P(a positive scores higher than a negative), from scores that may be
// dependent.
#pragma once

#include <vector>

#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {

// Scores that may depend on each other, as those of one scene. Different clusters are independent.
struct ScoreCluster {
  std::vector<double> negatives, positives;  // either may be empty
};

struct AreaUnderCurve {
  double value = 0.0;  // P(positive > negative) + P(equal) / 2 (Mann-Whitney); 1/2 is chance
  // By DeLong, DeLong & Clarke-Pearson (1988), for clusters Obuchowski (1997). Let I clusters contain
  // positives, M in all. For cluster c let m_c be the number of positives and b_c the sum of their
  // placements. (The placement of a positive is the share of all negatives below it, equal ones counting
  // half.) Then
  //   var = S10 + S01 + 2 S11,  S10 = I / (I - 1) sum_c (b_c - m_c A)^2 / M^2,
  // S01 is the same for the negatives, and S11 the sum of the products of both terms over the clusters that
  // contain both kinds. NaN with one cluster of a kind.
  double standard_error = 0.0;
  // With few positives the variance misses low scores that were not drawn, and value +- z standard_error
  // covers far too little (0.85 for 0.95 at 20 positives and an area of 0.95). Half a cluster of placements 0
  // and half a cluster of placements 1, of mean size, are therefore added to each kind, as Agresti & Coull do
  // for a rate. The interval is Student's on the log odds of the area, with Satterthwaite's degrees of
  // freedom. Measured coverage: results/README.md. [0, 1] with one cluster of a kind.
  Interval interval;
};

// Scores may be infinite; equal infinities are a tie. Throws std::invalid_argument if there are no negatives
// or no positives, or a score is NaN.
AreaUnderCurve MeasureClusteredAreaUnderCurve(const std::vector<ScoreCluster>& clusters,
                                              double confidence = 0.95);

// The same for independent scores: each is a cluster of its own.
AreaUnderCurve MeasureAreaUnderCurve(const std::vector<double>& negatives,
                                     const std::vector<double>& positives, double confidence = 0.95);

// For trials that yield one pair each: whether a < b, with a fair coin for a tie (including two equal
// infinities). The rate of "below" is then the area under the curve, P(a < b) + P(a = b) / 2, and trials are
// plain events.
bool IsBelow(double a, double b, RandomStream& rng);

}  // namespace rcme
