"""Whether scripts/fit_calibrated finds known weights, and measures what it says it measures."""

import os
import pathlib
import sys
import tempfile
import types
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "studies"))

import fit_calibrated as fit  # noqa: E402

PROGRAMS = pathlib.Path(os.environ.get("PROGRAMS", fit.ROOT / "build/release/bin"))


class Fits(unittest.TestCase):
    def test_logistic_weights_are_found(self):
        # Five standard errors of each, of the inverse information at the true weights: missed by chance once in a million runs. The
        # ridge moves the last, which it shrinks most, by a hundredth of it.
        random = np.random.default_rng(1)
        x = np.column_stack([np.ones(40_000), random.normal(size=(40_000, 3)) * [1.0, 5.0, 0.2]])
        weights = np.array([-1.0, 0.7, -0.1, 2.0])
        p = fit.logistic(x @ weights)
        failed = (random.uniform(size=len(x)) < p).astype(float)
        errors = np.sqrt(np.diag(np.linalg.inv((x * (p * (1 - p))[:, None]).T @ x)))
        found = fit.fit_failure(x, failed, np.ones(len(x)))
        self.assertTrue((abs(found - weights) < 5 * errors + 0.02 * abs(weights)).all(), found)

    def test_weights_without_a_constant_are_found(self):
        # A right mode against a wrong one: the terms with the sign of the outcome, so that the right one is always first.
        random = np.random.default_rng(4)
        x = random.normal(size=(40_000, 3)) * [1.0, 5.0, 0.2]
        weights = np.array([0.7, -0.1, 2.0])
        p = fit.logistic(x @ weights)
        x *= np.where(random.uniform(size=len(x)) < p, 1.0, -1.0)[:, None]
        errors = np.sqrt(np.diag(np.linalg.inv((x * (p * (1 - p))[:, None]).T @ x)))
        found = fit.fit_failure(x, np.ones(len(x)), np.ones(len(x)), fit.RIDGE_OF_MODES, has_constant=False)
        self.assertTrue((abs(found - weights) < 5 * errors + 0.02 * abs(weights)).all(), found)

    def test_arrays_of_the_header_are_written_and_read_again(self):
        names = ["sign_" + name for name in ("noise", "width", "depth")]
        products = [fit.Product(False, [fit.Hinge(1, 1, 0.25)]), fit.Product(True, [fit.Hinge(0, -1, -2.0), fit.Hinge(2, 1, 1e-5)])]
        check = fit.Check(np.array([[-5.0, 5.0], [0.0, 1.0], [-1.0, 1.0], [2.0, 3.0]]), products, np.array([0.5, 0.25, 0.125, -2.0, 3.0]))
        train = types.SimpleNamespace(names=names, spread_names=["spread_constant"])
        with tempfile.TemporaryDirectory() as folder:
            header, fit.HEADER = fit.HEADER, pathlib.Path(folder) / "fitted_constants.h"
            try:
                fit.HEADER.write_text(header.read_text())
                modes = fit.read_numbers("kModeTerms")
                fit.write_check([fit.Source("studies/x.yaml", 7, 20, 3)], train, check, np.array([0.75]))
                now, spread = fit.read_header(names)
                self.assertTrue(fit.is_same_check(now, check, names))
                np.testing.assert_array_equal(now.ranges, check.ranges)
                np.testing.assert_array_equal(spread, [0.75])
                np.testing.assert_array_equal(fit.read_numbers("kModeTerms"), modes)
                self.assertEqual(fit.HEADER.read_text().count("//   studies/x.yaml, seed 7, 20 draws, 3 trials of each condition\n"), 2)
            finally:
                fit.HEADER = header

    def test_products_of_hinges_are_found(self):
        # A product of two signs, a hinge, and one that tempers; signs 3 and 4 say nothing. Without products the log loss is .02 greater.
        random = np.random.default_rng(5)
        x, log_odds = random.uniform(-1, 1, (20_000, 5)), random.normal(size=20_000) * 2
        true = [fit.Product(False, [fit.Hinge(0, 1, 0.0)]), fit.Product(False, [fit.Hinge(0, 1, 0.0), fit.Hinge(1, -1, 0.5)]),
                fit.Product(True, [fit.Hinge(2, 1, 0.0)])]
        logit = log_odds + sum(weight * product.values(x, log_odds) for weight, product in zip((1.0, 4.0, -0.8), true))
        failed = (random.uniform(size=len(x)) < fit.logistic(logit)).astype(float)
        trials = types.SimpleNamespace(x=x, log_odds=log_odds, posterior=fit.logistic(log_odds), failed=failed, weight=np.ones(len(x)))
        found = fit.choose_products(x, log_odds, trials.posterior, failed, trials.weight, fit.Form(6, fit.FORM.ridge))
        self.assertEqual({(p.tempers, h.column) for p in found[:3] for h in p.hinges} - {(False, 0), (False, 1), (True, 2)}, set())
        check = fit.Check(np.array([[-9.0, 9.0]] + [[-1.0, 1.0]] * 5), found, None)
        check.weights = fit.fit_of_products(check, trials, found)
        loss = fit.log_loss(check.probability(trials), failed, trials.weight)
        self.assertLess(loss, fit.log_loss(fit.logistic(logit), failed, trials.weight) + 0.003)

    def test_no_condition_is_judged_by_its_own_trials(self):
        # Other outcomes of a condition change what is stated for others, not for itself.
        random = np.random.default_rng(6)
        trials = fit.Trials.__new__(fit.Trials)
        trials.x, trials.log_odds = random.uniform(-1, 1, (600, 3)), random.normal(size=600)
        trials.posterior, trials.failed = fit.logistic(trials.log_odds), (random.uniform(size=600) < 0.4).astype(float)
        trials.weight, trials.is_permuted, trials.cluster = np.ones(600), np.zeros(600, bool), np.arange(600) // 4
        before, own = fit.cross_validate(trials, fit.Form(3, 1e-3)), trials.cluster == 17
        trials.failed = np.where(own, 1 - trials.failed, trials.failed)
        after = fit.cross_validate(trials, fit.Form(3, 1e-3))
        np.testing.assert_array_equal(after[own], before[own])
        self.assertGreater(abs(after - before).max(), 1e-6)

    def test_a_weight_of_two_is_a_trial_twice(self):
        random = np.random.default_rng(2)
        x = np.column_stack([np.ones(300), random.normal(size=(300, 2))])
        failed = (random.uniform(size=300) < 0.3).astype(float)
        weight = random.integers(1, 3, 300)
        once = fit.fit_failure(x, failed, weight.astype(float))
        twice = fit.fit_failure(np.repeat(x, weight, axis=0), np.repeat(failed, weight), np.ones(weight.sum()))
        np.testing.assert_allclose(once, twice, atol=2e-3)  # the ridge is by the terms' spread, which differs a little

    def test_the_factor_makes_the_region_hold_the_truth_as_often_as_it_says(self):
        random = np.random.default_rng(3)
        y = np.column_stack([np.ones(20_000), random.uniform(0, 2, 20_000)])
        nees = random.chisquare(5, 20_000) * np.exp(0.3 + 0.8 * y[:, 1])
        a = fit.fit_spread(y, nees, np.ones(len(y)))
        np.testing.assert_allclose(a, [0.3, 0.8], atol=0.08)
        for low, high in [(0, 0.5), (1.5, 2)]:
            here = (y[:, 1] >= low) & (y[:, 1] < high)
            self.assertAlmostEqual((nees[here] / np.exp(y[here] @ a) <= fit.QUANTILE_95).mean(), 0.95, delta=0.015)

    def test_the_slope_of_the_log_odds_has_a_least_value(self):
        # A doubt that takes the slope below zero in the second trial; the third has no evidence.
        check = fit.Check(np.array([[-9.0, 9.0], [0.0, 1.0]]), [fit.Product(True, [fit.Hinge(0, 1, 0.0)])], np.array([0.5, 0.3, 0.0, -0.4]))
        trials = types.SimpleNamespace(x=np.array([[0.0], [0.9], [0.5]]), log_odds=np.array([-5.0, -5.0, 0.0]), posterior=np.zeros(3))
        np.testing.assert_allclose(check.probability(trials), fit.logistic(np.array([0.5 - 1.5, 0.5 - 0.1, 0.5])))

    def test_signs_beyond_their_range_count_as_its_end(self):
        check = fit.Check(np.array([[-9.0, 9.0], [0.0, 1.0]]), [fit.Product(False, [fit.Hinge(0, 1, 0.5)])], np.array([0.0, 1.0, 0.0, 2.0]))
        trials = types.SimpleNamespace(x=np.array([[1.0], [50.0]]), log_odds=np.array([-1.0, -1.0]), posterior=np.zeros(2))
        self.assertEqual(*check.probability(trials))
        self.assertEqual(check.is_in_domain(trials).tolist(), [True, False])

    def test_the_committed_constants_are_read(self):
        names = ["sign_" + row.strip("{").split(",")[0].strip('"') for row in fit.read_array("kSignRanges")[1:]]
        check, spread = fit.read_header(names)
        self.assertEqual(len(check.weights), 3 + len(check.products))
        self.assertEqual(len(check.products), fit.FORM.products)
        self.assertTrue((check.ranges[:, 0] < check.ranges[:, 1]).all())
        self.assertGreaterEqual(check.weights[2], 0)
        self.assertEqual(len(spread), 3)


