// Where the fast search gets its hypotheses from, eight at a time: one specialisation per minimal solver that
// has a fast implementation.
//
//   template <> class BlockSource<Solver> {
//     // Fills the block with the next eight hypotheses in the order of reference_search.h: the sample, F and
//     // what `outputs` asks for, and a bit of is_model for each that is a model. Their ids, and whether each
//     // is the last of its sample, go to `proposals`.
//     void FillNext(matches, outputs, rng, block, proposals);
//     // Puts one hypothesis into the first lane.
//     void FillFirst(matches, outputs, id, block);
//     // The model of a hypothesis in the arithmetic of the reference: what follows the loop goes on from it.
//     std::optional<Hypothesis<Solver>> FindHypothesis(problem, matches, id);
//   };
//
// After FillFirst and FindHypothesis the models that were not passed on yet are gone.
#pragma once

#include <array>
#include <optional>

#include "estimator/hypothesis.h"
#include "estimator/kernels/exact_block.h"
#include "estimator/kernels/five_point_block.h"
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
  void FillNext(const MatchBlocks& matches, RequestedOutputs outputs, RandomStream& rng,
                HypothesisBlock* block, ProposalBlock* proposals);
  void FillFirst(const MatchBlocks& matches, RequestedOutputs outputs, const HypothesisId& id,
                 HypothesisBlock* block);
  std::optional<Hypothesis<EightPoint>> FindHypothesis(const MotionProblem& problem,
                                                       const MatchBlocks& matches, const HypothesisId& id);

 private:
  std::array<Sample, kBlockSize> samples_{};
};

// Eight samples at a time are solved; their models, 4.6 a sample on average, pass on in blocks of eight.
//
// The models of a sample are numbered as those of FivePoint, in descending order of |E_33|. The block solver
// misses some solutions that nearly coincide (five_point_block.h), so that the numbers of the others may
// differ from the reference's.
template <>
class BlockSource<FivePoint> {
 public:
  void FillNext(const MatchBlocks& matches, RequestedOutputs outputs, RandomStream& rng,
                HypothesisBlock* block, ProposalBlock* proposals);
  void FillFirst(const MatchBlocks& matches, RequestedOutputs outputs, const HypothesisId& id,
                 HypothesisBlock* block);
  std::optional<Hypothesis<FivePoint>> FindHypothesis(const MotionProblem& problem,
                                                      const MatchBlocks& matches, const HypothesisId& id);

 private:
  void SolveSamples(const MatchBlocks& matches);
  void SolveOne(const MatchBlocks& matches, const Sample& sample);
  int CountModels(size_t place) const { return models_.begin[place + 1] - models_.begin[place]; }
  void SortModels(size_t place);

  void AdvanceToNextModel(const MatchBlocks& matches, RandomStream& rng);
  void CopyModel(const MatchBlocks& matches, size_t place, int model, int lane, HypothesisBlock* block);

  std::array<Sample, kBlockSize> samples_{};
  FivePointModels models_{};
  std::array<int, FivePointModels::kCapacity> order_{};  // the numbers in models_, sample by sample
  size_t place_ = kBlockSize - 1;                        // of the model last passed on
  int model_ = 0;
  EssentialBlock essentials_{};
};

}  // namespace rcme
