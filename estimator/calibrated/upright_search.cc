#include "estimator/calibrated/upright_search.h"

#include <algorithm>
#include <cmath>

#include "estimator/calibrated/candidates.h"
#include "estimator/geometry/essential_matrix.h"
#include "estimator/sample.h"
#include "estimator/solvers/upright_three_point.h"

namespace rcme {
namespace {

constexpr int kUprightFirstMatches = 64, kUprightMatches = 192;  // to rank models, to refine the best
constexpr size_t kUprightFullScores = 100;
// Models to refine: at most so many, and one for so many samples. Refinement costs most where few are wrong.
constexpr size_t kUprightRefined = 16;
constexpr int kSamplesOfRefined = 8;
// Above these similarities two models are alike before the refinement, and the same after it.
constexpr double kUprightAlike = 0.995, kUprightSame = 0.9999;
// Share of an error of gravity, times the focal length, that a usual residual of a good sample shows: the
// angle about gravity and the translation absorb the rest. With 90 % wrong matches and 2 deg of noise, 0.1 to
// 0.2 finds more motions than 0.05 and than 0.35.
constexpr double kShownShare = 0.15;
// Of both measurements together. With more, samples of three find no more motions than those of five.
constexpr double kGreatestGravitySdRad = 0.2;
constexpr double kScaleStep = 0.5;  // of a refinement, from one scale to the next
constexpr int kStepsOfScale = 2;

// The scale at which models are ranked, in units of the assumed sigma.
double ComputeRankingScale(const GravityPrior& gravity, const RayScale& scale) {
  const double focal_length = 1.0 / std::sqrt(scale.x2 * scale.y2);
  return std::hypot(kSoftScale, kShownShare * focal_length * std::hypot(gravity.sd1_rad, gravity.sd2_rad));
}

// At most `count` of the models, best first, each unlike those before it.
std::vector<ScoredEssential> SelectBest(std::vector<ScoredEssential> models, size_t count, double too_like) {
  std::ranges::stable_sort(models, std::ranges::greater{}, &ScoredEssential::score);
  std::vector<ScoredEssential> best;
  for (const ScoredEssential& model : models) {
    if (best.size() == count) break;
    const bool is_new = std::ranges::all_of(
        best, [&](const ScoredEssential& other) { return ComputeSimilarity(model.E, other.E) < too_like; });
    if (is_new) best.push_back(model);
  }
  return best;
}

class UprightModels {
 public:
  UprightModels(const MatchBlocks& matches, const ScoreMatches& score_matches, const GravityPrior& gravity,
                double scale)
      : matches_(matches),
        scores_(score_matches),
        solver_(gravity.in_cam1, gravity.in_cam2),
        scale_(scale),
        first_end_(std::min(kUprightFirstMatches, score_matches.num_matches())) {}

  void Draw(int num_samples, RandomStream& rng, LoopCounts* counts) {
    constexpr size_t kUsual = 3;  // models of a sample
    models_.reserve(kUsual * static_cast<size_t>(num_samples));
    UprightThreePoint::Rays rays1, rays2;
    for (int i = 0; i < num_samples; ++i) {
      const Sample sample = DrawSample(UprightThreePoint::kSampleSize, matches_.num_matches(), rng);
      for (size_t k = 0; k < rays1.size(); ++k) TakeRays(sample[k], &rays1[k], &rays2[k]);
      const UprightThreePoint::Solutions solutions = solver_.Solve(rays1, rays2);
      counts->num_hypotheses += std::max(solutions.count, 1);
      counts->num_degenerate_samples += solutions.count == 0 ? 1 : 0;
      for (int m = 0; m < solutions.count; ++m) {
        const Eigen::Matrix3d& E = solutions.E[static_cast<size_t>(m)];
        models_.push_back({E, Score(E, 0, first_end_)});
      }
    }
  }

  // The best distinct models by their score on all matches, at most `num_best`.
  std::vector<ScoredEssential> TakeBest(size_t num_best) {
    const size_t count = std::min(kUprightFullScores, models_.size());
    std::ranges::nth_element(models_, models_.begin() + static_cast<std::ptrdiff_t>(count),
                             std::ranges::greater{}, &ScoredEssential::score);
    models_.resize(count);
    for (ScoredEssential& model : models_) model.score += Score(model.E, first_end_, scores_.num_matches());
    return SelectBest(std::move(models_), num_best, kUprightAlike);
  }

