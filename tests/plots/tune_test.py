#!/usr/bin/python3
"""Tests of plots/tune.py; run as: /usr/bin/python3 tests/plots/tune_test.py"""

import contextlib
import io
import json
import math
import pathlib
import sys
import tempfile
import unittest
import warnings

PLOTS = pathlib.Path(__file__).resolve().parents[2] / "plots"
sys.path.insert(0, str(PLOTS))

import fake_tune as fake  # noqa: E402
import numpy as np  # noqa: E402
import tune as script  # noqa: E402
from rates.cells import luminance  # noqa: E402
from matplotlib.colors import to_rgb  # noqa: E402
from rates.rate_bands import BORDERS, TARGET, color_of  # noqa: E402
from tuning_figures.front import draw_front  # noqa: E402
from tuning_figures.marks import LevelAxis  # noqa: E402
from tuning_figures.roc import draw_roc, kept_apart  # noqa: E402
from tuning_figures.surface import Surface, draw_surface, grid_of  # noqa: E402
from tuning_figures.tune_file import read_tune  # noqa: E402

GRID = [fake.option("mu", ("0", "1", "2"), "nats"), fake.option("lambda", ("2", "0.5"))]  # levels in any order
FURTHER = [*GRID, fake.option("rank_aware", ("no", "yes"))]
MANY = [*GRID, fake.option("batch", tuple("abcdefg"))]  # more panels than fit
warnings.simplefilter("error")  # a layout that was given up is a fault


def points_of(axes, label):
    """The places of all lines with that label, in their order."""
    return [tuple(map(float, point)) for line in axes.lines if line.get_label() == label for point in line.get_xydata()]


def bars_of(axes, color):
    """The ends of the bars of that colour."""
    return {tuple(tuple(round(float(value), 9) for value in end) for end in segment)
            for bars in axes.collections if hasattr(bars, "get_segments") for segment in bars.get_segments()
            if len(segment) == 2 and tuple(bars.get_color()[0][:3]) == to_rgb(color)}


def legend_of(figure):
    legends = figure.legends + [axes.get_legend() for axes in figure.axes if axes.get_legend()]
    return [text.get_text().replace("\n", " ") for legend in legends for text in legend.get_texts()]


def caption_of(figure):
    return figure.texts[0].get_text().replace("\n", " ")


def panels_of(figure):
    return [axes for axes in figure.axes if axes.get_title("left")]


class TuneTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def write(self, value):
        path = self.folder / "tune.json"
        path.write_text(value if isinstance(value, str) else json.dumps(value))
        return str(path)

    def read(self, value):
        return read_tune(self.write(value))

    def run_main(self, value, *arguments, out="figure"):
        stdout, stderr = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(stdout), contextlib.redirect_stderr(stderr):
            code = script.main([self.write(value), "--out", str(self.folder / out), *arguments])
        return code, stdout.getvalue(), stderr.getvalue()

    def assert_refused(self, result, *named):
        code, out, err = result
        self.assertEqual((code, out), (2, ""))
        self.assertEqual(err.count("\n"), 1, err)
        for name in named:
            self.assertIn(name, err)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["tune.json"])


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


