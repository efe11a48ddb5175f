"""Known answers of tests/stats/variance_split_test.cc: the one-way analysis of variance of zeros and ones, from its mean squares
in exact fractions (intraclass correlation (MSB - MSW) / (MSB + (R - 1) MSW)), and the interval by scipy's Student
quantiles and beta quantiles, scene by scene.

    /usr/bin/python3 tests/known_answers/variance_split.py
"""

from fractions import Fraction
from math import exp, sqrt

from scipy.stats import beta, t


def mean_squares(counts, R):
    """(between, within) of scenes with so many events in R repeats."""
    data = [[1] * k + [0] * (R - k) for k in counts]
    n, grand = len(data), Fraction(sum(map(sum, data)), len(data) * R)
    means = [Fraction(sum(row), R) for row in data]
    between = R * sum((m - grand) ** 2 for m in means) / (n - 1)
    within = sum((x - m) ** 2 for row, m in zip(data, means) for x in row) / (n * (R - 1))
    return between, within


def interval(counts, R, confidence):
    scenes = [k / R for k in counts] + [0.0, 0.5, 1.0]
    n, tail = len(scenes), (1 - confidence) / 2
    inner = [R / (R - 1) * q * (1 - q) for q in scenes]
    mean, w = sum(scenes) / n, sum(inner) / n
    v = mean * (1 - mean) + sum((q - mean) ** 2 for q in scenes) / (n - 1) / n
    influence = [(x - w) / w - (1 - 2 * mean) * (q - mean) / v for x, q in zip(inner, scenes)]
    reach = t.ppf(1 - tail, n - 1) * sqrt(sum(x * x for x in influence) / (n - 1) / n)
    lower, upper = w / v * exp(-reach), min(1, w / v * exp(reach))
    mixed = sum(0 < k < R for k in counts)
    if mixed < 25:
        lower = min(lower, (beta.ppf(tail, mixed, len(counts) - mixed + 1) if mixed else 0) / R / v)
    return lower, upper


if __name__ == "__main__":
    for counts, R in (([0] * 30 + [5] * 10 + [2, 3, 1, 4] * 8, 5), ([0] * 60 + [1] * 10 + [2] * 30, 2),
                      ([0] * 20 + [10] * 20, 10), ([1, 2, 3, 2] * 12, 4)):
        between, within = mean_squares(counts, R)
        component = (between - within) / R
        print("%.12g, %.12g, %.12g, %.10f, %.10f" % (float(component), float(within),
                                                      float(within / (component + within)), *interval(counts, R, 0.95)))
