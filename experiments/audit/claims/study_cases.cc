#include "experiments/audit/claims/study_cases.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/data/make_data.h"
#include "parameters/input_error.h"
#include "parameters/settings.h"

namespace rcme {
namespace {

// Most conditions for an audit or a map; each costs seconds to minutes.
constexpr size_t kMaxCaseConditions = 1'000;
constexpr const char* kNoMatchFiles =
    "scene: match_files cannot be audited or mapped; of real pairs nobody knows which matches are true, nor "
    "the noise, nor can they be drawn again. `rcme run` and `rcme summarize` say what they can give: "
    "failures "
    "and nees_coverage of the estimators against the pairs' reference motions";

}  // namespace

void RequireCases(const Study& study) {
  RequireFixedOptions(study, "an audit or a map");
  const std::vector<std::vector<std::string>> rows = DesignRows(study);
  if (rows.size() > kMaxCaseConditions) {
    throw InputError(
        fmt::format("{} conditions are not allowed; at most {} are: choose levels with --set FACTOR=LEVEL",
                    rows.size(), kMaxCaseConditions));
  }
  for (const std::vector<std::string>& levels : rows) {
    if (FindSetting(CombineSettings(study, levels), "scene") == kMatchFilesScene)
      throw InputError(kNoMatchFiles);
  }
}

Settings SimulatedSettings(const StudyPlan& plan, const Condition& condition) {
  return ResolveSettings(CombineSettings(plan.study, condition.levels));
}

CaseMaker StudyCases(const StudyPlan& plan, const Condition& condition) {
  Settings settings = SimulatedSettings(plan, condition);
  settings.emplace_back("severity", "skipped");
  return CasesFrom(MakeSimulatedData(settings, BaselineTiming::kWithFirstScene));
}

std::string WhatIsMissing(const Case& made, const CaseNeeds& needs) {
  if (needs.true_motion && !made.data.truth.is_direction_known) {
    return "the true motion has no direction of translation";
  }
  if (std::ranges::count(made.data.truth.is_inlier_true, true) < needs.num_true_matches) {
    return fmt::format("fewer than {} true matches", needs.num_true_matches);
  }
  if (needs.matches == MatchesOf::kPair && made.data.weight != 1.0) {
    return "trials with weights (tilted_to) have no plain rates";
  }
  return {};
}

void KeepTrueMatches(TrialData* data, size_t num_matches) {
  const std::vector<bool> is_true = data->truth.is_inlier_true;
  const auto keep = [&](auto* values) {
    size_t num_kept = 0;
    for (size_t k = 0; k < values->size(); ++k) {
      if (is_true[k] && num_kept < num_matches) (*values)[num_kept++] = (*values)[k];
    }
    values->resize(num_kept);
  };
  keep(&data->problem.matches);
  keep(&data->problem.noise_scale);
  keep(&data->problem.match_quality);
  keep(&data->truth.is_inlier_true);
  keep(&data->truth.is_undetectable);
  keep(&data->scene_point);
}

void KeepWhatIsNeeded(TrialData* data, const CaseNeeds& needs) {
  if (needs.matches == MatchesOf::kSample) KeepTrueMatches(data, static_cast<size_t>(needs.num_true_matches));
  if (needs.matches == MatchesOf::kTruth) KeepTrueMatches(data);
}

}  // namespace rcme
