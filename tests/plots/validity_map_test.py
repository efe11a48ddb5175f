#!/usr/bin/python3
"""Tests of plots/validity_map.py; run as: /usr/bin/python3 tests/plots/validity_map_test.py"""

import pathlib
import unittest
from unittest import mock

from plot_test_case import PLOTS, PlotTestCase

import validity_map
from common import sheet
from matplotlib.collections import LineCollection

MAP_HEADER = ("sigma_px,num_points,baseline_m,median_parallax_deg,conditioning,median_conditioning,quantity,n,"
              "num_covered,coverage,lower,upper")
# Coverages and bounds with no relation to the counts: a script that recomputed any of them would be seen. Lines are not
# in the order of an axis.
MAP = MAP_HEADER + """
0.5,8,0.5,4.26,all,0.001,f,400,1,0.787,0.70,0.80
0.1,8,0.5,4.26,all,0.001,f,400,1,0.906,0.90,0.91
0.1,100,0.5,4.26,all,0.001,f,400,1,0.951,0.94,0.96
0.5,100,0.5,4.26,all,0.001,f,390,1,0.942,0.93,0.95
0.1,8,0.5,4.26,exact_lower,0.001,f,130,1,0.61,0.60,0.63
0.5,8,0.5,4.26,exact_lower,0.001,f,130,1,0.41,0.40,0.44
0.1,8,0.5,4.26,exact_upper,0.001,f,130,1,0.93,0.92,0.94
0.5,8,0.5,4.26,exact_upper,0.001,f,130,1,0.92,0.91,0.95
"""
REFERENCE_HEADER = "sigma_px,num_points,baseline_m,quantity,covariance,num_samples,n,num_covered,coverage,lower,upper"
REFERENCE = REFERENCE_HEADER + """
0.5,8,0.5,f,first_order_at_estimate,20,200,1,0.5,0.4,0.6
0.1,8,0.5,f,first_order_at_estimate,20,200,1,0.8,0.7,0.9
0.5,8,0.5,f,monte_carlo_at_truth,20,200,1,0.94,0.93,0.95
0.1,8,0.5,f,monte_carlo_at_truth,20,200,1,0.95,0.94,0.97
"""
FIGURES = ("validity_map", "validity_conditioning", "validity_reference")


def texts_of(axes):
    """{(x, y) of the cell: its printed number}."""
    return {(round(text.get_position()[0] - 0.5), int(text.get_position()[1])): text.get_text()
            for text in axes.texts if "." in text.get_text() and len(text.get_text()) < 6}


class ValidityMapTest(PlotTestCase):
    script, given = validity_map, ["validity_map.csv", "validity_reference.csv"]

    def write_tables(self, coverages=MAP, reference=REFERENCE):
        """The path of the first."""
        self.write(reference, self.given[1])
        return self.write(coverages)

    def read(self, text=MAP):
        path = self.write_tables(text)
        return path, validity_map.read_coverages(path, validity_map.MAP_KEYS, ["median_parallax_deg"])

    def run_main(self, *arguments, coverages=MAP, reference=REFERENCE):
        self.write_tables(coverages, reference)
        return self.run_script(self.folder, *arguments)


class WrittenFiles(ValidityMapTest):
    def test_three_figures_beside_the_tables_or_elsewhere_with_the_same_bytes(self):
        code, out, err = self.run_main()
        self.assertEqual((code, err), (0, ""))
        paths = [str(self.folder / f"{name}.{kind}") for name in FIGURES for kind in ("png", "pdf")]
        self.assertEqual(out.split(), paths)
        first = [pathlib.Path(path).read_bytes() for path in paths]
        self.assertTrue(all(png.startswith(b"\x89PNG") and len(png) > 10_000 for png in first[::2]))
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        with mock.patch("time.time", return_value=2e9):
            self.assertEqual(self.run_main("--out", str(elsewhere))[0], 0)
        self.assertEqual([(elsewhere / pathlib.Path(path).name).read_bytes() for path in paths], first)

    def test_places_that_are_not_there(self):
        self.assert_refused(self.run_main("--out", str(self.folder / "no")), "there is no folder", "no")
        self.assert_refused(self.run_main("--colour", "red"), "--colour", "--help")


