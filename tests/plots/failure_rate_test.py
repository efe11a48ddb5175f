#!/usr/bin/python3
"""Tests of plots/failure_rate.py; run as: /usr/bin/python3 tests/plots/failure_rate_test.py"""

import csv
import os
import pathlib
import subprocess
import unittest
from unittest import mock

from plot_test_case import PLOTS, PlotTestCase

import failure_rate
from common import sheet, style
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.lines import Line2D
from common.summary_csv import read_summary, text_of_cell, where

HEADER = "study,condition,outlier_ratio,sigma_px,estimator,quantity,kind,value,lower,upper,standard_error,n"
# Rates and bounds with no relation to n: a script that recomputed any of them would be seen. Lines are not in order of
# x, one estimator is a name style.py does not know, and one condition has no trials.
TABLE = HEADER + """
demo,"a, first",0.4,1,standard,failure,rate,0.30,0.10,0.50,,400
demo,"a, first",0.4,1,mine,failure,rate,0.05,0.01,0.20,,400
demo,b,0.0,1,standard,failure,rate,0,0,0.02,,390
demo,b,0.0,1,mine,failure,rate,0,0,0.03,,390
demo,c,0.8,1,standard,failure,rate,0.60,0.55,0.90,,400
demo,c,0.8,1,mine,failure,rate,,0,1,,0
demo,"a, first",0.4,1,standard,no_candidate,rate,0,0,0.02,,400
demo,"a, first",0.4,1,mine,no_candidate,rate,0.10,0.05,0.15,,400
demo,b,0.0,1,standard,no_candidate,rate,0,0,0.02,,390
demo,b,0.0,1,mine,no_candidate,rate,0,0,0.02,,390
demo,"a, first",0.4,1,standard,nees,mean,5.1,,,0.1,400
"""
def more_estimators(*names):
    """The rows of Standard again, by other names."""
    return "".join(line.replace("standard", name) + "\n" for name in names for line in TABLE.splitlines()
                   if ",standard,failure," in line)


TWO_SIGMAS = TABLE + TABLE.split("\n", 1)[1].replace(",1,", ",2,")


def line_of(axes, label):
    """The (x, y) points of one labelled line, gaps left out."""
    line, = [line for line in axes.lines if line.get_label() == label]
    return [(x, y) for x, y in zip(*line.get_data()) if y == y]


def band_of(axes, position):
    """The corners (x, y) of one interval band."""
    bands = [band for band in axes.collections if isinstance(band, PolyCollection)]
    return {tuple(corner) for path in bands[position].get_paths() for corner in path.vertices}


class NameTest(unittest.TestCase):
    """Names come from files."""

    def test_a_label_that_begins_with_an_underscore_is_in_the_legend(self):
        looks = style.looks_of(["standard", "_mine"])
        handles = [Line2D([], [], **look.line()) for look in looks.values()]
        figure, _ = style.new_figure(1, 1)
        legend = style.draw_legend(figure, handles)
        self.assertEqual([text.get_text() for text in legend.get_texts()], ["Standard", "_mine"])
        self.assertEqual(len(legend.legendHandles), 2)

    def test_a_text_that_no_spreadsheet_may_run_is_read_back(self):
        cells = {"'=1+1": "=1+1", "''=1": "'=1", "'-x": "-x", "-0.5": "-0.5", "'quoted'": "'quoted'", "it's": "it's",
                 "' @x": " @x", "'\uff1dx": "\uff1dx", "plain": "plain", "": ""}
        self.assertEqual({cell: text_of_cell(cell) for cell in cells}, cells)


class FailureRateTest(PlotTestCase):
    script, given = failure_rate, ["summary.csv"]

    def setUp(self):
        super().setUp()
        self.out = self.folder / "figure.v1"  # a dot in the name is not a suffix

    def draw(self, text=TABLE, quantities=("failure", "no_candidate"), conditions=(), log_y=False):
        summary = where(read_summary(self.write(text)), conditions)
        return failure_rate.draw(summary, "outlier_ratio", list(quantities), log_y)

    def run_main(self, *arguments, x="outlier_ratio", path=None, text=TABLE):
        """(exit code, stdout, stderr) of the script with the usual arguments and these."""
        return self.run_script(path or self.write(text), "--x", x, "--out", self.out, *arguments)


class Estimators(FailureRateTest):
    def test_estimators_can_be_chosen(self):
        options = failure_rate.parse([self.write(TABLE), "--x", "outlier_ratio", "--out", str(self.out), "--estimators", "mine"])
        axes = failure_rate.draw_for(options).axes[0]
        self.assertEqual({line.get_label() for line in axes.lines if not line.get_label().startswith("_")}, {"mine"})
        code, _, err = self.run_main("--estimators", "standard,rcme")
        self.assertNotEqual(code, 0)
        self.assertIn("--estimators rcme", err)
        self.assertIn("allowed: standard, mine", err)


