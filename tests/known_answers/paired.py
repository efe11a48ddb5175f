"""Known answers of tests/stats/paired_test.cc: Tango's interval with the restricted maximum likelihood by ternary search of
the likelihood itself instead of its closed form; McNemar's p-value, and the one that is valid at every look, in exact fractions.

    python3 tests/known_answers/paired.py
"""

from fractions import Fraction
from math import comb, log, sqrt
from statistics import NormalDist


def restricted_probability(b, c, n, d):
    """argmax over q = P(second only) of b log(q + d) + c log q + (n - b - c) log(1 - d - 2 q)."""
    low, high = max(0.0, -d), (1 - d) / 2

    def term(count, p):
        return 0.0 if count == 0 else count * log(p) if p > 0 else -1e300

    def likelihood(q):
        return term(b, q + d) + term(c, q) + term(n - b - c, 1 - d - 2 * q)

    for _ in range(300):
        third = (high - low) / 3
        if likelihood(low + third) < likelihood(high - third):
            low += third
        else:
            high -= third
    return (low + high) / 2


def interval(b, c, n, confidence):
    z = NormalDist().inv_cdf((1 + confidence) / 2)

    def score(d):
        variance = n * (2 * restricted_probability(b, c, n, d) + d * (1 - d))
        return (b - c - n * d) / sqrt(variance)

    ends = []
    for outside, sign in ((-1 + 1e-12, 1), (1 - 1e-12, -1)):
        inside = (b - c) / n
        for _ in range(60):
            middle = (inside + outside) / 2
            if sign * (b - c - n * middle) <= 0 or sign * score(middle) <= z:
                inside = middle
            else:
                outside = middle
        ends.append(outside)
    return ends


def mcnemar(b, c):
    return min(Fraction(1), 2 * sum(Fraction(comb(b + c, k), 2 ** (b + c)) for k in range(min(b, c) + 1)))


def anytime_mcnemar(b, c):
    """The mean over coins of the likelihood, B(b + 1/2, c + 1/2) / pi for Jeffreys' prior, against that of a fair coin."""
    mixture = Fraction(comb(2 * b, b) * comb(2 * c, c), 4 ** (b + c) * comb(b + c, b))
    return min(Fraction(1), Fraction(1, 2 ** (b + c)) / mixture)


if __name__ == "__main__":
    for both, b, c, neither, confidence in ((1, 1, 7, 12, 0.95), (43, 0, 1, 0, 0.95), (0, 25, 28, 565, 0.9),
                                            (0, 1, 5, 4732, 0.95), (100, 0, 0, 100, 0.95), (794, 150, 86, 570, 0.95)):
        n = both + b + c + neither
        print("{{%d, %d, %d, %d}, %g," % (both, b, c, neither, confidence),
              "%.9f, %.9f, %.12g, %.12g}," % (*interval(b, c, n, confidence), float(mcnemar(b, c)),
                                                float(anytime_mcnemar(b, c))))
