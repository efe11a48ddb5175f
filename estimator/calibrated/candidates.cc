#include "estimator/calibrated/candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/kernels/mixture_sums.h"

namespace rcme {
namespace {

constexpr int kFewSteps = 3, kMostSteps = 30;
constexpr int kCheiralityBlocks =
    32;                             // matches that decide on which side the cameras are, in blocks of eight
constexpr double kSameMode = 25.0;  // squared standard deviations

void SortByLikelihood(std::vector<Mode>* modes) {
  std::stable_sort(modes->begin(), modes->end(),
                   [](const Mode& a, const Mode& b) { return a.log_likelihood > b.log_likelihood; });
}

// Those that are not the same as a more likely one, at most `count`.
std::vector<Mode> Distinct(std::vector<Mode> modes, size_t count) {
  SortByLikelihood(&modes);
  std::vector<Mode> distinct;
  for (Mode& mode : modes) {
    if (distinct.size() == count) break;
    const bool is_new =
        std::ranges::none_of(distinct, [&](const Mode& other) { return IsSameMode(other, mode); });
    if (is_new) distinct.push_back(std::move(mode));
  }
  return distinct;
}

// Of some scales the one that explains the matches best at the mode's motion. From a scale that is too wide,
// a fit may end in a compromise between two motions.
double StartScale(const MatchBlocks& matches, const Mode& mode) {
  double best = kSoftScale, greatest = -std::numeric_limits<double>::infinity();
  for (const double factor : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    MixtureParameters mixture = mode.mixture;
    mixture.scale = factor * mixture.noise.scale_of_gaussian;
    const double right = SumMixture(matches, mode.used, mode.pose, mixture).num_right;
    mixture.inlier_ratio = std::clamp(right / matches.num_matches(), 0.05, 0.95);
    const double log_likelihood = SumMixture(matches, mode.used, mode.pose, mixture).log_likelihood;
    if (!(log_likelihood > greatest)) continue;
    greatest = log_likelihood;
    best = mixture.scale;
  }
  return best;
}

}  // namespace

RelativePose PoseInFront(const MatchBlocks& matches, const Eigen::Matrix3d& E) {
  const std::array<RelativePose, 4> poses = PosesFromEssential(ProjectToEssential(E));
  RelativePose best = poses[0];
  double clearest = -1.0;
  for (const size_t i : {size_t{0}, size_t{2}}) {  // the other two go the opposite way
    const double sum = SumCheirality(matches, kCheiralityBlocks, poses[i], kSoftScale);
    if (!(std::abs(sum) > clearest)) continue;
    clearest = std::abs(sum);
    best = poses[sum >= 0.0 ? i : i + 1];
  }
  return best;
}

bool IsSameMode(const Mode& a, const Mode& b, double standard_deviations) {
  const Vector5d difference = LocalCoordinates(a.pose, b.pose);
  return difference.dot(a.hessian * difference) <= standard_deviations * standard_deviations;
}

namespace {

// Of every candidate a mode after a few steps at a fixed scale.
std::vector<Mode> RefineALittle(const MatchBlocks& matches, const MixturePrior& prior,
                                const std::vector<ScoredEssential>& candidates) {
  std::vector<Mode> modes;
  const double share = candidates.empty() ? 0.5 : candidates.front().score / matches.num_matches();
  const MixtureParameters common = FirstGuess(prior, kSoftScale, share);
  for (const ScoredEssential& candidate : candidates) {
    Mode mode;
    mode.pose = PoseInFront(matches, candidate.E);
    mode.mixture = common;
    mode.used = matches.All();
    FitMode(matches, prior, kFewSteps, &mode, MixtureUpdate::kNone);
    if (mode.hessian.diagonal().minCoeff() > 0.0) modes.push_back(std::move(mode));
  }
  return modes;
}

// The same modes at another scale.
std::vector<Mode> AtScale(const MatchBlocks& matches, std::vector<Mode> modes, double scale) {
  for (Mode& mode : modes) {
    mode.mixture.scale = scale;
    mode.log_likelihood = SumMixture(matches, mode.used, mode.pose, mode.mixture).log_likelihood;
  }
  return modes;
}

}  // namespace

std::vector<Mode> FindModes(const MatchBlocks& matches, const MixturePrior& prior,
                            const std::vector<ScoredEssential>& candidates, size_t num_modes) {
  const std::vector<Mode> refined = RefineALittle(matches, prior, candidates);
  const double assumed_scale = NoiseLaw().scale_of_gaussian;
  std::vector<Mode> starts = Distinct(AtScale(matches, refined, assumed_scale), (num_modes + 1) / 2);
  if (prior.estimates_scale && !refined.empty()) {
    std::vector<Mode> wide = Distinct(refined, num_modes / 2);
    const double scale = StartScale(matches, wide.front());
    for (Mode& mode : wide) {
      mode.mixture.scale = scale;
      starts.push_back(std::move(mode));
    }
  }
  std::vector<Mode> optima;
  for (Mode& mode : starts) {
    if (FitMode(matches, prior, kMostSteps, &mode)) optima.push_back(std::move(mode));
  }
  return Distinct(std::move(optima), num_modes);
}

}  // namespace rcme
