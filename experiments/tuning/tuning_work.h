// The work of `rcme tune` and `rcme transfer` (core/work/work_plan.h): an item is ten trials of one
// condition, or a whole tuning that is repeated.
//
// A tuning has two rounds, for its last trials depend on what its first have chosen: the plain calls of the
// tuned estimator and the study's. Everything else is in the first round: every setting in the trials to
// explore, to calibrate and to verify, and the entropies of the curves. A transfer has no second one.
#pragma once

#include <string>
#include <vector>

#include "experiments/core/work/runner.h"
#include "experiments/tuning/entropy_roc.h"
#include "experiments/tuning/tune.h"

namespace rcme {

// The groups of the first round are the first `num_first`; those that the choice needs come before all
// others.
struct TuningWork {
  WorkPlan items;
  size_t num_choosing = 0, num_first = 0;
};
// Both throw as Tune does before any trial.
TuningWork PlanTuningWork(const StudyPlan& plan);
TuningWork PlanTransferWork(const StudyPlan& plan);

// Gets the results of a whole tuning, or of a transfer. What is not needed is not computed: without a choice
// nothing beyond it unless all settings are to be verified, and no plain calls. Throws as Runner::Get and
// CountOutcomes.
void GetTuningResults(const StudyPlan& plan, const SettingPlan& settings, const TuningWork& work,
                      Unreached unreached, Runner* runner);

// Gets the runner's shard of the first round, and that of the second if `merged`, the parts of all shards,
// hold the first and chose a setting. Returns what the merged parts lack of the first round, of which the
// second is in want: nothing for a work of one round.
MissingItems GetTuningShard(const StudyPlan& plan, const SettingPlan& settings, const TuningWork& work,
                            const WorkResults& merged, Runner* runner);

// The outcomes that results hold; what is asked of it must not be missing there. Lives no longer than its
// arguments. Throws InputError for a result that is damaged.
TuningSource CountsIn(const StudyPlan& plan, const SettingPlan& settings, const TuningWork& work,
                      const WorkResults& results);
EntropiesOfTrials EntropiesIn(const StudyPlan& plan, const TuningWork& work, const WorkResults& results);

// n tunings again: explores and calibrates with the seeds seed + 1, ..., seed + n; the reference are the
// study's trials for verification. Throws as Tune; InputError for a target on the risk, which nothing can
// violate.
WorkPlan PlanRepetitions(const StudyPlan& plan, int n);
// Throws as Runner::Get and CountOutcomes; InputError for a result that is damaged.
Repetitions RepeatTuning(const StudyPlan& plan, const SettingPlan& settings, Runner* runner);

}  // namespace rcme
