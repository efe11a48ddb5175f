// The mean of scores that are bounded, with an interval that is valid for any law of the scores, any number
// of them, and any number of looks.
//
// Scores are mostly a mixture: many at exactly 0 (failed), the others near the top. Student's interval misses
// the mean of such a law far too often as long as few or no failures have been seen: where a score is 0 with
// probability 0.01 and 0.9 else, 100 scores hold no zero in 37 % of the samples, and their interval is a
// point. So the mean is bounded by betting (Waudby-Smith & Ramdas 2024). A gambler who
// stakes a share f of what he can on "the mean exceeds m" has, after scores x_1..x_n in [0, 1],
//   K_n(m) = mean over f of prod_i (1 + f (x_i / m - 1)),
// a non-negative martingale of mean 1 where m is the mean: P(K_n(m) >= 1 / a for any n) <= a (Ville). The
// interval reaches about 3.3 standard errors to either side, and farther towards the end from which a law of
// scores may hide rare ones; that pays for all n at once, and so for a study that stops by what it sees.
//
// Scores of different laws, independent of each other and n fixed beforehand (conditions that are pooled):
// the same bounds hold for the mean of their means mu_i, as prod_i (1 + f (mu_i / m - 1)) is at most 1 where
// m is that mean (arithmetic and geometric mean).
#pragma once

#include <cstdint>
#include <vector>

#include "stats/betting.h"
#include "stats/intervals.h"

namespace rcme {

// Scores in a range, [0, 1] or that of paired differences, [-1, 1]. They are kept as counts on a grid: each
// is divided between the two points beside it so that the mean stays what it was. log(1 + f (x / m - 1)) is
// concave in x, so that this can only lower the capital: the bounds hold for the scores themselves.
class ScoreMean {
 public:
  explicit ScoreMean(Interval range = {0.0, 1.0}) : range_(range) {}

  // `count` times the same. Throws std::invalid_argument outside the range and for NaN.
  void Add(double score, std::int64_t count = 1);

  std::int64_t n() const { return n_; }
  // Scores that are on the grid already, divided as Add does it: how much of how many is at each of its
  // points; their sum is that of the scores themselves.
  static ScoreMean OnGrid(const std::vector<double>& counts, std::int64_t n, double sum);
  // A score moves by at most half a step of the grid, which adds at most a quarter of its square to a
  // variance.
  static constexpr int kNumSteps = 100;

  // NaN without scores.
  double mean() const;
  // Of the scores on the grid: a variance that exceeds theirs by at most a quarter of its squared step.
  double standard_deviation() const;

  // Confidence sequence: holds the mean at all n together. Two-sided, either bound has half of 1 -
  // confidence. The range without scores.
  Interval Sequence(double confidence = 0.95) const;

  // Two-sided p-value of the hypothesis that the mean of the scores is `mean`, inside the range: at most a
  // with probability at most a, however often it is looked at. It is at most 1 - confidence where Sequence
  // excludes `mean`.
  double PValue(double mean) const;

  // One-sided p-values of the hypotheses "the mean is at most `mean`" and "it is at least `mean`", likewise
  // valid at every look. `mean` is inside the range.
  double PValueOfAtMost(double mean) const;
  double PValueOfAtLeast(double mean) const;

 private:
  // The scores moved to [0, 1], mirrored if asked for, with the spread of the search for a bound.
  struct UnitScores {
    std::vector<CountedNumber> numbers;
    double mean = 0.0, standard_deviation = 0.0, distance = 0.0;
  };
  UnitScores InUnitRange(bool is_mirrored) const;
  // Of the gambler who stakes on a greater mean (mirrored: on a lesser one) than `mean`.
  double LogCapitalAt(double mean, bool is_mirrored) const;

  Interval range_;
  std::int64_t n_ = 0;
  double sum_ = 0.0;
  std::vector<double> counts_;  // per point of the grid; empty without scores
};

}  // namespace rcme
