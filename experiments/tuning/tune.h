// From a study with a `tune` block to a setting that is certified, and measured on fresh trials.
#pragma once

#include <functional>

#include "experiments/trial/trial_range.h"
#include "experiments/tuning/choose_setting.h"
#include "experiments/tuning/setting_counts.h"
#include "experiments/tuning/verify_setting.h"

namespace rcme {

// Three sets of trials of every condition that have none in common.
struct TuningTrials {
  TrialRange explore, calibrate, verify;
  explicit TuningTrials(const Tuning& tuning);
};

// Where a tuning takes the outcomes of its trials from (tuning_work.h).
struct TuningSource {
  std::function<SettingCounts(TrialRange)> count;  // all settings
  // Plain calls, on the trials for verification, of the tuned setting and the study's estimators.
  std::function<std::vector<VerifiedEstimator>(size_t tuned)> verify;
};

// The plan of the study with the tuned estimator before its own.
StudyPlan PlanWithTuned(const StudyPlan& plan, const SettingPlan& settings, size_t tuned);

struct TuneResult {
  std::vector<std::string> settings;  // "mu = 2, lambda = 0.5", one per setting
  std::vector<SettingCount> explored, calibrated, verified;
  Choice choice;
  // The tuned estimator first, then those of the study, on the trials for verification; empty without a
  // choice.
  std::vector<VerifiedEstimator> estimators;
};

// What to do where no setting is certified: stop, `verified` empty, or measure all of them nevertheless.
enum class Unreached { kStop, kVerifyAll };

// The plan is that of the study, whose tune block there is. Throws InputError: CountOutcomes', or too few
// trials for the target.
TuneResult Tune(const StudyPlan& plan, const SettingPlan& settings, Unreached unreached,
                const TuningSource& source);

// The first steps alone: what exploration and calibration choose.
Choice ChooseFrom(const StudyPlan& plan, const SettingPlan& settings, const TuningSource& source);

// For people: "mu = 2, lambda = 0.5", one per setting.
std::vector<std::string> DescribeEachSetting(const Tuning& tuning, const SettingPlan& settings);

// Throws InputError if the calibration of so many conditions cannot certify the target, whatever it shows;
// the message says how many trials could.
void CheckTrialsSuffice(const Tuning& tuning, size_t num_conditions);

// A tuning repeated with fresh seeds: how often does what it chose violate the target?
struct Repetitions {
  std::int64_t num_done = 0, num_without_choice = 0;
  std::int64_t num_violated = 0, num_undecided = 0;  // by `reference`, of what was chosen
  std::vector<std::int64_t> num_chosen;              // per setting
  std::vector<SettingCount> reference;               // per setting: many trials that no repetition saw
};

}  // namespace rcme