class WrittenFiles(FailureRateTest):
    def test_the_command_writes_both_files_and_prints_their_paths(self):
        done = subprocess.run(["/usr/bin/python3", str(PLOTS / "failure_rate.py"), self.write(TABLE), "--x",
                               "outlier_ratio", "--out", str(self.out)], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout.split(), [f"{self.out}.png", f"{self.out}.pdf"])
        png, pdf = (pathlib.Path(path).read_bytes() for path in done.stdout.split())
        self.assertTrue(png.startswith(b"\x89PNG") and len(png) > 20_000)
        self.assertTrue(pdf.startswith(b"%PDF") and pdf.rstrip().endswith(b"%%EOF") and len(pdf) > 8_000)

    def test_same_input_gives_same_bytes(self):
        def run():
            self.assertEqual(self.run_main("--log-y")[0], 0)
            return [pathlib.Path(f"{self.out}.{kind}").read_bytes() for kind in ("png", "pdf")]
        first = run()
        with mock.patch("time.time", return_value=2e9):
            self.assertEqual(run(), first)
        self.assertNotIn(b"CreationDate", first[1])

    def test_a_failed_write_leaves_the_old_files_and_nothing_half_written(self):
        old = {f"{self.out.name}.{kind}": b"old" for kind in ("png", "pdf")}
        for name, content in old.items():
            (self.folder / name).write_bytes(content)
        whole = style.written_as

        def disk_full(figure, kind, path, dpi):
            self.assertNotIn(os.path.basename(path), old)  # never written in place
            if kind == "png":
                return whole(figure, kind, path, dpi)
            pathlib.Path(path).write_bytes(b"%PDF half")
            raise OSError(28, "No space left on device")

        with mock.patch.object(style, "written_as", disk_full):
            code, _, err = self.run_main()
        self.assertEqual(code, 2)
        self.assertIn("No space left on device", err)
        (self.folder / "summary.csv").unlink()
        self.assertEqual({path.name: path.read_bytes() for path in self.folder.iterdir()}, old)


SCORES = TABLE + """demo,"a, first",0.4,1,standard,auc_5_deg,score,0.61,0.55,0.70,,400
demo,b,0.0,1,standard,auc_5_deg,score,0.9,0.8,0.95,,390
demo,b,0.0,1,standard,auc_5_deg_answered,score,0.9,0.8,0.95,,390
demo,b,0.0,1,standard,max_error_median_deg,median,inf,2,,,390
"""


class Scores(FailureRateTest):
    def test_scores_are_drawn_as_rates_are_and_the_axis_says_what_they_are(self):
        area, = self.draw(SCORES, quantities=["auc_5_deg"]).axes
        self.assertEqual(line_of(area, "Standard"), [(0.0, 0.9), (0.4, 0.61)])
        self.assertLessEqual({(0.4, 0.55), (0.4, 0.70)}, band_of(area, 0))
        self.assertEqual((area.get_title("left"), area.get_ylabel()), ("AUC@5\u00b0", "Score (%)"))
        both = self.draw(SCORES, quantities=["failure", "auc_5_deg_answered"]).axes
        self.assertEqual(both[0].get_ylabel(), "Rate or score (%)")
        self.assertIn("AUC@5\u00b0, refusals left out", both[1].get_title("left").replace("\n", " "))

    def test_the_caption_names_their_intervals(self):
        header, *rows = SCORES.strip().split("\n")
        kind_of = {"rate": "exact", "score": "betting"}
        kinds = [kind_of.get(next(csv.reader([row]))[6], "") for row in rows]
        text = "\n".join([f"{header},interval", *(f"{row},{kind}" for row, kind in zip(rows, kinds)), ""])
        caption = self.draw(text, quantities=["auc_5_deg"]).texts[0].get_text().replace("\n", " ")
        self.assertIn("anytime-valid 95 % (betting) intervals", caption)



# Median errors: one without an upper end of its interval, one infinite; and means, which have no interval.
ERRORS = TABLE + """demo,b,0.0,1,standard,direction_error_median_deg,median,0.2,0.1,0.4,,390
demo,"a, first",0.4,1,standard,direction_error_median_deg,median,2,0.5,,,400
demo,c,0.8,1,standard,direction_error_median_deg,median,inf,,,,400
demo,b,0.0,1,mine,direction_error_median_deg,median,0.3,0.2,0.5,,390
demo,"a, first",0.4,1,mine,direction_error_median_deg,median,3,1,20,,400
demo,c,0.8,1,mine,direction_error_median_deg,median,,,,,0
demo,b,0.0,1,standard,log_score,mean,-30,,,0.1,390
demo,"a, first",0.4,1,standard,log_score,mean,-20,,,0.1,400
"""


