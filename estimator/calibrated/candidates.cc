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

std::vector<Mode> FindModes(const MatchBlocks& matches, const MixturePrior& prior,
                            const std::vector<ScoredEssential>& candidates, size_t num_modes) {
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
  std::vector<Mode> optima;
  modes = Distinct(std::move(modes), num_modes);
  const double scale = modes.empty() || !prior.estimates_scale ? NoiseLaw().scale_of_gaussian
                                                               : StartScale(matches, modes.front());
  for (Mode& mode : modes) {
    mode.mixture.scale = scale;
    if (FitMode(matches, prior, kMostSteps, &mode)) optima.push_back(std::move(mode));
  }
  return Distinct(std::move(optima), num_modes);
}

}  // namespace rcme
