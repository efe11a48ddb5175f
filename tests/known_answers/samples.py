"""Known answers from small samples, by the definitions, in exact fractions where there is no root or logarithm: of
tests/stats/accuracy_test.cc, covariance_test_test.cc and thresholds_test.cc.

    python3 tests/known_answers/samples.py
"""

from fractions import Fraction
from math import erfc, exp, log, pi, sqrt
from statistics import NormalDist


def accuracy(errors):
    n = len(errors)
    mean = Fraction(sum(errors), n)
    s2 = sum((e - mean) ** 2 for e in errors) / (n - 1)
    mse = Fraction(sum(e * e for e in errors), n)
    mse_error = sqrt(sum((e * e - mse) ** 2 for e in errors) / (n * (n - 1)))
    print("bias %.12f %.12f" % (mean, sqrt(s2 / n)))
    print("empirical se %.12f %.12f" % (sqrt(s2), sqrt(s2 / (2 * (n - 1)))))
    print("mse %.12f %.12f, rmse %.12f %.12f" % (mse, mse_error, sqrt(mse), mse_error / (2 * sqrt(mse))))


def covariance_test(S, S0, n):
    """2 x 2, three degrees of freedom; tail of chi-square_3: erfc(sqrt(x / 2)) + sqrt(2 x / pi) exp(-x / 2)."""
    def determinant(M):
        return M[0][0] * M[1][1] - M[0][1] * M[1][0]
    d = determinant(S0)
    inverse = [[S0[1][1] / d, -S0[0][1] / d], [-S0[1][0] / d, S0[0][0] / d]]
    A = [[sum(inverse[i][k] * S[k][j] for k in range(2)) for j in range(2)] for i in range(2)]
    trace, product = A[0][0] + A[1][1], determinant(A)
    rho = 1 - Fraction(2 * 4 + 3 * 2 - 1, 6 * n * 3)
    x = rho * n * (log(d) - log(determinant(S)) + trace - 2)
    root = sqrt(trace * trace / 4 - product)
    print("covariance: statistic %.12f, p %.12g, eigenvalues %.12f %.12f" % (
        x, erfc(sqrt(x / 2)) + sqrt(2 * x / pi) * exp(-x / 2), trace / 2 - root, trace / 2 + root))


def delong(negatives, positives):
    def kernel(x, y):
        return Fraction(2 if x > y else 1 if x == y else 0, 2)
    m, n = len(positives), len(negatives)
    v10 = [sum(kernel(x, y) for y in negatives) / n for x in positives]
    v01 = [sum(kernel(x, y) for x in positives) / m for y in negatives]
    auc = sum(v10) / m
    variance = (sum((v - auc) ** 2 for v in v10) / (m - 1) / m + sum((v - auc) ** 2 for v in v01) / (n - 1) / n)
    half = NormalDist().inv_cdf(0.975) * sqrt(variance)
    print("auc %.12f, se %.12f, [%.12f, %.12f]" % (auc, sqrt(variance), auc - half, auc + half))


if __name__ == "__main__":
    accuracy([3, -1, 4, 1, -5, 9, 2, -6])
    covariance_test([[Fraction(5), Fraction(1)], [Fraction(1), Fraction(2)]],
                    [[Fraction(4), Fraction(1)], [Fraction(1), Fraction(3)]], 40)
    delong([1, 2, 2, 3, 4, 4, 5, 7], [2, 4, 5, 6, 6, 8, 9])
