// A verdict needs evidence either way: a test that did not reject is no evidence that a claim holds.
#pragma once

#include "stats/intervals.h"

namespace rcme {

enum class Verdict { kHolds, kDoesNotHold, kUndecided };

const char* Name(Verdict verdict);  // "holds", "does not hold", "undecided"

// [nominal - margin, nominal + margin]: what still counts as nominal.
Interval Around(double nominal, double margin);

// kHolds if the whole interval lies within `allowed` (an end may be infinite), kDoesNotHold if it lies wholly
// outside, else kUndecided. With a two-sided interval of confidence 1 - alpha, a value outside the allowed
// ones is called "holds" with probability at most alpha / 2 and one inside "does not hold" likewise; with a
// confidence sequence this is true (at alpha) for a study that looks after every trial and stops at the first
// verdict. An interval with a NaN end is undecided.
Verdict DecideEquivalence(const Interval& interval, const Interval& allowed);

// About how many trials decide a binomial rate with probability `power`, if `rate` is the truth: the nearest
// border of `allowed` that lies within (0, 1) is at a distance g, and the interval's half width plus the
// estimate's own scatter must fit into it,
//   n = max((z_(1 - alpha / 2) + z_power)^2 rate (1 - rate) / g^2, -ln(alpha / 2) / g),
// the second term for rates near 0 or 1; with z_(1 - (1 - power) / 2) for a rate between two borders, which
// must clear both (as in planning two one-sided tests). Infinite on a border. For a verdict by a confidence
// sequence, which pays for looking at every trial, expect two to three times as many.
double TrialsToDecide(double rate, const Interval& allowed, double confidence = 0.95, double power = 0.9);

}  // namespace rcme
