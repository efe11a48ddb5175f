// The score that ranks hypotheses: sum over matches of v = 1 / (1 + r^2 / s^2), r the Sampson residual (Geman
// and McClure's loss, reversed). Single precision suffices, because the score only selects hypotheses for
// closer examination.
#pragma once

#include <vector>

#include "estimator/kernels/match_blocks.h"

namespace rcme {

inline constexpr int kScoreBlockSize = 16;

// The matches in whitened coordinates, sixteen side by side.
struct alignas(64) ScoreBlock {
  float x1[kScoreBlockSize], y1[kScoreBlockSize], x2[kScoreBlockSize], y2[kScoreBlockSize];
};

class ScoreMatches {
 public:
  explicit ScoreMatches(const MatchBlocks& matches);
  int num_matches() const { return num_matches_; }
  // The score of matches first, ..., end - 1. `first` is a multiple of kScoreBlockSize. F is in whitened
  // coordinates, row by row, of any norm. `scale` is s in units of the assumed sigma.
  double SumScores(const double* F, double scale, int first, int end) const;

 private:
  std::vector<ScoreBlock> blocks_;
  int num_matches_;
};

}  // namespace rcme
