// Where the fast search gets its hypotheses from, eight at a time: one specialisation per minimal solver that
// has a fast implementation.
//
//   template <> class BlockSource<Solver> {
//     // Fills the block with the next eight hypotheses, in the order of reference_search.h: their ids,
//     whether
//     // each is the last of its sample, F and what `spread` asks for. Bits of is_model are zero where a
//     sample
//     // has no model.
//     void FillNext(matches, spread, rng, block, proposals);
//     // Puts one hypothesis into the first lane.
//     void FillFirst(matches, spread, id, block);
//   };
#pragma once

#include <array>

#include "estimator/kernels/exact_block.h"
#include "estimator/kernels/hypothesis_block.h"
#include "estimator/ransac_loop.h"
#include "estimator/solvers/eight_point.h"
#include "estimator/solvers/five_point.h"

namespace rcme {

using ProposalBlock = std::array<Proposal, kBlockSize>;

template <typename Solver>
class BlockSource;

// Eight samples, one model each.
template <>
class BlockSource<EightPoint> {
 public:
  void FillNext(const MatchBlocks& matches, Spread spread, RandomStream& rng, HypothesisBlock* block,
                ProposalBlock* proposals);
  void FillFirst(const MatchBlocks& matches, Spread spread, const HypothesisId& id, HypothesisBlock* block);

 private:
  std::array<Sample, kBlockSize> samples_{};
};

// Eight samples at a time are solved; their models, 4.7 a sample on average, pass on in blocks of eight.
template <>
class BlockSource<FivePoint> {
 public:
  void FillNext(const MatchBlocks& matches, Spread spread, RandomStream& rng, HypothesisBlock* block,
                ProposalBlock* proposals);
  void FillFirst(const MatchBlocks& matches, Spread spread, const HypothesisId& id, HypothesisBlock* block);

 private:
  void SolveSample(const MatchBlocks& matches, const Sample& sample, size_t place);
  void AdvanceToNextModel(const MatchBlocks& matches, RandomStream& rng);
  void CopyModel(const MatchBlocks& matches, const HypothesisId& id, size_t place, int lane,
                 HypothesisBlock* block);

  std::array<Sample, kBlockSize> samples_{};
  std::array<FivePoint::Solutions, kBlockSize> solutions_{};
  size_t sample_ = kBlockSize - 1;  // of the model last passed on
  int model_ = 0;
  EssentialBlock essentials_{};
};

}  // namespace rcme
