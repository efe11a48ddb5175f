#!/usr/bin/python3
"""Tests of plots/heat_map.py; run as: /usr/bin/python3 tests/plots/heat_map_test.py"""

import pathlib
import unittest

from plot_test_case import PlotTestCase

import heat_map
from matplotlib.collections import PolyCollection
from common import sheet, style
from common.summary_csv import read_summary, where
from rates.cells import COLORS, LEAST_TOP, luminance, scale_of
from rates.selection import select_rates

HEADER = "study,condition,noise,sigma_px,estimator,quantity,kind,value,lower,upper,standard_error,n"
# Rates and bounds with no relation to n: a script that recomputed any of them would be seen. One factor has words.
TABLE = HEADER + """
demo,0,student_t,1,standard,failure,rate,0.30,0.10,0.50,,400
demo,0,student_t,1,mine,failure,rate,0.05,0.01,0.20,,400
demo,1,student_t,0.5,standard,failure,rate,0.123,0.02,0.33,,400
demo,1,student_t,0.5,mine,failure,rate,0,0,0.03,,390
demo,2,gaussian,1,standard,failure,rate,0.60,0.55,0.90,,400
demo,2,gaussian,1,mine,failure,rate,,0,1,,0
demo,3,gaussian,0.5,standard,failure,rate,0.07,0.05,0.09,,400
demo,3,gaussian,0.5,mine,failure,rate,0.01,0,0.02,,400
demo,0,student_t,1,standard,no_candidate,rate,0,0,0.02,,400
demo,0,student_t,1,mine,no_candidate,rate,0.01,0.005,0.15,,400
demo,0,student_t,1,scene,parallax_deg,mean,5.1,,,0.1,400
"""


def texts_of(axes):
    """{(x, y) of the cell: [its printed lines from top to bottom]}."""
    cells = {}
    for text in sorted(axes.texts, key=lambda text: -text.get_position()[1]):
        x, y = text.get_position()
        cells.setdefault((int(x), int(y)), []).append(text.get_text())
    return cells


def colors_of(axes):
    """{(x, y) of the cell: its colour}."""
    return {tuple(box.get_paths()[0].vertices.min(axis=0).astype(int)): tuple(box.get_facecolor()[0])
            for box in axes.collections if isinstance(box, PolyCollection)}


class HeatMapTest(PlotTestCase):
    script, given = heat_map, ["summary.csv"]

    def draw(self, text=TABLE, quantities=("failure",), estimators=(), conditions=()):
        summary = where(read_summary(self.write(text)), conditions)
        figure, = heat_map.draw_pages(summary, "noise", "sigma_px", list(quantities), list(estimators))
        return figure

    def run_main(self, *arguments, text=TABLE, x="noise", y="sigma_px"):
        return self.run_script(self.write(text), "--x", x, "--y", y, "--out", self.folder / "map", *arguments)