 private:
  void TakeRays(int match, Eigen::Vector3d* ray1, Eigen::Vector3d* ray2) const {
    const int lane = match % kBlockSize;
    const MatchBlock& from = matches_[match / kBlockSize];
    const RayScale& scale = matches_.ray_scale();
    *ray1 = {scale.x1 * from.x1[lane], scale.y1 * from.y1[lane], 1.0};
    *ray2 = {scale.x2 * from.x2[lane], scale.y2 * from.y2[lane], 1.0};
  }
  double Score(const Eigen::Matrix3d& E, int first, int end) const {
    double F[9];
    WriteRowMajor(matches_.FundamentalFromEssential(E), F);
    return scores_.SumScores(F, scale_, first, end);
  }

  const MatchBlocks& matches_;
  const ScoreMatches& scores_;
  const UprightThreePoint solver_;
  const double scale_;
  const int first_end_;
  std::vector<ScoredEssential> models_;
};

// A few steps at each scale from `scale` down to kSoftScale, on the first matches. Returns false if a step
// fails.
bool RefineWhileScaleShrinks(const MatchBlocks& matches, const MixturePrior& prior, double scale,
                             Mode* mode) {
  for (;;) {
    mode->mixture.scale = std::max(scale, kSoftScale);
    ModeFit fit(matches, prior, mode, MixtureUpdate::kNone);
    for (int step = 0; step < kStepsOfScale && !fit.is_converged(); ++step) {
      if (!fit.Step()) return false;
    }
    if (scale <= kSoftScale) return true;
    scale *= kScaleStep;
  }
}

// The models after refinement, ranked by the score of SearchHypotheses.
std::vector<ScoredEssential> RefineUpright(const MatchBlocks& matches, const ScoreMatches& score_matches,
                                           const MixturePrior& prior, double scale,
                                           const std::vector<ScoredEssential>& models, size_t count) {
  std::vector<ScoredEssential> refined;
  const int n = matches.num_matches();
  const MatchMask some = TakeFirst(matches, kUprightMatches);
  for (const ScoredEssential& model : models) {
    Mode mode;
    mode.pose = PoseInFront(matches, model.E);
    mode.mixture = FirstGuess(prior, scale, 0.2);
    mode.used = some;
    if (!RefineWhileScaleShrinks(matches, prior, scale, &mode)) continue;
    ScoredEssential found{EssentialFromPose(mode.pose), 0.0};
    double F[9];
    WriteRowMajor(matches.FundamentalFromEssential(found.E), F);
    found.score = score_matches.SumScores(F, kSoftScale, 0, n);
    refined.push_back(found);
  }
  return SelectBest(std::move(refined), count, kUprightSame);
}

}  // namespace

void AddUprightCandidates(const MatchBlocks& matches, const ScoreMatches& score_matches,
                          const MixturePrior& prior, int num_samples, size_t count, RandomStream& rng,
                          HypothesisSearch* search) {
  if (prior.motion == nullptr || !prior.motion->gravity) return;
  const GravityPrior& gravity = *prior.motion->gravity;
  if (std::hypot(gravity.sd1_rad, gravity.sd2_rad) > kGreatestGravitySdRad) return;
  const double scale = ComputeRankingScale(gravity, matches.ray_scale());
  UprightModels models(matches, score_matches, gravity, scale);
  models.Draw(num_samples, rng, &search->counts);
  const size_t num_refined = std::min(kUprightRefined, static_cast<size_t>(num_samples / kSamplesOfRefined));
  const std::vector<ScoredEssential> found =
      RefineUpright(matches, score_matches, prior, scale, models.TakeBest(num_refined), count);
  if (found.empty()) return;
  std::vector<ScoredEssential>& candidates = search->candidates;
  const bool is_first = candidates.empty() || found.front().score > candidates.front().score;
  candidates.insert(is_first ? candidates.begin() : candidates.end(), found.front());
  candidates.insert(candidates.end(), found.begin() + 1, found.end());
}

}  // namespace rcme
