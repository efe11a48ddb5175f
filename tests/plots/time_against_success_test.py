"""Tests of plots/time_against_success.py: what it draws from, what it refuses."""

import unittest

from matplotlib.text import Text

from plot_test_case import PlotTestCase

import time_against_success
from common.command_line import PlotError
from common.summary_csv import read_summary
from rates.time_points import draw, front_of, points_of

HEAD = "study,condition,estimator,quantity,kind,value,lower,upper,standard_error,n,interval,verdict,trials_to_decide"
ROWS = ["peers,0,fast,success,rate,0.5,0.4,0.6,,100,exact,,", "peers,0,fast,time_ms,median,0.1,0.09,0.12,,100,,,",
        "peers,0,slow,success,rate,0.9,0.8,0.95,,100,exact,,", "peers,0,slow,time_ms,median,10,9,11,,100,,,"]


class TimeAgainstSuccess(PlotTestCase):
    script, given = time_against_success, ["summary.csv"]

    def summary(self, rows, name=None):
        return self.write("\n".join([HEAD, *rows]) + "\n", name)

    def test_a_point_has_the_numbers_of_the_file(self):
        points = points_of(read_summary(self.summary(ROWS)))
        self.assertEqual(points["fast"], ((0.1, 0.09, 0.12), (0.5, 0.4, 0.6)))
        self.assertEqual(points["slow"][1], (0.9, 0.8, 0.95))

    def test_the_front_leaves_out_what_is_slower_and_no_better(self):
        self.assertEqual(front_of([(3, 0.7), (1, 0.5), (2, 0.4), (2, 0.7), (9, 0.9)]), [(1, 0.5), (2, 0.7), (9, 0.9)])

    def test_draws_every_point(self):
        axes = draw([read_summary(self.summary(ROWS))]).axes[0]
        drawn = {tuple(line.get_xydata()[0]) for line in axes.lines if len(line.get_xydata()) == 1}
        self.assertLessEqual({(0.1, 0.5), (10.0, 0.9)}, drawn)

    def test_says_how_many_trials_a_point_has_and_what_lines_there_are(self):
        def words(figure):
            return " ".join(" ".join(text.get_text() for text in figure.findobj(match=Text)).split())
        one = draw([read_summary(self.summary(ROWS))])
        self.assertIn("(n = 100 for a point)", words(one))
        self.assertNotIn("a line joins", words(one))
        more = [row.replace(",100,", ",2500,") for row in ROWS]
        both = draw([read_summary(self.summary(ROWS)), read_summary(self.summary(more, "more.csv"))])
        self.assertIn("(n = 100 to 2,500 for a point)", words(both))
        self.assertIn("a line joins one estimator's budgets", words(both))

    def test_a_panel_per_study(self):
        other = self.summary([row.replace("peers,", "others,") for row in ROWS], "other.csv")
        first = read_summary(self.summary(ROWS))
        figure = draw([first, read_summary(other), first])
        panels = [axes for axes in figure.axes if axes.axison]
        self.assertEqual([axes.get_title(loc="left") for axes in panels], ["(a) Peers", "(b) Others"])
        counts = [sum(len(line.get_xydata()) == 1 and line.get_marker() != "None" for line in axes.lines)
                  for axes in panels]
        self.assertEqual(counts, [4, 2])

    def test_no_panel_is_left_empty_with_axes(self):
        summaries = []
        for study in ("one", "two", "three"):
            summaries.append(read_summary(self.summary([row.replace("peers,", f"{study},") for row in ROWS], f"{study}.csv")))
        self.assertEqual([axes.axison for axes in draw(summaries).axes], [True, True, True, False])

    def test_refuses_what_is_not_pooled_or_has_no_times(self):
        for rows, words in ((ROWS[::2], "--times"), (ROWS + ROWS, "several conditions")):
            with self.assertRaisesRegex(PlotError, words):
                draw([read_summary(self.summary(rows))])

    def test_writes_both_files(self):
        out = self.folder / "figure"
        self.assertEqual(self.run_script(self.summary(ROWS), "--out", out)[0], 0)
        for suffix in (".png", ".pdf"):
            self.assertGreater(out.with_suffix(suffix).stat().st_size, 1000)


if __name__ == "__main__":
    unittest.main()