class Errors(FailureRateTest):
    def draw_errors(self, *more, log_y=None):
        return self.draw(ERRORS, ["direction_error_median_deg", *more], log_y=log_y)

    def test_medians_have_their_intervals_on_a_logarithmic_axis_with_their_unit(self):
        axes, = self.draw_errors().axes
        self.assertEqual((axes.get_yscale(), axes.get_ylabel(), axes.get_title("left")),
                         ("log", "Error (deg)", "Median direction error (deg)"))
        self.assertEqual([line_of(axes, name) for name in ("Standard", "mine")], [[(0.0, 0.2), (0.4, 2)], [(0.0, 0.3), (0.4, 3)]])
        self.assertLessEqual({(0.0, 0.2), (0.0, 0.5), (0.4, 1), (0.4, 20)}, band_of(axes, 1))
        self.assertEqual(axes.yaxis.get_major_formatter()(0.5), "0.5")
        self.assertLess(axes.get_ylim()[0], 0.1)
        self.assertEqual(self.draw_errors(log_y=False).axes[0].get_yscale(), "linear")

    def test_what_has_no_place_is_named(self):
        figure = self.draw_errors()
        top = figure.axes[0].get_ylim()[1]
        self.assertGreater(top, 20)
        self.assertLessEqual({(0.4, 0.5), (0.4, top)}, band_of(figure.axes[0], 0), "an open interval reaches the top")
        caption = figure.texts[0].get_text().replace("\n", " ")
        for words in ("medians with distribution-free intervals", "no mark: infinite", "reach the end of a panel have no upper end"):
            self.assertIn(words, caption)
        self.assertNotIn("exact", caption, "no rate is drawn")
        self.assertNotIn("infinite", self.draw(quantities=["failure"]).texts[0].get_text())

    def test_intervals_of_a_population_are_named(self):
        header, *rows = ERRORS.strip().split("\n")
        text = "\n".join([f"{header},effective_n", *(f"{row},12.5" for row in rows), ""])
        caption = self.draw(text, ["direction_error_median_deg"]).texts[0].get_text()
        self.assertIn("medians with 95 % population intervals", caption.replace("\n", " "))

    def test_means_may_be_negative_and_stand_without_intervals(self):
        figure = self.draw_errors("log_score")
        self.assertEqual(line_of(figure.axes[1], "Standard"), [(0.0, -30), (0.4, -20)])
        low, high = figure.axes[1].get_ylim()
        self.assertLess(low, -30)
        self.assertGreater(high, -20)
        self.assertIn("means without intervals", figure.texts[0].get_text().replace("\n", " "))
        self.assertEqual(self.draw_errors("log_score", log_y=True).axes[1].get_yscale(), "linear", "it has no logarithm")

    def test_a_mark_without_an_interval_is_within_its_axes(self):
        words = ERRORS.replace(",0.4,1", ",student_t,1").replace(",0.0,1", ",gaussian,1").replace(",0.8,1", ",laplace,1")
        axes, = self.draw(words, ["log_score"]).axes
        self.assertLess(axes.get_ylim()[0], -30)

    def test_of_one_condition_errors_stand_on_a_logarithmic_axis_too(self):
        options = failure_rate.parse([self.write(ERRORS), "--out", str(self.out), "--where", "outlier_ratio=0.4", "--quantities",
                                      "failure,direction_error_median_deg"])
        failure, error = failure_rate.draw_for(options).axes
        self.assertEqual([failure.get_xscale(), error.get_xscale()], ["linear", "log"])
        self.assertEqual([line_of(error, name) for name in ("Standard", "mine")], [[(2, 0)], [(3, 1)]])
        bars = [line.get_xydata().tolist() for line in error.lines if line.get_label() == "_interval"]
        self.assertEqual(bars, [[[0.5, 0], [error.get_xlim()[1], 0]], [[1, 1], [20, 1]]])


REFUSALS = HEADER + "".join(f"""
demo,{x},{x},1,{name},failure,rate,{failure},0,1,,400
demo,{x},{x},1,{name},failure_or_refusal,rate,{either},0,1,,400
demo,{x},{x},1,{name},no_candidate,rate,{none},0,1,,400
demo,{x},{x},1,{name},other_refusal,rate,{other},0,1,,400""" for x, name, failure, either, none, other in (
    (0.4, "standard", 0.3, 0.3, 0, 0), (0.8, "standard", 0.6, 0.6, 0, 0), (0.4, "mine", 0.2, 0.3, 0, 0.1),
    (0.8, "mine", 0, 0.995, 0.9, 0.095))) + "\n"
GREATEST = "greatest refusal rate: 99.5 % (mine, at outlier ratio = 0.8)"


