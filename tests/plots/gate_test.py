#!/usr/bin/python3
"""Tests of plots/gate.py; run as: /usr/bin/python3 tests/plots/gate_test.py"""

import unittest

from plot_test_case import PlotTestCase

import gate as script
from common.command_line import PlotError
from gate_figure.gate_file import read_gate
from gate_figure.panel import draw


def test(quantity="failure", verdict="undecided", change=0.002, interval=(-0.005, 0.01), margin=0.005, **changes):
    return {"quantity": quantity, "verdict": verdict, "pairs": 200, "change": change, "interval": list(interval), "margin": margin,
            **changes}


def content(*tests, **changes):
    """A made-up gate.json."""
    tests = tests or (test(), test("miscoverage", "not worse", -0.04, (-0.06, -0.02), 0.01),
                      test("probability", "not measured", None, (None, None), pairs=0), test("time", "worse", 1.7, (1.5, 1.8), 0.05))
    return {"format": "rcme gate 1", "study": "demo", "old": "standard", "new": "rcme_calibrated", "verdict": "worse", "level": 0.05,
            "trials_per_condition": 25, "conditions": 8, "tests": list(tests), **changes}


class GateTest(PlotTestCase):
    script, given = script, ["gate.json"]

    def drawn(self, *tests, **changes):
        return draw(read_gate(self.write(content(*tests, **changes))))

    def lines(self, figure, label):
        return [list(line.get_xdata()) for line in figure.axes[0].lines if line.get_label() == label]

    def test_changes_and_intervals_are_in_margins(self):
        figure = self.drawn()
        for found, expected in zip(self.lines(figure, "_change") + self.lines(figure, "_interval"),
                                   ([0.4], [-4], [34], [-1, 2], [-6, -2], [30, 36]), strict=True):
            for value, wanted in zip(found, expected, strict=True):
                self.assertAlmostEqual(value, wanted)
        self.assertEqual(list(self.lines(figure, "_margin")[0]), [1, 1])

    def test_rows_have_their_values_and_verdicts_in_words(self):
        texts = [text.get_text().replace("\n", " ") for text in self.drawn().axes[0].texts]
        self.assertEqual(texts, [
            "failures: +0.2 [\u22120.5, +1] points, margin +0.5", "undecided",
            "truths outside of the region: \u22124 [\u22126, \u22122] points, margin +1", "not worse",
            "Brier score of the probability: margin +0.5 points", "not measured", "time: +170 [+150, +180] %, margin +5", "worse"])

    def test_the_caption_has_versions_and_trials(self):
        caption = self.drawn().texts[0].get_text().replace("\n", " ")
        for words in ("RCME, calibrated against Standard on study demo, 25 trials in each of 8 conditions (n = 200); worse",
                      "each end with 95 %", "ratios of new over old"):
            self.assertIn(words, caption)

    def test_a_limit_is_compared_with_the_rate(self):
        figure = self.drawn(test("failure_at_most", "not worse", 0.25, (0.2, 0.35), 0.4), old="", verdict="not worse")
        self.assertEqual(figure.axes[0].texts[0].get_text(), "failures: 25 [20, 35] %, limit 40")
        self.assertEqual(figure.axes[0].get_xlim()[0], 0)
        self.assertNotIn("against", figure.texts[0].get_text())

    def test_what_cannot_be_drawn_is_named(self):
        for row, words in ((test(margin=0), "test 1 has 'margin': 0; expected a number above 0"),
                           (test(interval=(2, 1)), "'interval': .*two rising numbers"), (test(verdict="good"), "'verdict': \"good\""),
                           (test(change=None), "'change': null"), (test(verdict="not measured"), "nothing to draw")):
            with self.assertRaisesRegex(PlotError, "gate.json.*" + words):
                self.drawn(row)
        self.assert_refused(self.run_script(self.write(content(format="rcme gate 9")), "--out", self.folder / "figure"),
                            "gate.json", "expected 'rcme gate 1'")


if __name__ == "__main__":
    unittest.main()
