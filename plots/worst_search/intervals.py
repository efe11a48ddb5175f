"""Exact intervals of rates and shares that hold together."""

import dataclasses

from scipy.stats import beta


def clopper_pearson(successes, trials, level):
    """(lower, upper) at this confidence level."""
    tail = (1 - level) / 2
    lower = 0.0 if successes == 0 else float(beta.ppf(tail, successes, trials - successes + 1))
    upper = 1.0 if successes == trials else float(beta.ppf(1 - tail, successes + 1, trials - successes))
    return lower, upper


@dataclasses.dataclass
class Rate:
    estimate: float
    lower: float
    upper: float


def level_of_each(num_intervals, level=0.95):
    """The confidence level of each interval, so that all of them hold together with `level` (Bonferroni)."""
    return 1 - (1 - level) / num_intervals


def simultaneous_share(count, size, num_intervals):
    """Of `count` among `size` independent draws, as one of several intervals that hold together."""
    return Rate(count / size, *clopper_pearson(count, size, level_of_each(num_intervals)))


def simultaneous_rate(counts, num_intervals):
    """One of several intervals that hold together. `counts`: fresh, independent trials. A difference of two rates on the same
    trials is bounded by the exact intervals of its two parts."""
    each = level_of_each(num_intervals)
    if counts.trials == 0:
        return Rate(float("nan"), -1.0 if counts.is_difference else 0.0, 1.0)
    if not counts.is_difference:
        return Rate(counts.events / counts.trials, *clopper_pearson(counts.events, counts.trials, each))
    half = 1 - (1 - each) / 2
    more, less = (clopper_pearson(n, counts.trials, half) for n in (counts.events, counts.reverse))
    return Rate((counts.events - counts.reverse) / counts.trials, more[0] - less[1], more[1] - less[0])
