#!/usr/bin/python3
"""Tests of the surface of plots/tune.py; run as: /usr/bin/python3 tests/plots/tune_surface_test.py"""

import math
import unittest

from tune_drawn import FURTHER, GRID, TuneTest, caption_of, legend_of, panels_of, points_of

import fake_tune as fake
import numpy as np
from rates.cells import luminance
from matplotlib.colors import to_rgb
from rates.rate_bands import BORDERS, TARGET, color_of
from tuning_figures.marks import LevelAxis
from tuning_figures.surface import Surface, draw_surface, grid_of


class TheSurface(TuneTest):
    def test_the_grid_holds_the_rates_of_the_file_in_order_of_the_numbers(self):
        value = fake.tune(GRID, others=[])
        surface = Surface(self.read(value), [])
        rates = {tuple(one["levels"]): one["refusal"]["value"] for one in value["settings"]}
        expected = [[rates[mu, rest] for mu in ("0", "1", "2")] for rest in ("0.5", "2")]
        self.assertEqual(grid_of(surface, surface.rows, "refusal").tolist(), expected)

    def test_a_band_has_the_colour_of_its_rates_and_the_targets_line_is_at_its_level(self):
        value = fake.tune(GRID, others=[], target=fake.target(at_most=0.25, max_refusal=None))
        for one in value["settings"]:
            one["failure"] = fake.rate(0.1 + 0.2 * float(one["levels"][0]), 0.001)  # 0.1, 0.3, 0.5 whatever lambda is
        failure = panels_of(draw_surface(self.read(value)))[0]
        line = next(lines for lines in failure.collections if len(lines.get_edgecolor()) and
                    tuple(lines.get_edgecolor()[0][:3]) == to_rgb(TARGET))
        self.assertTrue(all(abs(x - 0.75) < 1e-9 for x in line.get_paths()[0].vertices[:, 0]))
        for words, x in (("25 %", 0.75), ("20", 0.5)):  # the target's and a border's
            label = next(text for text in failure.texts if text.get_text() == words)
            self.assertAlmostEqual(label.get_position()[0], x, places=6)
        band = next(part for part in failure.collections if len(part.get_facecolor()) and part.get_paths()
                    and part.get_paths()[0].contains_point((0.2, 1)))
        self.assertEqual(tuple(band.get_facecolor()[0]), color_of(0.14))
        brightness = [luminance(color_of((low + high) / 2)) for low, high in zip(BORDERS, BORDERS[1:])]
        self.assertEqual(brightness, sorted(brightness, reverse=True))  # a grey print says the same

    def test_tuned_certified_and_other_settings_stand_at_their_levels(self):
        others = [fake.other("standard", "", None, 0.4, 0), fake.other("rcme", "as is", ["1.5", "2"], 0.1, 0.1)]
        value = fake.tune(GRID, others=others, tuned=fake.chosen(fake.tune(GRID)["settings"][2]))
        for number, one in enumerate(value["settings"]):
            one["is_certified"] = number in (1, 4)
        figure = draw_surface(self.read(value))
        for axes in panels_of(figure):
            self.assertEqual(points_of(axes, "_the tuned setting"), [(1, 2)])
            self.assertEqual(sorted(points_of(axes, "_certified")), [(0, 0.5), (2, 2)])
            self.assertEqual(points_of(axes, "_RCME (as is)"), [(1.5, 2)])
            self.assertEqual((points_of(axes, "_beyond"), points_of(axes, "_Standard")), ([], []))
        self.assertEqual(legend_of(figure), ["tuned: mu = 1 nats, lambda = 2", "certified setting",
                                             "target: failure \u2264 5 %, refusal \u2264 50 %", "RCME (as is)"])
        self.assertIn("Without a place among these levels: Standard.", caption_of(figure))
        self.assertIn(fake.target()["words"], caption_of(figure))

    def test_what_lies_beyond_the_levels_stands_at_the_edge_with_an_arrow_and_the_legend_says_where(self):
        others = [fake.other("rcme", "", ["-inf", "3"], 0.1, 0.1)]
        figure = draw_surface(self.read(fake.tune(GRID, others=others)))
        for axes in panels_of(figure):
            self.assertEqual(points_of(axes, "_RCME"), [(0, 2)])
            carets = [line for line in axes.lines if line.get_label() == "_beyond"]
            self.assertEqual([line.get_marker() for line in carets], [4, 6])  # to the left, upwards
            mark = next(line for line in axes.lines if line.get_label() == "_RCME")
            place = mark.get_transform().transform((0, 2))
            self.assertTrue(axes.get_window_extent().contains(*place))
        self.assertIn("RCME; arrow: at mu = \u2212\u221e nats, lambda = 3", legend_of(figure))

    def test_marks_of_one_place_do_not_cover_each_other(self):
        others = [fake.other(label, "", ["1", "2"], 0.1, 0.1) for label in ("rcme", "prcme", "standard")]
        axes = panels_of(draw_surface(self.read(fake.tune(GRID, others=others))))[0]
        places = [line.get_transform().transform((1, 2)) for line in axes.lines
                  if line.get_label() in ("_RCME", "_pRCME", "_Standard")]
        shifts = sorted(72 * place[0] / axes.figure.dpi for place in places)
        self.assertTrue(all(after - before > 6 for before, after in zip(shifts, shifts[1:])))

    def test_further_options_are_rows_of_panels_and_can_be_chosen(self):
        others = [fake.other("rcme", "", ["1", "2", "yes"], 0.1, 0.1)]
        tune = self.read(fake.tune(FURTHER, others=others))
        titles = [axes.get_title("left") for axes in panels_of(draw_surface(tune))]
        self.assertEqual([title.replace("\n", ", ") for title in titles],
                         ["(a) Failure rate, rank aware = no", "(b) Refusal rate, rank aware = no",
                          "(c) Failure rate, rank aware = yes", "(d) Refusal rate, rank aware = yes"])
        self.assertEqual([points_of(axes, "_RCME") for axes in panels_of(draw_surface(tune))],
                         [[], [], [(1, 2)], [(1, 2)]])
        figure = draw_surface(tune, ["rank_aware=no"])
        self.assertEqual(len(panels_of(figure)), 2)
        self.assertIn("Rank aware = no.", caption_of(figure))
        self.assertIn("Without a place among these levels: RCME", caption_of(figure))
        curve = draw_surface(tune, ["lambda=0.50", "rank_aware=yes"])
        self.assertEqual(panels_of(curve)[0].get_xlabel(), "mu (nats)")
        self.assertIn("_RCME", [line.get_label() for line in panels_of(draw_surface(tune, ["lambda=2"]))[2].lines])

    def test_false_refusals_have_a_panel_where_the_target_is_about_them(self):
        figure = draw_surface(self.read(fake.tune(GRID, kind="false_refusal")))
        self.assertEqual([axes.get_title("left") for axes in panels_of(figure)],
                         ["(a) Failure rate", "(b) Refusal rate", "(c) False-refusal rate"])
        self.assertIn("target: false refusal \u2264 5 %", legend_of(figure))

    def test_one_option_gives_curves_with_bands_and_bars(self):
        value = fake.tune([fake.option("mu", ("2", "0", "1"))], tuned=None,
                          others=[fake.other("rcme", "", ["9"], 0.31, 0.1)])
        value["settings"][1]["failure"] = fake.rate(None)
        figure = draw_surface(self.read(value))
        failure, refusal = panels_of(figure)
        by_mu = {float(one["levels"][0]): one for one in value["settings"]}
        self.assertEqual(points_of(refusal, "fresh trials"), [(mu, by_mu[mu]["refusal"]["value"]) for mu in (0, 1, 2)])
        self.assertTrue(math.isnan(points_of(failure, "fresh trials")[0][1]))
        self.assertEqual(points_of(failure, "_RCME"), [(2, 0.31)])
        self.assertEqual([line.get_ydata()[0] for line in failure.lines if line.get_label() == "_target"], [0.05])
        band = {tuple(map(float, point)) for point in refusal.collections[0].get_paths()[0].vertices}
        self.assertLessEqual({(mu, by_mu[mu]["refusal"][end]) for mu in (0, 1, 2) for end in ("lower", "upper")}, band)
        self.assertIn("no setting met it", caption_of(figure))

    def test_words_stand_side_by_side(self):
        value = fake.tune([fake.option("scoring", ("msac", "entropy", "support"))],
                          others=[fake.other("rcme", "", ["entropy"], 0.3, 0.1),
                                  fake.other("x", "", ["other"], 0.3, 0.1)])
        failure = panels_of(draw_surface(self.read(value)))[0]
        self.assertEqual([label.get_text() for label in failure.get_xticklabels()], ["msac", "entropy", "support"])
        self.assertEqual(points_of(failure, "fresh trials"),
                         [(place, one["failure"]["value"]) for place, one in enumerate(value["settings"])])
        self.assertEqual((points_of(failure, "_RCME"), points_of(failure, "_x")), ([(1, 0.3)], []))

    def test_far_spread_levels_stand_evenly_and_others_between_them(self):
        axis = LevelAxis(self.read(fake.tune([fake.option("mu", ("100", "0", "1", "2"))])).options[0])
        self.assertEqual((axis.levels, axis.places()), (["0", "1", "2", "100"], [0, 1, 2, 3]))
        self.assertEqual([axis.locate(level) for level in ("0.5", "51", "200", "-1")],
                         [(0.5, 0), (2.5, 0), (3, 1), (0, -1)])

    def test_levels_too_close_for_ticks_of_their_own_share_them(self):
        def axis_of(levels):
            return LevelAxis(self.read(fake.tune([fake.option("mu", levels)], others=[], tuned=None)).options[0])
        for levels in (("1",), fake.MUS, [f"{number / 7:.3f}" for number in range(200)]):
            self.assertEqual(list(axis_of(levels).ticks()), axis_of(levels).places())
        many = axis_of([f"{number / 7:.3f}" for number in range(1500)]).ticks()
        self.assertLess(len(many), 310)
        self.assertEqual(many[0], 0)
        self.assertTrue(all(0.3 < gap < 1 for gap in np.diff(many)))  # of a range of 214
        figure = draw_surface(self.read(fake.tune([fake.option("mu", [f"{number / 50}" for number in range(1500)])])))
        self.assertLess(len(panels_of(figure)[0].xaxis.get_minorticklocs()), 310)

    def test_rates_without_trials_are_hatched(self):
        value = fake.tune(GRID)
        for one in value["settings"]:
            one["refusal"] = fake.rate(None)
        figure = draw_surface(self.read(value))
        failure, refusal = panels_of(figure)
        self.assertFalse([part for part in refusal.collections if part.get_paths()])
        self.assertEqual(refusal.patch.get_hatch(), "///")
        self.assertIn("Hatched: no trials (n = 0)", caption_of(figure))


if __name__ == "__main__":
    unittest.main()
