#include "estimator/calibrated/hypothesis_search.h"

#include <algorithm>
#include <cmath>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/kernels/block_source.h"
#include "stats/constants.h"

namespace rcme {
namespace {

constexpr int kFirstMatches = 64;
constexpr int kModelsOfSample = 5;       // a rough figure, to reserve memory
constexpr size_t kLeastFullScores = 40;  // of a round: this many or a quarter of it, whichever is more
// Above these values of |<E_a, E_b>| / 2, two hypotheses are the same motion or near to each other.
constexpr double kSame = 0.9999, kNear = 0.98;
// Standard deviation of a minimal sample's motion, per coordinate of the tangent; and the tail probability of
// the prior below which it is not near.
constexpr double kSampleSdRad = 3.0 * kRadPerDeg, kLeastTail = 1e-3;

struct RankedModel {
  double F[9];  // whitened
  double first_score, score;
};

// Models are large: it is their ranks that are sorted.
struct ModelRank {
  double score;
  size_t index;
};
constexpr auto kIsBetter = [](const ModelRank& a, const ModelRank& b) {
  return a.score != b.score ? a.score > b.score : a.index < b.index;
};

// The lists of a search.
struct SearchLists {
  std::vector<RankedModel> fresh, scored;
  std::vector<ModelRank> order;
  std::vector<ScoredEssential> ranked;

  void Clear() {
    constexpr size_t kMostKept = 1 << 16;  // models
    if (fresh.capacity() > kMostKept || scored.capacity() > kMostKept) *this = {};
    fresh.clear();
    scored.clear();
    order.clear();
    ranked.clear();
  }
};

// Those of this thread. They stay with it from one call to the next, because memory that goes back to the
// kernel has to be cleared before it returns: a tenth of the time of a call.
SearchLists& ListsOfThread() {
  thread_local SearchLists lists;
  return lists;
}

// The least N with 1 - (1 - w^5)^N >= 0.999: the samples needed if a share `w` of the matches are inliers.
double SamplesNeeded(double w) {
  const double all_right = std::pow(std::clamp(w, 1e-3, 0.999), 5);
  return std::log(1e-3) / std::log1p(-all_right);
}

// The share of inliers that a score indicates. Under the exact motion an inlier scores about 0.88. Hypotheses
// are less exact, so that the share is too small and more samples than needed are drawn.
double InlierShare(double score, int num_matches) { return score / (0.88 * num_matches); }

class Rounds {
 public:
  Rounds(const MatchBlocks& matches, const ScoreMatches& score_matches, double soft_scale, RandomStream& rng,
         SearchLists* lists)
      : matches_(matches), scores_(score_matches), soft_scale_(soft_scale), rng_(rng), lists_(*lists) {}

  // Draws until `num_samples` samples have been drawn in all, and scores their models.
  void Draw(int num_samples) {
    const int first_end = std::min(kFirstMatches, scores_.num_matches());
    lists_.fresh.reserve(static_cast<size_t>(kModelsOfSample * std::max(num_samples - num_drawn_, 0)));
    while (num_drawn_ < num_samples) {
      source_.FillNext(matches_, RequestedOutputs::kNone, rng_, &block_, &proposals_);
      for (int lane = 0; lane < kBlockSize; ++lane) {
        num_drawn_ += proposals_[static_cast<size_t>(lane)].is_last ? 1 : 0;
        ++counts_.num_hypotheses;
        if (!(block_.is_model >> lane & 1)) {
          ++counts_.num_degenerate_samples;
          continue;
        }
        RankedModel model;
        for (int i = 0; i < 9; ++i) model.F[i] = block_.F[i][lane];
        model.first_score = model.score = scores_.SumScores(model.F, soft_scale_, 0, first_end);
        lists_.fresh.push_back(model);
      }
    }
    ScoreBest(first_end);
  }
  double best_score() const { return best_score_; }
  int num_drawn() const { return num_drawn_; }
  const LoopCounts& counts() const { return counts_; }

 private:
  // Scores the best of the fresh models on the rest of the matches.
  void ScoreBest(int first_end) {
    auto& [fresh, scored, order, ranked] = lists_;
    const size_t count = std::min(std::max(kLeastFullScores, fresh.size() / 4), fresh.size());
    order.clear();
    for (size_t i = 0; i < fresh.size(); ++i) order.push_back({fresh[i].first_score, i});
    std::ranges::nth_element(order, order.begin() + static_cast<std::ptrdiff_t>(count), kIsBetter);
    for (size_t i = 0; i < count; ++i) {
      RankedModel& model = fresh[order[i].index];
      model.score += scores_.SumScores(model.F, soft_scale_, first_end, scores_.num_matches());
      best_score_ = std::max(best_score_, model.score);
      scored.push_back(model);
    }
    fresh.clear();
  }

