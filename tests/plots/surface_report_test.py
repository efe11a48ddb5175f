#!/usr/bin/python3
"""Tests of plots/surface_report.py and what it is made of; run as: /usr/bin/python3 tests/plots/surface_report_test.py"""

import pathlib
import shlex
import tracemalloc
import unittest
from unittest import mock

from plot_test_case import PlotTestCase

import numpy as np
import pandas as pd
import surface_report as script
import yaml
from known_surface import conditions, crossed_conditions, events, surface_file
from scipy import special, stats
from surface import memory
from surface.cross_validation import (assign_folds, count_masses, cross_validate, exact_interval, interval_over_draws, score_count,
                                      standard_error_of_mean, transform_histogram)
from surface.effects import WIDEST_BAND, measure_effects
from surface.proposals import propose
from surface.report_text import heading
from surface.surface_data import read_surface_data

NUMBER, TRIALS = 100, 20


class SurfaceTestCase(PlotTestCase):
    script, given = script, ["surface.json"]

    def known(self, **more):
        """The file of a surface that is known, with later draws."""
        levels, logit = conditions(NUMBER, 1)
        return surface_file(levels, events(logit, TRIALS, 0.4, 1), TRIALS, conditions(60, 2)[0], **more)

    def noise(self):
        levels, _ = conditions(NUMBER, 1)
        return surface_file(levels, events(np.full(NUMBER, -1.0), TRIALS, 0.4, 2), TRIALS)

    def data(self, value):
        return read_surface_data(self.write(value))


