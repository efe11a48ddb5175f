#!/usr/bin/python3
"""Tests of plots/stanford.py; run as: /usr/bin/python3 tests/plots/stanford_test.py"""

import unittest

import numpy
from plot_test_case import PlotTestCase

import stanford as script
from common.command_line import PlotError
from fake_integrity import content, diagram, row
from stanford_figure.integrity_file import read_integrity
from stanford_figure.panels import draw


class StanfordTest(PlotTestCase):
    script, given = script, ["integrity.json"]

    def read(self, *diagrams, **changes):
        return read_integrity(self.write(content(*diagrams, **changes)))

    def test_cells_are_at_their_error_and_level(self):
        panel = draw(self.read()).axes[0]
        counts = panel.collections[0].get_array().reshape(4, 4)
        self.assertEqual(counts[1, 0], 90, "level .1 to 1 deg, error below .1")
        self.assertEqual(counts[3, 1], 78)
        self.assertTrue(numpy.ma.is_masked(counts[0, 0]))
        self.assertEqual((panel.get_xscale(), panel.get_yscale()), ("log", "log"))
        self.assertEqual((panel.get_xlabel(), panel.get_ylabel()), ("Error (deg)", "Protection level (deg)"))

    def test_the_lines_are_the_diagonal_and_the_alert_limit(self):
        panel = draw(self.read()).axes[1]
        diagonal = next(line for line in panel.lines if line.get_label() == "_diagonal").get_xydata()
        self.assertTrue(all(x == y for x, y in diagonal))
        limits = [line.get_xydata() for line in panel.lines if line.get_label() == "_limit"]
        self.assertTrue(all(y == 5 for _, y in limits[0]))
        self.assertTrue(all(x == 5 and y <= 5 for x, y in limits[1]))

    def test_regions_have_their_share_of_all_trials_inside_of_them(self):
        panel = draw(self.read()).axes[0]
        texts = {text.get_text().replace("\n", " "): text.get_position() for text in panel.texts}
        self.assertEqual(set(texts), {"available 45 % n = 90", "misleading 3.5 % n = 7", "hazardously misleading 1 % n = 2",
                                      "unavailable 39 % n = 78", "unavailable, misleading 1.5 % n = 3"})
        place = {name.split(" n =")[0]: where for name, where in texts.items()}
        x, y = place["available 45 %"]
        self.assertTrue(x < y < 1)
        x, y = place["misleading 3.5 %"]
        self.assertTrue(y < x < 1)
        x, y = place["hazardously misleading 1 %"]
        self.assertTrue(y < 1 < x)
        x, y = place["unavailable 39 %"]
        self.assertTrue(1 < y and x < y)
        x, y = place["unavailable, misleading 1.5 %"]
        self.assertTrue(1 < y < x)

    def test_the_caption_has_the_rate_to_hold_against_the_risk(self):
        caption = draw(self.read()).texts[0].get_text().replace("\n", " ")
        for words in ("RCME, calibrated on study demo, 200 trials, 20 of them without a motion", "a risk of 0.1 %",
                      "rotation: 6.67 % [3.51, 11.3] of the answers", "available: error \u2264 level \u2264 alert limit",
                      "misleading: level < error \u2264 limit", "hazardously misleading: level \u2264 limit < error",
                      "unavailable: limit < level"):
            self.assertIn(words, caption)

    def test_large_and_small_alert_limits_leave_room_for_names(self):
        for limit in (0.001, 30, 180):
            panel = draw(self.read(diagram(limit=limit))).axes[0]
            least, greatest = panel.get_xlim()
            self.assertTrue(least < limit < greatest)

    def test_what_cannot_be_drawn_is_named(self):
        none = diagram(cells=[], regions=dict.fromkeys(diagram()["regions"], 0), trials=20)
        with self.assertRaisesRegex(PlotError, "nothing to draw"):
            self.read(none, all=[row("rotation", None, None, None)])
        for changes, words in (({"alert_limit_deg": 0}, r"a number in \(0, 180\]"), ({"trials": 201}, "different numbers"),
                               ({"cells": [{"error": 4, "level": 0, "n": 180}]}, "one of 4 bins"), ({"error": "scale"}, "'all'")):
            with self.assertRaisesRegex(PlotError, words):
                self.read(diagram(**changes), all=[row("rotation")])
        with self.assertRaisesRegex(PlotError, "rising numbers"):
            self.read(edges_deg=[0.1, 0.1])
        with self.assertRaisesRegex(PlotError, "expected 'rcme integrity 1'"):
            self.read(format="rcme integrity 9")

    def test_writes_both_files(self):
        out = self.folder / "figure"
        self.assertEqual(self.run_script(self.write(content()), "--out", out)[0], 0)
        for suffix in (".png", ".pdf"):
            self.assertGreater(out.with_suffix(suffix).stat().st_size, 1000)


if __name__ == "__main__":
    unittest.main()