class Drawn(HeatMapTest):
    def test_every_cell_shows_its_rate_and_interval_in_the_order_of_the_study(self):
        standard, mine = self.draw().axes[:2]
        self.assertEqual(texts_of(standard), {(0, 0): ["30.0", "[10.0, 50.0]"], (0, 1): ["12.3", "[2.0, 33.0]"],
                                              (1, 0): ["60.0", "[55.0, 90.0]"], (1, 1): ["7.0", "[5.0, 9.0]"]})
        self.assertEqual(texts_of(mine)[1, 0], ["n = 0"])
        self.assertEqual([label.get_text() for label in standard.get_xticklabels()], ["student t", "gaussian"])
        self.assertEqual([label.get_text() for label in standard.get_yticklabels()], ["1", "0.5"])
        self.assertEqual((standard.get_xlabel(), standard.get_ylabel()), ("Noise", "Sigma (px)"))

    def test_the_colour_bar_is_in_per_cent_and_says_so(self):
        bar = self.draw().axes[2]
        self.assertEqual((bar.get_ylabel(), bar.yaxis.get_major_formatter()(0.3)), ("Rate (%)", "30"))

    def test_titles_name_quantity_and_estimator(self):
        titles = [axes.get_title("left") for axes in self.draw(quantities=["failure", "no_candidate"]).axes]
        self.assertEqual([title for title in titles if title],
                         ["(a) Failure rate, Standard", "(b) Failure rate, mine", "(c) No-candidate rate, mine"])

    def test_a_panel_of_zeros_is_left_out_and_named(self):
        figure = self.draw(quantities=["failure", "no_candidate"])
        self.assertIn("No-candidate rate of Standard: 0 in every cell, at most 2 %.", figure.texts[0].get_text().replace("\n", " "))
        never = TABLE.replace("mine,no_candidate,rate,0.01,0.005,0.15", "mine,no_candidate,rate,0,0,0.03")
        figure = self.draw(never, quantities=["failure", "no_candidate"])
        self.assertEqual(len([axes for axes in figure.axes if axes.get_title("left")]), 2)
        self.assertIn("No-candidate rate of Standard and mine: 0 in every cell, at most 3 %.",
                      figure.texts[0].get_text().replace("\n", " "))
        alone = self.draw(never, quantities=["no_candidate"])
        self.assertEqual([axes.get_title("left") for axes in alone.axes if axes.get_title("left")], ["No-candidate rate, Standard"])

    def test_equal_rates_have_equal_colours_in_all_panels_and_greater_ones_are_darker(self):
        same = TABLE.replace("mine,failure,rate,0.05,0.01", "mine,failure,rate,0.07,0.01")
        standard, mine = map(colors_of, self.draw(same).axes[:2])
        self.assertEqual(mine[0, 0], standard[1, 1])  # 7 % both
        brightness = [luminance(COLORS(i / 20)) for i in range(21)]
        self.assertEqual(brightness, sorted(brightness, reverse=True))  # a grey print says the same
        for color, texts in ((colors_of(axes), axes.texts) for axes in self.draw().axes[:1]):
            for text in texts:
                behind = luminance(color[tuple(map(int, text.get_position()))])
                self.assertEqual(text.get_color(), "white" if behind < 0.5 else "black")

    def test_rates_near_zero_are_not_painted_as_failures(self):
        scale = scale_of(select_rates(read_summary(self.write(TABLE)), ["no_candidate"]))
        self.assertEqual((scale.vmin, scale.vmax), (0, LEAST_TOP))

    def test_estimators_can_be_chosen_and_the_caption_says_n_and_interval(self):
        figure = self.draw(estimators=["mine"])
        self.assertEqual([axes.get_title("left") for axes in figure.axes if axes.get_title("left")],
                         ["Failure rate, mine"])
        caption = figure.texts[0].get_text().replace("\n", " ")
        self.assertEqual(caption, "Study demo; n = 0\u2013400 per cell; in each cell the rate in %, below it its exact 95 % "
                                  "(Clopper-Pearson) interval.")

    def test_the_caption_of_a_coverage_says_how_sharp_it_is(self):
        rows = "".join(f"demo,{c},{c},1,a,nees_coverage,rate,0.9,0.8,0.95,,10\n"
                       f"demo,{c},{c},1,a,sd_over_crb,median,{1.25 + c},1,9,,10\n" for c in range(3))
        caption = self.draw(HEADER + "\n" + rows, quantities=["nees_coverage"]).texts[0].get_text().replace("\n", " ")
        self.assertIn("stated sd 1.25 to 3.25 times the Cram\u00e9r-Rao bound", caption)

    def test_many_levels_go_into_more_rows_of_panels(self):
        lines = [f"demo,{c},{c},{y},{name},failure,rate,0.1,0.05,0.2,,10" for c in range(8) for y in (1, 2)
                 for name in ("a", "b", "c")]
        figure = self.draw(HEADER + "\n" + "\n".join(lines) + "\n")
        self.assertLessEqual(figure.get_size_inches()[0], 10)
        self.assertEqual(sum(bool(axes.get_title("left")) for axes in figure.axes), 3)

    def test_a_narrow_figure_is_split_into_pages_and_a_quantity_stays_together(self):
        levels = [(x, y) for x in range(3) for y in range(5)]
        names = [f"e{number}" for number in range(4)]
        lines = [f"demo,{c},{x},{y},{name},{quantity},rate,{0.1 + 0.2 * (name == 'e3')},0.05,0.4,,10" for c, (x, y) in enumerate(levels)
                 for name in names for quantity in ("failure", "success")]
        path = self.write(HEADER + "\n" + "\n".join(lines) + "\n")

        def titles_of_pages(*chosen):
            with sheet.use(sheet.Sheet(width=3.3)):
                pages = heat_map.draw_pages(read_summary(path), "noise", "sigma_px", ["failure", "success"], chosen)
            self.assertLessEqual(max(page.get_figheight() for page in pages), style.TALLEST + 1.5)
            self.assertEqual(len({bar.get_ylim() for page in pages for bar in page.axes if bar.get_ylabel() == "Rate (%)"}), 1)
            return [[axes.get_title("left") for axes in page.axes if axes.get_title("left")] for page in pages]
        self.assertEqual(titles_of_pages("e0", "e3"), [[f"({letter}) {quantity} rate, {name}" for letter, name in (("a", "e0"), ("b", "e3"))]
                                                       for quantity in ("Failure", "Success")])
        self.assertEqual(sum(map(len, titles_of_pages())), 8)
        code, out, err = self.run_main("--width", "3.3", "--estimators", "e0,e3", "--quantities", "failure,success", "--format", "pdf",
                                       text=pathlib.Path(path).read_text())
        self.assertEqual((code, err, [pathlib.Path(line).name for line in out.split()]), (0, "", ["map.pdf", "map_2.pdf"]))

    def test_the_command_writes_both_files_the_same_each_time(self):
        def run():
            code, out, err = self.run_main()
            self.assertEqual((code, err), (0, ""))
            return [pathlib.Path(path).read_bytes() for path in out.split()]
        first = run()
        self.assertTrue(first[0].startswith(b"\x89PNG") and first[1].startswith(b"%PDF"))
        self.assertEqual(run(), first)


