"""Whether scripts/fit_calibrated finds known weights, and measures what it says it measures."""

import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "studies"))

import fit_calibrated as fit  # noqa: E402


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
        x = np.zeros((3, 21))
        x[:, 0], x[:, 1] = 1.0, [-5.0, -5.0, 0.0]
        x[1, 3] = -5.0 * 0.9  # a doubt that takes the slope below zero
        b = np.zeros(21)
        b[0], b[1], b[3] = 0.5, 0.3, -0.4
        np.testing.assert_allclose(fit.probability(x, b), fit.logistic(np.array([0.5 - 1.5, 0.5 - 0.1, 0.5])))


class Measures(unittest.TestCase):
    def test_area_is_the_chance_of_the_right_order(self):
        p, failed = np.array([0.1, 0.4, 0.35, 0.8]), np.array([0, 0, 1, 1])
        self.assertEqual(fit.area(p, failed), 0.75)
        self.assertEqual(fit.area(np.array([0.5, 0.5, 0.5]), np.array([0, 1, 0])), 0.5)  # ties by half

    def test_calibration_error_is_of_bins(self):
        p, failed = np.array([0.05, 0.05, 0.95, 0.95]), np.array([0, 0, 1, 0])
        self.assertAlmostEqual(fit.calibration_error(p, failed), 0.5 * 0.05 + 0.5 * 0.45)

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