class RefusedTrials(FailureRateTest):
    def draw_with(self, *arguments, text=REFUSALS):
        return failure_rate.draw_for(failure_rate.parse([self.write(text), "--out", str(self.out), *arguments]))

    def caption_with(self, *arguments):
        return self.draw_with(*arguments).texts[0].get_text().replace("\n", " ")

    def test_an_estimator_that_refuses_everything_does_not_look_good(self):
        figure = self.draw_with("--x", "outlier_ratio")
        self.assertEqual([axes.get_title("left") for axes in figure.axes], ["(a) Failure rate", "(b) Failure or refusal rate"])
        self.assertEqual(line_of(figure.axes[1], "mine"), [(0.4, 0.3), (0.8, 0.995)])
        self.assertIn(GREATEST, figure.texts[0].get_text().replace("\n", " "))

    def test_the_caption_has_the_greatest_refusal_rate_where_the_panels_do_not_show_it(self):
        for quantities, is_needed in (("failure", True), ("failure,no_candidate", True), ("failure,no_candidate,other_refusal", False),
                                      ("failure_or_refusal", False)):
            with self.subTest(quantities=quantities):
                self.assertEqual(GREATEST in self.caption_with("--x", "outlier_ratio", "--quantities", quantities), is_needed)
        self.assertNotIn("refusal rate", self.caption_with("--x", "outlier_ratio", "--quantities", "failure", "--estimators", "standard"))
        self.assertIn("greatest refusal rate: 99.5 % (mine).", self.caption_with("--where", "outlier_ratio=0.8"))

    def test_a_table_without_failure_or_refusal_has_what_it_has(self):
        self.assertEqual([axes.get_title("left") for axes in self.draw_with("--x", "outlier_ratio", text=TABLE).axes],
                         ["(a) Failure rate", "(b) No-candidate rate"])


ZEROS = HEADER + "".join(f"""
demo,{x},{x},1,{name},failure,rate,0,0,0.018,,200
demo,{x},{x},1,{name},failure_or_refusal,rate,0,0,0.018,,200
demo,{x},{x},1,{name},rotation_error_median_deg,median,0.1,0.05,0.2,,200""" for x in (0.0, 0.4) for name in ("standard", "mine")) + "\n"


class NothingFails(FailureRateTest):
    SENTENCE = ("Failure rate and failure or refusal rate: 0 at every point; to draw errors, give --quantities "
                "rotation_error_median_deg.")

    def sentence_of(self, *arguments, text=ZEROS):
        figure = failure_rate.draw_for(failure_rate.parse([self.write(text), "--out", str(self.out), *arguments]))
        axes, = figure.axes
        self.assertFalse(axes.axison)
        self.assertIn("at most 1.8 %", figure.texts[0].get_text().replace("\n", " "))
        return axes.texts[0].get_text().replace("\n", " ")

    def test_a_sentence_stands_in_place_of_the_panels_and_says_what_to_draw(self):
        self.assertEqual(self.sentence_of("--x", "outlier_ratio"), self.SENTENCE)
        self.assertEqual(self.sentence_of("--where", "outlier_ratio=0"), self.SENTENCE)
        without = "".join(line + "\n" for line in ZEROS.splitlines() if "error" not in line or line == HEADER)
        self.assertEqual(self.sentence_of("--x", "outlier_ratio", text=without),
                         "Failure rate and failure or refusal rate: 0 at every point.")

    def test_options_for_what_is_not_drawn_are_no_mistake(self):
        self.assertEqual(self.run_main("--highlight", "mine", "--labels", "outlier_ratio=Wrong", "--width", "3.17", text=ZEROS)[0], 0)


