#!/usr/bin/python3
"""Tests of plots/crossings.py; run as: /usr/bin/python3 tests/plots/crossings_test.py"""

import unittest

from plot_test_case import PlotTestCase

import crossings as script
from common.command_line import PlotError
from rates.crossing_lines import draw, read_crossings


def crossing(ratio, estimator, estimate, interval, logistic, **levels):
    return {"levels": {"outlier_ratio": ratio, **levels}, "estimator": estimator, "estimate": estimate, "interval": interval,
            "logistic_interval": logistic, "trials": 300, "searched": [], "fresh": []}


def crossings(**changes):
    """Two estimators at three outlier ratios; an interval with an open end, and a crossing without a trial."""
    return {"format": "rcme crossings 1", "study": "two", "setting": "sigma_px", "from": 0.1, "to": 4, "logarithmic": True,
            "falling": False, "quantity": "failure", "rate": 0.3, "crossings": [
                crossing("0", "standard", 3.2, [1.0, None], [2.4, 3.9]), crossing("0", "other", 3.7, [2.1, 4.0], [3.4, 3.8]),
                crossing("0.2", "standard", 0.5, [None, 2.4], [0.2, 0.9]), crossing("0.2", "other", 1.9, [0.5, 3.9], [1.2, 2.6]),
                crossing("0.4", "standard", None, [None, None], [None, None]),
                crossing("0.4", "other", 0.2, [None, 0.3], [0.1, 0.25])], **changes}


class CrossingsTest(PlotTestCase):
    script, given = script, ["crossings.json"]

    def drawn(self, content=None, x="outlier_ratio", conditions=()):
        return draw(read_crossings(self.write(content or crossings())), x, conditions)

    def lines(self, axes):
        return {line.get_label(): (list(line.get_xdata()), list(line.get_ydata())) for line in axes.lines
                if not line.get_label().startswith("_")}

    def test_lines_are_the_estimates_and_nothing_stands_where_no_trial_could_be_simulated(self):
        axes, = self.drawn().axes
        self.assertEqual(self.lines(axes), {"Standard": ([0, 0.2], [3.2, 0.5]), "other": ([0, 0.2, 0.4], [3.7, 1.9, 0.2])})
        self.assertEqual((axes.get_yscale(), axes.get_ylim(), axes.get_ylabel()), ("log", (0.1, 4), "Sigma (px)"))

    def test_bars_are_the_monotone_intervals_and_end_at_the_range(self):
        axes, = self.drawn().axes
        bars = sorted(tuple(path.vertices[:, 1]) for collection in axes.collections for path in collection.get_paths()
                      if len(path.vertices) == 2)
        self.assertEqual(bars, sorted([(1.0, 4), (2.1, 4.0), (0.1, 2.4), (0.5, 3.9), (0.1, 0.3)]))

    def test_open_ends_have_arrows(self):
        axes, = self.drawn().axes
        arrows = [(line.get_marker(), x, y) for line in axes.lines if line.get_label() == "_beyond"
                  for x, y in zip(line.get_xdata(), line.get_ydata())]
        self.assertEqual(sorted(arrows), [("^", 0, 4), ("v", 0.2, 0.1), ("v", 0.4, 0.1)])
        self.assertIn("arrows:", self.drawn().texts[0].get_text().replace("\n", " "))

    def test_further_factors_have_panels_of_their_own(self):
        content = crossings()
        content["crossings"] = [crossing(ratio, "standard", 1.0, [0.5, 2.0], [0.8, 1.2], scene=scene)
                                for ratio in ("0", "0.2") for scene in ("room", "plane")]
        self.assertEqual([axes.get_title(loc="left") for axes in self.drawn(content).axes],
                         ["(a) scene = room", "(b) scene = plane"])
        self.assertEqual(len(self.drawn(content, conditions=["scene=room"]).axes), 1)

    def test_words_stand_side_by_side(self):
        content = crossings()
        content["crossings"] = [crossing("0", "standard", 1.0, [0.5, 2.0], [0.8, 1.2], scene=scene) for scene in ("room", "plane")]
        axes, = self.drawn(content, "scene").axes
        self.assertEqual([label.get_text() for label in axes.get_xticklabels()], ["room", "plane"])

    def test_what_is_no_such_file_is_refused(self):
        for content, named in (("{", "whole JSON"), (crossings(format="rcme tuning 1"), "rcme crossings 1"),
                               (crossings(crossings=[]), "no crossings"),
                               (crossings(crossings=[{**crossing("0", "standard", 1.0, [0.5], [0.8, 1.2])}]), "two numbers or nulls")):
            with self.subTest(named=named):
                self.assert_refused(self.run_script(self.write(content), "--x", "outlier_ratio", "--out", self.folder / "figure"),
                                    "crossings.json", named)

    def test_a_factor_that_is_none_is_refused(self):
        self.assert_refused(self.run_script(self.write(crossings()), "--x", "sigma_px", "--out", self.folder / "figure"),
                            "--x sigma_px", "outlier_ratio")

    def test_a_file_without_a_trial_is_refused(self):
        nothing = [crossing("0", "standard", None, [None, None], [None, None])]
        with self.assertRaisesRegex(PlotError, "no crossing has a trial"):
            self.drawn(crossings(crossings=nothing))

    def test_the_help_has_an_example(self):
        self.assert_help_shows("rcme solve", "rcme plot crossings")


if __name__ == "__main__":
    unittest.main()
