"""Known answers about stated probabilities, by the definitions: of tests/stats/isotonic_regression_test.cc, reliability_test.cc,
calibration_error_test.cc, calibration_line_test.cc, clustered_estimate_test.cc, risk_coverage_area_test.cc and
sparsification_test.cc. Exact fractions where there is no root or logarithm.

    /usr/bin/python3 tests/known_answers/forecasts.py
"""

from fractions import Fraction
from itertools import permutations

import numpy as np
from scipy.optimize import minimize
from scipy.stats import t as student

# (probability in tenths, happened, cluster)
FORECASTS = [(1, 0, 0), (1, 1, 0), (2, 0, 1), (3, 0, 1), (3, 1, 1), (3, 0, 2), (4, 0, 3), (5, 1, 3), (6, 1, 3), (6, 0, 4),
             (7, 0, 5), (8, 1, 5), (9, 1, 6), (9, 1, 6), (10, 1, 7), (0, 0, 8)]


def isotonic(values, weights):
    """The max-min formula: y_k = max over i <= k of min over j >= k of the mean of i..j."""
    def mean(i, j):
        return sum(Fraction(v) * w for v, w in zip(values[i:j + 1], weights[i:j + 1])) / sum(weights[i:j + 1])
    n = len(values)
    return [max(min(mean(i, j) for j in range(k, n)) for i in range(k + 1)) for k in range(n)]


def brier_decomposition(forecasts):
    different = sorted({p for p, _, _ in forecasts})
    outcomes = [[y for q, y, _ in forecasts if q == p] for p in different]
    curve = isotonic([Fraction(sum(o), len(o)) for o in outcomes], [len(o) for o in outcomes])
    n = len(forecasts)

    def score(of):
        return sum((of(p) - y) ** 2 for p, y, _ in forecasts) / n
    share = Fraction(sum(y for _, y, _ in forecasts), n)
    S, S_C = score(lambda p: Fraction(p, 10)), score(lambda p: curve[different.index(p)])
    S_R = score(lambda p: share)
    print("curve", [str(c) for c in curve])
    print("brier %.12f, miscalibration %.12f, discrimination %.12f, uncertainty %.12f" % (S, S - S_C, S_R - S_C, S_R))


def clustered_mean(numbers, clusters):
    n, mean = len(numbers), Fraction(sum(numbers), len(numbers))
    sums = [sum(x - mean for x, c in zip(numbers, clusters) if c == d) for d in sorted(set(clusters))]
    C = len(sums)
    se = float(Fraction(C, C - 1) * sum(s * s for s in sums)) ** 0.5 / n
    half = student.ppf(0.975, C - 1) * se
    print("mean %.12f, se %.12f, [%.12f, %.12f]" % (mean, se, mean - half, mean + half))


def calibration_errors(forecasts, num_bins):
    n = len(forecasts)

    def error(bins):
        return sum(abs(sum(Fraction(p, 10) - y for p, y, _ in b)) for b in bins) / n
    width = [[f for f in forecasts if min(f[0] * num_bins // 10, num_bins - 1) == k] for k in range(num_bins)]
    mass, last = [[] for _ in range(num_bins)], None
    for rank, f in enumerate(sorted(forecasts)):
        k = last[1] if last and last[0] == f[0] else rank * num_bins // n
        mass[k].append(f)
        last = (f[0], k)
    print("calibration error, %d bins: equal width %.12f, equal mass %.12f" % (num_bins, error(width), error(mass)))


def calibration_line(forecasts):
    p = np.clip(np.array([f[0] for f in forecasts]) / 10, 1e-4, 1 - 1e-4)
    X = np.column_stack([np.ones(len(p)), np.log(p / (1 - p))])
    y = np.array([f[1] for f in forecasts], dtype=float)

    def loss(b):
        return np.sum(np.logaddexp(0, X @ b) - y * (X @ b))
    b = minimize(loss, [0.0, 1.0], tol=1e-14).x
    for _ in range(3):  # polished
        mu = 1 / (1 + np.exp(-X @ b))
        b = b + np.linalg.solve(X.T @ (X * (mu * (1 - mu))[:, None]), X.T @ (y - mu))
    mu = 1 / (1 + np.exp(-X @ b))
    scores = X * (y - mu)[:, None]
    clusters = np.array([f[2] for f in forecasts])
    sums = np.array([scores[clusters == c].sum(axis=0) for c in sorted(set(clusters))])
    inverse = np.linalg.inv(X.T @ (X * (mu * (1 - mu))[:, None]))
    C = len(sums)
    covariance = C / (C - 1) * inverse @ sums.T @ sums @ inverse
    print("intercept %.10f +- %.10f, slope %.10f +- %.10f" % (b[0], covariance[0, 0] ** 0.5, b[1],
                                                            covariance[1, 1] ** 0.5))


def area_of_mean_losses(scored):
    """The mean loss of the first k, averaged over k and over all orders of equal scores."""
    areas = []
    for order in set(permutations(range(len(scored)))):
        scores = [scored[i][0] for i in order]
        if any(a < b for a, b in zip(scores, scores[1:])):
            continue
        failed = [scored[i][1] for i in order]
        areas.append(sum(Fraction(sum(failed[:k]), k) for k in range(1, len(scored) + 1)) / len(scored))
    return sum(areas) / len(areas)


def sparsification(pairs):
    """AUSE of (stated, error) and that of a random order."""
    mean = Fraction(sum(error for _, error in pairs), len(pairs))
    stated = area_of_mean_losses([(-s, error) for s, error in pairs])
    oracle = area_of_mean_losses([(-error, error) for _, error in pairs])
    print("AUSE %.12f, of a random order %.12f" % ((stated - oracle) / mean, 1 - oracle / mean))


if __name__ == "__main__":
    print("isotonic", [str(y) for y in isotonic([3, 1, 2, 6, 5, 4, 7, 7, 1], [1, 2, 1, 1, 3, 1, 1, 1, 2])])
    brier_decomposition(FORECASTS)
    clustered_mean([f[0] for f in FORECASTS], [f[2] for f in FORECASTS])
    calibration_errors(FORECASTS, 4)
    calibration_errors(FORECASTS, 10)
    calibration_line(FORECASTS)
    print("area under the risk-coverage curve %.12f" %
          area_of_mean_losses([(9, 0), (8, 0), (8, 1), (5, 0), (5, 1), (5, 1), (2, 0), (1, 1)]))
    sparsification([(2, 3), (1, 1), (4, 2), (4, 9), (3, 1), (1, 4), (7, 6), (5, 5)])
