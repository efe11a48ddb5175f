#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "stats/exact_moments.h"
#include "stats/score_mean.h"

namespace rcme {

// Scores in [0, 1] for ScoreMean, collected so that neither order nor groups matter: the parts in which a
// score is divided between two points of the grid are whole numbers of 2^-26. That moves a score by at most
// 2^-27 / 100, less than the search for the bounds of its mean resolves.
class ExactScores {
 public:
  // Throws std::invalid_argument outside of [0, 1].
  void Add(double score);
  void Merge(const ExactScores& other);

  const ExactMoments& moments() const { return moments_; }
  ScoreMean Scores() const;

  // Those of the moments, then the parts at the points of the grid, separated by spaces.
  std::vector<std::string> Texts() const;
  // Throws std::invalid_argument for texts that it does not give.
  static ExactScores FromTexts(const std::vector<std::string>& texts);

 private:
  ExactMoments moments_;
  std::vector<std::int64_t> parts_;  // per point of the grid; empty without scores
};

}  // namespace rcme