class DrawnValues(FailureRateTest):
    def test_lines_and_bands_are_those_of_the_file_in_order_of_x(self):
        failure, no_candidate = self.draw().axes
        self.assertEqual(line_of(failure, "Standard"), [(0.0, 0), (0.4, 0.30), (0.8, 0.60)])
        self.assertEqual(line_of(failure, "mine"), [(0.0, 0), (0.4, 0.05)])  # n = 0 at 0.8: a gap, not a zero
        self.assertEqual(line_of(no_candidate, "mine"), [(0.0, 0), (0.4, 0.10)])
        self.assertLessEqual({(0.0, 0.02), (0.4, 0.10), (0.4, 0.50), (0.8, 0.55), (0.8, 0.90)}, band_of(failure, 0))
        self.assertLessEqual({(0.0, 0.03), (0.4, 0.01), (0.4, 0.20)}, band_of(failure, 1))
        self.assertEqual(max(x for x, _ in band_of(failure, 1)), 0.4)

    def test_axes_are_in_per_cent_from_zero_and_in_words(self):
        failure, no_candidate = self.draw().axes
        self.assertEqual(failure.get_ylim()[0], 0)
        self.assertEqual(failure.yaxis.get_major_formatter()(0.07), "7")
        self.assertEqual((failure.get_xlabel(), failure.get_ylabel()), ("Outlier ratio", "Rate (%)"))
        self.assertEqual((failure.get_title("left"), no_candidate.get_title("left")),
                         ("(a) Failure rate", "(b) No-candidate rate"))

    def test_legend_handles_look_like_the_lines_in_the_order_of_the_study(self):
        figure = self.draw()
        legend, lines = figure.legends[0], [line for line in figure.axes[0].lines if not line.get_label().startswith("_")]
        self.assertEqual([text.get_text() for text in legend.get_texts()], ["Standard", "mine"])
        for handle, line in zip(legend.get_lines(), lines):
            for look in ("get_color", "get_marker", "get_linestyle"):
                self.assertEqual(getattr(handle, look)(), getattr(line, look)(), look)

    def test_the_caption_says_study_levels_n_and_interval(self):
        caption = self.draw().texts[0].get_text().replace("\n", " ")
        self.assertEqual(caption, "Study demo; sigma = 1 px; n = 0\u2013400 per point; "
                                  "bands: exact 95 % (Clopper-Pearson) intervals; "
                                  "greatest refusal rate: 10 % (mine, at outlier ratio = 0.4).")

    def test_on_a_logarithmic_axis_with_a_floor_a_zero_stands_there(self):
        options = failure_rate.parse([self.write(TABLE), "--x", "outlier_ratio", "--out", str(self.out), "--log-y",
                                      "--quantities", "failure", "--floor", "0.001", "--names", "mine"])
        figure = failure_rate.draw_for(options)
        axes = figure.axes[0]
        marks = [line.get_xydata().tolist() for line in axes.lines if line.get_label() == "_marker"]
        self.assertEqual(marks, [[[0.0, 0.001]], [[0.0, 0.001]]])
        self.assertEqual((axes.get_ylim()[0], axes.get_yticklabels()[0].get_text()), (0.001, "0"))
        self.assertEqual(line_of(axes, "mine"), [(0.0, 0.001), (0.4, 0.05)], "it begins on the floor")
        self.assertLessEqual({(0.0, 0.001), (0.0, 0.03), (0.4, 0.01), (0.4, 0.20)}, band_of(axes, 1))
        self.assertIn("open marks: rate zero", figure.texts[0].get_text())
        self.assertEqual([text.get_text() for text in axes.texts], ["mine"], "the other line has no name")

    def test_floor_and_names_are_checked(self):
        for arguments, fault in ((("--floor", "0"), "--floor 0"), (("--names", "rcme"), "--names rcme")):
            code, _, err = self.run_main(*arguments)
            self.assertNotEqual(code, 0)
            self.assertIn(fault, err)

    def test_without_one_the_floor_is_below_the_least_rate_that_is_not_zero(self):
        failure, no_candidate = self.draw(log_y=True).axes
        self.assertEqual([failure.get_ylim()[0], no_candidate.get_ylim()[0]], [0.02, 0.05])  # of 0.05 and 0.10
        self.assertEqual(line_of(failure, "Standard"), [(0.0, 0.02), (0.4, 0.30), (0.8, 0.60)])

    def test_where_levels_are_words_a_zero_is_an_arrow_at_its_upper_bound(self):
        words = TABLE.replace(",0.4,1", ",student_t,1").replace(",0.0,1", ",gaussian,1").replace(",0.8,1", ",laplace,1")
        figure = self.draw(words, log_y=True)
        failure = figure.axes[0]
        self.assertEqual(line_of(failure, "Standard"), [(0, 0.30), (2, 0.60)])
        arrows = [line.get_xydata().tolist() for line in failure.lines if line.get_label() == "_arrow"]
        self.assertEqual(arrows, [[[1.0, 0.02]], [[1.0, 0.03]]])
        self.assertLess(failure.get_ylim()[0], 0.02)
        self.assertIn("arrows: rate zero", figure.texts[0].get_text())

    def test_the_grey_ones_without_a_name_have_one_together(self):
        options = failure_rate.parse([self.write(TABLE + more_estimators("a", "b")), "--x", "outlier_ratio", "--out", str(self.out),
                                      "--quantities", "failure", "--highlight", "mine", "--names", "mine"])
        with sheet.use(options.sheet):
            axes = failure_rate.draw_for(options).axes[0]
        self.assertEqual({text.get_text() for text in axes.texts}, {"mine", "three others"})

    def test_a_point_without_neighbours_still_shows_its_interval(self):
        alone = TABLE.replace(",0.0,1,mine,failure,rate,0,0,0.03,,390", ",0.0,1,mine,failure,rate,,0,1,,0")
        failure = self.draw(alone).axes[0]  # of "mine" only 0.4 is left
        bars = [segment.tolist() for lines in failure.collections if isinstance(lines, LineCollection)
                for segment in lines.get_segments()]
        self.assertEqual(bars, [[[0.4, 0.01], [0.4, 0.20]]])

    def test_another_factor_gives_a_row_of_panels_per_level_unless_fixed(self):
        titles = [axes.get_title("left") for axes in self.draw(TWO_SIGMAS).axes]
        self.assertEqual(titles, ["(a) Failure rate, sigma = 1 px", "(b) No-candidate rate, sigma = 1 px",
                                  "(c) Failure rate, sigma = 2 px", "(d) No-candidate rate, sigma = 2 px"])
        self.assertEqual(len(self.draw(TWO_SIGMAS, conditions=["sigma_px=2.0"]).axes), 2)
        one = self.draw(TWO_SIGMAS, ["failure"], ["sigma_px=1", "estimator=mine"]).axes
        self.assertEqual([line.get_label() for line in one[0].lines], ["mine"])

    def test_words_stand_side_by_side_in_the_order_of_the_study_without_lines(self):
        words = TABLE.replace(",0.4,1", ",student_t,1").replace(",0.0,1", ",gaussian,1").replace(",0.8,1", ",laplace,1")
        failure = self.draw(words).axes[0]
        self.assertEqual([label.get_text() for label in failure.get_xticklabels()], ["student t", "gaussian", "laplace"])
        self.assertEqual(line_of(failure, "Standard"), [(0, 0.30), (1, 0), (2, 0.60)])
        self.assertEqual({line.get_linestyle() for line in failure.lines}, {"None"})
        bars = {tuple(map(tuple, segment)) for lines in failure.collections for segment in lines.get_segments()}
        self.assertIn(((0, 0.10), (0, 0.50)), bars)
        places = [line.get_transform().transform((0, 0))[0] for line in failure.lines]
        self.assertEqual(len(set(places)), 2)  # the two estimators do not hide each other
        figure = self.draw(words, log_y=True)
        self.assertIn("bars: exact", figure.texts[0].get_text().replace("\n", " "))

    def test_of_one_factor_at_a_time_the_others_stay_at_their_base(self):
        more = TABLE + 'demo,d,0.4,3,standard,failure,rate,0.9,0.8,0.95,,400\n'
        failure, _ = self.draw(more).axes
        self.assertEqual(line_of(failure, "Standard"), [(0.0, 0), (0.4, 0.30), (0.8, 0.60)])
        self.assertEqual(failure.get_title("left"), "(a) Failure rate")