class Measures(unittest.TestCase):
    def measure(self, p, failed, covered=None, clusters=None):
        """{quantity: value} before and after of trials of conditions of their own."""
        n = len(p)
        trials = types.SimpleNamespace(cluster=np.arange(n) if clusters is None else np.array(clusters), failed=np.array(failed, float))
        covered = np.ones(n, bool) if covered is None else np.array(covered, bool)
        rows = fit.measure(PROGRAMS, trials, (np.full(n, 0.5), np.array(p)), (np.zeros(n, bool), covered), np.ones(n, bool))
        return {row[0]: [cell if cell == "-" else float(cell.split(" ")[0]) for cell in row[1:]] for row in rows}

    def test_measures_are_of_the_probabilities(self):
        of = self.measure([0.05, 0.05, 0.35, 0.4, 0.8, 0.95], [0, 0, 1, 0, 1, 1], [1, 0, 1, 1, 1, 1])
        self.assertEqual(of["failed"], [0.5, 0.5])
        self.assertEqual(of["stated"], [0.5, 0.433])
        self.assertEqual(of["kept at P <= 0.1"], [0.0, 0.333])
        self.assertEqual(of["failed at P <= 0.1"], ["-", "-"])  # fewer than five conditions
        self.assertEqual(of["AUC"], [0.5, 0.889])  # ties by half
        self.assertEqual(of["ECE"], [0.0, round((0.1 + 0.65 + 0.4 + 0.2 + 0.05) / 6, 3)])
        self.assertEqual(of["Brier"], [0.25, round((2 * 0.05**2 + 0.65**2 + 0.4**2 + 0.2**2 + 0.05**2) / 6, 3)])

    def test_rates_of_the_sure_are_of_them_alone(self):
        of = self.measure([0.009] * 5 + [0.09] * 5 + [0.9] * 10, [0, 0, 0, 0, 1] + [0] * 5 + [1] * 10, [1, 1, 1, 1, 0] + [1] * 5 + [0] * 10)
        self.assertEqual(of["failed at P <= 0.1"], ["-", 0.1])
        self.assertEqual(of["covered at P <= 0.1"], ["-", 0.9])
        self.assertEqual(of["covered at P <= 0.01"], ["-", 0.8])

    def test_a_regime_is_what_was_simulated(self):
        row = {"noise": "gaussian", "outliers": "uniform", "homography_share": "0.5"}
        regime = fit.Trials._regime
        self.assertEqual(regime(row), "deep")
        self.assertEqual(regime({**row, "homography_share": "0.95"}), "flat")
        self.assertEqual(regime({**row, "noise": "correlated"}), "dependent noise")
        self.assertEqual(regime({**row, "outliers": "moving_object"}), "coherent outliers")
        self.assertEqual(regime({**row, "outliers": "mixture", "noise": "duplicated"}), "both")


if __name__ == "__main__":
    unittest.main()
