// Tunes a study with a `tune` block: finds a certified setting and measures it on fresh trials.
#pragma once

#include <functional>
#include <vector>

#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_range.h"
#include "experiments/tuning/choose_setting.h"
#include "experiments/tuning/setting_counts.h"
#include "stats/paired.h"
#include "stats/risk_control.h"

namespace rcme {

// Three disjoint sets of trials of every condition.
struct TuningTrials {
  TrialRange explore, calibrate, verify;
  explicit TuningTrials(const Tuning& tuning);
};

// What an estimator did on trials that played no part in tuning.
struct VerifiedEstimator {
  EstimatorSpec spec;
  ErrorCount failure, refusal, failure_or_refusal;
  // Number of trials in which failure or refusal happened to the first estimator (first) and to this one
  // (second).
  PairedCounts against_first;
};

// Measures every estimator of the plan in these trials of every condition, in the plan's order: by plain
// calls, on the same problems for all.
std::vector<VerifiedEstimator> VerifyEstimators(const StudyPlan& plan, TrialRange trials);

// The source of the outcomes of a tuning's trials (tuning_work.h).
struct TuningSource {
  std::function<SettingCounts(TrialRange)> count;  // of all settings
  // Plain calls of the tuned setting and the study's estimators on the trials for verification.
  std::function<std::vector<VerifiedEstimator>(size_t tuned)> verify;
};

// The plan of the study with the tuned estimator inserted before its own.
StudyPlan PlanWithTuned(const StudyPlan& plan, const SettingPlan& settings, size_t tuned);

struct TuneResult {
  std::vector<std::string> settings;  // "mu = 2, lambda = 0.5", one per setting
  std::vector<SettingCount> explored, calibrated, verified;
  Choice choice;
  // The tuned estimator first, then those of the study, on the trials for verification; empty without a
  // choice.
  std::vector<VerifiedEstimator> estimators;
};

// What to do if no setting is certified: stop and leave `verified` empty, or measure all of them.
enum class Unreached { kStop, kVerifyAll };

// Tunes the study of the plan, which must have a tune block. Throws InputError as CountOutcomes, or for too
// few trials for the target.
TuneResult Tune(const StudyPlan& plan, const SettingPlan& settings, Unreached unreached,
                const TuningSource& source);

// The first steps alone: the choice by exploration and calibration.
Choice ChooseFrom(const StudyPlan& plan, const SettingPlan& settings, const TuningSource& source);

// "mu = 2, lambda = 0.5", one per setting.
std::vector<std::string> DescribeEachSetting(const Tuning& tuning, const SettingPlan& settings);

// Throws InputError if the calibration of this many conditions cannot certify the target, whatever it shows.
// The message says how many trials could.
void CheckTrialsSuffice(const Tuning& tuning, size_t num_conditions);

// A tuning repeated with fresh seeds, to count how often its choice violates the target.
struct Repetitions {
  std::int64_t num_done = 0, num_without_choice = 0;
  std::int64_t num_violated = 0, num_undecided = 0;  // of the choices, judged by `reference`
  std::vector<std::int64_t> num_chosen;              // per setting
  std::vector<SettingCount> reference;               // per setting: many trials that no repetition used
};

}  // namespace rcme
