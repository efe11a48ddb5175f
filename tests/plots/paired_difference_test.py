#!/usr/bin/python3
"""Tests of plots/paired_difference.py; run as: /usr/bin/python3 tests/plots/paired_difference_test.py"""

import pathlib
import unittest

from plot_test_case import PlotTestCase

import paired_difference
from common.summary_csv import read_comparison, where

HEADER = ("study,condition,outlier_ratio,estimator,reference,event,n,both,estimator_only,reference_only,neither,"
          "risk_difference,lower,upper,p_mcnemar,p_holm")
# Differences, bounds and p-values with no relation to the counts: a script that recomputed any would be seen.
TABLE = HEADER + """
demo,1,0.4,mine,standard,failure,400,1,2,3,4,-0.30,-0.50,-0.10,0.001,0.002
demo,1,0.4,rcme,standard,failure,400,1,2,3,4,0.05,-0.01,0.20,0.01,0.06
demo,0,0.0,mine,standard,failure,390,1,2,3,4,0,-0.02,0.02,1,1
demo,0,0.0,rcme,standard,failure,390,1,2,3,4,0.04,0.01,0.07,0.04,0.049
demo,2,0.8,mine,standard,failure,0,0,0,0,0,,-1,1,,
demo,2,0.8,rcme,standard,failure,400,1,2,3,4,0.1,0.05,0.2,0.05,0.05
demo,0,0.0,mine,standard,refusal,400,1,2,3,4,0.5,0.4,0.6,0.001,0.001
"""


def marks_of(axes, estimator):
    """{x: (difference, whether the mark is filled)}."""
    return {x: (y, line.get_label().startswith("_filled")) for line in axes.lines
            if line.get_label() in (f"_filled {estimator}", f"_open {estimator}")
            for x, y in zip(*line.get_data()) if y == y}


class PairedDifferenceTest(PlotTestCase):
    script, given = paired_difference, ["comparison.csv"]

    def draw(self, text=TABLE, events=("failure",), conditions=()):
        return paired_difference.draw(where(read_comparison(self.write(text)), conditions), "outlier_ratio",
                                      list(events))

    def run_main(self, *arguments, text=TABLE, x="outlier_ratio"):
        return self.run_script(self.write(text), "--x", x, "--out", self.folder / "difference", *arguments)


class Estimators(PairedDifferenceTest):
    def test_estimators_can_be_chosen(self):
        options = paired_difference.parse([self.write(TABLE), "--x", "outlier_ratio", "--out",
                                           str(self.folder / "difference"), "--estimators", "mine"])
        axes = paired_difference.draw_for(options).axes[0]
        self.assertEqual((marks_of(axes, "RCME"), marks_of(axes, "mine") != {}), ({}, True))
        code, _, err = self.run_main("--estimators", "other")
        self.assertNotEqual(code, 0)
        self.assertIn("allowed: mine, rcme", err)


