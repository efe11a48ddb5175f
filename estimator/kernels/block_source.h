// The source of hypotheses of the fast search, eight at a time. Each minimal solver with a fast
// implementation has a specialisation:
//
//   template <> class BlockSource<Solver> {
//     // Fills the block with the next eight hypotheses in the order of reference_search.h: the sample, F,
//     // the numbers that `outputs` requests, and a bit of is_model for each that is a model. Writes their
//     // ids to `proposals`, and whether each is the last of its sample.
//     void FillNext(matches, outputs, rng, block, proposals);
//     // Puts one hypothesis into the first lane.
//     void FillFirst(matches, outputs, id, block);
//     // The model of a hypothesis in the arithmetic of the reference, from which the steps after the loop
//     // continue.
//     std::optional<Hypothesis<Solver>> FindHypothesis(problem, matches, id);
//   };
//
// FillFirst and FindHypothesis discard the models that FillNext has not passed on yet.
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

// Solves eight samples at a time. Their models, 4.6 per sample on average, are passed on in blocks of eight.
//
// The models of a sample are numbered as those of FivePoint, in descending order of |E_33|. The block solver
// misses some solutions that nearly coincide (five_point_block.h), so that the remaining models may have
// other numbers than in the reference.
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
  void CopyModel(const MatchBlocks& matches, RequestedOutputs outputs, size_t place, int model, int lane,
                 HypothesisBlock* block);

  std::array<Sample, kBlockSize> samples_{};
  FivePointModels models_{};
  std::array<int, FivePointModels::kCapacity> order_{};  // the numbers in models_, sample by sample
  size_t place_ = kBlockSize - 1;                        // sample of the last model passed on
  int model_ = 0;
  EssentialBlock essentials_{};
};

}  // namespace rcme