class TheFront(TuneTest):
    def test_every_setting_and_estimator_stands_at_its_rates_with_its_intervals(self):
        value = fake.tune(GRID, others=[fake.other("rcme", "as is", None, 0.31, 0.12)])
        for number, one in enumerate(value["settings"]):
            one.update(is_on_front=number in (3, 4), is_on_path=number in (0, 3), is_certified=number == 3)
        value["tuned"] = fake.chosen(value["settings"][3])
        figure = draw_front(self.read(value))
        axes, places = figure.axes[0], [(one["refusal"]["value"], one["failure"]["value"]) for one in value["settings"]]
        self.assertEqual(points_of(axes, "_settings"), [places[number] for number in (1, 2, 4, 5)])
        self.assertEqual(points_of(axes, "_front"), sorted([places[3], places[4]]))
        self.assertEqual((points_of(axes, "_tested"), points_of(axes, "_certified")), ([places[0]], [places[3]]))
        self.assertEqual(points_of(axes, "_tuned"), [places[3]])
        self.assertEqual(points_of(axes, "_RCME (as is)"), [(0.12, 0.31)])
        refusal, failure = value["tuned"]["refusal"], value["tuned"]["failure"]
        self.assertEqual(bars_of(axes, TARGET), {
            tuple((round(refusal[end], 9), round(failure["value"], 9)) for end in ("lower", "upper")),
            tuple((round(refusal["value"], 9), round(failure[end], 9)) for end in ("lower", "upper"))})
        self.assertIn("RCME (as is)", legend_of(figure))

    def test_legend_handles_look_like_the_points(self):
        value = fake.tune(GRID)
        for number, one in enumerate(value["settings"]):
            one.update(is_on_path=number in (0, 3), is_certified=number == 3)
        figure = draw_front(self.read(value))
        legend = figure.legends[0] if figure.legends else figure.axes[1].get_legend()
        handles = dict(zip((text.get_text() for text in legend.get_texts()), legend.get_lines()))
        for label, name in (("_certified", "tested, certified"), ("_tested", "tested, not certified")):
            drawn = next(line for line in figure.axes[0].lines if line.get_label() == label)
            for look in ("get_marker", "get_markerfacecolor", "get_markeredgecolor"):
                self.assertEqual(getattr(handles[name], look)(), getattr(drawn, look)(), (name, look))

    def test_a_long_path_needs_no_more_artists_than_a_short_one(self):
        def count(num_levels):
            value = fake.tune([fake.option("mu", [f"{number}" for number in range(num_levels)])], others=[], tuned=None)
            for one in value["settings"]:
                one["is_on_path"] = True
            axes = draw_front(self.read(value)).axes[0]
            self.assertEqual(sum(len(bars.get_segments()) for bars in axes.collections), 2 * num_levels)
            return len(axes.collections)
        self.assertEqual(count(300), count(3))

    def test_the_targets_lines_are_at_what_it_allows(self):
        def lines(kind):
            axes = draw_front(self.read(fake.tune(GRID, kind=kind))).axes[0]
            return [line.get_xydata()[0].tolist() for line in axes.lines if line.get_label() == "_target"]
        self.assertEqual(lines("failure"), [[0.5, 0], [0, 0.05]])
        self.assertEqual((lines("false_refusal"), lines("risk")), ([], []))

    def test_axes_are_in_per_cent_with_room_for_small_rates_and_lines_of_equal_sum(self):
        axes = draw_front(self.read(fake.tune(GRID))).axes[0]
        self.assertEqual((axes.xaxis.get_major_formatter()(0.05), axes.get_xlabel()), ("5", "Refusal rate (%)"))
        self.assertEqual((axes.yaxis.get_major_formatter()(0.05), axes.get_ylabel()), ("5", "Failure rate (%)"))
        self.assertLess(axes.get_ylim()[0], 0)
        to_paper = axes.transScale.transform
        self.assertAlmostEqual(to_paper((0.04, 0.09))[0], 0.2)
        self.assertAlmostEqual(to_paper((0.04, 0.09))[1], 0.3)
        for line in axes.lines:
            if line.get_label() == "_sum":
                sums = {round(float(x + y), 9) for x, y in line.get_xydata()}
                self.assertEqual(len(sums), 1)

    def test_settings_without_trials_have_no_place(self):
        nowhere = {**fake.other("rcme", "", None, 0.1, 0.1), "failure": fake.rate(None)}
        value = fake.tune(GRID, tuned=None, others=[nowhere])
        for one in value["settings"]:
            one.update(refusal=fake.rate(None), is_on_front=False, is_on_path=False)
        figure = draw_front(self.read(value))
        figure.canvas.draw()
        self.assertEqual(points_of(figure.axes[0], "_settings"), [])


