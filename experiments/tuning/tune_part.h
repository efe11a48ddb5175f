// `rcme tune` and `rcme transfer` on many machines. A piece is ten trials of one condition
// (core/work/piece_plan.h).
//
// A tuning has two rounds, for its last trials depend on what its first have chosen: the plain calls of the
// tuned estimator and the study's. Everything else is in the first round: every setting in the trials to
// explore, to calibrate and to verify, and the entropies of the curves. A transfer has no second one.
#pragma once

#include <string>
#include <vector>

#include "experiments/core/work/divided_work.h"
#include "experiments/tuning/entropy_roc.h"
#include "experiments/tuning/tune.h"

namespace rcme {

// What is divided. The groups of its first round are the first `num_first`.
struct TuningPieces {
  PiecePlan pieces;
  size_t num_first = 0;
};
// Both throw as Tune does before any trial.
TuningPieces PiecesOfTuning(const StudyPlan& plan);
TuningPieces PiecesOfTransfer(const StudyPlan& plan);

// Does the shard's pieces of the first round into the file at `path`, and those of the second if `merged`,
// the parts of all shards, hold the first and chose a setting; what the file holds already is not done again.
// Returns what the merged parts lack of the first round, of which the second is in want: nothing for a work
// of one round. Throws InputError if the file holds another part, Stopped.
MissingPieces RunTuningPart(const StudyPlan& plan, const SettingPlan& settings, const TuningPieces& work,
                            const MergedParts& merged, const Shard& shard, int num_threads,
                            const std::string& path);

// The outcomes that the parts hold; what is asked of it must not be missing there. Lives no longer than its
// arguments. Throws InputError for a result that is damaged.
TuningSource CountsOf(const StudyPlan& plan, const SettingPlan& settings, const TuningPieces& work,
                      const MergedParts& merged);
EntropiesOfTrials EntropiesIn(const StudyPlan& plan, const TuningPieces& work, const MergedParts& merged);

}  // namespace rcme
