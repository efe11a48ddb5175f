#!/usr/bin/python3
"""Tests of plots/conform.py; run as: /usr/bin/python3 tests/plots/conform_test.py"""

import pathlib
import unittest

from plot_test_case import PlotTestCase

import conform as script
from common.command_line import PlotError
from conform_figure.conform_file import read_report, read_table_of_regions
from conform_figure.panels import draw

TABLE = pathlib.Path(__file__).resolve().parents[2] / "results" / "conform" / "regions.csv"
FRESH = ["estimator=rcme_calibrated", "draws=fresh"]


def region(name="stated", **changes):
    return {"region": name, "coverage": 0.3, "coverage_interval": [0.25, 0.35], "hardest_quarter": 0.1,
            "hardest_quarter_interval": [0.05, 0.2], "size_deg": 0.5, "hardest_deg": 0.4, "all_motions": 0.0, **changes}


def content(*regions, **changes):
    """A made-up report."""
    regions = regions or (region(), region("conformed", coverage=0.9, coverage_interval=[0.88, 0.93], size_deg=12, all_motions=0.08))
    return {"format": "rcme conform report 1", "estimator": "standard", "is_check": True, "answers": 143, "level": 0.9,
            "regions": list(regions), **changes}


class ConformTest(PlotTestCase):
    script, given = script, ["report.json"]

    def drawn(self, *regions, **changes):
        return draw(read_report(self.write(content(*regions, **changes))))

    def test_coverages_have_intervals_and_the_promised_level(self):
        panel = self.drawn().axes[0]
        found = {label: [[round(x, 6) for x in line.get_xdata()] for line in panel.lines if line.get_label() == label]
                 for label in ("_coverage", "_interval", "_level")}
        self.assertEqual(found, {"_coverage": [[30], [10], [90], [10]], "_interval": [[25, 35], [5, 20], [88, 93], [5, 20]],
                                 "_level": [[90, 90]]})
        self.assertEqual([label.get_text() for label in panel.get_yticklabels()], ["stated", "conformed"])

    def test_sizes_are_logarithmic_and_those_that_are_none_left_out(self):
        panel = self.drawn(region(), region("conformed", hardest_deg=None)).axes[1]
        self.assertEqual(panel.get_xscale(), "log")
        self.assertEqual([line.get_xdata()[0] for line in panel.lines], [0.5, 0.4, 0.5])

    def test_the_caption_says_what_was_judged(self):
        for is_check, words in ((True, "Standard, the file's own rule, on new problems, 143 answers"), (False, "cross-validated")):
            caption = self.drawn(is_check=is_check).texts[0].get_text().replace("\n", " ")
            self.assertIn(words, caption)
            self.assertIn("conformed: 8 % of the regions are all motions", caption)

    def test_a_table_is_drawn_with_its_level_and_selection(self):
        report = read_table_of_regions(TABLE, 0.9, FRESH)
        self.assertEqual((report.estimator, report.origin, report.level), ("rcme_calibrated", "fresh", 0.9))
        self.assertEqual([one.name for one in report.regions], ["stated", "conformed"])
        for level, conditions, words in ((0.9, FRESH[:1], "--where draws="), (90, FRESH, "--level 90"), (0.9, ["draws=x"], "no such draws")):
            with self.assertRaisesRegex(PlotError, words):
                read_table_of_regions(TABLE, level, conditions)

    def test_rows_are_selected_of_a_table_only(self):
        for report in (self.write(content()), TABLE):
            self.assert_refused(self.run_script(report, "--where", FRESH[0], "--out", self.folder / "figure"), "--where " + FRESH[0],
                                "--level")

    def test_what_cannot_be_drawn_is_named(self):
        for one, words in ((region(coverage=2), "region 1 has 'coverage': 2; expected a number in 0..1"),
                           (region(coverage_interval=[1]), "'coverage_interval'"),
                           (region(coverage=None, coverage_interval=[None, None]), "nothing to draw")):
            with self.assertRaisesRegex(PlotError, "report.json.*" + words):
                self.drawn(one)
        self.assert_refused(self.run_script(self.write(content(format="rcme conform 2")), "--out", self.folder / "figure"),
                            "report.json", "expected 'rcme conform report 1'")


if __name__ == "__main__":
    unittest.main()
