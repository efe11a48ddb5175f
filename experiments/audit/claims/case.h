// One simulated trial as a check sees it: the exact scene, the problem and the truth.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/audit/claims/claim.h"
#include "experiments/audit/claims/design.h"
#include "experiments/data/simulated_data.h"
#include "simulator/scene.h"

namespace rcme {

struct Case {
  StreamName name;
  Scene scene;       // exact
  TrialData data;    // its noisy matches in random order, and the truth
  RandomStream rng;  // for draws of the check itself
  // The true noise level; the problem states the assumed one.
  double sigma_px_true = std::numeric_limits<double>::quiet_NaN();

  const MotionProblem& problem() const { return data.problem; }
  const RelativePose& pose_true() const { return scene.cam2_from_cam1_true; }
};

// The Cramer-Rao bound of the case's motion (5x5, [rotation, direction], rad^2): the inverse information at
// the true motion and the exact points of the true matches. Nullopt if they do not determine a motion.
std::optional<Matrix5d> CramerRaoBound(const Case& made);

using CaseMaker = std::function<Case(const StreamName&)>;
using Statistic = std::function<Outcome(Case&)>;

// Cases of simulated data.
CaseMaker CasesFrom(std::shared_ptr<const SimulatedData> simulated);

// Simulated cases. `settings` override the defaults of the scene uniform_volume and of noise. There are no
// outliers unless outlier_ratio is given.
CaseMaker SimulatedCases(const Settings& settings);

// All settings of SimulatedCases, including defaults.
Settings ResolveCaseSettings(const Settings& settings);

// A check of `statistic` on simulated cases.
Check MakeCheck(const Settings& settings, const Statistic& statistic, const std::vector<Target>& targets,
                const TrialLimits& limits);

// Noise levels for claims about minimal samples: from the range of first-order theory to beyond the paper's
// 0.5 px.
inline const std::vector<double> kNoiseLevelsPx = {1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0};

// The same check at several noise levels.
std::vector<Check> ChecksAtNoiseLevels(const std::vector<double>& sigmas_px, const Settings& settings,
                                       const Statistic& statistic, const std::vector<Target>& targets,
                                       const TrialLimits& limits);

// Coverage of the 1 - alpha regions of a chi-square law at alpha = .5, .2, .1, .05, .01, alpha = .05 first,
// and the mean of its probability integral transform. The allowed range is the effect of sigmas wrong by the
// tolerance.
std::vector<Target> CoverageTargets(int degrees_of_freedom,
                                    const ScaleTolerance& tolerance = kFormulaTolerance);

// A target for an identity: the statistic, a relative deviation, is within `tolerance` in at least 999 of
// 1,000 trials.
Target IdentityTarget(const std::string& quantity, double tolerance);

// The matches of a case that a statistic uses.
enum class MatchesOf {
  kSample,  // the first true matches, no more than needed; their order is random
  kTruth,   // all true matches
  kPair     // all matches, including wrong ones
};
struct CaseNeeds {
  int num_true_matches = 8;  // minimum
  MatchesOf matches = MatchesOf::kSample;
  bool true_motion = true;  // compares with the true motion, whose direction must be defined
};

// A claim about a statistic of a trial, independent of the source of the trials: the built-in scene (below)
// or a study (study_claims.h).
struct CaseClaim {
  Claim words;  // the claim without checks
  Statistic statistic;
  std::vector<Target> targets;
  TrialLimits limits;
  CaseNeeds needs;
  std::optional<size_t> difficulty_statistic = std::nullopt;  // as in Check
  std::string not_stated = {};                                // likewise
};

// The claim on the built-in scene, one check for each of the settings.
Claim OnBuiltInScene(const CaseClaim& claim, const std::vector<Settings>& settings);

// The claim on the built-in scene, one check per noise level.
Claim AtNoiseLevels(const CaseClaim& claim, const std::vector<double>& sigmas_px, const Settings& settings);

}  // namespace rcme
