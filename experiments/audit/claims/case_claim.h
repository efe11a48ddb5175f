// A claim about a statistic of a trial, before it is said where the trials come from: from the built-in scene
// (below) or from a study (study_claims.h).
#pragma once

#include <string>
#include <vector>

#include "experiments/audit/claims/case.h"

namespace rcme {

// What a statistic takes from a case.
enum class MatchesOf {
  kSample,  // the first true matches (they are in random order), no more than it needs
  kTruth,   // all true matches
  kPair     // all matches, wrong ones included
};
struct CaseNeeds {
  int num_true_matches = 8;  // at least
  MatchesOf matches = MatchesOf::kSample;
  bool true_motion = true;  // is compared with the true motion, so that its direction must be defined
};

struct CaseClaim {
  Claim words;  // the claim without checks
  Statistic statistic;
  std::vector<Target> targets;
  TrialLimits limits;
  CaseNeeds needs;
  std::optional<size_t> difficulty_statistic = std::nullopt;  // as of Check
  std::string not_stated = {};                                // likewise
};

// The claim on the built-in scene, one check for each of the settings.
Claim OnBuiltInScene(const CaseClaim& claim, const std::vector<Settings>& settings);

// The same at several noise levels.
Claim AtNoiseLevels(const CaseClaim& claim, const std::vector<double>& sigmas_px, const Settings& settings);

}  // namespace rcme
