#include "experiments/audit/claims/model_entropy.h"

#include <algorithm>
#include <stdexcept>

namespace rcme {

std::optional<UncertainFundamental> ComputeSampleModel(const MotionProblem& problem, const Sample& sample) {
  std::optional<Hypothesis<EightPoint>> hypothesis = InstantiateModel<EightPoint>(problem, {sample});
  if (!hypothesis) return std::nullopt;
  PropagateCovariance(problem, &*hypothesis);
  return ComputeUncertainFundamental(problem, *hypothesis);
}

Sample DrawSampleByKind(SampleKind kind, Case& made) {
  const std::vector<bool>& is_inlier = made.data.truth.is_inlier_true;
  for (int draw = 0; draw < 1'000'000; ++draw) {
    const Sample sample = DrawSample(8, static_cast<int>(is_inlier.size()), made.rng);
    const bool is_good = std::all_of(sample.begin(), sample.end(),
                                     [&](int index) { return is_inlier[static_cast<size_t>(index)]; });
    if (is_good == (kind == SampleKind::kGood)) return sample;
  }
  throw std::logic_error("claims: no such sample among a million draws");
}

double MeanEntropyOrInfinity(const InlierScore& score) {
  return score.num_inliers > 0 ? score.mean_entropy : std::numeric_limits<double>::infinity();
}

}  // namespace rcme
