// The work of `rcme tune` and `rcme transfer` (core/work/work_plan.h): an item is ten trials of one
// condition, or one of the repetitions of a whole tuning.
//
// A tuning has two rounds, because its last trials depend on the choice from the first ones. The second round
// has the plain calls of the tuned estimator and of the study's. The first has everything else: every setting
// in the trials to explore, to calibrate and to verify, and the entropies of the curves. A transfer has no
// second round.
#pragma once

#include "experiments/core/work/runner.h"
#include "experiments/tuning/entropy_roc.h"
#include "experiments/tuning/tune.h"

namespace rcme {

// The first `num_first` groups are those of the first round. The groups that the choice needs come before all
// others.
struct TuningWork {
  WorkPlan items;
  size_t num_choosing = 0, num_first = 0;
};
// Both throw as Tune throws before any trial.
TuningWork PlanTuningWork(const StudyPlan& plan);
TuningWork PlanTransferWork(const StudyPlan& plan);

// Gets the results of a whole tuning, or of a transfer, and computes only what is needed. Without a choice,
// it computes nothing beyond the choice unless all settings are to be verified, and no plain calls. Throws as
// Runner::Get and CountOutcomes.
void GetTuningResults(const StudyPlan& plan, const SettingPlan& settings, const TuningWork& work,
                      Unreached unreached, Runner* runner);

// Gets the runner's shard of the first round. Also gets that of the second, if `merged`, the parts of all
// shards, hold the first round and chose a setting. Returns the results of the first round that are missing
// in the merged parts and that the second round needs; nothing for a work of one round.
MissingItems GetTuningShard(const StudyPlan& plan, const SettingPlan& settings, const TuningWork& work,
                            const WorkResults& merged, Runner* runner);

// Reads outcomes from results. What is requested must not be missing. The source must not outlive the
// arguments. Throws InputError for a damaged result.
TuningSource CountsIn(const StudyPlan& plan, const SettingPlan& settings, const TuningWork& work,
                      const WorkResults& results);
EntropiesOfTrials EntropiesIn(const StudyPlan& plan, const TuningWork& work, const WorkResults& results);

// Plans n repetitions of the tuning, which explore and calibrate with the seeds seed + 1, ..., seed + n. The
// reference are the study's trials for verification. Throws as Tune, and InputError for a target on the risk,
// which cannot be violated.
WorkPlan PlanRepetitions(const StudyPlan& plan, int n);
// Throws as Runner::Get and CountOutcomes; InputError for a result that is damaged.
Repetitions RepeatTuning(const StudyPlan& plan, const SettingPlan& settings, Runner* runner);

}  // namespace rcme
