// A verdict needs evidence either way: that a test did not reject is none that a claim holds.
#pragma once

#include "stats/intervals.h"

namespace rcme {

enum class Verdict { kHolds, kDoesNotHold, kUndecided };

const char* Name(Verdict verdict);  // "holds", "does not hold", "undecided"

// kHolds if the whole interval lies in [nominal - margin, nominal + margin], kDoesNotHold if it lies wholly
// outside, else kUndecided. With a two-sided interval of confidence 1 - alpha, a value outside the margin is
// called "holds" with probability at most alpha / 2 and one inside "does not hold" likewise; with a
// confidence sequence this is true (at alpha) for a study that looks after every trial and stops at the first
// verdict. An interval with a NaN end is undecided.
Verdict DecideEquivalence(const Interval& interval, double nominal, double margin);

// About how many trials decide a binomial rate with probability `power`, if `rate` is the truth: the nearest
// border of the margin that lies within (0, 1) is at a distance g, and the interval's half width plus the
// estimate's own scatter must fit into it,
//   n = max((z_(1 - alpha / 2) + z_power)^2 rate (1 - rate) / g^2, -ln(alpha / 2) / g),
// the second term for rates near 0 or 1; with z_(1 - (1 - power) / 2) for a rate within the margin that must
// clear two borders (as in planning two one-sided tests). Infinite on a border. For a verdict by a confidence
// sequence, which pays for looking at every trial, expect two to three times as many.
double TrialsToDecide(double rate, double nominal, double margin, double confidence = 0.95,
                      double power = 0.9);

}  // namespace rcme
