"""Known answers of tests/stats/weighted_rate_test.cc: the gamma interval by scipy, for data of Fay & Feuer (1997).

Down's syndrome in Michigan, 1950-1964, by the mother's age; cases and births among mothers with at least five
births, standardised to the births of all mothers.

    /usr/bin/python3 tests/known_answers/weighted_rate.py
"""

from scipy.stats import gamma

cases = [0, 8, 63, 112, 262, 295]
births = [327, 30666, 123419, 149919, 104088, 34392]
all_births = [319933, 931318, 786511, 488235, 237863, 61313]

weights = [a / (b * sum(all_births)) for a, b in zip(all_births, births)]
y = sum(w * x for w, x in zip(weights, cases))
v = sum(w * w * x for w, x in zip(weights, cases))
for name, m in [("greatest weight", max(weights)),
                ("greatest weight with a case", max(w for w, x in zip(weights, cases) if x > 0))]:
    lower = gamma.ppf(0.025, y * y / v, scale=v / y)
    upper = gamma.ppf(0.975, (y + m) ** 2 / (v + m * m), scale=(v + m * m) / (y + m))
    print(f"{name}: per 100,000 births {1e5 * y:.10g} [{1e5 * lower:.10g}, {1e5 * upper:.10g}]")
