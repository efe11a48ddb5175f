"""Known answers of tests/stats/goodness_of_fit_test.cc: the limit law of A^2 by inverting its characteristic function
(Imhof's integral), instead of Anderson and Darling's series. A^2 is the sum of chi-square_1 variables with weights
1 / (j (j + 1)), whose characteristic function is, with s = sqrt(1 + 8 i t),
    prod_j (1 - 2 i t / (j (j + 1)))^(-1/2) = sqrt(-2 pi i t / cos(pi s / 2)).

    python3 tests/known_answers/anderson_darling.py
"""

import cmath
from math import pi


def log_product(t):
    """log prod_j (1 - 2 i t / (j (j + 1))), on the continuous branch: near factors one by one, the far ones, whose
    logarithms' sum is a series in t, from the closed form by fixing its multiple of 2 pi i."""
    near = sum(cmath.log(1 - 2j * t / (j * (j + 1))) for j in range(1, 400))
    far = -2j * t / 400 - 0.5 * (2j * t) ** 2 / (3.0 * 400 ** 3)
    s = cmath.sqrt(1 + 8j * t)
    closed = cmath.log(cmath.cos(0.5 * pi * s) / (-2j * pi * t))
    turns = round((near + far - closed).imag / (2 * pi))
    return closed + 2j * pi * turns


def tail(z, step=0.02, last=300.0):
    """P(A^2 > z) = 1/2 + 1/pi int_0^inf Im(exp(-i t z) phi(t)) / t dt, by Simpson's rule; at t = 0 the integrand is
    E(A^2) - z = 1 - z."""
    n = int(last / step)
    total = 1 - z
    for k in range(1, n + 1):
        t = k * step
        value = (cmath.exp(-1j * t * z - 0.5 * log_product(t))).imag / t
        total += value * (1 if k == n else 4 if k % 2 else 2)
    return 0.5 + total * step / (3 * pi)


if __name__ == "__main__":
    for z in (0.2, 0.5, 1.0, 2.0, 2.492367, 3.857, 6.0, 10.0):
        print("{%g, %.10f}," % (z, tail(z)))
