"""Known answers of tests/stats/area_under_curve_test.cc from small samples, by the definitions, in exact fractions where
there is no root or logarithm.

    python3 tests/known_answers/samples.py
"""

from fractions import Fraction
from math import exp, log, sqrt


def area_under_curve(clusters):
    """Of clusters (negatives, positives): the area, Obuchowski's standard error, and Student's interval on the log odds
    with half a cluster of placements 0 and half a one of placements 1 added (scipy for the quantile alone)."""
    from scipy.stats import t as student
    negatives, positives = [y for c in clusters for y in c[0]], [x for c in clusters for x in c[1]]

    def kernel(x, y):
        return Fraction(2 if x > y else 1 if x == y else 0, 2)
    of_positives = [[sum(kernel(x, y) for y in negatives) / len(negatives) for x in c[1]] for c in clusters]
    of_negatives = [[sum(kernel(x, y) for x in positives) / len(positives) for y in c[0]] for c in clusters]

    def moments(placements, added):
        held = [c for c in placements if c]
        size = Fraction(sum(map(len, held)), len(held))
        weighted = [(1, c_n, c_sum) for c_n, c_sum in ((len(c), sum(c)) for c in held)]
        weighted += [(added, size, size), (added, size, 0)]
        number, count = sum(w for w, _, _ in weighted), sum(w * n for w, n, _ in weighted)
        mean = sum(w * total for w, _, total in weighted) / count
        squares = sum(w * (total - n * mean) ** 2 for w, n, total in weighted)
        return number, count, mean, number / Fraction(number - 1) * squares / count ** 2

    def whole(added):
        p, n = moments(of_positives, added), moments(of_negatives, added)
        product = sum((sum(a) - len(a) * p[2]) * (sum(b) - len(b) * n[2]) for a, b in zip(of_positives, of_negatives))
        covariance = Fraction(len(clusters), len(clusters) - 1) * product / (p[1] * n[1])
        return p, n, p[3] + n[3] + 2 * covariance
    p, n, variance = whole(Fraction(0))
    area, se = p[2], sqrt(variance)
    p, n, variance = whole(Fraction(1, 2))
    k = min(p[0], n[0]) - 1
    centre = float((k * area + Fraction(1, 2)) / (k + 1))
    freedom = float(variance ** 2 / (p[3] ** 2 / (p[0] - 1) + n[3] ** 2 / (n[0] - 1)))
    half = student.ppf(0.975, freedom) * sqrt(variance) / (centre * (1 - centre))
    ends = [1 / (1 + exp(-(log(centre / (1 - centre)) + sign * half))) for sign in (-1, 1)]
    print("area %.12f, se %.12f, [%.12f, %.12f]" % (area, se, *ends))


if __name__ == "__main__":
    area_under_curve([([y], []) for y in (1, 2, 2, 3, 4, 4, 5, 7)] + [([], [x]) for x in (2, 4, 5, 6, 6, 8, 9)])
    area_under_curve([([1, 2, 2], [2, 4]), ([3, 4], []), ([4], [5, 6, 6]), ([5, 7], [8, 9])])
