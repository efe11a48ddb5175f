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

// Tunes on every family alone and measures every choice on all of them; the families are the conditions, or
// those that have a level of the factor `by` in common. All settings are measured in the same trials, so the
// matrix takes no more estimation than one tuning. Throws as Tune; InputError if there is no such factor, if
// there are fewer than two families, or for a target on the risk.
TransferResult MeasureTransfer(const StudyPlan& plan, const SettingPlan& settings, const std::string& by,
                               int num_threads);

}  // namespace rcme
