"""Known answers of tests/stats/score_mean_test.cc: the capital by its definition, score by score, and the bounds by
bisection. The scores are multiples of 0.01 of the range, which the program's grid keeps as they are.

    python3 tests/known_answers/score_mean.py
"""

from math import prod

SHARES = (0.95, 0.85, 0.7, 0.55, 0.4, 0.28, 0.2, 0.14, 0.1, 0.07, 0.05, 0.025, 0.0125, 0.00625)


def capital(scores, m):
    """Mean over the stakes f of prod_i (1 + f (x_i / m - 1))."""
    return sum(prod(1 + f * (x / m - 1) for x in scores) for f in SHARES) / len(SHARES)


def lower_bound(scores, confidence):
    needed, low, high = 2 / (1 - confidence), 0.0, sum(scores) / len(scores)
    if high == 0:
        return 0.0
    for _ in range(100):
        middle = (low + high) / 2
        if capital(scores, middle) >= needed:
            low = middle
        else:
            high = middle
    return low


def interval(scores, confidence, low, high):
    unit = [(x - low) / (high - low) for x in scores]
    return (low + (high - low) * lower_bound(unit, confidence),
            high - (high - low) * lower_bound([1 - x for x in unit], confidence))


def p_value(scores, mean, low, high):
    unit, m = [(x - low) / (high - low) for x in scores], (mean - low) / (high - low)
    return min(1, 2 / max(capital(unit, m), capital([1 - x for x in unit], 1 - m)))


if __name__ == "__main__":
    for scores, confidence, low, high, mean in (
            ([1.0] * 10, 0.95, 0, 1, 0.5), ([0.0] * 3 + [0.9] * 57, 0.95, 0, 1, 0.75),
            ([0.25, 0.5, 0.75] * 40, 0.99, 0, 1, 0.55), ([-1.0] * 2 + [0.0] * 80 + [0.5] * 18, 0.95, -1, 1, 0.0),
            ([-0.1, 0.3] * 50, 0.95, -1, 1, 0.0)):
        print("%.10f, %.10f, %.10g" % (*interval(scores, confidence, low, high), p_value(scores, mean, low, high)))
