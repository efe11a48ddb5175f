// The parts of the hypothesis loop, for eight hypotheses and many matches at a time. Gives the same samples,
// verdicts and scores as reference_search.h, to rounding, for the solvers of block_source.h.
#pragma once

#include <optional>

#include "estimator/kernels/block_source.h"
#include "estimator/kernels/score.h"
#include "estimator/ransac_loop.h"
#include "estimator/reference_search.h"

namespace rcme {

// The tests that a decision asks for by its PointTest and kTestsSample.
enum class BlockReading { kKnownPose, kAsPrinted, kRankAware };
struct BlockTests {
  BlockReading reading = BlockReading::kKnownPose;
  bool tests_sample = false;  // only if the solver's sample can be tested
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

  // The model of a hypothesis in the arithmetic of the reference, from which the steps after the loop
  // continue.
  std::optional<Hypothesis<Solver>> FindHypothesis(const HypothesisId& id);
  // The inliers of a hypothesis.
  const MatchMask& FindSupport(const HypothesisId& id);

 private:
  RequestedOutputs OutputsOfModels() const;
  std::uint8_t FindConsistent() const;  // bits of the hypotheses whose sample agrees with its model
  // The score without the matches `left_out`.
  InlierScore ScoreLane(int lane, const Sample& left_out);

  const MotionProblem& problem_;
  const MatchBlocks& matches_;
  BlockTests tests_;
  Thresholds thresholds_;
  double entropy_offset_ = 0.0;  // in h = log(spread) / 2 + offset
  RandomStream& rng_;
  BlockSource<Solver> source_;
  ProposalBlock proposals_{};
  HypothesisBlock block_;
  std::uint8_t is_consistent_ = 0;
  int lane_ = kBlockSize - 1;  // lane of the last proposal
  InlierScan scan_;
};

}  // namespace rcme