class DrawnValues(ValidityMapTest):
    def test_cells_show_the_coverages_of_the_file_with_noise_to_the_right_and_points_upwards(self):
        axes, = validity_map.draw_map(*self.read()).axes
        self.assertEqual(texts_of(axes), {(0, 0): "90.6", (1, 0): "78.7", (0, 1): "95.1", (1, 1): "94.2"})
        self.assertEqual([label.get_text() for label in axes.get_xticklabels()], ["0.1", "0.5"])
        self.assertEqual([label.get_text() for label in axes.get_yticklabels()], ["8", "100"])
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("Noise sigma (px)", "Points m"))
        self.assertIn("baseline 0.5 m, parallax 4.3\u00b0", [text.get_text() for text in axes.texts])

    def test_a_study_has_its_conditions_in_words_no_reference_and_blank_cells_where_there_is_no_sample(self):
        study = MAP.replace("baseline_m", "condition").replace(",0.5,4.26", ',"scene = room, outlier_ratio = 0.2",4.26')
        none = study.split("\n")[2].split(",4.26")[0] + ",4.26,all,,pose,0,0,,,\n"
        self.write_tables(study + none)
        (self.folder / "validity_reference.csv").unlink()
        code, out, _ = self.run_script(self.folder)
        self.assertEqual((code, [pathlib.Path(path).stem for path in out.split()[::2]]), (0, list(FIGURES[:2])))
        path, rows = self.read(study + none)
        axes, = validity_map.draw_map(path, rows).axes  # a quantity without any sample has no panels
        self.assertIn("scene = room, outlier_ratio = 0.2, parallax 4.3\u00b0",
                      [text.get_text().replace("\n", " ") for text in axes.texts])

    def test_more_conditions_than_fit_go_to_another_figure(self):
        more = "".join(f"0.1,8,{baseline},4.26,all,0.001,f,400,1,0.9,0.8,1\n" for baseline in (1, 2, 3, 4))
        pages = validity_map.pages_of(self.read(MAP + more)[1])
        self.assertEqual([validity_map.conditions_of(page) for page in pages],
                         [[f"baseline {b} m" for b in ("0.5", "1", "2", "3")], ["baseline 4 m"]])

    def test_a_column_of_paper_is_no_taller_than_a_page(self):
        with sheet.use(sheet.Sheet(width=3.3)):
            path = str(PLOTS.parent / "results" / "validity_map" / "validity_map.csv")
            pages = validity_map.pages_of(validity_map.read_coverages(path, validity_map.MAP_KEYS, ["median_parallax_deg"]))
            heights = [validity_map.draw_map(path, page).get_figheight() for page in pages]
        self.assertEqual(len(pages), 4)
        self.assertLess(max(heights), 9)

    def test_borders_run_between_the_cells_on_either_side_of_a_level(self):
        for upper_right in ("0.942", "0.94"):  # a coverage at a level is on its upper side
            axes, = validity_map.draw_map(*self.read(MAP.replace("0.942", upper_right))).axes
            borders = {line.get_linewidth(): [] for line in axes.lines}
            for line in axes.lines:
                borders[line.get_linewidth()].append(sorted(zip(*line.get_data())))
            self.assertEqual(borders[validity_map.CONTOURS[0.94]["linewidth"]], [[(0, 1), (1, 1)], [(1, 1), (2, 1)]])
            self.assertEqual(borders[validity_map.CONTOURS[0.90]["linewidth"]], [[(1, 0), (1, 1)], [(1, 1), (2, 1)]])

    def test_every_coverage_has_a_shade(self):
        for coverage in (0, 0.5, 0.8999, 0.9, 0.94, 0.95, 0.96, 1):
            self.assertTrue(validity_map.shade_of(coverage))
        self.assertNotEqual(validity_map.shade_of(0.8999), validity_map.shade_of(0.9))
        self.assertNotEqual(validity_map.shade_of(0.9399), validity_map.shade_of(0.94))

    def test_captions_say_n_and_the_interval(self):
        caption = validity_map.draw_map(*self.read()).texts[0].get_text().replace("\n", " ")
        self.assertIn("n = 390\u2013400 per cell", caption)
        self.assertIn("\u00b18.7 points", caption)  # 0.787 - 0.70
        caption = validity_map.draw_conditioning(*self.read()).texts[0].get_text().replace("\n", " ")
        self.assertIn("m = 8 points, baseline 0.5 m", caption)
        self.assertIn("n = 130 per point", caption)

    def test_conditioning_shows_the_thirds_of_the_least_number_of_points(self):
        axes, = validity_map.draw_conditioning(*self.read()).axes
        lines = {line.get_label(): list(zip(*line.get_data())) for line in axes.lines if " third" in line.get_label()}
        self.assertEqual(lines, {"without noise: worst third": [(0.1, 0.61), (0.5, 0.41)],
                                 "without noise: best third": [(0.1, 0.93), (0.5, 0.92)]})

    def test_the_reference_shows_its_coverages_with_their_intervals(self):
        self.write_tables()
        path = str(self.folder / "validity_reference.csv")
        rows = validity_map.read_coverages(path, validity_map.REFERENCE_KEYS, ["num_samples"])
        axes, = validity_map.draw_reference(path, rows).axes
        drawn = {line.get_label(): [(round(x), y) for x, y in zip(*line.get_data())] for line in axes.lines}
        self.assertEqual(drawn["first order, at the estimate"], [(1, 0.5), (0, 0.8)])
        self.assertEqual(drawn["Monte Carlo, at the truth"], [(1, 0.94), (0, 0.95)])
        bars = [[y for _, y in segment] for lines in axes.collections if isinstance(lines, LineCollection)
                for segment in lines.get_segments()]
        self.assertEqual(bars, [[0.4, 0.6], [0.7, 0.9], [0.93, 0.95], [0.94, 0.97]])


