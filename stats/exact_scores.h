#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "stats/exact_moments.h"
#include "stats/score_mean.h"

namespace rcme {

// Scores in [0, 1] for ScoreMean, collected independently of order and grouping: the parts into which a score
// is split between two points of the grid are multiples of 2^-26. This moves a score by at most 2^-27 / 100,
// less than the resolution of the search for the bounds of the mean.
class ExactScores {
 public:
  // Throws std::invalid_argument outside of [0, 1].
  void Add(double score);
  void Merge(const ExactScores& other);

  const ExactMoments& moments() const { return moments_; }
  ScoreMean Scores() const;

  // The texts of the moments, then the parts at the points of the grid, separated by spaces.
  std::vector<std::string> Texts() const;
  // Throws std::invalid_argument for texts that Texts() cannot have written.
  static ExactScores FromTexts(const std::vector<std::string>& texts);

 private:
  ExactMoments moments_;
  std::vector<std::int64_t> parts_;  // per point of the grid; empty without scores
};

}  // namespace rcme
