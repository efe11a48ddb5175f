// Measures whether a setting tuned on one family of scenes keeps its promise on another.
#pragma once

#include <string>
#include <vector>

#include "experiments/tuning/tune.h"

namespace rcme {

// Conditions that are tuned together, and the setting chosen for them.
struct Family {
  std::string words;  // "scene = room"
  std::vector<std::uint32_t> conditions;
  Choice choice;
};

struct TransferResult {
  std::vector<std::string> settings;  // descriptions, one per setting
  std::vector<Family> families;
  std::vector<std::vector<SettingCount>> verified;  // [family][setting], on fresh trials
};

// The families: single conditions, or the conditions that share a level of the factor `by`. Throws InputError
// if there is no such factor, if there are fewer than two families, if one has too few trials
// (CheckTrialsSuffice), or for a target on the risk.
std::vector<Family> ListFamilies(const StudyPlan& plan, const std::string& by);

// Tunes on each family alone and measures each choice on all families. All settings are measured in the same
// trials, so that the matrix takes no more estimations than one tuning. Throws as ListFamilies and
// CountOutcomes.
TransferResult MeasureTransfer(const StudyPlan& plan, const SettingPlan& settings, const std::string& by,
                               const TuningSource& source);

}  // namespace rcme
