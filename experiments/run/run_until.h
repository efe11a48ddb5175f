// Adds trials to each condition until the interval of a rate is narrow enough.
//
//
// A condition is evaluated after 100, 150, 225, ... trials, however often the run was interrupted, so the
// number of its trials depends only on the study. Stopping when an interval is narrow depends on the
// outcomes. The intervals are therefore confidence sequences, which hold at every look.
#pragma once

#include <string>
#include <vector>

#include "experiments/run/run_study.h"
#include "experiments/trial/trial_event.h"
#include "stats/intervals.h"

namespace rcme {

struct PrecisionTarget {
  enum class Kind { kHalfWidth, kRelative };
  Kind kind = Kind::kHalfWidth;
  double value = 0.01;  // half width of the 95 % interval: as a rate, or relative to the estimate

  // "ci=0.002" or "rel=0.1". Throws InputError.
  static PrecisionTarget Parse(const std::string& text);
};

// The precision that one condition reached.
struct CellPrecision {
  std::uint32_t condition = 0;
  std::int64_t num_trials = 0;
  size_t estimator = 0;  // the estimator whose interval is farthest from the target
  double rate = 0.0;
  Interval interval;
  bool is_reached = false;
};

struct UntilOptions {
  PrecisionTarget target;
  TrialEvent event = TrialEvents().front();  // failure
  std::int64_t max_trials = 1'000'000;       // per condition
  int num_threads = 0;
};

// Throws InputError if scenes are repeated or the trials are passes over the same real pairs, which the
// intervals do not allow.
void CheckTrialsAreNew(const StudyPlan& plan);

// Runs one round of one shard. A round looks at the merged trials that all shards computed in earlier
// rounds, and adds this shard's part of the trials that every condition needs for its next look. `merged` is
// null in the first round. Returns false if nothing was missing: every condition has reached the target or
// max_trials, and RunUntil on the merged file adds no trial. Trials that were lost in a round are missing
// from the merged trials, so the next round computes them. Throws InputError as RunUntil does, and if
// `merged` is of another study.
bool RunRoundUntil(const StudyPlan& plan, const UntilOptions& options, const Shard& shard,
                   ResultStore* merged, ResultStore* store);

// Runs until every estimator of every condition reaches the target or max_trials. Notes in the store that
// the number of trials depends on the outcomes. Throws InputError if trials are weighted, because their
// intervals hold for one look only, and as CheckTrialsAreNew does.
std::vector<CellPrecision> RunUntil(const StudyPlan& plan, const UntilOptions& options, ResultStore* store);

}  // namespace rcme
