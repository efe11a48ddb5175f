#!/usr/bin/python3
"""Tests of plots/tune.py; run as: /usr/bin/python3 tests/plots/tune_test.py"""

import json
import math
import pathlib
import unittest

from tune_drawn import FURTHER, GRID, MANY, TuneTest, bars_of, legend_of, panels_of, points_of

import fake_tune as fake
import tune as script
from rates.rate_bands import TARGET
from tuning_figures.front import draw_front
from tuning_figures.roc import draw_roc, kept_apart
from tuning_figures.surface import draw_surface


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
        self.assert_help_shows("rcme plot tune tune.json --out tune")


if __name__ == "__main__":
    unittest.main()
