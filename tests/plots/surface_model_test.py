#!/usr/bin/python3
"""Tests of the model in plots/surface against surfaces that are known; run as: /usr/bin/python3 tests/plots/surface_model_test.py"""

import types
import unittest

import plot_test_case  # noqa: F401  (makes plots/ importable)

import numpy as np
import pandas as pd
from scipy import optimize, stats

from known_surface import conditions, crossed_conditions, events, texts
from surface.anova_kernel import AnovaKernel, log_likelihood, log_prior
from surface.condition_encoder import ConditionEncoder
from surface.condition_model import ConditionModel, Exchange
from surface.effects import measure_indices, tested

TRIALS = 20


def fitted(number=120, seed=1, **more):
    levels, logit = conditions(number, seed, **more)
    return ConditionModel().fit(levels, events(logit, TRIALS, 0.4, seed), np.full(number, TRIALS))


def fitted_to_crossed(num_draws, seed):
    levels, logit, draws = crossed_conditions(num_draws, 4, seed)
    return ConditionModel().fit(levels, events(logit, TRIALS, 0.3, seed), np.full(len(levels), TRIALS), draws=draws)


def sample_of(levels):
    return types.SimpleNamespace(levels=levels, is_sample=np.ones(len(levels), bool))


class EncoderTest(unittest.TestCase):
    def setUp(self):
        self.levels, _ = conditions(400, 1)
        self.encoder = ConditionEncoder().fit(self.levels.assign(always="1"))

    def test_a_key_that_one_word_brings_belongs_to_its_choice(self):
        self.assertEqual(self.encoder.groups, ["sigma_px", "outlier_ratio", "noise", "idle_0", "idle_1"])
        self.assertEqual(self.encoder.members("noise"), ["noise", "student_dof"])

    def test_a_key_that_two_choices_decide_about_belongs_to_the_one_that_says_most(self):
        random = np.random.default_rng(1)
        scene, motion = random.choice(["room", "far_points", "plane"], 200), random.choice(["orbit", "rotation", "forward"], 200)
        baseline = np.where((scene == "far_points") & (motion != "rotation"), texts(random.uniform(0, 1, 200)), "-")
        encoder = ConditionEncoder().fit(pd.DataFrame({"scene": scene, "motion": motion, "baseline_m": baseline}))
        self.assertEqual(encoder.members("scene"), ["scene", "baseline_m"])

    def test_scales_are_found_from_the_levels(self):
        is_log = {column.name: column.is_log for column in self.encoder.columns}
        self.assertTrue(is_log["sigma_px"])
        self.assertFalse(is_log["outlier_ratio"] or is_log["idle_0"])

    def test_features_are_orthogonal_and_of_one_size_under_the_population(self):
        columns = self.encoder.columns_of("sigma_px")
        even = self.levels.iloc[:1].loc[[0] * 2000].assign(
            sigma_px=texts(np.exp(np.log(0.1) + (np.arange(2000) + 0.5) / 2000 * np.log(30))))
        encoder = ConditionEncoder().fit(self.levels, {"sigma_px": ("log", 0.1, 3)})
        features = encoder.encode(even)[:, columns]
        np.testing.assert_allclose(features.mean(axis=0), 0, atol=1e-3)
        np.testing.assert_allclose(features.T @ features / 2000, np.eye(len(columns)), atol=1e-3)

    def test_a_number_with_few_levels_has_features_orthogonal_under_its_shares(self):
        levels = pd.DataFrame({"n": ["50"] * 30 + ["200"] * 60 + ["800"] * 10})
        features = ConditionEncoder().fit(levels).encode(levels)
        self.assertEqual(features.shape[1], 2)
        np.testing.assert_allclose(features.T @ features / 100, np.eye(2), atol=1e-9)

    def test_a_factor_that_few_lack_says_so_by_itself(self):
        levels = pd.DataFrame({"parallax_deg": ["-"] * 10 + texts(np.linspace(1, 5, 90)).tolist()})
        features = ConditionEncoder().fit(levels).encode(levels)
        self.assertTrue((features[:10, :-1] == 0).all())
        self.assertEqual(len(set(features[:, -1])), 2)


    def test_a_word_among_many_numbers_stands_for_having_none(self):
        levels = pd.DataFrame({"parallax_deg": ["none"] * 10 + texts(np.linspace(1, 5, 90)).tolist()})
        encoder = ConditionEncoder().fit(levels)
        self.assertIsNone(encoder.columns[0].words)
        self.assertEqual(encoder.columns[0].presence, 0.9)
        self.assertTrue((encoder.encode(levels)[:10, :-1] == 0).all())


