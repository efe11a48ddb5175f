// Which setting meets the target, from two sets of trials.
//
// The exploration proposes: the settings that no other beats in both what the target limits and what is to be
// least (ties included), in the order of how surely they meet the target. The calibration, on trials that
// played no part in that, certifies them one after the other (stats/risk_control.h) until the first that is
// not; of the certified ones the best is chosen. Hence P(the chosen setting violates the target) <= delta,
// whatever the exploration proposed.
//
// A target on the risk has nothing to certify: the exploration chooses, the calibration bounds its risk.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/study/tuning.h"
#include "experiments/tuning/setting_counts.h"
#include "stats/equivalence.h"

namespace rcme {

struct Choice {
  std::optional<size_t> setting;  // nothing: `why` says why not
  std::vector<size_t> path;       // in the order of testing
  size_t num_certified = 0;       // of the path
  double risk_bound = 0.0;        // target risk: the risk is at most this, except with probability delta
  std::string why;                // the nearest reachable figure, and how many trials would do
};

// What the target limits: false refusals, failures, or failures of what is not refused.
ErrorCount TargetedCount(const Tuning& tuning, const SettingCount& count);

// Whether the target limits refusals, too.
bool HasRefusalLimit(const Tuning& tuning);

// Whether a setting meets the target on the trials of a count: it holds if the whole 95 % interval of every
// rate that it limits lies below the limit, it does not if one lies above.
Verdict DecideSetting(const Tuning& tuning, const SettingCount& count);

// cost_of_failure * failure rate + cost_of_refusal * refusal rate.
double Risk(const Tuning& tuning, const SettingCount& count);

// Both hold one count per setting, of disjoint sets of trials; `settings` names them in messages.
Choice ChooseSetting(const Tuning& tuning, const std::vector<std::string>& settings,
                     const std::vector<SettingCount>& explored, const std::vector<SettingCount>& calibrated);

// Why the calibration of so many conditions has too few trials for the target, whatever they show, and how
// many would do; empty if it has not.
std::string WhyTooFewTrials(const Tuning& tuning, size_t num_conditions);

// "at most 5 % of ..., except with probability 0.05", for people.
std::string DescribeTarget(const Tuning& tuning);

}  // namespace rcme
