// The parts of the hypothesis loop, eight hypotheses and many matches at a time. The same samples, verdicts
// and scores as reference_search.h, to rounding.
#pragma once

#include <array>

#include "estimator/kernels/score.h"
#include "estimator/point_consistency.h"
#include "estimator/ransac_loop.h"

namespace rcme {

class BlockSearch {
 public:
  // What a pipeline's PointTest and kTestsSample ask for.
  enum class Reading { kKnownPose, kAsPrinted, kRankAware };
  struct Tests {
    Reading reading = Reading::kKnownPose;
    bool tests_sample = false;
    bool needs_likelihood = false;
  };

  BlockSearch(const MotionProblem& problem, const MatchBlocks& matches, const RansacOptions& options,
              const Tests& tests, RandomStream& rng);

  const Thresholds& thresholds() const { return thresholds_; }
  Proposal Next();
  InlierScore Score();

  // The inliers of a sample's hypothesis.
  const MatchMask& FindSupport(const Sample& sample);

 private:
  void InstantiateSamples();
  std::uint8_t FindConsistent() const;  // lanes of the block whose sample agrees with its model
  InlierScore ScoreLane(int lane);

  const MatchBlocks& matches_;
  Tests tests_;
  Thresholds thresholds_;
  double entropy_offset_ = 0.0;  // of h = log(spread) / 2 + offset
  RandomStream& rng_;
  std::array<Sample, kBlockSize> samples_{};
  HypothesisBlock block_;
  std::uint8_t is_consistent_ = 0;
  int lane_ = kBlockSize - 1;  // of the last proposal
  InlierScan scan_;
};

}  // namespace rcme