# One quantity, so that names may stand beside the lines; a coverage; rates that are small; and one that is always zero.
COVERAGE = """demo,"a, first",0.4,1,standard,nees_coverage,rate,0.91,0.88,0.93,,400
demo,b,0.0,1,standard,nees_coverage,rate,0.95,0.93,0.97,,390
"""
SMALL = """demo,"a, first",0.4,1,standard,invalid_motion,rate,0.01,0.004,0.02,,400
demo,b,0.0,1,standard,invalid_motion,rate,0.002,0.001,0.01,,390
demo,"a, first",0.4,1,standard,timed_out,rate,0,0,0.0092,,400
demo,b,0.0,1,standard,timed_out,rate,0,0,0.0094,,390
"""


# From 0 to 0.4 all three are at zero, then two stay together.
ALIKE = HEADER + "".join(f"""
demo,a,0.0,1,{name},failure,rate,0,0,0.02,,400
demo,b,0.4,1,{name},failure,rate,0,0,0.02,,400
demo,c,0.8,1,{name},failure,rate,{end},0.01,{upper},,400""" for name, end, upper in (
    ("standard", 0.3, 0.5), ("mine", 0.1, 0.2), ("other", 0.1, 0.2))) + "\n"


class LinesThatCoincide(FailureRateTest):
    def setUp(self):
        super().setUp()
        self.figure = self.draw(ALIKE, quantities=["failure"])
        self.axes = self.figure.axes[0]

    def test_their_dashes_fill_the_line_together(self):
        dashes = {}
        for line in self.axes.lines:
            if line.get_label() == "_shared":
                dashes.setdefault(tuple(map(tuple, line.get_xydata())), []).append(line._unscaled_dash_pattern)
        self.assertEqual(set(dashes), {((0.0, 0), (0.4, 0)), ((0.4, 0), (0.8, 0.1))})
        for patterns in dashes.values():
            whole = {offset + on for offset, (on, off) in patterns}
            self.assertEqual(len(whole), len(patterns))
            for _, (on, off) in patterns:
                self.assertAlmostEqual(len(patterns) * on, on + off)
        self.assertEqual(line_of(self.axes, "Standard"), [(0.4, 0), (0.8, 0.3)])
        self.assertIn("coinciding lines alternate", self.figure.texts[0].get_text().replace("\n", " "))

    def test_each_point_has_the_mark_of_one(self):
        lines = [line for line in self.axes.lines if line.get_label() == "_marks"]
        marks = [(line.get_marker(), tuple(point)) for line in lines for point in line.get_xydata()]
        self.assertEqual(len({point for _, point in marks}), len(marks))
        self.assertEqual({point for _, point in marks}, {(0.0, 0), (0.4, 0), (0.8, 0.1), (0.8, 0.3)})
        self.assertEqual(len({marker for marker, _ in marks}), 3)

    def test_a_band_of_several_is_drawn_once(self):
        bands = [band for band in self.axes.collections if isinstance(band, PolyCollection)]
        pieces = [tuple(map(float, band.get_facecolor()[0])) for band in bands for _ in band.get_paths()]
        self.assertEqual(len(pieces), 2)  # the one of Standard, and one of two parts that meet
        self.assertEqual(len(set(pieces)), 2)


