"""Known answers of tests/stats/confidence_sequence_test.cc: the mixture by Simpson's rule over the prior instead of beta
functions, the borders by bisection in logarithms of fractions.

    python3 tests/known_answers/confidence_sequence.py
"""

from math import cos, exp, log, pi, sin


def log_likelihood(s, n, p):
    return (s * log(p) if s else 0.0) + ((n - s) * log(1 - p) if n > s else 0.0)


def log_mixture(s, n, jeffreys, steps=200000):
    """log of the mean likelihood: p = sin^2(angle) makes the Jeffreys prior uniform in the angle; the uniform prior adds
    the weight pi/2 sin(2 angle)."""
    peak = log_likelihood(s, n, min(max(s / n, 1e-300), 1 - 1e-16)) if 0 < s < n else 0.0
    total = 0.0
    for i in range(steps + 1):
        angle = 0.5 * pi * i / steps
        p = sin(angle) ** 2
        q = cos(angle) ** 2
        if (s and p == 0.0) or (n > s and q < 1e-30):
            continue
        value = exp((s * log(p) if s else 0.0) + ((n - s) * log(q) if n > s else 0.0) - peak)
        weight = 1.0 if jeffreys else 0.5 * pi * sin(2 * angle)
        total += value * weight * (1 if i in (0, steps) else 4 if i % 2 else 2)
    return log(total / (3 * steps)) + peak


def border(inside, outside, s, n, limit):
    for _ in range(200):
        middle = (inside + outside) / 2
        if log_likelihood(s, n, middle) > limit:
            inside = middle
        else:
            outside = middle
    return outside


if __name__ == "__main__":
    for s, n, confidence, jeffreys in ((0, 20, 0.95, True), (8, 10, 0.95, True), (8, 10, 0.95, False),
                                       (950, 1000, 0.95, True), (3, 200, 0.99, False), (9500, 10000, 0.999, True)):
        mixture = log_mixture(s, n, jeffreys)
        limit = mixture + log(1 - confidence)
        lower = 0.0 if s == 0 else border(s / n, 0.0, s, n, limit)
        upper = 1.0 if s == n else border(s / n, 1.0, s, n, limit)
        print("{%d, %d, %g, %s, %.12g, %.12g, %.12g}," % (s, n, confidence, "0.5" if jeffreys else "1.0", lower, upper,
                                                       mixture - log_likelihood(s, n, 0.9)))