  const MatchBlocks& matches_;
  const ScoreMatches& scores_;
  const double soft_scale_;
  RandomStream& rng_;
  BlockSource<FivePoint> source_;
  HypothesisBlock block_;
  ProposalBlock proposals_{};
  SearchLists& lists_;
  double best_score_ = 0.0;
  int num_drawn_ = 0;
  LoopCounts counts_;
};

// The E of an F in whitened coordinates, Frobenius norm sqrt(2).
Eigen::Matrix3d EssentialFromWhitened(const double* F, const RayScale& scale) {
  Eigen::Matrix3d E;
  const double left[3] = {scale.x2, scale.y2, 1.0}, right[3] = {scale.x1, scale.y1, 1.0};
  for (int i = 0; i < 9; ++i) E(i / 3, i % 3) = F[i] / (left[i / 3] * right[i % 3]);
  return E * (std::sqrt(2.0) / E.norm());
}

// Whether one of the poses of E agrees with the prior. The motion of a minimal sample is taken to be off by 3
// deg in each coordinate.
bool IsNearPrior(const MotionPrior& prior, const Eigen::Matrix3d& E) {
  const Matrix5d spread = kSampleSdRad * kSampleSdRad * Matrix5d::Identity();
  return std::ranges::any_of(PosesFromEssential(ProjectToEssential(E)), [&](const RelativePose& pose) {
    return ComputePriorTail(prior, pose, spread) > kLeastTail;
  });
}

// Selects half of `count` as the best distinct ones, then fills up with those far from all selected, then
// adds those near the prior.
std::vector<ScoredEssential> SelectDistinct(SearchLists* lists, const RayScale& scale, size_t count,
                                            const MotionPrior* prior) {
  auto& [fresh, models, order, ranked] = *lists;
  order.clear();
  for (size_t i = 0; i < models.size(); ++i) order.push_back({models[i].score, i});
  std::ranges::sort(order, kIsBetter);
  for (const ModelRank& rank : order)
    ranked.push_back({EssentialFromWhitened(models[rank.index].F, scale), rank.score});
  std::vector<ScoredEssential> taken;
  std::vector<bool> is_taken(ranked.size(), false);
  const auto take = [&](size_t up_to, double too_like, const MotionPrior* near) {
    for (size_t i = 0; i < ranked.size() && taken.size() < up_to; ++i) {
      if (is_taken[i]) continue;
      const ScoredEssential& next = ranked[i];
      const bool is_new = std::ranges::all_of(
          taken, [&](const ScoredEssential& other) { return ComputeSimilarity(next.E, other.E) < too_like; });
      if (!is_new || (near != nullptr && !IsNearPrior(*near, next.E))) continue;
      taken.push_back(next);
      is_taken[i] = true;
    }
  };
  take((count + 1) / 2, kSame, nullptr);
  take(count, kNear, nullptr);
  if (prior != nullptr) take(taken.size() + (count + 1) / 2, kSame, prior);
  return taken;
}

}  // namespace

double ComputeSimilarity(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return 0.5 * std::abs(a.cwiseProduct(b).sum());
}

HypothesisSearch SearchHypotheses(const MatchBlocks& matches, const ScoreMatches& score_matches,
                                  const CalibratedOptions& options, RandomStream& rng, double soft_scale,
                                  const MotionPrior* prior) {
  SearchLists& lists = ListsOfThread();
  lists.Clear();
  Rounds rounds(matches, score_matches, soft_scale, rng, &lists);
  for (int num_samples = options.min_samples;;) {
    rounds.Draw(num_samples);
    const double needed = SamplesNeeded(InlierShare(rounds.best_score(), matches.num_matches()));
    const int enough = static_cast<int>(std::min(std::ceil(needed), 1.0 * options.max_samples));
    if (num_samples >= enough) break;
    num_samples = std::min(enough, 2 * num_samples);
  }
  return {SelectDistinct(&lists, matches.ray_scale(), static_cast<size_t>(options.num_candidates), prior),
          rounds.num_drawn(), rounds.counts()};
}

}  // namespace rcme
