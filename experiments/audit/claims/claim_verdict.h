// What the trials say of a claim.
#pragma once

#include "experiments/audit/claims/claim.h"

namespace rcme {

struct TargetResult {
  double measured = 0.0;
  Interval interval;  // anytime-valid; of means without bounds: Student's at the one look
  std::int64_t n = 0;
  std::optional<Verdict> verdict;  // nothing: not claimed, only measured
  double trials_to_decide = 0.0;   // if undecided: about how many trials of the check would decide
};

// How a confidence region is wrong: it covers less often than it says, or more often.
enum class Side { kTooNarrow, kTooWide, kBoth };
const char* Name(Side side);  // "too narrow", "too wide", "too narrow and too wide"

// Of a target of a region that does not hold; nothing: of others.
std::optional<Side> FindFailedSide(const Target& target, const TargetResult& result);
// Of those that have one: theirs, or both.
std::optional<Side> JoinSides(const std::vector<std::optional<Side>>& sides);

// The coverage of a fifth of the trials, from those of the easiest problems to those of the hardest.
struct DifficultyFifth {
  double easiest = 0.0, hardest = 0.0;  // of its trials
  double measured = 0.0;
  Interval interval;
  std::int64_t n = 0;
};

struct CheckResult {
  std::int64_t num_trials = 0;
  std::vector<TargetResult> targets;
  std::optional<Verdict> verdict;       // of all targets together; nothing: none is claimed
  std::vector<DifficultyFifth> fifths;  // of the first target; empty: the check has no difficulty
  std::string not_possible;  // Check::not_possible, or Check::not_stated once nothing is; else empty
};

enum class ClaimVerdict { kHolds, kSmallNoiseOnly, kDoesNotHold, kUndecided, kMeasured, kNotPossible };
const char* Name(ClaimVerdict verdict);

struct ClaimResult {
  ClaimVerdict verdict = ClaimVerdict::kUndecided;
  std::optional<double>
      holds_up_to_sigma_px;         // the highest noise level such that it holds there and at all below
  std::vector<CheckResult> checks;  // as claim.checks
};

// Does not hold if one of them does not, holds if all do, else undecided; nothing claimed: nothing.
std::optional<Verdict> Together(const std::vector<std::optional<Verdict>>& verdicts);

// The claim's verdict from its checks', by noise level (equal sigma_px): "holds" if it holds at every level
// up to kAssertedSigmaPx (higher ones only inform), "small noise only" if it fails by kAssertedSigmaPx but
// holds on the lowest levels, "does not hold" if it fails at the lowest, else undecided. Checks without a
// noise level are judged together: the claim holds if it holds in all of them. "Not possible" if none of them
// is.
void JudgeClaim(const Claim& claim, ClaimResult* result);

}  // namespace rcme
