"""Known answers of tests/stats/population_rate_test.cc and population_mean_test.cc: the intervals of
stats/population_rate.h and population_mean.h, written down once more with scipy.

    /usr/bin/python3 tests/known_answers/population_rate.py
"""

import numpy as np
from scipy import optimize, stats

TAIL = 0.025


def upper_end(a, q, n):
    m, M = len(q), 1 / np.sum(a**2)
    p, s_0 = np.sum(a * q), M * np.sum(a**2 / n)
    if p == 0:
        return 1 - TAIL ** (1 / M)
    V = m / (m - 1) * np.sum(a**2 * (q - p) ** 2)
    B = p * (1 - p) * s_0 / M
    t_over_z = stats.t.ppf(1 - TAIL, max(M - 1, 1)) / stats.norm.ppf(1 - TAIL)
    S = M**2 * max(V * t_over_z**2, 0.6 * B)
    c = p**2 / np.sum(a**2 * q**2)
    G = stats.chi2.cdf((m - 1) * V / B, m - 1) if B > 0 else 0
    h = max(G**4, 1 / (1 + (np.sum(n * q) / 10) ** 2))
    r = np.clip(np.max(a * M * (q - p)), s_0, 1)
    w = (1 + 3 / (c + 3)) / 2 * r ** (c / (c + 8 * h))
    T = M * p + w
    p_more = T / (M + w)
    if p_more >= 1:
        return 1.0
    s = np.clip((S + w**2) / (T * (1 - p_more)), s_0 / 2, 1)
    N = (M + w) / s
    return max(p, stats.beta.ppf(1 - TAIL, p_more * N, (1 - p_more) * N))


def rate(k, n, equal):
    k, n = np.array(k, float), np.array(n, float)
    q = k / n
    a = np.full(len(k), 1 / len(k)) if equal else n / n.sum()
    p, m = np.sum(a * q), len(k)
    V = m / (m - 1) * np.sum(a**2 * (q - p) ** 2)
    trials = 1 / np.sum(a**2 / n)
    these = stats.beta.ppf(TAIL, p * trials, trials * (1 - p) + 1), stats.beta.ppf(1 - TAIL, p * trials + 1, trials * (1 - p))
    between = np.sum(n * (q - k.sum() / n.sum()) ** 2) / (m - 1)
    within = np.sum(n * q * (1 - q)) / (n.sum() - m)
    size = (n.sum() - np.sum(n**2) / n.sum()) / (m - 1)
    icc = (between - within) / (between + (size - 1) * within)
    return p, 1 - upper_end(a, 1 - q, n), upper_end(a, q, n), *these, icc, p * (1 - p) / V


def difference(first, second, n):
    one, two = rate(first, n, True), rate(second, n, True)
    r = np.corrcoef(np.array(first) / n, np.array(second) / n)[0, 1]
    d = one[0] - two[0]
    reach = lambda u, v: np.sqrt(u**2 + v**2 - 2 * r * u * v)
    return d, d - reach(one[0] - one[1], two[2] - two[0]), d + reach(one[2] - one[0], two[0] - two[1])


def mean(samples, equal):
    n = np.array([len(x) for x in samples], float)
    x = np.array([np.mean(s) for s in samples])
    s2 = np.array([np.var(s, ddof=1) for s in samples])
    a = np.full(len(n), 1 / len(n)) if equal else n / n.sum()
    value, m = np.sum(a * x), len(n)
    V = m / (m - 1) * np.sum(a**2 * (x - value) ** 2)
    t = stats.t.ppf(1 - TAIL, 1 / np.sum(a**2) - 1)
    d = a * (x - value)
    k = np.sum(d**3) / np.sum(d**2) ** 1.5
    upper, lower = (value - np.sqrt(V) * optimize.brentq(lambda T: T + k * T**2 / 3 + k**2 * T**3 / 27 + k / 6 - end, -99, 99)
                    for end in (-t, t))  # Hall's (1992) cubic
    parts = a**2 * s2 / n
    half_here = stats.t.ppf(1 - TAIL, parts.sum() ** 2 / np.sum(parts**2 / (n - 1))) * np.sqrt(parts.sum())
    n_eff = np.sum(a * ((x - value) ** 2 + s2)) / V
    return value, np.sqrt(V), lower, upper, value - half_here, value + half_here, n_eff


if __name__ == "__main__":
    unequal = [0, 0, 1, 5, 0, 6], [60, 20, 30, 40, 50, 60]
    print("one decides         ", *(f"{x:.10f}" for x in rate([0, 0, 1, 5, 0, 60], [60] * 6, True)))
    print("unequal, conditions ", *(f"{x:.10f}" for x in rate(*unequal, True)))
    print("unequal, trials     ", *(f"{x:.10f}" for x in rate(*unequal, False)))
    print("alike               ", *(f"{x:.10f}" for x in rate([29, 31, 33, 27, 30, 30], [60] * 6, True)))
    print("mostly events       ", *(f"{x:.10f}" for x in rate([60, 60, 60, 60, 59, 60, 12, 60], [60] * 8, True)))
    print("no event, six       ", f"{1 - TAIL ** (1 / 6):.10f}")
    print("difference          ", *(f"{x:.10f}" for x in difference([3, 0, 10, 2, 0, 1, 4], [0, 1, 2, 0, 0, 3, 5], 40)))
    samples = [1.0, 2.0, 4.0], [0.5, 0.25], [3.0, 3.5, 5.0, 4.5], [2.0, 2.5]
    print("mean, conditions    ", *(f"{x:.10f}" for x in mean(samples, True)))
    print("mean, trials        ", *(f"{x:.10f}" for x in mean(samples, False)))