class TheRocCurves(TuneTest):
    def test_curves_and_marks_are_those_of_the_file(self):
        value = fake.tune(GRID)
        figure = draw_roc(self.read(value))
        axes = figure.axes[0]
        for entry, name in zip(value["roc"], ("RCME, as printed, samples", "RCME, as printed, winners",
                                              "RCME, rank-aware, samples", "RCME, rank-aware, winners")):
            line = next(line for line in axes.lines if line.get_label() == f"_{name}")
            self.assertEqual(line.get_xydata().tolist(), [point[1:] for point in entry["curve"]])
            self.assertEqual(line.is_dashed(), entry["population"] == "winners")
            auc = f"{name} AUC {entry['auc']['value']:.3f}"
            self.assertTrue(any(text.startswith(auc) for text in legend_of(figure)))
        self.assertEqual(points_of(axes, "_mark"), [(mark["false_accept_rate"], mark["true_accept_rate"])
                                                    for entry in value["roc"] for mark in entry["marks"]])
        self.assertEqual([text.get_text() for text in axes.texts], ["1", "2", "3", "4", "5", "6"])
        self.assertIn("1: RCME, as printed, samples paper, mu = -3.53", legend_of(figure))
        self.assertEqual(points_of(axes, "_chance"), [(0, 0), (1, 1)])
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("Bad models accepted (%)", "Good models accepted (%)"))

    def test_numbers_keep_apart_from_each_other_and_from_the_points(self):
        places = [(0.1, 2.0), (0.1, 2.0), (0.15, 2.05), (3.0, 3.0)]
        numbers = [(72 * x + dx, 72 * y + dy) for (x, y), (dx, dy) in zip(places, kept_apart(places))]
        points = numbers + [(72 * x, 72 * y) for x, y in places]
        for number, one in enumerate(numbers):
            for other in points[number + 1:]:
                self.assertGreaterEqual(math.dist(one, other), 10.9)

    def test_no_bad_models_no_curve(self):
        entry = {**fake.rocs()[0], "num_bad": 0, "auc": {"value": None, "lower": None, "upper": None},
                 "curve": [[None, None, 0], [None, None, 1]],
                 "marks": [{"words": "paper", "false_accept_rate": None, "true_accept_rate": 0.7}]}
        figure = draw_roc(self.read(fake.tune(GRID, roc=[entry])))
        self.assertEqual(points_of(figure.axes[0], "_mark"), [])
        self.assertIn("AUC not defined", legend_of(figure)[0])