class KernelTest(unittest.TestCase):
    def test_the_gradient_is_that_of_the_likelihood_and_the_prior(self):
        for model in (fitted(60), fitted_to_crossed(15, 1)):
            theta, num = model.kernel.theta.clip(-3, 1) + 0.1, len(model.encoder.blocks)
            known = model.features, model.response, model.noise, model.draws

            def likelihood(theta):
                return log_likelihood(AnovaKernel(model.encoder, theta), *known)
            gradient = log_likelihood(AnovaKernel(model.encoder, theta), *known, gradient=True)[1]
            np.testing.assert_allclose(gradient, optimize.approx_fprime(theta, likelihood, 1e-6), rtol=1e-3, atol=1e-3)
            np.testing.assert_allclose(log_prior(theta, num)[1],
                                       optimize.approx_fprime(theta, lambda t: log_prior(t, num)[0], 1e-7), atol=1e-5)

    def test_the_likelihood_is_that_of_a_normal_distribution(self):
        model = fitted(60)
        cov = model.kernel.surface(model.features, model.features) + np.diag(model.noise + model.kernel.own_variance)
        expected = stats.multivariate_normal(np.zeros(60), cov).logpdf(model.response)
        self.assertAlmostEqual(log_likelihood(model.kernel, model.features, model.response, model.noise), expected, places=6)


class ModelTest(unittest.TestCase):
    def test_without_factors_one_rate_is_found(self):
        levels = pd.DataFrame(index=range(50))
        model = ConditionModel(ConditionEncoder().fit(levels)).fit(levels, np.full(50, 6), np.full(50, 20))
        rate, low, high = (numbers[0] for numbers in model.predict_rate(levels))
        self.assertAlmostEqual(rate, 0.3, delta=0.02)
        self.assertTrue(low < 0.3 < high)

    def test_bands_hold_the_true_surface_as_often_as_they_say(self):
        """Eight known surfaces of 100 conditions, 200 new conditions each. Bands with half the width would hold .59."""
        held_surface, held_condition = [], []
        for seed in range(8):
            model = fitted(100, seed)
            levels, logit = conditions(200, [seed, 7])
            own = 0.4 * np.random.default_rng([seed, 8]).standard_normal(200)
            for own_part, held in ((0, held_surface), (own, held_condition)):
                mean, sd = model.predict(levels, own=own_part is own)
                held.append(np.mean(np.abs(mean - logit - own_part) < stats.norm.ppf(0.95) * sd))
        for held in (held_surface, held_condition):
            self.assertGreater(np.mean(held), 0.84)
            self.assertLess(np.mean(held), 0.98)

    def test_drawn_surfaces_have_the_mean_and_spread_that_are_predicted(self):
        """400 surfaces: the mean of each of 40 points is within five standard errors, which all are with .99998; the mean ratio
        of spreads is within .05, more than two standard deviations of a single one (.035)."""
        for model, levels in ((fitted(80), conditions(40, 9)[0]), (fitted_to_crossed(20, 1), crossed_conditions(10, 4, 9)[0])):
            model._draw_parameters = lambda number, random: [model.kernel.theta] * number  # predictions are for these
            features = model.encoder.encode(levels)
            surfaces = model.draw_surfaces(400, np.random.default_rng(1))
            drawn = np.array([surface.at(features) for surface in surfaces])
            mean, sd = model.predict(levels, own=False)
            np.testing.assert_allclose(drawn.mean(axis=0), mean, atol=5 * sd.max() / 20)
            self.assertAlmostEqual(np.mean(drawn.std(axis=0) / sd), 1, delta=0.05)
            np.testing.assert_allclose(model.mean_surface().at(features), mean, atol=1e-6)
            np.testing.assert_allclose(np.sqrt(model.covariance(levels).diagonal()), sd, rtol=1e-6)
            self.assertAlmostEqual(surfaces[0].own, model.kernel.own_variance + model.kernel.draw_variance)

    def test_exchanged_features_give_what_the_exchanged_condition_has(self):
        model = fitted(60)
        surface = model.draw_surfaces(1, np.random.default_rng(1))[0]
        features = model.features[:5]
        columns = np.concatenate([model.encoder.columns_of(group) for group in ("noise", "sigma_px")])
        exchanged = Exchange(surface, features).exchanged(columns, model.features[5:9])
        swapped = features.copy()
        swapped[:, columns] = model.features[7, columns]
        np.testing.assert_allclose(exchanged[:, 2], surface.at(swapped), atol=1e-9)

    def test_a_mean_is_fitted_on_its_own_scale(self):
        levels, logit = conditions(100, 1)
        values = 3 + 0.01 * logit
        model = ConditionModel().fit_values(levels, values, np.full(100, 0.001))
        new, new_logit = conditions(100, 2)
        mean, low, high = model.predict_rate(new)
        self.assertLess(np.std(mean - 3 - 0.01 * new_logit), 0.005)
        self.assertGreater(np.mean((low < 3 + 0.01 * new_logit) & (3 + 0.01 * new_logit < high)), 0.75)


