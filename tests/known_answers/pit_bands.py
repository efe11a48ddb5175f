"""Known answers of tests/stats/pit_bands_test.cc: the Markov chain of counts with binomial increments, in exact fractions.

    python3 tests/known_answers/pit_bands.py
"""

from fractions import Fraction
from math import comb


def coverage(n, lower, upper):
    num_points = len(lower)
    inside = {0: Fraction(1)}
    for i in range(1, num_points + 1):
        p = Fraction(1, num_points - i + 1)  # of a value beyond z_(i-1) to lie in the next cell
        step = {}
        for count, probability in inside.items():
            left = n - count
            for more in range(left + 1):
                to = count + more
                if lower[i - 1] <= to <= upper[i - 1]:
                    mass = comb(left, more) * p ** more * (1 - p) ** (left - more)
                    step[to] = step.get(to, Fraction(0)) + probability * mass
        inside = step
    return sum(inside.values(), Fraction(0))


def pointwise(n, z, tail):
    """The least counts with P(X <= lower) >= tail and P(X > upper) <= tail."""
    below, counts = Fraction(0), []
    for k in range(n + 1):
        below += comb(n, k) * z ** k * (1 - z) ** (n - k)
        counts.append(below)
    lower = next(k for k in range(n + 1) if counts[k] >= tail)
    upper = next(k for k in range(n + 1) if 1 - counts[k] <= tail)
    return lower, upper


def bands(n, num_points, gamma):
    pairs = [pointwise(n, Fraction(i, num_points), Fraction(gamma) / 2) for i in range(1, num_points)] + [(n, n)]
    return [a for a, _ in pairs], [b for _, b in pairs]


def widest_gamma(n, num_points, confidence):
    """The coverage falls in steps as gamma rises: bisection to where it falls below the confidence."""
    small, large = Fraction(0), 1 - Fraction(confidence)
    if coverage(n, *bands(n, num_points, large)) >= Fraction(confidence):
        return large
    for _ in range(26):
        middle = (small + large) / 2
        if coverage(n, *bands(n, num_points, middle)) >= Fraction(confidence):
            small = middle
        else:
            large = middle
    return small


if __name__ == "__main__":
    for n, num_points, confidence in ((10, 5, "0.95"), (20, 10, "0.9"), (50, 8, "0.95"), (5, 2, "0.99")):
        gamma = widest_gamma(n, num_points, confidence)
        lower, upper = bands(n, num_points, gamma)
        print("{%d, %d, %s, %.6f, %.12f, {%s}, {%s}}," % (n, num_points, confidence, gamma, coverage(n, lower, upper),
                                                       ", ".join(map(str, lower)), ", ".join(map(str, upper))))
