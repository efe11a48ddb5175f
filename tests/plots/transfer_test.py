#!/usr/bin/python3
"""Tests of plots/transfer.py; run as: /usr/bin/python3 tests/plots/transfer_test.py"""

import json
import pathlib
import unittest

from plot_test_case import PlotTestCase

import fake_tune as fake
import transfer as script
from matplotlib.collections import PolyCollection
from matplotlib.patches import Rectangle
from rates.rate_bands import color_of
from transfer import number_in_cell, shortened
from tuning_figures.tune_file import read_transfer


def cell(i, j, value, verdict="holds", refusal=0.1):
    return {"tuned_on": i, "verified_on": j, "rate": value if isinstance(value, dict) else fake.rate(value, 0.01),
            "failure": fake.rate(0.9), "refusal": fake.rate(refusal), "false_refusal": fake.rate(0.8),
            "verdict": verdict}


def small(**changes):
    """Three families, the second not tuned, one pair without a cell; every rate is different."""
    families = [{"words": "scene = room", "levels": ["1.5", "soft"], "why": ""},
                {"words": "scene = wall", "levels": None, "why": "unreachable: nearest 7 %"},
                {"words": "scene = cube", "levels": ["-3", "hard"], "why": ""}]
    cells = [cell(0, 0, 0.03), cell(0, 1, 0.2, "does not hold", 0.95), cell(0, 2, 0.06, "undecided"),
             cell(2, 0, fake.rate(None)), cell(2, 1, 0.123)]
    options = [fake.option("mu", ("-3", "0", "1.5"), "nats"), fake.option("rule", ("soft", "hard"))]
    return fake.transfer(3, families=families, cells=cells, options=options, **changes)


def matrix_of(figure):
    return figure.axes[0]


def colors_of(axes):
    """{(column, row from below): colour}; cells without trials are hatched instead."""
    return {tuple(box.get_paths()[0].vertices.min(axis=0).astype(int)): tuple(box.get_facecolor()[0])
            for box in axes.collections if isinstance(box, PolyCollection) and not box.get_hatch()}


def texts_of(axes):
    """{(column, row from below): [texts from top to bottom]}."""
    found = {}
    for text in sorted(axes.texts, key=lambda text: -text.get_position()[1]):
        found.setdefault(tuple(map(int, text.get_position())), []).append(text)
    return found


def words_of(figure):
    return [text.get_text() for text in figure.texts]


class TransferTest(PlotTestCase):
    script, given = script, ["transfer.json"]

    def draw(self, value, quantity="rate"):
        return script.draw(read_transfer(self.write(value)), quantity, "A title")

    def run_main(self, value, out="figure"):
        return self.run_script(self.write(value), "--out", self.folder / out)


class Drawn(TransferTest):
    def test_rows_are_tuned_on_and_columns_verified_on_each_with_its_rate(self):
        axes = matrix_of(self.draw(small()))
        self.assertEqual(colors_of(axes), {(0, 2): color_of(0.03), (1, 2): color_of(0.2), (2, 2): color_of(0.06),
                                           (1, 0): color_of(0.123)})
        lines = {place: [text.get_text() for text in texts] for place, texts in texts_of(axes).items()}
        self.assertEqual(lines[1, 2], ["20.0", "[19.0, 21.4]"])
        self.assertEqual(lines[1, 0], ["12.3", "[11.3, 13.7]"])
        self.assertEqual(lines[0, 0], ["n = 0"])
        self.assertNotIn((2, 0), lines)  # no cell in the file
        self.assertEqual(axes.patch.get_hatch(), "////")

    def test_the_second_figure_has_the_refusals_in_the_same_places(self):
        axes = matrix_of(self.draw(small(), "refusal"))
        self.assertEqual(colors_of(axes)[1, 2], color_of(0.95))
        self.assertEqual(colors_of(axes)[0, 2], color_of(0.1))

    def test_violations_are_outlined_and_undecided_numbers_pale(self):
        for quantity in ("rate", "refusal"):
            axes = matrix_of(self.draw(small(), quantity))
            outlines = [tuple(map(int, patch.get_xy())) for patch in axes.patches if isinstance(patch, Rectangle)]
            self.assertEqual(outlines, [(1, 2)])
            pale = {place for place, texts in texts_of(axes).items() if texts[0].get_alpha() is not None}
            self.assertEqual(pale, {(2, 2)})
        caption = words_of(self.draw(small()))[-1].replace("\n", " ")
        for part in (fake.target()["words"], "n = 0\u2013400 per cell", "outlined", "undecided", "hatched"):
            self.assertIn(part, caption)

    def test_what_could_not_be_tuned_says_why_and_tuned_levels_stand_beside_their_row(self):
        figure = self.draw(small())
        axes = matrix_of(figure)
        self.assertEqual([text.get_text() for text in texts_of(axes)[1, 1]], ["unreachable: nearest 7 %"])
        rows = {text.get_text(): text.get_position()[1] for text in figure.texts}
        left = [text for text in figure.texts if text.get_ha() == "right"]
        self.assertEqual([text.get_text() for text in left], ["scene = room", "scene = wall", "scene = cube"])
        self.assertEqual([rows["1.5"], rows["soft"]], [left[0].get_position()[1]] * 2)
        self.assertEqual([rows["\u22123"], rows["hard"]], [left[2].get_position()[1]] * 2)
        for header in ("mu (nats)", "rule", "Tuned on", "Verified on", "A title"):
            self.assertIn(header, rows)
        box = axes.get_window_extent()
        for number, text in enumerate(left):  # beside the middle of its row
            y = text.get_window_extent()
            self.assertAlmostEqual((y.y0 + y.y1) / 2, box.y1 - (number + 0.5) * box.height / 3, delta=1.5)

    def test_the_target_is_marked_on_the_scale(self):
        def mark(quantity, kind="failure"):
            lines = self.draw(small(target=fake.target(kind)), quantity).axes[1].lines
            return [line.get_ydata()[0] for line in lines]
        self.assertEqual((mark("rate"), mark("refusal"), mark("rate", "risk")), ([0.05], [0.5], []))

    def test_thirty_families_have_numbers_that_fit_their_cells(self):
        value = fake.transfer(30)
        figure = self.draw(value)
        axes = matrix_of(figure)
        self.assertEqual(len(colors_of(axes)), len(value["cells"]))
        cell_width = axes.get_window_extent().width / 30
        numbers = [text for text in axes.texts if not text.get_text().startswith("unreachable")]
        self.assertEqual(len(numbers), len(value["cells"]))
        for text in numbers:
            self.assertLess(text.get_window_extent().width, 0.8 * cell_width)
        for one, text in zip(value["cells"], numbers):
            self.assertEqual(text.get_text(), number_in_cell(one["rate"]["value"]))
        self.assertLess(figure.get_size_inches()[0], 8.2)

    def test_no_text_stands_on_another_or_beyond_the_paper(self):
        long = [{**family, "words": "a very long description of a family of trials, " + family["words"],
                 "why": family["why"] * 9} for family in fake.families(6)]
        many = [fake.option(f"number_of_hypotheses_{number}", fake.MUS) for number in range(4)]
        for family in long:
            family["levels"] = family["levels"] and [family["levels"][0]] * 4
        for value in (fake.transfer(1), small(), fake.transfer(30), fake.transfer(6, families=long, options=many)):
            figure = self.draw(value)
            boxes = [(text.get_text(), text.get_window_extent()) for text in figure.texts]
            for number, (name, box) in enumerate(boxes):
                self.assertGreaterEqual(min(box.x0, box.y0), 0, name)
                self.assertLessEqual(box.x1, figure.bbox.x1, name)
                self.assertLessEqual(box.y1, figure.bbox.y1, name)
                for other_name, other in boxes[number + 1:]:
                    shared = (min(box.x1, other.x1) - max(box.x0, other.x0),
                              min(box.y1, other.y1) - max(box.y0, other.y0))
                    self.assertFalse(min(shared) > 1.5, f"{name} / {other_name}")
            matrix = matrix_of(figure).get_window_extent()
            for text in matrix_of(figure).texts:
                self.assertLessEqual(text.get_window_extent().width, matrix.width)

    def test_numbers_of_small_cells_are_short(self):
        self.assertEqual([number_in_cell(rate) for rate in (0, 0.0004, 0.0123, 0.0995, 0.5, 0.999, 1)],
                         ["0", "0.0", "1.2", "10", "50", "100", "100"])
        self.assertEqual(shortened("short", 3, 7), "short")
        self.assertTrue(shortened("long " * 20, 1, 7).endswith("\u2026"))