class Refusals(HeatMapTest):
    def test_names_that_are_not_in_the_file(self):
        self.assert_refused(self.run_main(x="parallax"), "--x parallax", "allowed: noise, sigma_px")
        self.assert_refused(self.run_main(y="noise"), "--y noise", "two factors")
        self.assert_refused(self.run_main("--quantities", "fail"), "'fail'", "allowed: failure, no_candidate")
        self.assert_refused(self.run_main("--quantities", "parallax_deg"), "'parallax_deg' is a mean", "rates and scores only")
        self.assert_refused(self.run_main("--estimators", "rcme"), "--estimators rcme", "allowed: standard, mine")
        self.assert_refused(self.run_main("--estimators", ","), "--estimators")
        self.assert_refused(self.run_main("--where", "noise=uniform"), "noise=uniform", "student_t")
        self.assert_refused(self.run_main("--out", str(self.folder / "map.png")), "without .png")

    def test_tables_that_are_no_grid(self):
        three = TABLE.replace("sigma_px,", "sigma_px,f,", 1).replace(",standard,", ",a,standard,").replace(
            ",mine,", ",b,mine,").replace(",scene,", ",a,scene,")
        self.assert_refused(self.run_main(text=three), "f varies too", "--where f=a")
        self.assert_refused(self.run_main(text=TABLE.replace("3,gaussian,0.5", "3,gaussian,1")), "second failure",
                            "noise = gaussian, sigma_px = 1")
        self.assert_refused(self.run_main(text=TABLE.replace("0.30,0.10,0.50", "0.30,0.40,0.50")), "line 2", "interval")

    def test_help_teaches_with_an_example(self):
        self.assert_help_shows("rcme plot heat_map summary.csv --x outlier_ratio --y sigma_px --out heat_map")


if __name__ == "__main__":
    unittest.main()
