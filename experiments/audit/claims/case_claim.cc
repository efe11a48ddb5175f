#include "experiments/audit/claims/case_claim.h"

namespace rcme {

Claim OnBuiltInScene(const CaseClaim& claim, const std::vector<Settings>& settings) {
  Claim on_scene = claim.words;
  for (const Settings& each : settings) {
    on_scene.checks.push_back(MakeCheck(each, claim.statistic, claim.targets, claim.limits));
    on_scene.checks.back().difficulty_statistic = claim.difficulty_statistic;
    on_scene.checks.back().not_stated = claim.not_stated;
  }
  return on_scene;
}

Claim AtNoiseLevels(const CaseClaim& claim, const std::vector<double>& sigmas_px, const Settings& settings) {
  Claim on_scene = claim.words;
  on_scene.checks = ChecksAtNoiseLevels(sigmas_px, settings, claim.statistic, claim.targets, claim.limits);
  return on_scene;
}

}  // namespace rcme
