// The parts of the hypothesis loop, eight hypotheses and many matches at a time. The same samples, verdicts
// and scores as reference_search.h, to rounding. For the solvers of block_source.h.
#pragma once

#include <optional>

#include "estimator/kernels/block_source.h"
#include "estimator/kernels/score.h"
#include "estimator/point_consistency.h"
#include "estimator/ransac_loop.h"
#include "estimator/reference_search.h"

namespace rcme {

// What a decision's PointTest and kTestsSample ask for.
enum class BlockReading { kKnownPose, kAsPrinted, kRankAware };
struct BlockTests {
  BlockReading reading = BlockReading::kKnownPose;
  bool tests_sample = false;  // as far as the solver's sample can be tested
  bool needs_likelihood = false;
};

template <typename Solver>
class BlockSearch {
 public:
  BlockSearch(const MotionProblem& problem, const MatchBlocks& matches, const RansacOptions& options,
              const BlockTests& tests, RandomStream& rng);

  const Thresholds& thresholds() const { return thresholds_; }
  Proposal Next();
  InlierScore Score();

  // The model of a hypothesis in the arithmetic of the reference: what follows the loop goes on from it.
  std::optional<Hypothesis<Solver>> FindHypothesis(const HypothesisId& id);
  // The inliers of a hypothesis.
  const MatchMask& FindSupport(const HypothesisId& id);

 private:
  RequestedOutputs OutputsOfModels() const;
  std::uint8_t FindConsistent() const;  // lanes of the block whose sample agrees with its model
  // The score without the matches `left_out`.
  InlierScore ScoreLane(int lane, const Sample& left_out);

  const MotionProblem& problem_;
  const MatchBlocks& matches_;
  BlockTests tests_;
  Thresholds thresholds_;
  double entropy_offset_ = 0.0;  // of h = log(spread) / 2 + offset
  RandomStream& rng_;
  BlockSource<Solver> source_;
  ProposalBlock proposals_{};
  HypothesisBlock block_;
  std::uint8_t is_consistent_ = 0;
  int lane_ = kBlockSize - 1;  // of the last proposal
  InlierScan scan_;
};

}  // namespace rcme
