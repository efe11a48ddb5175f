// A claim about a statistic of a trial, independent of the source of the trials: the built-in scene (below)
// or a study (study_claims.h).
#pragma once

#include <string>
#include <vector>

#include "experiments/audit/claims/case.h"

namespace rcme {

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