class Refusals(ValidityMapTest):
    def test_files_that_are_not_the_tables(self):
        self.assert_refused(self.run_main(coverages=""), "validity_map.csv", "has no column sigma_px", "rcme map --out")
        self.assert_refused(self.run_main(coverages=MAP_HEADER), "validity_map.csv", "no rows")
        self.assert_refused(self.run_main(reference=REFERENCE[:-12]), "validity_reference.csv", "cut off")
        self.assert_refused(self.run_main(reference=MAP), "validity_reference.csv", "has no column covariance")
        (self.folder / "validity_map.csv").unlink()
        self.assert_refused(self.run_script(self.folder), "cannot be read")

    def test_values_that_cannot_be_drawn(self):
        self.assert_refused(self.run_main(coverages=MAP.replace("0.787,0.70", "nan,0.70")), "line 2", "coverage")
        self.assert_refused(self.run_main(coverages=MAP.replace("0.787,0.70", "0.6,0.70")), "line 2", "interval")
        self.assert_refused(self.run_main(coverages=MAP.replace("400,1,0.787", "0,0,0.787")), "line 2", "n must be")
        self.assert_refused(self.run_main(coverages=MAP.replace("0.5,8,0.5,4.26,all", "0,8,0.5,4.26,all")), "line 2",
                            "sigma_px")
        self.assert_refused(self.run_main(coverages=MAP + MAP.split("\n")[1] + "\n"), "line 10", "twice")
        self.assert_refused(self.run_main(coverages=MAP.replace(",f,", ",g,")), "quantity", "f, pose")
        self.assert_refused(self.run_main(coverages=MAP_HEADER + "\n0.5,8,0.5,,all,,f,0,0,,,\n"), "no cell has a sample")

    def test_help_teaches_with_an_example(self):
        self.assert_help_shows("rcme plot validity_map map --out figures")


if __name__ == "__main__":
    unittest.main()
