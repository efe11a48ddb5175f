// P(a positive scores higher than a negative), from scores that need not be independent.
#pragma once

#include <vector>

#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {

// Scores that may depend on each other: of one scene, one patient. Other clusters are independent of it.
struct ScoreCluster {
  std::vector<double> negatives, positives;  // either may be empty
};

struct AreaUnderCurve {
  double value = 0.0;  // P(positive > negative) + P(equal) / 2 (Mann-Whitney); 1/2 is chance
  // Of `value`: DeLong, DeLong & Clarke-Pearson (1988), for clusters Obuchowski (1997). With I clusters that
  // hold positives, b_c the sum of their placements (a positive's placement: the share of all negatives below
  // it, equal ones counting half) and m_c their number, M in all,
  //   var = S10 + S01 + 2 S11,  S10 = I / (I - 1) sum_c (b_c - m_c A)^2 / M^2,
  // S01 likewise for the negatives, S11 the products of both sums over the clusters that hold both kinds.
  // NaN with one cluster of a kind.
  double standard_error = 0.0;
  // With few positives a variance misses the low scores that were not drawn, and value +- z standard_error
  // covers far too little (0.85 for 0.95 at 20 positives and an area of 0.95). So half a cluster of
  // placements 0 and half a cluster of placements 1, of mean size, are added to either kind, as Agresti &
  // Coull do for a rate; the interval is Student's on the log odds of the area, with Satterthwaite's degrees
  // of freedom. Measured coverage: results/README.md. [0, 1] with one cluster of a kind.
  Interval interval;
};

// A score may be infinite: equal infinities are a tie as others are. Throws std::invalid_argument if there
// are no negatives or no positives, or a score is NaN.
AreaUnderCurve MeasureClusteredAreaUnderCurve(const std::vector<ScoreCluster>& clusters,
                                              double confidence = 0.95);

// All scores independent: each a cluster of its own.
AreaUnderCurve MeasureAreaUnderCurve(const std::vector<double>& negatives,
                                     const std::vector<double>& positives, double confidence = 0.95);

// For trials that yield one pair each: whether a < b; of a tie, two infinities among them, a fair coin says.
// So the rate of "below" is the area under the curve, P(a < b) + P(a = b) / 2, and its trials stay plain
// events.
bool IsBelow(double a, double b, RandomStream& rng);

}  // namespace rcme
