#!/usr/bin/python3
"""Tests of plots/reliability.py; run as: /usr/bin/python3 tests/plots/reliability_test.py"""

import math
import unittest

from plot_test_case import PlotTestCase

import reliability as script
from common.command_line import PlotError
from fake_reliability import content, entry, measured
from reliability_figure.panels import draw
from reliability_figure.risk_band import wilson
from reliability_figure.reliability_file import read_reliability


class ReliabilityTest(PlotTestCase):
    script, given = script, ["reliability.json"]

    def read(self, *entries, **changes):
        return read_reliability(self.write(content(*entries, **changes)))

    def test_the_panels_have_the_numbers_of_the_file(self):
        figure = draw(self.read(entry(), entry("poselib", source="inlier_share")))
        diagram, histogram, risk = figure.axes
        curve = next(line for line in diagram.lines if line.get_label() == "_curve")
        self.assertEqual([tuple(point) for point in curve.get_xydata()], [(0, 0.01), (0.05, 0.01), (0.4, 0.6), (1, 0.6)])
        band = diagram.collections[0].get_paths()[0].vertices
        self.assertIn((0.5, 0.6), {tuple(point) for point in band})
        self.assertIn((0.5, 0.4), {tuple(point) for point in band})
        dots = {tuple(line.get_xydata()[0]) for line in diagram.lines if len(line.get_xydata()) == 1}
        self.assertEqual(dots, {(0.02, 0.0125), (0.7, 0.6)})
        text = figure.texts[0].get_text().replace("\n", " ")
        for words in ("RCME, calibrated: n = 100, refused 7", "Brier 0.0310 [0.0200, 0.0500]", "slope not defined", "AUC 0.910"):
            self.assertIn(words, text)
        self.assertEqual(len(diagram.texts), 0, "so that all panels begin at one height")
        self.assertEqual(list(histogram.patches[0].get_data().values), [80, 0, 5, 15])
        self.assertEqual([tuple(point) for point in risk.lines[0].get_xydata()], [(1, 0.18)])  # zero has no place
        self.assertEqual(risk.get_yscale(), "log")
        self.assertEqual(len(risk.lines), 2, "all estimators, also those without a diagram")

    def test_risk_is_drawn_from_the_first_failure_on_with_its_interval(self):
        curve = [{"probability": None, "coverage": coverage, "risk": risk} for coverage, risk in
                 ((0.5, 0.0), (0.8, 0.01), (0.9, 0.05), (1, 0.18))]
        figure = draw(self.read(entry(risk_coverage=curve), entry("poselib", risk_coverage=curve[:1] + curve[2:])))
        risk = figure.axes[-1]
        self.assertTrue(0.75 < risk.get_xlim()[0] < 0.8)
        bands = [band.get_paths()[0].vertices for band in risk.collections if band.get_label() == "_risk_band"]
        self.assertEqual(len(bands), 2)
        # Wilson's interval of 5 among 100: R, prop.test(5, 100, correct = FALSE)
        lower, upper = (bound(y for x, y in bands[0] if x == 1) for bound in (min, max))
        self.assertTrue(lower < 0.18 < upper)
        for bound, known in zip(wilson(0.05, 100), (0.02154336, 0.11175047)):
            self.assertAlmostEqual(bound, known, places=6)
        self.assertIn("band pointwise 95 % (Wilson)", figure.texts[0].get_text().replace("\n", " "))

    def test_draws_of_a_population_have_no_band_of_independent_trials(self):
        figure = draw(self.read(entry(intervals_of="population")))
        self.assertFalse([band for band in figure.axes[-1].collections if band.get_label() == "_risk_band"])
        self.assertNotIn("Wilson", figure.texts[0].get_text())

    def test_panels_begin_at_one_height_and_the_last_one_ends_with_the_histogram(self):
        figure = draw(self.read(entry()))
        figure.draw_without_rendering()
        diagram, histogram, risk = (axes.get_position() for axes in figure.axes)
        self.assertAlmostEqual(diagram.y1, risk.y1, places=3)
        self.assertAlmostEqual(histogram.y0, risk.y0, places=3)

    def test_those_that_state_probabilities_come_first(self):
        file = self.read(entry("standard", source="inlier_share"), entry())
        self.assertEqual([axes.get_title("left") for axes in draw(file).axes if axes.get_title("left")],
                         ["(a) RCME, calibrated", "(b) Risk and coverage"])
        named = draw(file, ["standard"])
        self.assertEqual(named.axes[0].get_title("left"), "(a) Standard, P from inlier share")

    def test_a_group_is_drawn_alone(self):
        file = self.read(entry(group="0.1"), entry(group="0.3", n=55), by="outlier_ratio")
        self.assertIn("n = 55", draw(file, group="0.3").texts[0].get_text().replace("\n", " "))
        self.assertIn("outlier ratio = 0.3", draw(file, group="0.3").texts[0].get_text().replace("\n", " "))
        with self.assertRaisesRegex(PlotError, "no group 'x'; expected one of '0.1', '0.3'"):
            draw(file, group="x")

    def test_what_cannot_be_drawn_is_named(self):
        with self.assertRaisesRegex(PlotError, "nothing to draw"):
            self.read({"estimator": "a", "group": "", "source": "stated", "n": 0, "refused": 3, "without": 0})
        with self.assertRaisesRegex(PlotError, "no probabilities of 'nobody'"):
            draw(self.read(entry()), ["nobody"])
        for changes, words in (({"histogram": [1]}, "4 whole numbers"), ({"brier": measured("x")}, "finite number"),
                               ({"curve": [{"first": 2, "last": 3, "recalibrated": 0}]}, r"0\.\.1"),
                               ({"source": "guess"}, "'stated', 'inlier_share'")):
            with self.assertRaisesRegex(PlotError, words):
                self.read(entry(**changes))
        with self.assertRaisesRegex(PlotError, "expected 'rcme reliability 1'"):
            self.read(entry(), format="rcme reliability 9")

    def test_no_failures_at_all(self):
        never = entry(risk_coverage=[{"probability": 0, "coverage": 1, "risk": 0.0}], area_under_curve=measured(None),
                      curve=[{"first": 0, "last": 0, "recalibrated": 0, "n": 100, "failed": 0}], band=[])
        self.assertTrue(math.isclose(draw(self.read(never)).axes[-1].get_ylim()[1], 1))

    def test_the_legend_names_what_is_drawn(self):
        safe = entry("poselib", risk_coverage=[{"probability": 0, "coverage": 1, "risk": 0.0}])
        figure = draw(self.read(entry(), safe, entry("standard")))
        names = [text.get_text().split(":")[0] for text in figure.legends[0].get_texts()]
        self.assertEqual(names, ["RCME, calibrated", "Standard", "if P were right (95 %)"])
        self.assertEqual(len(figure.axes[-1].lines), 2)
        self.assertIn("without a failure, so without a curve: PoseLib.", figure.texts[0].get_text().replace("\n", " "))
        proxy = draw(self.read(entry(), entry("poselib", source="inlier_share")))
        self.assertIn("P from inlier share: PoseLib.", proxy.texts[0].get_text().replace("\n", " "))
        self.assertNotIn("inlier share", str(proxy.legends[0].get_texts()))
        self.assertNotIn("if P", str([text.get_text() for text in draw(self.read(entry(band=[]))).legends[0].get_texts()]))
        self.assertEqual(figure.axes[-1].lines[0].get_marker(), "o")  # of a single point, where a line would not be seen

    def test_writes_both_files(self):
        out = self.folder / "figure"
        self.assertEqual(self.run_script(self.write(content(entry(), entry("poselib"))), "--out", out)[0], 0)
        for suffix in (".png", ".pdf"):
            self.assertGreater(out.with_suffix(suffix).stat().st_size, 1000)


if __name__ == "__main__":
    unittest.main()