def indices_of(function, low, high, dimension):
    random = np.random.default_rng(1)
    points = random.uniform(low, high, (200, dimension))
    values = function(points)
    levels = pd.DataFrame({f"x{d + 1}": texts(points[:, d]) for d in range(dimension)})
    model = ConditionModel().fit_values(levels, values, np.full(len(values), 0.01 * values.std()))
    matters = {group: tested(sample_of(levels), model, group) for group in model.encoder.groups}
    return measure_indices(model, model.draw_surfaces(20, random), levels, random, matters)[0].set_index("group")


class IndicesTest(unittest.TestCase):
    def assert_indices(self, found, first, total, tolerance):
        np.testing.assert_allclose(found["first"][:len(first)], first, atol=tolerance)
        np.testing.assert_allclose(found["total"][:len(total)], total, atol=tolerance)

    def test_of_ishigamis_function(self):
        """Known: Saltelli and others, Global sensitivity analysis (2008), a = 7, b = 0.1. x3 acts through x1 alone."""
        found = indices_of(lambda x: np.sin(x[:, 0]) + 7 * np.sin(x[:, 1])**2 + 0.1 * x[:, 2]**4 * np.sin(x[:, 0]),
                           -np.pi, np.pi, 3)
        self.assert_indices(found, [0.3139, 0.4424, 0], [0.5576, 0.4424, 0.2437], 0.06)
        self.assertTrue(found.matters.all())

    def test_of_sobols_g_function(self):
        a = np.array([0, 1, 9, 99])
        found = indices_of(lambda x: np.prod((np.abs(4 * x - 2) + a) / (1 + a), axis=1), 0, 1, 4)
        parts = 1 / 3 / (1 + a)**2
        whole = np.prod(1 + parts) - 1
        total = [part * np.prod(1 + np.delete(parts, i)) / whole for i, part in enumerate(parts)]
        self.assert_indices(found, parts / whole, total, 0.08)
        self.assertEqual(found.first_lower["x4"], 0)

    def test_noise_alone_seldom_makes_a_factor_matter(self):
        """36 runs without any effect, five factors: in each the chance that one seems to matter is at most 5 %. More than 6
        would happen with probability .003."""
        num_wrong = 0
        for seed in range(36):
            levels, logit = conditions(50, [seed, 3])
            model = ConditionModel().fit(levels, events(np.full(50, -1.0), TRIALS, 0.4, seed), np.full(50, TRIALS))
            num_wrong += any(tested(sample_of(levels), model, group) for group in model.encoder.groups)
        self.assertLessEqual(num_wrong, 6)

    def test_what_conditions_of_a_draw_share_is_no_effect_of_what_is_drawn(self):
        """Six runs of 30 draws crossed with four levels, where no drawn factor has an effect: in each the chance that one
        seems to matter is at most 5 % (measured: 7 of 153 runs), three or more of six have probability .002. In a model
        without a variance of draws 32 of 38 runs had one, so that it passes with probability .006."""
        found = []
        for seed in range(6):
            model = fitted_to_crossed(30, seed)
            found.append({group for group in model.encoder.groups if tested(None, model, group)})
        self.assertTrue(all("num_matches" in groups for groups in found))
        self.assertLess(sum(len(groups) > 1 for groups in found), 3)

    def test_draws_of_one_condition_have_no_variance_of_their_own(self):
        self.assertEqual(fitted(60).kernel.draw_variance, 0)
        self.assertGreater(fitted_to_crossed(30, 1).kernel.draw_variance, 0.1)

    def test_factors_with_an_effect_are_found_and_idle_ones_are_not(self):
        model = fitted(150)
        matters = {group: tested(None, model, group) for group in model.encoder.groups}
        self.assertEqual([group for group in matters if matters[group]], ["sigma_px", "outlier_ratio", "noise"])


if __name__ == "__main__":
    unittest.main()
