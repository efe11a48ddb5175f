// Decides a check from the outcomes of its trials.
//
// Trials are looked at in batches whose ends depend on nothing but how many there were before, and are
// counted in their order: the result is a pure function of the check and the run, on any number of threads
// and wherever the outcomes were computed. At each look rates and bounded means are judged through confidence
// sequences, so that looking often does not inflate errors; other means are looked at once, after the last
// trial of the budget, and a check that claims one runs to there.
#pragma once

#include <vector>

#include "experiments/audit/claims/claim_verdict.h"
#include "stats/moments.h"
#include "stats/score_mean.h"

namespace rcme {

struct CheckRun {
  std::uint64_t seed = 1;
  std::uint32_t condition = 0;  // names the check's random streams
  Budget budget = Budget::kQuick;
  double confidence = 0.95;  // of each target's interval, at all sample sizes at once
  int num_threads = 0;       // 0: one per core
};

// The trials of one target, counted.
struct TargetTally {
  explicit TargetTally(const Target& target) : bounded(target.range) {}
  void Add(const Target& target, double value);

  Moments moments;    // of the statistic; of an indicator for rates
  ScoreMean bounded;  // where its sequence is asked for
  std::int64_t num_successes = 0;
};

// Whether a verdict can end the check before its budget does.
bool CanEndEarly(const Check& check);

// After how many trials the check is looked at next when it has had so many.
std::int64_t NextLook(const Check& check, Budget budget, std::int64_t num_trials);

// Outcomes of the trials begin, ..., end - 1.
std::vector<Outcome> RunTrials(const Check& check, const CheckRun& run, std::int64_t begin, std::int64_t end);

// A check in the making. A check that is not possible is done from the beginning, without results; one of
// whose claims nothing is stated (Target::is_if_stated) is done after kMostSilentTrials, and not possible
// either.
class CheckDecision {
 public:
  // `check` must live longer.
  CheckDecision(const Check& check, const CheckRun& run);

  // The outcome of the next trial. Those that come after the end are not looked at.
  void Add(const Outcome& outcome);
  bool IsDone() const { return is_done_; }
  std::int64_t num_trials() const { return num_trials_; }
  // As of the last look.
  CheckResult Result() const;

 private:
  // How hard a trial's problem was, and whether the first target's statistic covered.
  struct RatedTrial {
    double difficulty;
    bool is_covered;
  };
  void Rate(const Outcome& outcome);
  void Look();
  // Whether everything that is claimed is if stated, and nothing was, in so many trials that nothing will be.
  bool IsSilent() const;
  std::vector<DifficultyFifth> Fifths() const;

  const Check& check_;
  const CheckRun run_;
  std::vector<TargetTally> tallies_;  // as check.targets
  std::vector<RatedTrial> rated_;
  std::int64_t num_trials_ = 0, next_look_ = 0;
  CheckResult result_;  // without fifths
  bool is_done_ = false;
};

// Runs trials until the check is decided.
CheckResult DecideCheck(const Check& check, const CheckRun& run);

}  // namespace rcme