class WhatAReviewerLooksFor(FailureRateTest):
    def test_names_stand_beside_the_lines_of_one_panel_in_their_colours(self):
        figure = self.draw(quantities=["failure"])
        self.assertEqual(figure.legends, [])
        names = {text.get_text(): text.get_color() for text in figure.axes[0].texts}
        colors = {line.get_label(): line.get_color() for line in figure.axes[0].lines}
        self.assertEqual(names, {name: colors[name] for name in ("Standard", "mine")})

    def test_a_coverage_has_a_line_at_the_level_it_states_and_other_rates_have_none(self):
        figure = self.draw(TABLE + COVERAGE, ["nees_coverage", "failure"])
        levels = [[line.get_ydata()[0] for line in axes.lines if line.get_label() == "_stated"] for axes in figure.axes]
        self.assertEqual(levels, [[0.95], []])
        self.assertIn("dashed: the stated level, 95 %", figure.texts[0].get_text().replace("\n", " "))

    def test_a_coverage_is_not_drawn_without_its_sharpness(self):
        sharp = """demo,"a, first",0.4,1,standard,sd_over_crb,median,1.5,1.25,2.5,,400
demo,b,0.0,1,standard,sd_over_crb,median,3,2,4,,390
"""
        figure = self.draw(TABLE + COVERAGE + sharp, ["nees_coverage"])
        self.assertEqual([axes.get_title("left") for axes in figure.axes],
                         ["(a) NEES coverage", "(b) Stated sd over its bound"])
        points = line_of(figure.axes[1], "Standard")
        self.assertEqual(points[:2], [(0.0, 3), (0.4, 1.5)])
        self.assertEqual([line.get_ydata()[0] for line in figure.axes[1].lines if line.get_label() == "_stated"], [1])
        caption = figure.texts[0].get_text().replace("\n", " ")
        for words in ("medians with distribution-free intervals", "1, below which no covariance is right"):
            self.assertIn(words, caption)
        self.assertEqual(len(self.draw(TABLE + COVERAGE + sharp, ["failure"]).axes), 1)

    def test_rates_that_are_small_have_a_logarithmic_axis_unless_asked_otherwise(self):
        scales = [axes.get_yscale() for axes in self.draw(TABLE + SMALL, ["failure", "invalid_motion"], log_y=None).axes]
        self.assertEqual(scales, ["linear", "log"])
        self.assertEqual(self.draw(TABLE + SMALL, ["invalid_motion"], log_y=False).axes[0].get_yscale(), "linear")

    def test_the_axis_is_logarithmic_where_the_best_estimator_has_small_rates(self):
        """Though most rates of all estimators are large; one that is never wrong does not count."""
        best = "".join(f'demo,{x},{x},1,best,failure,rate,{rate},0,0.2,,400\n' for x, rate in ((0.0, 0), (0.4, 0.004), (0.8, 0.02)))
        self.assertEqual(self.draw(TABLE + best, ["failure"], log_y=None).axes[0].get_yscale(), "log")
        never = best.replace("0.004", "0").replace("0.02,", "0,")
        self.assertEqual(self.draw(TABLE + never, ["failure"], log_y=None).axes[0].get_yscale(), "linear")

    def test_levels_far_apart_stand_on_a_logarithmic_axis(self):
        self.assertEqual(self.draw(TABLE, ["failure"]).axes[0].get_xscale(), "linear")  # it has a zero
        far = TABLE.replace(",0.0,1,", ",0.01,1,")
        self.assertEqual(self.draw(far, ["failure"]).axes[0].get_xscale(), "log")
        self.assertEqual(line_of(self.draw(far, ["failure"]).axes[0], "Standard"), [(0.01, 0), (0.4, 0.30), (0.8, 0.60)])

    def test_a_panel_that_would_hold_only_zeros_is_left_out_and_named(self):
        figure = self.draw(TABLE + SMALL, ["failure", "timed_out"])
        self.assertEqual([axes.get_title("left") for axes in figure.axes], ["Failure rate"])
        self.assertIn("Timed out: 0 everywhere, at most 0.94 % at a point", figure.texts[0].get_text().replace("\n", " "))
        self.assertEqual(len(self.draw(TABLE + SMALL, ["timed_out"]).axes), 1)

    def test_a_highlight_that_the_figure_does_not_show_is_refused(self):
        self.assert_refused(self.run_main("--highlight", "yours"), "--highlight yours", "standard, mine")
        self.assertEqual(self.run_main("--highlight", "mine")[0], 0)


