#include "estimator/kernels/block_source.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rcme {

void BlockSource<EightPoint>::FillNext(const MatchBlocks& matches, RequestedOutputs outputs,
                                       RandomStream& rng, HypothesisBlock* block, ProposalBlock* proposals) {
  for (size_t lane = 0; lane < kBlockSize; ++lane) {
    samples_[lane] = DrawSample(EightPoint::kSampleSize, matches.num_matches(), rng);
    (*proposals)[lane] = {{samples_[lane]}};
  }
  InstantiateModels(matches, samples_, outputs, block);
}

void BlockSource<EightPoint>::FillFirst(const MatchBlocks& matches, RequestedOutputs outputs,
                                        const HypothesisId& id, HypothesisBlock* block) {
  samples_.fill(id.sample);
  InstantiateModels(matches, samples_, outputs, block);
}

std::optional<Hypothesis<EightPoint>> BlockSource<EightPoint>::FindHypothesis(const MotionProblem& problem,
                                                                              const MatchBlocks&,
                                                                              const HypothesisId& id) {
  return InstantiateModel<EightPoint>(problem, id);
}

void BlockSource<FivePoint>::SolveSamples(const MatchBlocks& matches) {
  const RayScale& scale = matches.ray_scale();
  FivePointSamples rays;
  for (size_t place = 0; place < kBlockSize; ++place) {
    for (size_t k = 0; k < FivePoint::kSampleSize; ++k) {
      const int match = samples_[place][k], lane = match % kBlockSize;
      const MatchBlock& from = matches[match / kBlockSize];
      rays.x1[k][place] = scale.x1 * from.x1[lane];
      rays.y1[k][place] = scale.y1 * from.y1[lane];
      rays.x2[k][place] = scale.x2 * from.x2[lane];
      rays.y2[k][place] = scale.y2 * from.y2[lane];
    }
  }
  SolveFivePoints(rays, &models_);
  std::iota(order_.begin(), order_.begin() + models_.count(), 0);
  for (size_t place = 0; place < kBlockSize; ++place) SortModels(place);
}

void BlockSource<FivePoint>::SortModels(size_t place) {
  std::sort(order_.begin() + models_.begin[place], order_.begin() + models_.begin[place + 1],
            [this](int a, int b) { return std::abs(models_.E[8][a]) > std::abs(models_.E[8][b]); });
}

void BlockSource<FivePoint>::SolveOne(const MatchBlocks& matches, const Sample& sample) {
  samples_.fill(sample);
  SolveSamples(matches);
  place_ = kBlockSize - 1;  // nothing is left to pass on
  model_ = CountModels(place_);
}

// A sample without a model takes one step, too.
void BlockSource<FivePoint>::AdvanceToNextModel(const MatchBlocks& matches, RandomStream& rng) {
  if (++model_ < CountModels(place_)) return;
  model_ = 0;
  if (++place_ < kBlockSize) return;
  place_ = 0;
  for (Sample& sample : samples_) sample = DrawSample(FivePoint::kSampleSize, matches.num_matches(), rng);
  SolveSamples(matches);
}

void BlockSource<FivePoint>::CopyModel(const MatchBlocks& matches, RequestedOutputs outputs, size_t place,
                                       int model, int lane, HypothesisBlock* block) {
  if (outputs != RequestedOutputs::kNone) CopySample(matches, samples_[place], lane, block);
  const int number = order_[static_cast<size_t>(models_.begin[place] + model)];
  for (int i = 0; i < 9; ++i) essentials_.E[i][lane] = models_.E[i][number];
}

void BlockSource<FivePoint>::FillNext(const MatchBlocks& matches, RequestedOutputs outputs, RandomStream& rng,
                                      HypothesisBlock* block, ProposalBlock* proposals) {
  unsigned has_model = 0;
  for (int lane = 0; lane < kBlockSize; ++lane) {
    AdvanceToNextModel(matches, rng);
    const int count = CountModels(place_);
    const HypothesisId id = {samples_[place_], model_};
    (*proposals)[static_cast<size_t>(lane)] = {id, SampleVerdict::kDegenerate, model_ + 1 >= count};
    if (count == 0) continue;
    CopyModel(matches, outputs, place_, model_, lane, block);
    has_model |= 1u << lane;
  }
  InstantiateExactModels(matches.ray_scale(), essentials_, outputs, block);
  block->is_model &= static_cast<std::uint8_t>(has_model);
}

void BlockSource<FivePoint>::FillFirst(const MatchBlocks& matches, RequestedOutputs outputs,
                                       const HypothesisId& id, HypothesisBlock* block) {
  SolveOne(matches, id.sample);
  for (int lane = 0; lane < kBlockSize; ++lane) CopyModel(matches, outputs, 0, id.model, lane, block);
  InstantiateExactModels(matches.ray_scale(), essentials_, outputs, block);
}

std::optional<Hypothesis<FivePoint>> BlockSource<FivePoint>::FindHypothesis(const MotionProblem& problem,
                                                                            const MatchBlocks& matches,
                                                                            const HypothesisId& id) {
  SolveOne(matches, id.sample);
  if (id.model < 0 || id.model >= CountModels(0)) return std::nullopt;
  const int number = order_[static_cast<size_t>(id.model)];
  Eigen::Matrix3d E;
  for (int i = 0; i < 9; ++i) E(i / 3, i % 3) = models_.E[i][number];
  const SampleRays<FivePoint> rays(problem, id.sample);
  const std::optional<FivePoint::Model> model = FivePoint::ModelNear(E, rays.first, rays.second);
  if (!model) return std::nullopt;
  return HypothesisFromModel<FivePoint>(problem, id, *model);
}

}  // namespace rcme