class TheCommand(TuneTest):
    def test_it_writes_three_figures_the_same_each_time(self):
        def run():
            code, out, err = self.run_main(fake.tune(GRID))
            self.assertEqual((code, err), (0, ""))
            return {pathlib.Path(path).name: pathlib.Path(path).read_bytes() for path in out.split()}
        first = run()
        self.assertEqual(list(first), [f"figure_{name}.{kind}" for name in ("surface", "front", "roc")
                                       for kind in ("png", "pdf")])
        self.assertEqual(run(), first)

    def test_no_curves_no_third_figure(self):
        code, out, _ = self.run_main(fake.tune(GRID, roc=[]))
        self.assertEqual((code, len(out.split())), (0, 4))

    def test_nothing_stands_on_anything_else_in_a_full_figure(self):
        others = [fake.other(f"estimator_{number}", "as in the study", None, 0.1 * number, 0.05) for number in range(9)]
        tune = self.read(fake.tune(FURTHER, others=others, roc=fake.rocs() * 3))
        for figure in (draw_surface(tune), draw_front(tune), draw_roc(tune)):
            figure.canvas.draw()
            texts = [text for axes in panels_of(figure) or figure.axes[:1]
                     for text in (axes._left_title, axes.xaxis.label, axes.yaxis.label)]
            texts += figure.texts + [text for one in (figure.legends or [figure.axes[1].get_legend()])
                                     for text in one.get_texts()]
            boxes = [(text.get_text(), text.get_window_extent()) for text in texts if text.get_text()]
            for number, (name, box) in enumerate(boxes):
                self.assertGreaterEqual(min(box.x0, box.y0), 0, name)
                self.assertLessEqual(box.x1, figure.bbox.x1 + 1, name)
                for other_name, other in boxes[number + 1:]:
                    shared = (min(box.x1, other.x1) - max(box.x0, other.x0),
                              min(box.y1, other.y1) - max(box.y0, other.y0))
                    self.assertFalse(min(shared) > 2, f"{name} / {other_name}")

    def test_files_that_are_no_tuning(self):
        whole = fake.tune(GRID)
        self.assert_refused(self.run_main(json.dumps(whole)[:300]), "tune.json", "not a whole JSON file")
        self.assert_refused(self.run_main("{}"), "'format'", "rcme tune")
        self.assert_refused(self.run_main("[]"), "must be an object")
        self.assert_refused(self.run_main(fake.transfer()), "'format'", "'rcme tuning 1'")
        for key in ("study", "estimator", "seed", "target", "options", "settings", "tuned", "others", "roc"):
            self.assert_refused(self.run_main({name: part for name, part in whole.items() if name != key}),
                                f"no key '{key}'")
        for changes, named in (
                ({"target": fake.target(at_most=5)}, ("'target'", "at_most", "0..1")),
                ({"target": fake.target(kind="failure") | {"kind": "least"}}, ('"least"', "'risk'")),
                ({"options": []}, ("'options'",)),
                ({"options": [GRID[0], GRID[0]]}, ("'options'", "its own 'name'")),
                ({"options": [fake.option("mu", ("0", "0.0"))]}, ("mu", "different")),
                ({"settings": whole["settings"][:-1]}, ("5 'settings'", "6 combinations")),
                ({"settings": whole["settings"][::-1]}, ("setting 1", "first option slowest")),
                ({"tuned": fake.chosen(whole["settings"][0]) | {"levels": ["7", "2"]}}, ("'tuned'", "'7'", "of mu")),
                ({"others": [fake.other("rcme", "", ["1"], 0.1, 0.1)]}, ("other 1", "expected 2")),
                ({"others": [fake.other("rcme", "", ["1", "no"], 0.1, 0.1)]},
                 ("other 1", "'no' of lambda", "a number")),
                ({"roc": [fake.rocs()[0] | {"population": "models"}]}, ("roc 1", "'samples'")),
                ({"roc": [fake.rocs()[0] | {"curve": [[0, 1.5, 0]]}]}, ("roc 1", "'curve'")),
        ):
            self.assert_refused(self.run_main(whole | changes), "tune.json", *named)
        wrong = fake.tune(GRID)
        wrong["settings"][2]["failure"]["lower"] = 0.9
        self.assert_refused(self.run_main(wrong), "setting 3, 'failure'", "'lower'..'upper'")
        wrong["settings"][2]["failure"] = {"value": None, "lower": 0, "upper": 1, "n": 3}
        self.assert_refused(self.run_main(wrong), "setting 3, 'failure'", "null only where")

    def test_without_a_surface_the_others_are_drawn_and_a_note_says_why(self):
        for options, *why in ((MANY, "7 combinations of batch", "--where batch=a"),
                              ([fake.option("mu", ("1",))], "no option varies")):
            code, out, err = self.run_main(fake.tune(options, others=[], tuned=None))
            self.assertEqual((code, err.count("\n")), (0, 1), err)
            for part in ("tune.py: no surface: ", *why):
                self.assertIn(part, err)
            self.assertEqual([pathlib.Path(path).name for path in out.split()],
                             [f"figure_{name}.{kind}" for name in ("front", "roc") for kind in ("png", "pdf")])

    def test_a_part_of_the_surface_that_is_asked_for_has_to_be_there(self):
        many = fake.tune(MANY, others=[], tuned=None)
        self.assert_refused(self.run_main(many, "--where", "batch=z"), "--where batch=z", "has no such batch")
        self.assert_refused(self.run_main(many, "--where", "kappa=1"), "--where kappa=1", "mu, lambda, batch")
        self.assert_refused(self.run_main(many, "--where", "mu=1"), "7 combinations of batch")
        self.assert_refused(self.run_main(fake.tune(GRID), out="figure.png"), "without .png")

    def test_help_teaches_with_an_example(self):
        out = io.StringIO()
        with contextlib.redirect_stdout(out), self.assertRaises(SystemExit):
            script.main(["--help"])
        self.assertIn("rcme plot tune tune.json --out tune", out.getvalue())


if __name__ == "__main__":
    unittest.main()
