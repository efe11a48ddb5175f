// Verdicts on claims from their trials.
#pragma once

#include "experiments/audit/claims/claim.h"

namespace rcme {

struct TargetResult {
  double measured = 0.0;
  Interval interval;  // anytime-valid; for means without bounds, Student's at the single look
  std::int64_t n = 0;
  std::optional<Verdict> verdict;  // nullopt: not claimed, only measured
  double trials_to_decide = 0.0;   // if undecided: about how many trials of the check would decide it
};

// In which way a confidence region fails: it covers less often than stated (too narrow), or more often.
enum class Side { kTooNarrow, kTooWide, kBoth };
const char* Name(Side side);  // "too narrow", "too wide", "too narrow and too wide"

// The side of a region's target that does not hold; nullopt for other targets.
std::optional<Side> FindFailedSide(const Target& target, const TargetResult& result);
// The common side of those that have one, or kBoth.
std::optional<Side> JoinSides(const std::vector<std::optional<Side>>& sides);

// The coverage of a fifth of the trials. The fifths go from the easiest problems to the hardest.
struct DifficultyFifth {
  double easiest = 0.0, hardest = 0.0;  // of its trials
  double measured = 0.0;
  Interval interval;
  std::int64_t n = 0;
};

struct CheckResult {
  std::int64_t num_trials = 0;
  std::vector<TargetResult> targets;
  std::optional<Verdict> verdict;       // of all targets together; nullopt: none is claimed
  std::vector<DifficultyFifth> fifths;  // of the first target; empty: the check has no difficulty
  std::string not_possible;  // Check::not_possible, or Check::not_stated if nothing was stated; else empty
};

enum class ClaimVerdict { kHolds, kSmallNoiseOnly, kDoesNotHold, kUndecided, kMeasured, kNotPossible };
const char* Name(ClaimVerdict verdict);

struct ClaimResult {
  ClaimVerdict verdict = ClaimVerdict::kUndecided;
  // The highest noise level such that the claim holds there and at all lower ones.
  std::optional<double> holds_up_to_sigma_px;
  std::vector<CheckResult> checks;  // one per check of the claim
};

// "Does not hold" if any of them does not, "holds" if all do, else undecided; nullopt if nothing is claimed.
std::optional<Verdict> Together(const std::vector<std::optional<Verdict>>& verdicts);

// Computes the verdict of a claim from its checks, by noise level (equal sigma_px):
// - "holds" if it holds at every level up to kAssertedSigmaPx; higher levels are for information;
// - "small noise only" if it holds at the lowest level but fails at one up to kAssertedSigmaPx;
// - "does not hold" if it fails at the lowest level;
// - "not possible" if no check is possible;
// - else undecided.
//
// Checks without a noise level are judged together: the claim holds if it holds in all of them.
void JudgeClaim(const Claim& claim, ClaimResult* result);

}  // namespace rcme
