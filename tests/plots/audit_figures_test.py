#!/usr/bin/python3
"""Tests of the figures of plots/audit.py; run as: /usr/bin/python3 tests/plots/audit_figures_test.py"""

import math
import pathlib
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
PLOTS = HERE.parents[1] / "plots"
sys.path[:0] = [str(PLOTS), str(HERE)]

from audit_figures.look import series_look  # noqa: E402
from fake_audit import SIGMAS, claim, coverage, evidence, target  # noqa: E402
from matplotlib.collections import PolyCollection  # noqa: E402
from audit_drawn import bands_of, bars_of, caption_of, draw, fake_figure, file_with, lines_of, marks_of, texts_of  # noqa: E402


class Curves(unittest.TestCase):
    def test_values_intervals_range_and_nominal_are_those_of_the_file(self):
        rows = [evidence([target("bias", "mean", value, 1, 0.9, 1.2, half)], num_points=n)
                for n, value, half in ((8, 1.0, 0.05), (30, 1.5, 0.1), (20, 1.15, 0.2))]  # not in order of x
        axes, = draw(file_with(claim("mle.bias", rows, figure_x="num_points"))).axes
        self.assertEqual(lines_of(axes, "_series"), [[(8, 1.0), (20, 1.15), (30, 1.5)]])
        self.assertEqual(bars_of(axes), [[[8, 0.95], [8, 1.05]], [[20, 1.15 - 0.2], [20, 1.15 + 0.2]],
                                         [[30, 1.4], [30, 1.6]]])
        self.assertEqual(bands_of(axes), [(0.9, 1.2)])
        self.assertEqual([ys for _, ys in lines_of(axes, "_nominal")[0]], [1, 1])
        self.assertEqual([marks_of(axes, "_" + verdict) for verdict in ("holds", "undecided", "does not hold")],
                         [[(8, 1.0)], [(20, 1.15)], [(30, 1.5)]])
        self.assertEqual((axes.get_xscale(), axes.get_xlabel(), axes.get_ylabel()), ("linear", "Num points", "Bias"))

    def test_of_a_coverage_row_alpha_005_is_strong_and_the_others_pale(self):
        rows = [evidence(coverage(0.1), sigma_px=s, num_points=8) for s in SIGMAS]
        figure = draw(file_with(claim("inlier.x", rows, figure_x="sigma_px")))
        axes, = figure.axes
        by_alpha = {one["quantity"]: one["measured"] for one in rows[0]["targets"]}
        self.assertEqual({y for _, y in lines_of(axes, "_series")[0]}, {by_alpha["coverage at alpha 0.05"]})
        self.assertEqual([points[0][1] for points in lines_of(axes, "_pale")],
                         [by_alpha[f"coverage at alpha {alpha}"] for alpha in ("0.5", "0.2", "0.1", "0.01")])
        self.assertEqual(sorted(points[0][1] for points in lines_of(axes, "_nominal")), [0.5, 0.8, 0.9, 0.95, 0.99])
        self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("log", "logit"))
        figure.canvas.draw()
        self.assertLessEqual({"50", "80", "90", "95", "99"}, {label.get_text() for label in axes.get_yticklabels()})
        self.assertIn("pale: the other significance levels", caption_of(figure))

    def test_another_condition_gives_series_that_differ_without_colour(self):
        axes = fake_figure("inlier").axes[2]
        series = [line for line in axes.lines if not line.get_label().startswith("_")]
        self.assertEqual([line.get_label() for line in series], ["num points = 8", "num points = 20", "num points = 100"])
        self.assertEqual(len({repr(series_look(position)[1]) for position in range(5)}), 5)
        self.assertEqual(axes.figure.legends[1].get_texts()[1].get_text(), "20")

    def test_a_condition_that_x_determines_makes_no_series(self):
        rows = [evidence([target("bias", "mean", 1, 1, 0.9, 1.1)], sigma_px=s, sigma_rad=f"{s}e-3") for s in SIGMAS]
        axes, = draw(file_with(claim("mle.bias", rows, figure_x="sigma_px"))).axes
        self.assertEqual(len(lines_of(axes, "_series")), 1)

    def test_too_many_series_become_panels(self):
        figure = fake_figure("mle")
        self.assertEqual(len(figure.axes), 4)
        self.assertIn("outlier ratio = 0.3", texts_of(figure))

    def test_quantities_of_different_size_have_panels_of_their_own(self):
        first, second = fake_figure("sigma_p").axes[:2]
        self.assertEqual(second.get_ylabel(), "Condition number of\nSigma_p")
        self.assertLess(first.get_ylim()[1], 2)
        self.assertIn("standard deviation, rotation about x, scene = cube", [line.get_label() for line in first.lines])

    def test_a_range_that_follows_x_is_a_band_that_follows_x(self):
        band, = [one for one in fake_figure("mle").axes[3].collections if isinstance(one, PolyCollection)]
        corners = {tuple(corner) for path in band.get_paths() for corner in path.vertices}
        self.assertLessEqual({(8, 0.97 * 3), (8, 1.03 * 3), (1000, 0.97 * 995), (1000, 1.03 * 995)}, corners)

    def test_words_stand_side_by_side_without_a_line(self):
        axes = fake_figure("sigma_p").axes[2]
        self.assertEqual([label.get_text() for label in axes.get_xticklabels()],
                         ["cube", "random_\npoints", "wall", "corridor"])
        line, = [line for line in axes.lines if line.get_label() == "_series"]
        self.assertEqual((list(line.get_xdata()), line.get_linestyle()), ([0, 1, 2, 3], "None"))

    def test_a_zero_has_a_place_on_a_logarithmic_axis_and_0_and_1_on_a_logit_axis(self):
        axes = fake_figure("inlier").axes[3]
        x = [axes.transData.transform((float(s), 0.5))[0] for s in ("0", *SIGMAS)]
        self.assertEqual(x, sorted(x))
        self.assertTrue(all(math.isfinite(one) for one in x))
        self.assertGreater(x[1] - x[0], 10)
        self.assertEqual(lines_of(axes, "_series")[0][-1], (5.0, axes.get_ylim()[1]))
        self.assertEqual([axes.yaxis.get_major_formatter()(end) for end in axes.get_ylim()], ["0", "100"])

    def test_gaps_crosses_and_arrows_stand_for_what_is_not_finite(self):
        figure = fake_figure("failure")
        axes = figure.axes[0]
        self.assertEqual([x for x, _ in lines_of(axes, "_series")[0]], [0, 0.2, 0.6, 0.8])
        self.assertEqual(marks_of(axes, "_missing"), [(0.4, 0)])
        top = axes.get_ylim()[1]
        self.assertEqual(marks_of(axes, "_cut"), [(0.6, top), (0.8, top)])
        self.assertLess(top, 10)  # an interval up to 9e9 does not flatten the rest
        self.assertIn("arrow at a frame: the interval goes on; cross at a frame", caption_of(figure))

    def test_the_noise_up_to_which_the_claim_holds_is_marked(self):
        figure = fake_figure("inlier")
        self.assertEqual([{x for x, _ in points} for points in lines_of(figure.axes[2], "_limit")], [{0.5}])
        self.assertEqual(lines_of(figure.axes[0], "_limit"), [])
        self.assertIn("\u25d0 holds in the small-noise limit only: sigma \u2264 0.5 px", texts_of(figure))

    def test_one_level_only_is_drawn_as_a_list(self):
        axes, = draw(file_with(claim("inlier.x", [evidence(coverage(0), sigma_px="1")], figure_x="sigma_px"))).axes
        self.assertFalse(axes.yaxis.get_visible())
        self.assertEqual(len(bars_of(axes)), 5)

    def test_values_far_apart_are_on_a_logarithmic_axis_if_all_are_positive(self):
        far, jumps = fake_figure("entropy").axes[4:6]
        self.assertEqual((far.get_yscale(), jumps.get_yscale()), ("log", "linear"))


