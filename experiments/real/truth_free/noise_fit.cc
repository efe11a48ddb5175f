#include "experiments/real/truth_free/noise_fit.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "experiments/data/make_data.h"
#include "experiments/real/truth_free/kept_answers.h"
#include "experiments/real/truth_free/residual_pattern.h"
#include "experiments/real/truth_free/twin.h"
#include "experiments/real/truth_free/twin_settings.h"
#include "stats/fnv1a.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

constexpr double kLeastFittedProducts = 100.0;  // of residuals, for a correlation
constexpr size_t kMostForFit = 20;              // pairs that the noise is fitted to
constexpr std::uint32_t kFitTrial = 0xf17;      // no trial of a report has this number
constexpr std::uint32_t kFitDraws = 3;          // for each of these
constexpr double kFarLengthsPx[] = {20.0, 40.0, 80.0, 160.0};
// Of Student's law, from the shortest to the longest tails; 0: normal.
constexpr double kDegreesOfFreedom[] = {0.0, 20.0, 10.0, 6.0, 4.0, 3.0, 2.5, 2.0, 1.75, 1.5, 1.25, 1.0};
constexpr int kSizeRounds = 2;
// Mean correlation that a mosaic of side 2.3 px gives pairs of points up to 1 px apart (area-weighted).
constexpr double kNearMeanCorrelation = 0.66;

using PatternOf = std::function<ResidualPattern(const RedrawSettings&)>;

// The pairs that the noise is fitted to.
std::vector<const AnsweredTrial*> SelectForFit(const TwinSource& source) {
  std::vector<const AnsweredTrial*> used;
  for (const AnsweredTrial& answered : source.pairs) {
    if (answered.HasAnsweredTemplate() && used.size() < kMostForFit) used.push_back(&answered);
  }
  return used;
}

ResidualPattern ObservedPattern(const std::vector<const AnsweredTrial*>& used) {
  PatternSum sum;
  for (const AnsweredTrial* answered : used) sum.Add(answered->pair.problem, answered->estimate);
  return sum.Take();
}

// Median over pairs of the largest inlier residual, px, scaled to a pair of median noise.
double FarthestAccepted(const std::vector<const AnsweredTrial*>& used) {
  std::vector<double> farthest;
  for (const AnsweredTrial* answered : used) {
    const std::vector<double> sizes = ResidualSizes(answered->pair.problem, answered->estimate);
    farthest.push_back(*std::ranges::max_element(sizes) *
                       EstimateNoise(answered->pair.problem, answered->estimate) / answered->noise_level);
  }
  return ComputeMedian(std::move(farthest));
}

// Tries longer and longer tails, each with the noise scaled until the estimator finds the observed size, up
// to the first that are too long. Keeps the tails nearest to the observed ones.
void FitSizeAndTails(const ResidualPattern& observed, const PatternOf& pattern_of, RedrawSettings* noise) {
  double least = std::numeric_limits<double>::infinity();
  RedrawSettings tried = *noise;
  for (const double dof : kDegreesOfFreedom) {
    tried.student_dof = dof;
    ResidualPattern pattern = pattern_of(tried);
    for (int round = 0; round < kSizeRounds && pattern.sigma_px > 0.0; ++round) {
      tried.noise_px *= observed.sigma_px / pattern.sigma_px;
      pattern = pattern_of(tried);
    }
    const double difference = std::abs(pattern.tail_ratio - observed.tail_ratio);
    if (difference < least) {
      least = difference;
      *noise = tried;
    }
    if (!(pattern.tail_ratio < observed.tail_ratio)) return;
  }
}

// Fits the correlation of the pairs' residuals in excess of that with independent noise: at 1 to 64 px by
// least squares over share and length, then the remainder below 1 px.
void FitShares(const ResidualPattern& observed, const ResidualPattern& independent, RedrawSettings* noise) {
  const auto excess = [&](size_t k) {
    const double difference = observed.products.Correlation(k) - independent.products.Correlation(k);
    const bool is_known =
        std::min(observed.products.counts[k], independent.products.counts[k]) >= kLeastFittedProducts;
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

}  // namespace

RedrawSettings FitNoise(const TwinSource& source, const MotionEstimator& estimator, std::uint64_t seed,
                        KeptSteps* steps) {
  RedrawSettings noise;
  const std::vector<const AnsweredTrial*> used = SelectForFit(source);
  const ResidualPattern observed = ObservedPattern(used);
  if (used.empty() || !(observed.sigma_px > 0.0)) return noise;
  noise.noise_px = observed.sigma_px;
  noise.within_px = FarthestAccepted(used);
  const PatternOf draw_pattern = [&](const RedrawSettings& tried) {
    const Redraw redraw(tried);
    PatternSum sum;
    for (const AnsweredTrial* answered : used) {
      for (std::uint32_t draw = 0; draw < kFitDraws; ++draw) {
        const StreamName name{seed, HashToStreamKey(answered->pair.origin), kFitTrial + draw, 0};
        const TrialData drawn = redraw.Draw(*answered->exact, name, answered->noise_level);
        sum.Add(drawn.problem, AnswerTo(drawn.problem, estimator, name));
      }
    }
    return sum.Take();
  };
  const PatternOf pattern_of = [&](const RedrawSettings& tried) {
    return TakePattern([&] { return draw_pattern(tried); }, steps);
  };
  FitShares(observed, pattern_of(noise), &noise);
  FitSizeAndTails(observed, pattern_of, &noise);
  return noise;
}

RedrawSettings FitSimulatedNoise(const TwinSource& source, const TwinFit& fit, double clustered_share,
                                 const MotionEstimator& estimator, double assumed_sigma_px,
                                 std::uint64_t seed, KeptSteps* steps) {
  RedrawSettings noise = fit.noise;
  const std::vector<const AnsweredTrial*> used = SelectForFit(source);
  const ResidualPattern observed = ObservedPattern(used);
  if (used.empty() || !(observed.sigma_px > 0.0)) return noise;
  TwinFit tried_fit = fit;
  const PatternOf draw_pattern = [&](const RedrawSettings& tried) {
    tried_fit.simulated_noise = tried;
    const auto data = MakeSimulatedData(SimulatedTwinData(tried_fit, clustered_share, assumed_sigma_px));
    PatternSum sum;
    for (std::uint32_t number = 0; number < kFitDraws * used.size(); ++number) {
      const StreamName name{seed, HashToStreamKey(source.scene), kFitTrial + number, 0};
      const TrialData drawn = data->Make(name);
      sum.Add(drawn.problem, AnswerTo(drawn.problem, estimator, name));
    }
    return sum.Take();
  };
  const PatternOf pattern_of = [&](const RedrawSettings& tried) {
    return TakePattern([&] { return draw_pattern(tried); }, steps);
  };
  FitSizeAndTails(observed, pattern_of, &noise);
  return noise;
}

}  // namespace rcme