class OneCondition(FailureRateTest):
    MORE = TABLE + COVERAGE + """demo,"a, first",0.4,1,mine,failure_probability,score,0.2,0.15,0.25,,400
demo,"a, first",0.4,1,mine,timed_out,rate,0,0,0.01,,400
"""

    def draw_one(self, *arguments):
        return failure_rate.draw_for(failure_rate.parse([self.write(self.MORE), "--out", str(self.out), *arguments]))

    def test_each_estimator_has_a_mark_with_its_interval_in_each_panel(self):
        figure = self.draw_one("--where", "outlier_ratio=0.4", "--quantities", "failure,nees_coverage,failure_probability,timed_out")
        failure, coverage, stated = figure.axes
        self.assertEqual([label.get_text() for label in failure.get_yticklabels()], ["Standard", "mine"])
        self.assertEqual([line_of(failure, name) for name in ("Standard", "mine")], [[(0.30, 0)], [(0.05, 1)]])
        bars = [line.get_xydata().tolist() for line in failure.lines if line.get_label() == "_interval"]
        self.assertEqual(bars, [[[0.10, 0], [0.50, 0]], [[0.01, 1], [0.20, 1]]])
        self.assertEqual([line.get_xdata()[0] for line in coverage.lines if line.get_label() == "_stated"], [0.95])
        self.assertEqual(line_of(stated, "mine"), [(0.2, 1)])
        caption = figure.texts[0].get_text().replace("\n", " ")
        for words in ("outlier ratio = 0.4", "n = 400 per estimator", "dashed: the stated level", "Timed out: 0 everywhere"):
            self.assertIn(words, caption)

    def test_of_several_conditions_one_has_to_be_chosen(self):
        self.assert_refused(self.run_script(self.write(self.MORE), "--out", self.out), "3 conditions", "--x",
                            "outlier_ratio, sigma_px", "--where condition=")


class Refusals(FailureRateTest):
    def test_files_that_are_not_a_summary(self):
        self.assert_refused(self.run_main(path=self.folder / "nowhere.csv"), "nowhere.csv", "cannot be read")
        self.assert_refused(self.run_main(text=""), "summary.csv", "has no column study")
        self.assert_refused(self.run_main(text=HEADER), "no rows")
        self.assert_refused(self.run_main(text=TABLE.replace("upper", "top")), "has no column upper")
        self.assert_refused(self.run_main(text=TABLE.replace("sigma_px", "n", 1)), "more than one column n")
        self.assert_refused(self.run_main(text=TABLE[:-12]), "line 12", "cut off")
        self.assert_refused(self.run_main(text=TABLE + '"open'), "is not a CSV file")

    def test_names_that_are_not_in_the_file(self):
        self.assert_refused(self.run_main(x="parallax"), "--x parallax", "allowed: outlier_ratio, sigma_px")
        self.assert_refused(self.run_main("--quantities", "fail"), "'fail'", "allowed: failure, no_candidate")
        self.assert_refused(self.run_main("--quantities", "neess"), "no quantity called 'neess'", "no_candidate, nees")
        self.assert_refused(self.run_main("--quantities", ","), "--quantities")
        self.assert_refused(self.run_main("--where", "sigma=1"), "--where sigma=1", "sigma_px")
        self.assert_refused(self.run_main("--where", "sigma_px=3"), "--where sigma_px=3", "it has 1")
        self.assert_refused(self.run_main("--where", "condition=c", "--where", "outlier_ratio=0"), "together")
        self.assert_refused(self.run_main("--colour", "red"), "--colour", "--help")

    def test_values_that_cannot_be_drawn(self):
        self.assert_refused(self.run_main(text=TABLE.replace("0.30,0.10", "nan,0.10")), "line 2", "column value")
        self.assert_refused(self.run_main(text=TABLE.replace("0.30,0.10,0.50", "0.30,,")), "line 2", "interval")
        self.assert_refused(self.run_main(text=TABLE.replace("0.30,0.10,0.50", "30,10,50")), "line 2", "0..1")
        self.assert_refused(self.run_main(text=TABLE.replace("0.30,0.10,0.50", "0.30,-0.1,0.50")), "line 2", "0..1")
        self.assert_refused(self.run_main(text=TABLE.replace("c,0.8", "c,0.4")), "line 6", "second failure",
                            "--where condition=NAME")

    def test_more_than_one_figure_can_hold(self):
        body = TABLE.split("\n", 1)[1]
        many = HEADER + "\n" + "".join(body.replace(",1,", f",{level},") for level in range(1, 9))
        self.assert_refused(self.run_main(text=many), "8 combinations of sigma_px", "--where sigma_px=1")
        self.assert_refused(self.run_main(text=TABLE + body.replace("demo", "next")), "several studies", "study=next")

    def test_places_that_cannot_be_written(self):
        self.assert_refused(self.run_main("--out", str(self.folder / "no" / "figure")), "there is no folder")
        self.assert_refused(self.run_main("--out", str(self.folder / "figure.png")), "without .png")

    def test_help_teaches_with_an_example(self):
        self.assert_help_shows("rcme plot failure_rate summary.csv --x outlier_ratio --out failure_rate")


if __name__ == "__main__":
    unittest.main()