class Forests(unittest.TestCase):
    def test_each_target_is_a_line_with_its_words_and_numbers(self):
        row = evidence([target("exponent", "mean", 1.02, 1, 0.9, 1.1, 0.04), target("slope", "mean", 2, 1, 0.9, 1.1, 0.1)],
                       sigma_px="1")
        figure = draw(file_with(claim("complexity.x", [row], "does not hold")))
        axes, = figure.axes
        (first, y), = marks_of(axes, "_holds")
        (second, lower_y), = marks_of(axes, "_does not hold")
        self.assertEqual((first, second), (1.02, 2))
        self.assertLess(y, lower_y)  # y runs downwards
        self.assertEqual(bars_of(axes), [[[0.98, y], [1.02 + 0.04, y]], [[1.9, lower_y], [2.1, lower_y]]])
        self.assertEqual([bar[0][0] for bar in bars_of(axes, "_bound")], [0.9, 1.1, 0.9, 1.1])
        self.assertEqual([bar[0][0] for bar in bars_of(axes, "_nominal")], [1, 1])
        for text in ("exponent", "slope", "1.020 [0.980, 1.060]", "2.00 [1.90, 2.10]", "sigma = 1 px", "\u2713", "\u2717"):
            self.assertIn(text, texts_of(figure))

    def test_rates_and_sizes_have_axes_of_their_own_and_zeros_fit_with_small_ones(self):
        figure = fake_figure("complexity")
        self.assertEqual([axes.get_xlabel() for axes in figure.axes], ["Num points", "", "Rate (%)", "", ""])
        for heading in ("exponent of the time in N", "share of the refinement", "estimator = rcme", "0 [0, 0]"):
            self.assertIn(heading, texts_of(figure))

    def test_only_conditions_that_vary_are_written_and_the_others_once(self):
        figure = fake_figure("mu")
        self.assertEqual(texts_of(figure).count("sigma = 1 px"), 2)

    def test_the_bound_that_decides_is_in_the_panel_however_far(self):
        axes = fake_figure("mu").axes[2]
        self.assertEqual([bar[0][0] for bar in bars_of(axes, "_bound")], [0.9])
        self.assertLess(axes.get_xlim()[0], 0.63)
        self.assertGreater(axes.get_xlim()[1], 0.9)

    def test_missing_values_and_open_ends_are_said(self):
        figure = fake_figure("failure")
        self.assertIn("\u2013", texts_of(figure))
        self.assertIn("3.2 [1.1, \u221e)", texts_of(figure))
        self.assertIn("no value", [text.get_text() for axes in figure.axes for text in axes.texts])

    def test_a_claim_without_a_value_is_named_below_and_takes_no_panel(self):
        empty, full = claim("mle.none", []), claim("mle.bias", [evidence([target("bias", "mean", 1, 1, 0.9, 1.1)])])
        figure = draw(file_with(empty, full))
        self.assertNotIn("no evidence in the file", texts_of(figure))
        self.assertTrue(caption_of(figure).endswith("nothing measured for mle.none."), caption_of(figure))
        self.assertEqual(texts_of(draw(file_with(empty))).count("no evidence in the file"), 1)

    def test_an_open_side_of_the_allowed_range_does_not_flatten_the_values(self):
        rows = [evidence([target("difference", "mean", value, 0, -1, 0, half=0.001)], outlier_ratio=ratio)
                for ratio, value in ((0.2, -0.001), (0.8, 0.002))]
        low, high = draw(file_with(claim("mle.x", rows, figure_x="outlier_ratio"))).axes[0].get_ylim()
        self.assertLess(high - low, 0.02)
        self.assertTrue(low < -0.002 and high > 0.003, (low, high))


