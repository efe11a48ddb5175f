"""Known answers of tests/stats/intervals_test.cc: the definition, solved by bisection in exact fractions.

    python3 tests/known_answers/clopper_pearson.py
"""

from fractions import Fraction
from math import comb


def at_least(k, n, p, bits=4096):
    """P(X >= k), X ~ Binomial(n, p), to `bits` bits: the shorter of the two sums."""
    one = 1 << bits
    p_fixed = int(p * one)
    q_fixed = one - p_fixed

    def power(base, exponent):
        result = one
        while exponent:
            if exponent & 1:
                result = result * base >> bits
            base = base * base >> bits
            exponent >>= 1
        return result

    def total(terms):
        return sum(comb(n, i) * power(p_fixed, i) * power(q_fixed, n - i) >> bits for i in terms)

    if n - k < k:
        return Fraction(total(range(k, n + 1)), one)
    return 1 - Fraction(total(range(0, k)), one)


def root(increasing, target):
    low, high = Fraction(0), Fraction(1)
    for _ in range(60):
        middle = (low + high) / 2
        if increasing(middle) < target:
            low = middle
        else:
            high = middle
    return float(low)


def interval(k, n, confidence):
    tail = (1 - Fraction(confidence)) / 2
    lower = 0.0 if k == 0 else root(lambda p: at_least(k, n, p), tail)
    upper = 1.0 if k == n else root(lambda p: at_least(k + 1, n, p), 1 - tail)
    return lower, upper


if __name__ == "__main__":
    for case in ((1, 4738, "0.95"), (68, 4738, "0.95"), (0, 10078, "0.95"), (8, 10, "0.95"), (3, 200, "0.99"),
                 (900, 1000, "0.9999")):
        print("{%d, %d, %s," % case, "%.12g, %.12g}" % interval(*case))
