// Decides a check from the outcomes of its trials.
//
// Outcomes are examined after batches of trials, in the order of the trials. The size of a batch depends only
// on the number of trials before it. So the result is a pure function of the check and the run, for any
// number of threads and wherever the outcomes were computed.
//
// At each look, rates and bounded means are judged by confidence sequences, so that looking often does not
// inflate the error rate. Other means are judged once, after the last trial of the budget; a check that
// claims one runs until then.
#pragma once

#include <vector>

#include "experiments/audit/claims/claim_verdict.h"
#include "stats/moments.h"
#include "stats/score_mean.h"

namespace rcme {

struct CheckRun {
  std::uint64_t seed = 1;
  std::uint32_t condition = 0;  // of the check's random streams
  Budget budget = Budget::kQuick;
  double confidence = 0.95;  // of each target's interval, simultaneously at all sample sizes
  int num_threads = 0;       // 0: one per core
};

// The running statistics of one target.
struct TargetTally {
  explicit TargetTally(const Target& target) : bounded(target.range) {}
  void Add(const Target& target, double value);

  Moments moments;    // of the statistic; for rates, of the indicator
  ScoreMean bounded;  // for a target with a confidence sequence of its mean
  std::int64_t num_successes = 0;
};

// Whether a verdict can end the check before the end of its budget.
bool CanEndEarly(const Check& check);

// The number of trials at the next look, after a look at `num_trials`.
std::int64_t NextLook(const Check& check, Budget budget, std::int64_t num_trials);

// The outcomes of trials begin, ..., end - 1.
std::vector<Outcome> RunTrials(const Check& check, const CheckRun& run, std::int64_t begin, std::int64_t end);

// A check in progress. A check that is not possible is done from the start, without results. If nothing is
// stated about any of its claims (Target::is_if_stated), it ends after kMostSilentTrials and is not possible
// either.
class CheckDecision {
 public:
  // `check` must outlive this object.
  CheckDecision(const Check& check, const CheckRun& run);

  // Adds the outcome of the next trial. Outcomes after the end are ignored.
  void Add(const Outcome& outcome);
  bool IsDone() const { return is_done_; }
  std::int64_t num_trials() const { return num_trials_; }
  // The result as of the last look.
  CheckResult Result() const;

 private:
  // The difficulty of a trial's problem, and whether the first target's statistic was covered.
  struct RatedTrial {
    double difficulty;
    bool is_covered;
  };
  void Rate(const Outcome& outcome);
  void Look();
  // Whether all claimed targets are is_if_stated, and enough trials stated none of them.
  bool IsSilent() const;
  std::vector<DifficultyFifth> Fifths() const;

  const Check& check_;
  const CheckRun run_;
  std::vector<TargetTally> tallies_;  // one per target of the check
  std::vector<RatedTrial> rated_;
  std::int64_t num_trials_ = 0, next_look_ = 0;
  CheckResult result_;  // without fifths
  bool is_done_ = false;
};

// Runs trials until the check is decided.
CheckResult DecideCheck(const Check& check, const CheckRun& run);

}  // namespace rcme