class Roc(unittest.TestCase):
    def test_the_curve_joins_rates_at_equal_mu_and_marks_the_default(self):
        def models(name, *rates):
            return evidence([target(f"accepted at {mu}", "rate", rate, half=0.01, threshold=mu) for mu, rate in rates],
                            models=name)
        rows = [models("contaminated", (-3, 0.4), (-3.5, 0.2), (-6, 0.01)), models("good", (-6, 0.3), (-3, 0.95), (-3.5, 0.9))]
        figure = draw(file_with(claim("mu.x.roc", rows, "measured")))
        axes, = figure.axes
        self.assertEqual(lines_of(axes, "_roc"), [[(0.01, 0.3), (0.2, 0.9), (0.4, 0.95)]])
        self.assertEqual(marks_of(axes, "_default mu"), [(0.2, 0.9)])
        self.assertEqual(axes.texts[0].get_text(), "mu = \u22123.5")
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()),
                         ("Contaminated models accepted (%)", "Good models accepted (%)"))
        self.assertIn("nearest to the default of its reading", caption_of(figure))

    def test_further_conditions_give_several_curves(self):
        labels = [line.get_label() for line in fake_figure("mu").axes[1].lines]
        self.assertLessEqual({"scene = cube", "scene = wall"}, set(labels))


if __name__ == "__main__":
    unittest.main()