class PredictionTest(SurfaceTestCase):
    def test_masses_of_counts_are_those_of_the_binomial_distribution_where_the_rate_is_known(self):
        np.testing.assert_allclose(count_masses(20, 0.3, 1e-9), stats.binom(20, 1 / (1 + np.exp(-0.3))).pmf(range(21)), atol=1e-9)

    def test_masses_of_counts_are_averaged_over_the_logit(self):
        logits = np.linspace(-8, 8, 4001)
        weights = stats.norm(0.5, 1.1).pdf(logits)
        expected = np.average(stats.binom.pmf(7, 12, 1 / (1 + np.exp(-logits))), weights=weights)
        self.assertAlmostEqual(count_masses(12, 0.5, 1.1)[7], expected, places=6)

    def test_masses_are_those_of_a_dense_grid_for_many_trials_and_wide_predictions(self):
        """Likelihoods from far wider to far narrower than the prediction. Not statistical."""
        for trials in (1, 20, 60, 1000, 100_000):
            for sd in (0.1, 1.5, 6):
                mass = count_masses(trials, -1, sd)
                for count in {0, 1, trials // 2, trials}:
                    expected = log_mass(count, trials, -1, sd)
                    if expected > -300:  # of a representable probability
                        self.assertAlmostEqual(np.log(mass[count]), expected, delta=1e-3, msg=f"{count} of {trials}, sd {sd}")

    def test_exact_intervals_are_clopper_and_pearsons(self):
        np.testing.assert_allclose(exact_interval(5, 20), (0.08657, 0.49105), atol=1e-5)  # R: binom.test(5, 20)
        self.assertEqual(exact_interval(0, 20)[0], 0)
        self.assertEqual(exact_interval(20, 20)[1], 1)

    def test_counts_from_the_prediction_fill_its_intervals_and_bins(self):
        random = np.random.default_rng(1)
        counts = random.binomial(15, 1 / (1 + np.exp(-random.normal(-1, 0.8, 3000))))
        scored = pd.DataFrame([score_count(k, 15, -1, 0.8) for k in counts])
        self.assertAlmostEqual(scored[3].mean(), scored[4].mean(), delta=0.015)
        np.testing.assert_allclose(transform_histogram(scored[[5, 6]].to_numpy(float)), 0.1, atol=0.02)

    def test_a_surface_predicts_better_than_a_constant_and_noise_does_not(self):
        for value, beats in ((self.known(), True), (self.noise(), False)):
            data = self.data(value)
            check = cross_validate(data, data.fit())
            self.assertEqual(check.beats_constant, beats)
            share, low, high, expected = check.inside
            self.assertTrue(low <= expected <= high, f"{share} of the held-out conditions inside, {expected} expected")


def log_mass(count, trials, mean, sd):
    """Logarithm of the probability of a count whose rate has a normal logit: sums over 20,000 logits, first over all, then
    where the integrand is."""
    def log_integrand(x):
        return stats.norm(mean, sd).logpdf(x) + stats.binom.logpmf(count, trials, 1 / (1 + np.exp(-x)))
    x = np.linspace(-45, 30, 20_001)
    logs = log_integrand(x)
    is_there = logs > logs.max() - 50
    x = np.linspace(x[is_there][0] - 1e-3, x[is_there][-1] + 1e-3, 20_001)
    return special.logsumexp(log_integrand(x)) + np.log(x[1] - x[0])


class SharedDrawsTest(SurfaceTestCase):
    """Studies that cross the draws of a population with levels."""

    def crossed(self):
        levels, logit, draws = crossed_conditions(12, 4, 1)
        return surface_file(levels, events(logit, TRIALS, 0.3, 1), TRIALS, draws=draws)

    def test_conditions_of_a_draw_are_left_out_together(self):
        data = self.data(self.crossed())
        self.assertEqual(set(pd.Series(assign_folds(data)).groupby(data.shared_draws).nunique()), {1})
        self.assertIsNone(self.data(self.known()).shared_draws)
        self.assertIsNotNone(data.fit().draws)

    def test_copies_of_a_condition_say_nothing_more_of_a_mean(self):
        values, draws = np.random.default_rng(1).standard_normal(30), np.arange(30)
        expected = values.std(ddof=1) / np.sqrt(30)
        self.assertAlmostEqual(standard_error_of_mean(values, draws), expected)
        self.assertAlmostEqual(standard_error_of_mean(np.repeat(values, 4), np.repeat(draws, 4)), expected)

    def test_copies_of_a_condition_say_nothing_more_of_a_share(self):
        is_inside, draws = np.repeat([1.0, 0.0], [25, 5]), np.arange(30)
        self.assertEqual(interval_over_draws(is_inside, draws), exact_interval(25, 30))
        copies = interval_over_draws(np.repeat(is_inside, 4), np.repeat(draws, 4))
        np.testing.assert_allclose(copies, exact_interval(25, 30), atol=0.015)
        self.assertEqual(interval_over_draws(np.ones(120), np.repeat(draws, 4)), exact_interval(30, 30))

    def test_intervals_over_draws_hold_as_often_as_they_say(self):
        """A share of .9 in 40 draws of four conditions whose rates scatter, 400 times: the interval holds in 95.6 %, so that
        fewer than 92 % have probability .001; Clopper and Pearson of all conditions holds in 87.5 % and passes with .003."""
        random, draws, held = np.random.default_rng(1), np.repeat(np.arange(40), 4), []
        for rates in random.beta(1.8, 0.2, (400, 40)):
            low, high = interval_over_draws(random.binomial(1, np.repeat(rates, 4)).astype(float), draws)
            held.append(low < 0.9 < high)
        self.assertGreater(np.mean(held), 0.92)

    def test_the_report_says_that_draws_count(self):
        text = " ".join(heading(self.data(self.crossed())).split())
        self.assertIn("48 conditions of 12 draws", text)
        self.assertNotIn("draws with", " ".join(heading(self.data(self.known())).split()))


class HeadingTest(SurfaceTestCase):
    def test_a_coverage_is_not_said_without_its_sharpness(self):
        value = self.known(quantity="coverage")
        self.assertNotIn("Cramer-Rao", heading(self.data(value)))
        for c, condition in enumerate(value["conditions"][1:]):
            condition["sd_over_crb"] = 1.25 + c % 3
        self.assertIn("The stated sd is 1.25 to 3.25 times its Cramer-Rao bound",
                      " ".join(heading(self.data(value)).split()))


class EffectsTest(SurfaceTestCase):
    def test_curves_and_maps_are_those_of_the_known_surface(self):
        data = self.data(self.known())
        effects = measure_effects(data, data.fit())
        curve = effects.curves[effects.curves.group == "outlier_ratio"]
        self.assertTrue((curve.lower < curve.rate).all() and (curve.rate < curve.upper).all())
        others, _ = conditions(2000, 3)
        held = [low < known_mean(others, ratio) < high
                for ratio, low, high in zip(curve.level.astype(float), curve.lower, curve.upper)]
        self.assertGreater(np.mean(held), 0.6)  # bands of one curve hold or miss together
        self.assertIn(("sigma_px", "outlier_ratio"), set(zip(effects.maps["first"], effects.maps["second"])))
        self.assertTrue((effects.maps.is_known <= (effects.maps.upper - effects.maps.lower <= WIDEST_BAND)).all())

    def test_a_corner_without_conditions_is_not_known(self):
        levels, logit = conditions(200, 1, num_idle=0)
        is_there = ~((levels.sigma_px.astype(float) > 0.8) & (levels.outlier_ratio.astype(float) > 0.4)).to_numpy()
        levels, logit = levels[is_there].reset_index(drop=True), logit[is_there]
        data = self.data(surface_file(levels, events(logit, TRIALS, 0.4, 1), TRIALS))
        maps = measure_effects(data, data.fit()).maps
        cells = maps[(maps["first"] == "sigma_px") & (maps["second"] == "outlier_ratio")]
        is_corner = (cells.first_level.astype(float) > 1.5) & (cells.second_level.astype(float) > 0.62)
        self.assertFalse(cells.is_known[is_corner].any())
        self.assertGreater(cells.is_known[~is_corner].mean(), 0.6)


def known_mean(levels, ratio):
    """Mean rate of the known surface where all conditions have that outlier ratio; 0.4 is each condition's own deviation."""
    log_sigma, dof = np.log(levels.sigma_px.astype(float)), levels.student_dof.replace("-", "6").astype(float)
    logit = -1 + 1.2 * log_sigma + (3 + 1.5 * log_sigma) * (ratio - 0.4) + (levels.noise == "student_t") * (1 - 0.2 * (dof - 6))
    return (1 / (1 + np.exp(-logit.to_numpy()[:, None] - 0.4 * stats.norm.ppf((np.arange(20) + 0.5) / 20)))).mean()


class ProposalTest(SurfaceTestCase):
    def test_the_least_known_are_chosen_and_one_choice_changes_the_next(self):
        data = self.data(self.known())
        model = data.fit()
        chosen = propose(data, model, 8)
        self.assertEqual(chosen.draw.nunique(), 8)
        self.assertTrue((chosen.draw >= NUMBER).all())
        self.assertTrue((np.diff(chosen.score) <= 1e-12).all())
        least = propose(data, model, 60)
        self.assertLess(least.score.iloc[-1], 0.7 * least.score.iloc[0])

    def test_a_copy_of_a_chosen_condition_is_not_chosen_next(self):
        value = self.known()
        first = propose(self.data(value), self.data(value).fit(), 1).draw[0]
        copy = next(candidate for candidate in value["candidates"] if candidate["draw"] == first)
        value["candidates"].append(dict(copy, draw=900))
        data = self.data(value)
        chosen = propose(data, data.fit(), 2)
        self.assertEqual(len({first, 900} & set(chosen.draw)), 1)

    def test_with_a_level_the_least_decided_are_chosen(self):
        data = self.data(self.known())
        model = data.fit()
        chosen = propose(data, model, 5, level=0.5)
        mean, sd = model.predict(data.candidates[data.names], own=False)
        self.assertTrue((chosen.score <= 0.5).all())
        z = dict(zip(data.candidates.draw, np.abs(mean) / sd))
        self.assertEqual(chosen.draw[0], min(z, key=z.get))


class ScriptTest(SurfaceTestCase):
    def out(self):
        return self.folder / "out"

    def written(self):
        return sorted(path.name for path in self.out().iterdir())

    def test_a_surface_is_reported_drawn_and_tabled(self):
        code, out, err = self.run_script(self.write(self.known()), "--out", self.out(), "--propose", "4")
        self.assertEqual(code, 0, err)
        figures = [f"{name}.{kind}" for name in ("check", "indices", "curves", "maps") for kind in ("pdf", "png")]
        tables = [f"{name}.csv" for name in ("cross_validation", "curves", "indices", "maps", "proposed")]
        self.assertEqual(self.written(), sorted([*figures, *tables, "next.yaml", "report.txt"]))
        report = (self.out() / "report.txt").read_text(encoding="utf-8")
        self.assertLessEqual(max(map(len, report.splitlines())), 80)
        for part in ("better than that", "All are random draws", "sigma_px", "first-order", "noise +"):
            self.assertIn(part, report)
        self.assertIn(report, out)
        study = yaml.safe_load((self.out() / "next.yaml").read_text(encoding="utf-8"))
        draws = sorted(pd.read_csv(self.out() / "proposed.csv").draw)
        self.assertEqual(study["conditions"]["draws"], draws)
        self.assertEqual(len(draws), 4)

    def test_the_command_of_the_proposed_study_can_be_typed(self):
        code, out, err = self.run_script(self.write(self.known()), "--out", self.folder / "a b", "--propose", "2", "--no-figures")
        self.assertEqual(code, 0, err)
        words = shlex.split(next(line for line in out.splitlines() if line.startswith("  rcme run")))
        self.assertEqual(words, ["rcme", "run", str(self.folder / "a b" / "next.yaml"), "--out", "next.sqlite"])
        self.assertTrue(pathlib.Path(words[2]).is_file())

    def test_noise_gets_no_maps_and_what_stood_there_is_gone(self):
        self.out().mkdir()
        (self.out() / "maps.png").write_text("old", encoding="utf-8")
        code, out, err = self.run_script(self.write(self.noise()), "--out", self.out(), "--no-figures")
        self.assertEqual(code, 0, err)
        self.assertIn("DOES NOT PREDICT BETTER", out)
        self.assertEqual(self.written(), ["cross_validation.csv", "report.txt"])

    def test_chosen_conditions_speak_for_no_population(self):
        """A second run of proposed draws: the mean over the population is that of the first."""
        value = self.known()
        value["runs"].append({"path": "next.sqlite", "study": "known_next", "is_sample": False})
        value["conditions"] += [dict(condition, run=1, draw=500 + i, mean=1.0, sd=0.0)
                                for i, condition in enumerate(value["conditions"][:20])]
        mean = f"{100 * np.mean([condition['mean'] for condition in value['conditions'][:NUMBER]]):.1f} %"
        code, out, err = self.run_script(self.write(value), "--out", self.out(), "--no-figures")
        self.assertEqual(code, 0, err)
        self.assertIn(mean, " ".join(out.split()))
        self.assertIn("the other 20 were chosen", " ".join(out.split()))
        self.assertTrue((pd.read_csv(self.out() / "cross_validation.csv").run == 0).all())

    def test_without_a_sample_the_report_says_so(self):
        code, out, err = self.run_script(self.write(self.known(is_sample=False)), "--out", self.out(), "--no-figures")
        self.assertEqual(code, 0, err)
        self.assertIn("None of them is a random draw", " ".join(out.split()))
        self.assertIn("Mean over these conditions where", out)

    def test_more_conditions_than_the_memory_holds_are_refused(self):
        enough = memory.matrix_bytes(NUMBER, 20) / memory.SHARE + 1
        with mock.patch.object(memory, "memory_bytes", lambda: enough / 10):
            self.assert_refused(self.run_script(self.write(self.known()), "--out", self.out()),
                                f"{NUMBER} conditions need", "fewer draws")
        with mock.patch.object(memory, "memory_bytes", lambda: enough):
            self.assertEqual(len(self.data(self.known()).trials), NUMBER)
        self.assertEqual(memory.most_conditions(20, enough), NUMBER)
        self.assertLess(memory.most_conditions(20, 8e9), 10_000)

    def test_the_memory_of_a_fit_is_what_was_expected(self):
        """Not statistical. The variances are learned from few conditions, so that matrices over all are the greatest."""
        number = 400
        levels, logit = conditions(number, 1)
        data = self.data(surface_file(levels, events(logit, TRIALS, 0.4, 1), TRIALS))
        with mock.patch("surface.condition_model.MOST_FOR_VARIANCES", 100):
            tracemalloc.start()
            data.fit()
            _, peak = tracemalloc.get_traced_memory()
            tracemalloc.stop()
        expected = memory.matrix_bytes(number, len(data.encoder.groups))
        self.assertLess(peak, 1.1 * expected)
        self.assertGreater(peak, 0.6 * expected)

    def test_what_is_wrong_is_named(self):
        few = self.known()
        few["conditions"] = few["conditions"][:19]
        self.assert_refused(self.run_script(self.write(few), "--out", self.out()), "at least 20 conditions")
        self.assert_refused(self.run_script(self.write("{}"), "--out", self.out()), "surface.json")
        self.assert_refused(self.run_script(self.write(self.noise()), "--out", self.out(), "--propose", "3"), "--propose")
        self.assert_refused(self.run_script(self.write(self.known()), "--out", self.out(), "--propose", "3", "--level", "1"),
                            "--level 1")


if __name__ == "__main__":
    unittest.main()