class Command(TransferTest):
    def test_it_writes_both_figures_the_same_each_time(self):
        def run():
            code, out, err = self.run_main(small())
            self.assertEqual((code, err), (0, ""))
            return {pathlib.Path(path).name: pathlib.Path(path).read_bytes() for path in out.split()}
        first = run()
        self.assertEqual(list(first), [f"figure_{name}.{kind}" for name in ("matrix", "refusal")
                                       for kind in ("png", "pdf")])
        self.assertEqual(run(), first)

    def test_a_study_whose_families_cannot_be_tuned_is_drawn(self):
        families = [family | {"levels": None, "why": "unreachable"} for family in fake.families(2)]
        self.assertEqual(self.run_main(fake.transfer(2, families=families, cells=[]))[0], 0)

    def test_files_that_are_no_transfer(self):
        whole = small()
        self.assert_refused(self.run_main(json.dumps(whole)[:200]), "transfer.json", "not a whole JSON file")
        self.assert_refused(self.run_main(fake.tune()), "'format'", "'rcme transfer 1'")
        for key in ("format", "study", "estimator", "seed", "target", "options", "families", "cells"):
            self.assert_refused(self.run_main({name: part for name, part in whole.items() if name != key}),
                                f"no key '{key}'", "expected the output of 'rcme transfer'")
        for changes, named in (
                ({"families": [], "cells": []}, ("no families",)),
                ({"cells": [cell(0, 3, 0.1)]}, ("cell 1", "0 to 2")),
                ({"cells": [cell(1, 0, 0.1)]}, ("cell 1", "family without 'levels'")),
                ({"cells": [cell(0, 0, 0.1)] * 2}, ("two cells of one pair",)),
                ({"cells": [cell(0, 0, 0.1, "perhaps")]}, ("cell 1", "'verdict'", "'undecided'")),
                ({"cells": [cell(0, 0, {"value": 0.5, "lower": 0.6, "upper": 0.7, "n": 9})]},
                 ("cell 1, 'rate'", "'lower'")),
                ({"cells": [{**cell(0, 0, 0.1), "refusal": None}]}, ("cell 1, 'refusal'", "an object")),
                ({"families": [whole["families"][0] | {"levels": ["1.5"]}]}, ("family 1", "expected 2")),
                ({"families": [whole["families"][0] | {"levels": "1.5"}]}, ("family 1", "a list of texts or null")),
        ):
            self.assert_refused(self.run_main(whole | changes), "transfer.json", *named)
        self.assert_refused(self.run_main(whole, "figure.pdf"), "without .png")

    def test_help_teaches_with_an_example(self):
        self.assert_help_shows("rcme plot transfer transfer.json --out transfer", "file that 'rcme transfer' wrote")


if __name__ == "__main__":
    unittest.main()
