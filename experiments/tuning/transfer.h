// Does a setting tuned on one family of scenes keep its promise on another?
#pragma once

#include <string>
#include <vector>

#include "experiments/tuning/tune.h"

namespace rcme {

// Conditions that are tuned on together, and what is chosen for them.
struct Family {
  std::string words;  // "scene = room"
  std::vector<std::uint32_t> conditions;
  Choice choice;
};

struct TransferResult {
  std::vector<std::string> settings;  // in words, one per setting
  std::vector<Family> families;
  std::vector<std::vector<SettingCount>> verified;  // [family][setting], on fresh trials
};

// The conditions, or those that have a level of the factor `by` in common. Throws InputError if there is no
// such factor, if there are fewer than two families, if one has too few trials (CheckTrialsSuffice), or for a
// target on the risk.
std::vector<Family> ListFamilies(const StudyPlan& plan, const std::string& by);

// Tunes on every family alone and measures every choice on all of them. All settings are measured in the same
// trials, so the matrix takes no more estimation than one tuning. Throws as ListFamilies and CountOutcomes.
TransferResult MeasureTransfer(const StudyPlan& plan, const SettingPlan& settings, const std::string& by,
                               const TuningSource& source);

}  // namespace rcme
