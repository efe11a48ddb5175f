#include "estimator/calibrated/candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "estimator/calibrated/explanation.h"
#include "estimator/geometry/essential_matrix.h"
#include "estimator/kernels/mixture_sums.h"
#include "stats/order_statistic.h"

namespace rcme {
namespace {

constexpr int kFewSteps = 3, kCandidateSteps = 18;
constexpr int kMatchesOfCandidates = 192;  // used to refine and rank candidates; a whole number of blocks
constexpr int kScaleMatches = 128;         // used to estimate a first scale
constexpr int kCheiralityBlocks = 32;      // blocks of matches that decide the cheirality
// Standard deviations of the parallax's noise. Where some mode has less, the first candidates are fitted as
// they are, too.
constexpr double kLittleParallax = 6.0;
constexpr size_t kUnrefined = 3;

void SortByLikelihood(std::vector<Mode>* modes) {
  std::stable_sort(modes->begin(), modes->end(),
                   [](const Mode& a, const Mode& b) { return a.log_likelihood > b.log_likelihood; });
}

// At most `count` modes, most likely first, without those that equal a more likely one.
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

// The scale out of six that maximises the likelihood of the first kScaleMatches at the mode's motion. A fit
// that starts at too wide a scale may end in a compromise between two motions.
double StartScale(const MatchBlocks& matches, const Mode& mode) {
  MatchTermLists terms;
  EvaluateTerms(matches, mode.pose, &terms, kScaleMatches);
  const auto n = static_cast<size_t>(std::min(matches.num_matches(), kScaleMatches));
  const MixtureParameters& m = mode.mixture;
  const double wrong = (1.0 - m.inlier_ratio) * m.outlier_density;  // of r (mixture_parameters.h)
  double best = m.scale, greatest = -std::numeric_limits<double>::infinity();
  for (const double factor : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    const double scale = factor * m.noise.scale_of_gaussian;
    double product = 1.0, log_likelihood = 0.0;
    for (size_t i = 0; i < n; ++i) {
      product *= m.inlier_ratio * NoiseDensity(m.noise, terms.residual[i] / scale) / scale +
                 wrong * matches.NoiseScaleAt(i);
      if (i % 32 == 31) log_likelihood += std::log(product), product = 1.0;
    }
    log_likelihood += std::log(product);
    if (!(log_likelihood > greatest)) continue;
    greatest = log_likelihood;
    best = scale;
  }
  return best;
}

}  // namespace

RelativePose PoseInFront(const MatchBlocks& matches, const Eigen::Matrix3d& E) {
  const std::array<RelativePose, 4> poses = PosesFromEssential(ProjectToEssential(E));
  RelativePose best = poses[0];
  double clearest = -1.0;
  for (const size_t i : {size_t{0}, size_t{2}}) {  // poses 1 and 3 have the opposite translation
    const double sum = SumCheirality(matches, kCheiralityBlocks, poses[i], kSoftScale);
    if (!(std::abs(sum) > clearest)) continue;
    clearest = std::abs(sum);
    best = poses[sum >= 0.0 ? i : i + 1];
  }
  return best;
}

MatchMask TakeFirst(const MatchBlocks& matches, size_t count) {
  MatchMask mask = matches.All();
  for (size_t b = count / kBlockSize; b < mask.size(); ++b) mask[b] = 0;
  return mask;
}

bool IsSameMode(const Mode& a, const Mode& b, double standard_deviations) {
  const Vector5d difference = LocalCoordinates(a.pose, b.pose);
  return difference.dot(a.hessian * difference) <= standard_deviations * standard_deviations;
}

namespace {

// Each candidate after a few steps at a fixed wide scale, on the first matches. A candidate that becomes the
// same as an earlier one is dropped.
std::vector<Mode> RefineALittle(const MatchBlocks& matches, const MixturePrior& prior,
                                const std::vector<ScoredEssential>& candidates) {
  std::vector<Mode> modes;
  const double share = candidates.empty() ? 0.5 : candidates.front().score / matches.num_matches();
  const MixtureParameters common = FirstGuess(prior, kSoftScale, share);
  const MatchMask some = TakeFirst(matches, kMatchesOfCandidates);
  for (const ScoredEssential& candidate : candidates) {
    Mode mode;
    mode.pose = PoseInFront(matches, candidate.E);
    mode.mixture = common;
    mode.used = some;
    ModeFit fit(matches, prior, &mode, MixtureUpdate::kNone);
    bool is_new = true;
    for (int step = 0; step < kFewSteps && !fit.is_converged() && is_new; ++step) {
      is_new = fit.Step() &&
               std::ranges::none_of(modes, [&](const Mode& other) { return IsSameMode(other, mode); });
    }
    if (!is_new) continue;
    fit.Finish();
    if (mode.hessian.diagonal().minCoeff() > 0.0) modes.push_back(std::move(mode));
  }
  return modes;
}

// The same modes at another scale.
std::vector<Mode> AtScale(const MatchBlocks& matches, const MixturePrior& prior, std::vector<Mode> modes,
                          double scale) {
  for (Mode& mode : modes) {
    mode.mixture.scale = scale;
    mode.log_likelihood = SumLogPosterior(matches, mode.used, prior, mode.pose, mode.mixture);
  }
  return modes;
}

struct Optima {
  std::vector<Mode> modes;
  // The most likely fit that did not converge: among points without parallax, c(z) rejects all but the
  // smallest steps.
  std::optional<Mode> stuck;
};

// Adds the optimum reached from `mode` on all matches, unless it is already in the list. Most duplicates show
// within the first steps, where the fit is then stopped.
void AddOptimum(const MatchBlocks& matches, const MixturePrior& prior, Mode mode, Optima* optima) {
  const auto is_known = [&] {
    return std::ranges::any_of(optima->modes, [&](const Mode& other) {
      return IsSameMode(other, mode) && std::abs(std::log(other.mixture.scale / mode.mixture.scale)) < 0.7;
    });
  };
  mode.used = matches.All();
  ModeFit fit(matches, prior, &mode);
  for (int step = 0; step < kCandidateSteps && !fit.is_converged(); ++step) {
    if (!fit.Step() || (step < kFewSteps && is_known())) return;
  }
  const bool has_converged = fit.Finish();
  if (has_converged && !is_known())
    optima->modes.push_back(std::move(mode));
  else if (!has_converged && mode.inverse_hessian.allFinite() &&
           (!optima->stuck || mode.log_likelihood > optima->stuck->log_likelihood))
    optima->stuck = std::move(mode);
}

// The parallax that a fifth of the matches that the mode explains exceed, in standard deviations of its
// noise, among the first kScaleMatches.
double UsualParallax(const MatchBlocks& matches, const Mode& mode) {
  constexpr double kExplained = 3.0;  // standard deviations
  MatchTermLists terms;
  EvaluateTerms(matches, mode.pose, &terms, kScaleMatches);
  const auto n = static_cast<size_t>(std::min(matches.num_matches(), kScaleMatches));
  std::vector<double> parallaxes;
  for (size_t i = 0; i < n; ++i)
    if (std::abs(terms.residual[i]) < kExplained * mode.mixture.scale) parallaxes.push_back(terms.depth[i]);
  return ComputeQuantile(parallaxes, 0.8);
}

// Adds the optima reached from the first candidates without the few steps at a wide scale. Where the parallax
// is no greater than that scale, these steps lead away from the motion of a good sample.
void AddOptimaOfCandidates(const MatchBlocks& matches, const MixturePrior& prior,
                           const std::vector<ScoredEssential>& candidates, Optima* optima) {
  for (size_t i = 0; i < std::min(candidates.size(), kUnrefined); ++i) {
    Mode mode;
    mode.pose = PoseInFront(matches, candidates[i].E);
    mode.mixture =
        FirstGuess(prior, NoiseLaw().scale_of_gaussian, candidates.front().score / matches.num_matches());
    if (prior.estimates_scale) mode.mixture.scale = StartScale(matches, mode);
    AddOptimum(matches, prior, std::move(mode), optima);
  }
}

// A fit that did not converge counts if no optimum is as likely: then no other fit has reached its motion.
std::vector<Mode> TakeModes(Optima optima) {
  const auto is_less_likely = [&](const Mode& mode) {
    return mode.log_likelihood < optima.stuck->log_likelihood;
  };
  if (optima.stuck && std::ranges::all_of(optima.modes, is_less_likely))
    optima.modes.push_back(std::move(*optima.stuck));
  return std::move(optima.modes);
}

}  // namespace

std::vector<Mode> FindModes(const MatchBlocks& matches, const MixturePrior& prior,
                            const std::vector<ScoredEssential>& candidates, size_t num_modes) {
  const std::vector<Mode> refined = RefineALittle(matches, prior, candidates);
  const double assumed_scale = NoiseLaw().scale_of_gaussian;
  Optima found;
  for (Mode& mode : Distinct(AtScale(matches, prior, refined, assumed_scale), (num_modes + 1) / 2)) {
    AddOptimum(matches, prior, std::move(mode), &found);
  }
  for (Mode& mode : Distinct(refined, prior.estimates_scale ? num_modes / 2 : 0)) {
    mode.mixture.scale = StartScale(matches, mode);
    AddOptimum(matches, prior, std::move(mode), &found);
  }
  const bool has_little_parallax = std::ranges::any_of(
      found.modes, [&](const Mode& mode) { return UsualParallax(matches, mode) < kLittleParallax; });
  if (has_little_parallax) AddOptimaOfCandidates(matches, prior, candidates, &found);
  std::vector<Mode> optima = TakeModes(std::move(found));
  // There may be no optimum, because c(z) can reject every step. Then take the best motion after a few steps.
  for (Mode& mode : Distinct(refined, optima.empty() ? 1 : 0)) {
    mode.used = matches.All();
    mode.mixture.scale = prior.estimates_scale ? StartScale(matches, mode) : assumed_scale;
    FitMode(matches, prior, kFewSteps, &mode);
    if (mode.inverse_hessian.allFinite()) optima.push_back(std::move(mode));
  }
  return Distinct(std::move(optima), num_modes + kUnrefined);
}

std::vector<Mode> ModesFrom(const MatchBlocks& matches, const MixturePrior& prior,
                            const std::vector<RelativePose>& starts) {
  Optima optima;
  for (const RelativePose& start : starts) {
    Mode mode;
    mode.pose = start;
    mode.mixture = FirstGuess(prior, NoiseLaw().scale_of_gaussian, 0.5);
    AddOptimum(matches, prior, mode, &optima);
    mode.mixture.scale = StartScale(matches, mode);
    if (prior.estimates_scale) AddOptimum(matches, prior, std::move(mode), &optima);
  }
  return TakeModes(std::move(optima));
}

}  // namespace rcme