class Drawn(PairedDifferenceTest):
    def test_marks_are_those_of_the_file_filled_where_holm_says_so(self):
        axes = self.draw().axes[0]
        self.assertEqual(marks_of(axes, "mine"), {0.4: (-0.30, True), 0.0: (0, False)})
        self.assertEqual(marks_of(axes, "RCME"), {0.4: (0.05, False), 0.0: (0.04, True), 0.8: (0.1, False)})
        for line in axes.lines:
            if line.get_label().startswith("_open"):
                self.assertEqual(line.get_markerfacecolor(), "white")
            elif line.get_label().startswith("_filled"):
                self.assertEqual(line.get_markerfacecolor(), line.get_markeredgecolor())

    def test_bars_are_the_intervals_and_the_zero_line_is_there(self):
        axes = self.draw().axes[0]
        bars = {tuple(map(tuple, segment)) for lines in axes.collections for segment in lines.get_segments()}
        self.assertLessEqual({((0.4, -0.50), (0.4, -0.10)), ((0.0, 0.01), (0.0, 0.07))}, bars)
        self.assertEqual([list(line.get_ydata()) for line in axes.lines if line.get_label() == "_zero"], [[0, 0]])
        self.assertEqual(axes.yaxis.get_major_formatter()(0.07), "+7")

    def test_legend_and_caption_say_what_is_what(self):
        figure = self.draw()
        labels = [text.get_text() for text in figure.legends[0].get_texts()]
        self.assertEqual(labels, ["mine", "RCME", "filled: Holm-adjusted McNemar p < 0.05", "open: p \u2265 0.05"])
        caption = figure.texts[0].get_text().replace("\n", " ")
        for part in ("Study demo", "minus that of Standard, on the same trials", "n = 0\u2013400 per point", "Tango's 95 %"):
            self.assertIn(part, caption)

    def test_axes_are_named_once_and_legend_handles_look_like_the_marks(self):
        two_sigmas = TABLE.replace("outlier_ratio,", "outlier_ratio,sigma_px,", 1)
        two_sigmas = two_sigmas.replace(",mine,", ",1,mine,").replace(",rcme,", ",1,rcme,")
        two_sigmas += two_sigmas.split("\n", 1)[1].replace(",1,mine,", ",2,mine,").replace(",1,rcme,", ",2,rcme,")
        figure = self.draw(two_sigmas)
        above, below = figure.axes
        self.assertEqual((above.get_xlabel(), below.get_xlabel()), ("", "Outlier ratio"))
        self.assertEqual({axes.get_ylabel() for axes in (above, below)}, {"Difference (% points)"})
        handles = dict(zip((text.get_text() for text in figure.legends[0].get_texts()), figure.legends[0].get_lines()))
        for name in ("mine", "RCME"):
            drawn = next(line for line in above.lines if line.get_label() == f"_filled {name}")
            for look in ("get_marker", "get_markeredgecolor", "get_markerfacecolor"):
                self.assertEqual(getattr(handles[name], look)(), getattr(drawn, look)(), (name, look))
        self.assertEqual(handles["open: p \u2265 0.05"].get_markerfacecolor(), "white")
        self.assertNotEqual(handles["filled: Holm-adjusted McNemar p < 0.05"].get_markerfacecolor(), "white")

    def test_scores_with_their_own_tests_and_intervals(self):
        text = HEADER + """,kind,p_value,test,interval
demo,0,0.0,mine,standard,auc_5_deg,390,,,,,0.1,0.05,0.2,,0.01,score,0.005,betting,betting
demo,1,0.4,mine,standard,auc_5_deg,390,,,,,-0.1,-0.3,0.2,,0.3,score,0.2,betting,betting
demo,0,0.0,mine,standard,max_error_median_deg,390,,,,,-9,-inf,2,,0.01,error,0.005,sign,order_statistics
demo,0,0.0,mine,standard,failure,390,1,2,3,4,-0.1,-0.3,0.2,,0.3,event,0.2,discordant_sequence,betting
"""
        figure = self.draw(text, events=["auc_5_deg"])
        self.assertEqual(marks_of(figure.axes[0], "mine"), {0.0: (0.1, True), 0.4: (-0.1, False)})
        self.assertEqual(figure.axes[0].get_title("left"), "AUC@5\u00b0")
        caption = figure.texts[0].get_text().replace("\n", " ")
        for part in ("score of each estimator minus that of Standard", "bars: anytime-valid 95 % (betting) intervals"):
            self.assertIn(part, caption)
        self.assertIn("filled: Holm-adjusted betting p < 0.05", [t.get_text() for t in figure.legends[0].get_texts()])
        event = self.draw(text, events=["failure"])
        self.assertIn("filled: Holm-adjusted anytime-valid p < 0.05", [t.get_text() for t in event.legends[0].get_texts()])
        self.assert_refused(self.run_main("--event", "max_error_median_deg", text=text), "no event or score called",
                            "allowed: auc_5_deg, failure")

    def test_events_side_by_side_and_words_on_the_axis(self):
        words = TABLE.replace("1,0.4,", "1,student_t,").replace("0,0.0,", "0,gaussian,").replace("2,0.8,", "2,laplace,")
        failure, refusal = self.draw(words, events=["failure", "refusal"]).axes
        self.assertEqual((failure.get_title("left"), refusal.get_title("left")), ("(a) Failures", "(b) Refusals"))
        self.assertEqual([label.get_text() for label in failure.get_xticklabels()], ["student t", "gaussian", "laplace"])
        self.assertEqual(marks_of(failure, "mine"), {0: (-0.30, True), 1: (0, False)})
        self.assertEqual(marks_of(refusal, "mine"), {1: (0.5, True)})
        self.assertFalse([line for line in failure.lines if line.get_label() == "_line"])

    def test_the_command_writes_both_files_the_same_each_time(self):
        def run():
            code, out, err = self.run_main()
            self.assertEqual((code, err), (0, ""))
            return [pathlib.Path(path).read_bytes() for path in out.split()]
        first = run()
        self.assertTrue(first[0].startswith(b"\x89PNG") and first[1].startswith(b"%PDF"))
        self.assertEqual(run(), first)


class Refusals(PairedDifferenceTest):
    def test_names_that_are_not_in_the_file(self):
        self.assert_refused(self.run_main(x="sigma"), "--x sigma", "allowed: outlier_ratio")
        self.assert_refused(self.run_main("--event", "success"), "'success'", "allowed: failure, refusal")
        self.assert_refused(self.run_main("--event", ""), "--event")
        self.assert_refused(self.run_main("--where", "estimator=x"), "estimator=x", "mine, rcme")

    def test_files_that_are_no_comparison(self):
        self.assert_refused(self.run_main(text=HEADER.replace("p_holm", "p")), "has no column p_holm", "rcme compare")
        self.assert_refused(self.run_main(text=TABLE.replace("0.05,-0.01,0.20", "0.05,0.06,0.20")), "line 3", "interval")
        self.assert_refused(self.run_main(text=TABLE.replace("0.01,0.06", "0.01,6")), "line 3", "p_holm")
        self.assert_refused(self.run_main(text=TABLE.replace("rcme,standard", "rcme,other")), "several references")
        self.assert_refused(self.run_main(text=TABLE.replace("2,0.8", "2,0.4")), "second failure")

    def test_help_teaches_with_an_example(self):
        self.assert_help_shows("rcme plot paired_difference comparison.csv --x outlier_ratio --out difference")


if __name__ == "__main__":
    unittest.main()
