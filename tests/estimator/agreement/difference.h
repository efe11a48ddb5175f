// What differs between two estimates of one problem.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "estimator/kernels/block_search.h"
#include "estimator/solvers/solver_list.h"
#include "tests/estimator/agreement/variant.h"

namespace rcme::agreement {

inline double RelativeDifference(double a, double b) {
  return a == b ? 0.0 : std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

inline bool HaveSameCounts(const LoopCounts& a, const LoopCounts& b) {
  return a.num_hypotheses == b.num_hypotheses && a.num_degenerate_samples == b.num_degenerate_samples &&
         a.num_inconsistent_samples == b.num_inconsistent_samples &&
         a.num_poor_inlier_sets == b.num_poor_inlier_sets &&
         a.num_too_small_inlier_sets == b.num_too_small_inlier_sets && a.num_candidates == b.num_candidates;
}

inline bool AreSame(const Hypothesis<FivePoint>& a, const Hypothesis<FivePoint>& b) {
  const Vector9d &f = a.model.f, &g = b.model.f;
  return std::min((f - g).norm(), (f + g).norm()) < 1e-6;
}

// Whether both implementations find the same models in a sample.
inline bool AreSame(const ModelList<Hypothesis<FivePoint>, FivePoint::kMaxModels>& models, int num_models,
                    const MotionProblem& problem, const MatchBlocks& matches) {
  if (models.count != num_models) return false;
  BlockSource<FivePoint> source;
  return std::ranges::all_of(models, [&](const Hypothesis<FivePoint>& model) {
    const auto other = source.FindHypothesis(problem, matches, model.id);
    return other && AreSame(model, *other);
  });
}

// Whether both implementations find the same models in all samples of a trial. Eight points always have one;
// the block solver of five points misses some solutions that nearly coincide, and the scalar one others.
inline bool HaveSameModels(const Variant& variant, const MotionProblem& problem, std::uint32_t trial) {
  if (variant.solver != MinimalSolver::kFivePoint) return true;
  const MatchBlocks matches(problem);
  BlockSource<FivePoint> source;
  HypothesisBlock block;
  ProposalBlock proposals;
  RandomStream rng = SamplingStream(trial);
  int num_samples = 0;
  for (size_t lane = kBlockSize; num_samples < variant.Options().num_iterations; ++lane) {
    if (lane >= kBlockSize) {
      source.FillNext(matches, RequestedOutputs::kNone, rng, &block, &proposals);
      lane = 0;
    }
    if (!proposals[lane].is_last) continue;
    ++num_samples;
    const HypothesisId& last = proposals[lane].id;
    const int num_models = block.is_model >> lane & 1 ? last.model + 1 : last.model;
    if (!AreSame(InstantiateModels<FivePoint>(problem, last.sample), num_models, problem, matches)) {
      return false;
    }
  }
  return true;
}

// What may differ. A winner of eight points that is the same sample and the same one of its four motions is
// the same to the bit. Where the solvers find different models, the fast loop is compared with that of the
// reference over the models of the fast one (given_models.h); if those agree, the reference may still have
// another winner, for it had other models to choose from (kMissedModel).
enum class Difference { kLoop, kEstimate, kEntropy, kMissedModel };

struct Differing {
  Difference kind;
  std::string what;
};
inline bool HaveSameWinner(const MotionEstimate& a, const MotionEstimate& b) {
  if (a.initial_pose.R == b.initial_pose.R && a.initial_pose.t == b.initial_pose.t) return true;
  return a.hypothesis.sample == b.hypothesis.sample && a.hypothesis.sample.size() == 5 &&
         LocalCoordinates(a.initial_pose, b.initial_pose).norm() < 1e-9;
}

// Two solutions of the fast solver may be one to the reference: then their numbers say nothing.
inline bool HasWinner(const MotionEstimate& estimate, const LoopResult& loop) {
  if (!loop.winner) return estimate.hypothesis == HypothesisId();
  const auto& [id, score, z] = *loop.winner;
  const bool is_same_model =
      estimate.hypothesis == id || (estimate.hypothesis.sample == id.sample &&
                                    RelativeDifference(estimate.mean_entropy, score.mean_entropy) < 1e-9);
  return is_same_model && estimate.num_support == score.num_inliers;
}

// `given`: the loop of the reference over the models of the fast solver, where the two find different ones.
inline std::optional<Differing> FindDifference(const MotionEstimate& fast, const MotionEstimate& reference,
                                               const std::optional<LoopResult>& given) {
  const LoopCounts& counts = given ? given->counts : reference.counts;
  if (!HaveSameCounts(fast.counts, counts)) return Differing{Difference::kLoop, "counts"};
  if (given && !HasWinner(fast, *given)) return Differing{Difference::kLoop, "winner"};
  const bool is_other_winner = !HaveSameWinner(fast, reference);
  if (given && is_other_winner) return Differing{Difference::kMissedModel, "winner"};
  if (fast.num_support != reference.num_support) return Differing{Difference::kLoop, "support"};
  if (is_other_winner) return Differing{Difference::kLoop, "winner"};
  if (fast.status != reference.status) return Differing{Difference::kEstimate, "status"};
  if (fast.inliers != reference.inliers) return Differing{Difference::kEstimate, "final inliers"};
  if (RelativeDifference(fast.mean_entropy, reference.mean_entropy) > 1e-9)
    return Differing{Difference::kEntropy, "entropy"};
  return std::nullopt;
}

}  // namespace rcme::agreement
