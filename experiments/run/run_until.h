// Precision on demand: trials are added to each condition until the interval of a rate is narrow enough.
//
// A condition is looked at after 100, 150, 225, ... trials, whatever they were run by and however often the
// run was cut off, so that the number of its trials is a function of the study alone. Stopping when an
// interval is narrow is a decision that depends on the outcomes: the intervals are confidence sequences,
// which hold at every look.
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
  double value = 0.01;  // half width of the 95 % interval: as a rate, or as a share of the estimate

  // "ci=0.002" or "rel=0.1". Throws InputError.
  static PrecisionTarget Parse(const std::string& text);
};

// What one condition took.
struct CellPrecision {
  std::uint32_t condition = 0;
  std::int64_t num_trials = 0;
  size_t estimator = 0;  // the one whose interval is farthest from the target
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

// In shards: rounds, each of which looks at the merged trials of all shards after those before. One round of
// one shard: adds its share of the trials that every condition needs for its next look, as far as the looks
// at `merged` tell (null: the first one). False: nothing was missing, every condition has reached the target
// or max_trials, and RunUntil on the merged file adds no trial. Whatever is lost or cut off in a round is
// missing from the merged trials and so part of the next one. Throws InputError as RunUntil, and if `merged`
// is of another study.
bool RunRoundUntil(const StudyPlan& plan, const UntilOptions& options, const Shard& shard,
                   ResultStore* merged, ResultStore* store);

// Every estimator of a condition has to reach the target. Notes in the store that the number of trials
// depends on the outcomes. Throws InputError if trials are weighted: their intervals hold for one look only;
// and if scenes are repeated.
std::vector<CellPrecision> RunUntil(const StudyPlan& plan, const UntilOptions& options, ResultStore* store);

}  // namespace rcme
