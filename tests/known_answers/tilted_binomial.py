"""Known answers of tests/stats/tilted_binomial_test.cc: the definition, integrated with 40 digits (mpmath).

    /usr/bin/python3 tests/known_answers/tilted_binomial.py
"""

import mpmath as mp

mp.mp.dps = 40


def weight(k, n, p, q):
    """|q - p| Binom(k; n, p) / int_[p, q] Binom(k; n, u) du, all relative to the likelihood's peak in [p, q]."""
    p, q = mp.mpf(p), mp.mpf(q)
    low, high = min(p, q), max(p, q)
    peak = min(max(mp.mpf(k) / n, low), high)

    def log_likelihood(u):
        terms = mp.mpf(0)
        if k > 0:
            terms += k * mp.log(u)
        if k < n:
            terms += (n - k) * mp.log(1 - u)
        return terms

    top = log_likelihood(peak)
    # Pieces of a standard deviation around the peak, or of an e-fold where it is steeper.
    sd = mp.sqrt(max(peak * (1 - peak), mp.mpf(1) / n) / n)
    slope = abs((k / peak if peak > 0 else 0) - ((n - k) / (1 - peak) if peak < 1 else 0))
    piece = min(sd, 1 / slope) if slope > 0 else sd
    cuts = sorted({low, high} | {peak + i * piece for i in range(-120, 121) if low < peak + i * piece < high})
    integral = mp.quad(lambda u: mp.exp(log_likelihood(u) - top), cuts)
    if (p == 0 and k > 0) or (p == 1 and k < n):
        return mp.mpf(0)
    return (high - low) * mp.exp(log_likelihood(p) - top) / integral


for k, n, p, q in [(0, 1, "0.2", "0.5"), (1, 1, "0.2", "0.5"), (0, 20, "0", "0.3"), (20, 20, "1", "0.4"),
                   (7, 20, "0.3", "0.6"), (0, 100, "0.2", "0.6"), (40, 100, "0.2", "0.6"), (100, 100, "0.2", "0.6"),
                   (300, 500, "0.5", "0.4"), (205000, 1000000, "0.2", "0.21"), (199000, 1000000, "0.2", "0.6"),
                   (200500, 1000000, "0.2", "0.2001"), (0, 1000000, "0.2", "0.6")]:
    print(f"{{{k}, {n}, {p}, {q}, {mp.nstr(weight(k, n, p, q), 15, min_fixed=1, max_fixed=0)}}},")
