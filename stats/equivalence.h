// Equivalence verdicts, which need evidence for either answer: a test that did not reject is no evidence that
// a claim holds.
#pragma once

#include "stats/intervals.h"

namespace rcme {

enum class Verdict { kHolds, kDoesNotHold, kUndecided };

const char* Name(Verdict verdict);  // "holds", "does not hold", "undecided"

// [nominal - margin, nominal + margin]: the values that count as nominal.
Interval Around(double nominal, double margin);

// kHolds if the whole interval lies within `allowed` (an end may be infinite), kDoesNotHold if it lies wholly
// outside, else kUndecided; also kUndecided if an end is NaN. With a two-sided interval of confidence 1 -
// alpha "holds" for a value that is not allowed has probability at most alpha / 2, "does not hold" for an
// allowed one alpha (alpha / 2 if `allowed` is open on one side). With a confidence sequence both have at
// most alpha, also for a study that looks after every trial and stops at the first verdict.
Verdict DecideEquivalence(const Interval& interval, const Interval& allowed);

// The approximate number of trials that decide a binomial rate with probability .9, the power, if `rate` is
// the truth. Let g be the distance to the nearest border of `allowed` within (0, 1). The half width of the
// interval plus the scatter of the estimate must fit into it,
//   n = max((z_(1 - alpha / 2) + z_power)^2 rate (1 - rate) / g^2, -ln(alpha / 2) / g),
// the second term for rates near 0 or 1. A rate between two borders must clear both, so z_power becomes z_(1
// - (1 - power) / 2) (as in planning two one-sided tests). Infinite on a border. A verdict by a confidence
// sequence takes two to three times as many trials.
double TrialsToDecide(double rate, const Interval& allowed, double confidence = 0.95);

}  // namespace rcme
