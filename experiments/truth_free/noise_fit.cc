#include "experiments/truth_free/noise_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/truth_free/residual_pattern.h"
#include "experiments/truth_free/twin.h"

namespace rcme {
namespace {

constexpr double kLeastProducts = 100.0;  // of residuals, for a correlation
constexpr size_t kMostForFit = 20;        // templates that are redrawn to fit the noise
constexpr double kFarLengthsPx[] = {20.0, 40.0, 80.0, 160.0};
constexpr int kDegreesOfFreedom[] = {0, 20, 10, 6, 4, 3};  // 0: normal
// Mean correlation that a mosaic of side 2.3 px gives pairs of points up to 1 px apart (area-weighted).
constexpr double kNearMeanCorrelation = 0.66;

// The templates with their pairs' answers, some of which the noise is fitted to.
class NoiseFit {
 public:
  NoiseFit(const TwinSource& source, const MotionEstimator& estimator, std::uint64_t seed)
      : estimator_(estimator), seed_(seed) {
    PatternSum sum;
    for (const AnsweredTrial& answered : source.pairs) {
      if (!answered.exact || answered.estimate.status != MotionStatus::kOk || used_.size() == kMostForFit)
        continue;
      used_.push_back(&answered);
      sum.Add(answered.pair.problem, answered.estimate);
    }
    observed_ = sum.Take();
  }

  RedrawSettings Fit() const {
    RedrawSettings noise;
    noise.noise_px = observed_.sigma_px;
    if (used_.empty() || !(noise.noise_px > 0.0)) return noise;
    FitShares(PatternOf(noise), &noise);
    double least = std::numeric_limits<double>::infinity(), sigma_px = noise.noise_px;
    int best_dof = 0;
    for (const int dof : kDegreesOfFreedom) {
      noise.student_dof = dof;
      const ResidualPattern pattern = PatternOf(noise);
      const double difference = std::abs(pattern.tail_ratio - observed_.tail_ratio);
      if (!(difference < least)) continue;
      least = difference;
      best_dof = dof;
      sigma_px = noise.noise_px * observed_.sigma_px / pattern.sigma_px;
    }
    noise.student_dof = best_dof;
    noise.noise_px = sigma_px;
    return noise;
  }

 private:
  ResidualPattern PatternOf(const RedrawSettings& noise) const {
    const Redraw redraw(noise);
    PatternSum sum;
    for (const AnsweredTrial* answered : used_) {
      const StreamName name{seed_, StreamKeyOf(answered->pair.origin), 0xf17, 0};
      const TrialData drawn = redraw.Draw(*answered->exact, name);
      sum.Add(drawn.problem, Answered(drawn.problem, estimator_, name));
    }
    return sum.Take();
  }

  // What the pairs' residuals have in common beyond those of independent noise: at 1 to 64 px by least
  // squares over lengths, the rest of what is in common below 1 px.
  void FitShares(const ResidualPattern& independent, RedrawSettings* noise) const {
    const auto excess = [&](size_t k) {
      const double difference = observed_.products.Correlation(k) - independent.products.Correlation(k);
      const bool is_known =
          std::min(observed_.products.counts[k], independent.products.counts[k]) >= kLeastProducts;
      return is_known ? difference : 0.0;
    };
    double least = std::numeric_limits<double>::infinity();
    for (const double length_px : kFarLengthsPx) {
      double xy = 0.0, xx = 0.0, yy = 0.0;
      for (size_t k = 1; k < kNumDistances; ++k) {
        const double from = kDistanceEdgesPx[k], to = kDistanceEdgesPx[k + 1];
        const double u = std::min(std::sqrt(0.5 * (from * from + to * to)) / length_px, 1.4);
        const double shape = u < 1.0 ? 1.0 - 4.0 * u / std::numbers::pi + u * u / std::numbers::pi : 0.0;
        xy += shape * excess(k);
        xx += shape * shape;
        yy += excess(k) * excess(k);
      }
      const double share = std::clamp(xy / xx, 0.0, 0.9), misfit = yy - 2.0 * share * xy + share * share * xx;
      if (misfit >= least) continue;
      least = misfit;
      noise->far_share = share;
      noise->far_length_px = length_px;
    }
    noise->near_share =
        std::clamp((excess(0) - noise->far_share) / kNearMeanCorrelation, 0.0, 0.95 - noise->far_share);
  }

  const MotionEstimator& estimator_;
  std::uint64_t seed_;
  std::vector<const AnsweredTrial*> used_;
  ResidualPattern observed_;
};

}  // namespace

RedrawSettings FitNoise(const TwinSource& source, const MotionEstimator& estimator, std::uint64_t seed) {
  return NoiseFit(source, estimator, seed).Fit();
}

}  // namespace rcme
