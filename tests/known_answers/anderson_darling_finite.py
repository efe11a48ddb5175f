"""Tail probabilities of the Anderson-Darling statistic of n uniforms, by simulation (numpy): the known answers, good to
four standard errors, of tests/stats/goodness_of_fit_test.cc for finite n.

    /usr/bin/python3 tests/known_answers/anderson_darling_finite.py
"""

import numpy

BATCH, BATCHES = 100_000, 60


def tails(n, levels, generator):
    above = numpy.zeros(len(levels))
    weights = 2 * numpy.arange(n) + 1
    for _ in range(BATCHES):
        u = numpy.sort(generator.random((BATCH, n)), axis=1)
        statistic = -n - ((numpy.log(u) + numpy.log1p(-u[:, ::-1])) @ weights) / n
        above += (statistic[:, None] > levels).sum(axis=0)
    return above / (BATCH * BATCHES)


if __name__ == "__main__":
    for n in (5, 8, 20):
        levels = numpy.array([0.3, 0.6, 1.0, 1.6, 2.5, 3.9])
        for z, p in zip(levels, tails(n, levels, numpy.random.default_rng(1))):
            print("{%d, %g, %.6f}," % (n, z, p), "standard error %.1e" % (p * (1 - p) / (BATCH * BATCHES)) ** 0.5)
