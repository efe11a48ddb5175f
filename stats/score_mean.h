// The mean of bounded scores, with an interval that is valid for any law of the scores, any number of scores
// and any number of looks.
//
// Scores are mostly a mixture: many at exactly 0 (failed), the others near the top. For such a law Student's
// interval misses the mean far too often while few or no failures have been seen. If a score is 0 with
// probability 0.01 and 0.9 otherwise, 100 scores contain no zero in 37 % of the samples, and the interval is
// a point. The mean is therefore bounded by betting (Waudby-Smith & Ramdas 2024). A gambler who stakes a
// share f of the possible on "the mean exceeds m" has, after scores x_1..x_n in [0, 1],
//   K_n(m) = mean over f of prod_i (1 + f (x_i / m - 1)),
// a non-negative martingale of mean 1 if m is the mean: P(K_n(m) >= 1 / a for any n) <= a (Ville). The
// interval reaches about 3.3 standard errors to either side, and farther towards the end at which rare scores
// may be unseen. The extra width pays for validity at all n at once, and so for studies that stop depending
// on the data.
//
// For independent scores of different laws with n fixed beforehand (pooled conditions) the same bounds hold
// for the mean of their means mu_i: prod_i (1 + f (mu_i / m - 1)) is at most 1 if m is that mean (arithmetic
// and geometric mean).
#pragma once

#include <cstdint>
#include <vector>

#include "stats/betting.h"
#include "stats/intervals.h"

namespace rcme {

// Scores in a range, [0, 1] or, for paired differences, [-1, 1]. They are kept as counts on a grid: each
// score is split between its two neighbouring points such that the mean is unchanged. log(1 + f (x / m - 1))
// is concave in x, so this can only lower the capital, and the bounds remain valid for the scores themselves.
class ScoreMean {
 public:
  explicit ScoreMean(Interval range = {0.0, 1.0}) : range_(range) {}

  // Adds a score `count` times. Throws std::invalid_argument outside of the range and for NaN.
  void Add(double score, std::int64_t count = 1);

  std::int64_t n() const { return n_; }
  // Scores already on the grid, split as Add does it: the counts at the points, the number of scores and the
  // sum of the scores themselves.
  static ScoreMean OnGrid(const std::vector<double>& counts, std::int64_t n, double sum);
  // Number of grid steps. A score moves by at most half a step, which adds at most a quarter of the squared
  // step to a variance.
  static constexpr int kNumSteps = 100;

  // NaN without scores.
  double mean() const;
  // From the scores on the grid; its square exceeds the variance of the scores by at most a quarter of the
  // squared step.
  double standard_deviation() const;

  // Confidence sequence: contains the mean at all n together. Two-sided; each bound has half of 1 -
  // confidence. The whole range without scores.
  Interval Sequence(double confidence = 0.95) const;

  // Two-sided p-value of the hypothesis that the mean of the scores is `mean`, inside the range: at most a
  // with probability at most a, at any number of looks. It is at most 1 - confidence if Sequence excludes
  // `mean`.
  double PValue(double mean) const;

  // One-sided p-values of the hypotheses "the mean is at most `mean`" and "it is at least `mean`", valid at
  // every look. `mean` is inside the range.
  double PValueOfAtMost(double mean) const;
  double PValueOfAtLeast(double mean) const;

 private:
  // The scores mapped to [0, 1], optionally mirrored, with the step of the search for a bound.
  struct UnitScores {
    std::vector<CountedNumber> numbers;
    double mean = 0.0, standard_deviation = 0.0, distance = 0.0;
  };
  UnitScores InUnitRange(bool is_mirrored) const;
  // Log capital of the gambler who stakes on a greater mean (mirrored: a smaller one) than `mean`.
  double LogCapitalAt(double mean, bool is_mirrored) const;

  Interval range_;
  std::int64_t n_ = 0;
  double sum_ = 0.0;
  std::vector<double> counts_;  // per point of the grid; empty without scores
};

}  // namespace rcme
