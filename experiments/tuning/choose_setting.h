// Chooses a setting that meets the target, from two sets of trials.
//
// The exploration proposes settings: those for which no other is better both in what the target limits and in
// what is to be minimised (ties included). They are ordered by how surely they meet the target. The
// calibration, on trials that played no part in this, certifies them one after the other
// (stats/risk_control.h) until one is not certified. The best of the certified ones is chosen. Hence P(the
// chosen setting violates the target) <= delta, whatever the exploration proposed.
//
// A target on the risk certifies nothing: the exploration chooses the setting, and the calibration bounds its
// risk.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/study/tuning.h"
#include "experiments/tuning/setting_counts.h"
#include "stats/equivalence.h"

namespace rcme {

struct Choice {
  std::optional<size_t> setting;  // nullopt: `why` gives the reason
  std::vector<size_t> path;       // the proposed settings, in the order of testing
  size_t num_certified = 0;       // of the path
  // for a target on the risk: the risk is at most this, except with probability delta
  double risk_bound = 0.0;
  std::string why;  // the nearest rate reached, and how many trials would suffice
};

// The count that the target limits: false refusals, failures, or failures among answers that are not refused.
ErrorCount TargetedCount(const Tuning& tuning, const SettingCount& count);

// Whether a setting meets the target on the trials of a count. It holds if the whole 95 % interval of every
// limited rate lies below its limit; it does not hold if one lies above.
Verdict DecideSetting(const Tuning& tuning, const SettingCount& count);

// cost_of_failure * failure rate + cost_of_refusal * refusal rate.
double Risk(const Tuning& tuning, const SettingCount& count);

// `explored` and `calibrated` hold one count per setting, from disjoint sets of trials. `settings` names the
// settings in messages.
Choice ChooseSetting(const Tuning& tuning, const std::vector<std::string>& settings,
                     const std::vector<SettingCount>& explored, const std::vector<SettingCount>& calibrated);

// Why the calibration of this many conditions has too few trials for the target, whatever they show, and how
// many would suffice. Empty if it has enough.
std::string WhyTooFewTrials(const Tuning& tuning, size_t num_conditions);

// "at most 5 % of ..., except with probability 0.05".
std::string DescribeTarget(const Tuning& tuning);

}  // namespace rcme
