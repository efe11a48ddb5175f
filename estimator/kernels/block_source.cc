#include "estimator/kernels/block_source.h"

namespace rcme {

void BlockSource<EightPoint>::FillNext(const MatchBlocks& matches, Spread spread, RandomStream& rng,
                                       HypothesisBlock* block, ProposalBlock* proposals) {
  for (size_t lane = 0; lane < kBlockSize; ++lane) {
    samples_[lane] = DrawSample(EightPoint::kSampleSize, matches.num_matches(), rng);
    (*proposals)[lane] = {{samples_[lane]}};
  }
  InstantiateModels(matches, samples_, spread, block);
}

void BlockSource<EightPoint>::FillFirst(const MatchBlocks& matches, Spread spread, const HypothesisId& id,
                                        HypothesisBlock* block) {
  samples_.fill(id.sample);
  InstantiateModels(matches, samples_, spread, block);
}

void BlockSource<FivePoint>::SolveSample(const MatchBlocks& matches, const Sample& sample, size_t place) {
  const RayScale& scale = matches.ray_scale();
  FivePoint::Rays rays1, rays2;
  for (size_t k = 0; k < rays1.size(); ++k) {
    const MatchBlock& from = matches[sample[k] / kBlockSize];
    const int lane = sample[k] % kBlockSize;
    rays1[k] = {scale.x1 * from.x1[lane], scale.y1 * from.y1[lane], 1.0};
    rays2[k] = {scale.x2 * from.x2[lane], scale.y2 * from.y2[lane], 1.0};
  }
  samples_[place] = sample;
  solutions_[place] = FivePoint::Solve(rays1, rays2);
}

// Of a sample without a model, to the place where it would be.
void BlockSource<FivePoint>::AdvanceToNextModel(const MatchBlocks& matches, RandomStream& rng) {
  if (++model_ < solutions_[sample_].count) return;
  model_ = 0;
  if (++sample_ < kBlockSize) return;
  sample_ = 0;
  for (size_t place = 0; place < kBlockSize; ++place) {
    SolveSample(matches, DrawSample(FivePoint::kSampleSize, matches.num_matches(), rng), place);
  }
}

void BlockSource<FivePoint>::CopyModel(const MatchBlocks& matches, const HypothesisId& id, size_t place,
                                       int lane, HypothesisBlock* block) {
  CopySample(matches, id.sample, lane, block);
  const Eigen::Matrix3d& E = solutions_[place].E[static_cast<size_t>(id.model)];
  for (int i = 0; i < 9; ++i) essentials_.E[i][lane] = E(i / 3, i % 3);
}

void BlockSource<FivePoint>::FillNext(const MatchBlocks& matches, Spread spread, RandomStream& rng,
                                      HypothesisBlock* block, ProposalBlock* proposals) {
  unsigned has_model = 0;
  for (int lane = 0; lane < kBlockSize; ++lane) {
    AdvanceToNextModel(matches, rng);
    const int count = solutions_[sample_].count;
    const HypothesisId id = {samples_[sample_], model_};
    (*proposals)[static_cast<size_t>(lane)] = {id, SampleVerdict::kDegenerate, model_ + 1 >= count};
    if (count == 0) continue;
    CopyModel(matches, id, sample_, lane, block);
    has_model |= 1u << lane;
  }
  InstantiateExactModels(matches.ray_scale(), essentials_, spread, block);
  block->is_model &= static_cast<std::uint8_t>(has_model);
}

void BlockSource<FivePoint>::FillFirst(const MatchBlocks& matches, Spread spread, const HypothesisId& id,
                                       HypothesisBlock* block) {
  SolveSample(matches, id.sample, 0);
  for (int lane = 0; lane < kBlockSize; ++lane) CopyModel(matches, id, 0, lane, block);
  InstantiateExactModels(matches.ray_scale(), essentials_, spread, block);
  solutions_ = {};  // no models are left to pass on
  sample_ = kBlockSize - 1;
}

}  // namespace rcme
