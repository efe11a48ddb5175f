#!/usr/bin/python3
"""Tests of the looks of estimators in every figure; run as: /usr/bin/python3 tests/plots/palette_test.py

No two estimators share a colour or a marker; colours differ to the eye, in simulated protanopia, deuteranopia and tritanopia
and, with their dashes, in grey.
"""

import csv
import itertools
import unittest
from unittest import mock

import numpy

from plot_test_case import PLOTS, PlotTestCase

import failure_rate
import failure_rate_test
from common import direct_labels, sheet, style
from matplotlib.colors import to_rgb

LEAST_DIFFERENCE, LEAST_OF_TRITANOPIA = 12, 10  # CIEDE2000; about 2 can be told apart side by side
LEAST_STEP = 4  # of lightness, 0 to 100, between greys that say something
# Machado, Oliveira and Fernandes, "A physiologically-based model for simulation of color vision deficiency" (2009), of
# linear RGB, at full severity.
VISIONS = {
    "normal": numpy.eye(3),
    "protanopia": numpy.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]),
    "deuteranopia": numpy.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]),
    "tritanopia": numpy.array([[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]])}
COMMON = ("normal", "protanopia", "deuteranopia")
XYZ = numpy.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])
WHITE = XYZ.sum(axis=1)


def lab(color, vision="normal"):
    """CIELAB (L 0..100, a, b) of an sRGB colour, as that vision sees it."""
    rgb = numpy.array(to_rgb(color))
    linear = numpy.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    t = XYZ @ numpy.clip(VISIONS[vision] @ linear, 0, 1) / WHITE
    x, y, z = numpy.where(t > 216 / 24389, numpy.cbrt(t), (24389 / 27 * t + 16) / 116)
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def difference(one, other):
    """CIEDE2000 (Sharma, Wu and Dalal 2005, whose test data are below) of two CIELAB colours."""
    (l1, a1, b1), (l2, a2, b2) = one, other
    mean_c = (numpy.hypot(a1, b1) + numpy.hypot(a2, b2)) / 2
    stretch = 1.5 - 0.5 * numpy.sqrt(mean_c**7 / (mean_c**7 + 25.0**7))
    c1, c2 = numpy.hypot(stretch * a1, b1), numpy.hypot(stretch * a2, b2)
    h1, h2 = (numpy.degrees(numpy.arctan2(b, stretch * a)) % 360 for a, b in ((a1, b1), (a2, b2)))
    turn = 0 if c1 * c2 == 0 else (h2 - h1 + 180) % 360 - 180
    mean_h = h1 + h2 if c1 * c2 == 0 else (h1 + turn / 2) % 360
    mean_l, mean_c = (l1 + l2) / 2, (c1 + c2) / 2

    def cosine(degrees):
        return numpy.cos(numpy.radians(degrees))
    t = (1 - 0.17 * cosine(mean_h - 30) + 0.24 * cosine(2 * mean_h) + 0.32 * cosine(3 * mean_h + 6) - 0.2 * cosine(4 * mean_h - 63))
    of_l = (l2 - l1) / (1 + 0.015 * (mean_l - 50)**2 / numpy.sqrt(20 + (mean_l - 50)**2))
    of_c = (c2 - c1) / (1 + 0.045 * mean_c)
    of_h = 2 * numpy.sqrt(c1 * c2) * numpy.sin(numpy.radians(turn / 2)) / (1 + 0.015 * mean_c * t)
    rotation = -2 * numpy.sqrt(mean_c**7 / (mean_c**7 + 25.0**7)) * numpy.sin(numpy.radians(60 * numpy.exp(-((mean_h - 275) / 25)**2)))
    return numpy.sqrt(of_l**2 + of_c**2 + of_h**2 + rotation * of_c * of_h)


def least_difference(colors, visions=COMMON):
    return min(difference(lab(a, vision), lab(b, vision)) for a, b in itertools.combinations(colors, 2) for vision in visions)


def estimators_of_a_study():
    """A list for every committed table of rates."""
    lists = {}
    for path in (PLOTS.parent / "results").glob("*/*.csv"):
        with open(path, newline="", encoding="utf-8") as file:
            rows = csv.DictReader(file)
            if {"study", "estimator"} <= set(rows.fieldnames or ()):
                lists[path.name] = list(dict.fromkeys(row["estimator"] for row in rows))
    return lists


class Palette(unittest.TestCase):
    def test_the_difference_of_colours_is_that_of_the_published_data(self):
        for one, other, known in (((50, 2.6772, -79.7751), (50, 0, -82.7485), 2.0425), ((50, 0, 0), (50, -1, 2), 2.3669),
                                  ((50, 2.49, -0.001), (50, -2.49, 0.0009), 7.1792), ((50, 2.5, 0), (73, 25, -18), 27.1492),
                                  ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082)):
            self.assertAlmostEqual(difference(one, other), known, places=4)
        self.assertAlmostEqual(lab("white")[0], 100, places=3)

    def test_no_two_slots_look_alike_with_any_vision_or_in_grey(self):
        colors, markers, dashes = zip(*style.SLOTS)
        self.assertEqual(len(set(markers)), len(markers))
        self.assertGreaterEqual(least_difference(colors), LEAST_DIFFERENCE)
        self.assertGreaterEqual(least_difference(colors, ["tritanopia"]), LEAST_OF_TRITANOPIA)
        for i, j in itertools.combinations(range(len(colors)), 2):
            step = abs(lab(colors[i])[0] - lab(colors[j])[0])
            self.assertTrue(step >= LEAST_STEP or dashes[i] != dashes[j], style.SLOTS[i] + style.SLOTS[j])
        for color in colors:
            self.assertLess(lab(color)[0], 75, f"{color} is too pale on white")

    def test_the_measure_finds_a_shared_colour_and_what_the_colour_blind_confuse(self):
        self.assertEqual(least_difference((style.PURPLE, style.BLUE, style.PURPLE)), 0)
        self.assertGreater(difference(lab("#808000"), lab("#B05000")), LEAST_DIFFERENCE)
        self.assertLess(least_difference(("#808000", "#B05000")), LEAST_DIFFERENCE)
        self.assertLess(least_difference(("#4B5A5A", "#5A694B"), ["tritanopia"]), LEAST_OF_TRITANOPIA)

    def test_no_two_estimators_of_a_committed_table_share_a_look(self):
        lists = estimators_of_a_study()
        self.assertGreater(len(lists), 100)
        for name, estimators in lists.items():
            looks = list(style.looks_of(estimators[:len(style.SLOTS)]).values())
            self.assertEqual(len({look.color for look in looks}), len(looks), name)
            self.assertEqual(len({look.marker for look in looks}), len(looks), name)
            self.assertEqual(len({look.label for look in looks}), len(looks), name)

    def test_no_label_of_a_known_estimator_is_anothers(self):
        labels = [label for label, _ in style.KNOWN.values()]
        self.assertEqual(len(set(labels)), len(labels))

    def test_the_order_of_a_study_and_strangers_do_not_change_a_known_colour(self):
        peers = ["standard_five_point", "rcme_calibrated", "opencv_magsac", "poselib"]
        colors = {name: look.color for name, look in style.looks_of(peers).items()}
        for more in (peers[::-1], ["mine", *peers], ["mine", "yours", *peers[1:]]):
            looks = style.looks_of(more)
            self.assertEqual({name: looks[name].color for name in more if name in colors},
                             {name: colors[name] for name in more if name in colors})
        self.assertEqual(style.looks_of(["standard_five_point"])["standard_five_point"].color, style.BLACK)

    def test_an_estimator_has_one_look_in_every_committed_table(self):
        """But for those of a table that has more than there are slots."""
        found = {}
        for name, estimators in estimators_of_a_study().items():
            for estimator, look in style.looks_of(estimators).items():
                if estimator in style.KNOWN and len(estimators) <= len(style.SLOTS):
                    found.setdefault(estimator, {}).setdefault((look.color, look.marker, look.dashes), name)
        self.assertEqual({estimator: looks for estimator, looks in found.items() if len(looks) > 1}, {})
        self.assertGreater(len(found), 20)

    def test_six_estimators_have_colours_that_no_other_label_gets(self):
        owners = {name for name, (_, slot) in style.KNOWN.items() if slot in style.OWNED}
        self.assertEqual(owners, {"standard_five_point", "rcme_calibrated", "poselib", "opencv_magsac", "rcme", "rcme_as_printed",
                                  "prcme", "prcme_as_printed"})
        others = [f"other {number}" for number in range(len(style.SLOTS) - len(style.OWNED))]
        owned = {style.SLOTS[slot][0] for slot in style.OWNED}
        self.assertFalse(owned & {look.color for look in style.looks_of(others).values()})
        colors = [look.color for look in style.looks_of([*others, "one more", "rcme_calibrated"]).values()]
        self.assertEqual((len(set(colors)), len(owned & set(colors))), (len(colors), 2))  # one is lent: better than grey

    def test_the_colour_of_a_stranger_depends_on_its_label(self):
        alone = {name: style.looks_of([name])[name].color for name in ("mine", "yours", "theirs", "ours")}
        self.assertGreater(len(set(alone.values())), 2)
        for known in (["rcme_calibrated", "poselib"], ["standard_five_point", "opencv_magsac", "rcme"]):
            self.assertEqual({name: style.looks_of([*known, name])[name].color for name in alone}, alone)
        together = style.looks_of(list(alone))
        self.assertEqual({name: look.color for name, look in style.looks_of(list(alone)[::-1]).items()},
                         {name: look.color for name, look in together.items()})
        self.assertEqual(len({look.color for look in together.values()}), len(alone))

    def test_beyond_the_last_slot_estimators_are_grey(self):
        looks = list(style.looks_of([f"other {number}" for number in range(len(style.SLOTS) + 2)]).values())
        colors = [look.color for look in looks if look.color != style.REST]
        self.assertEqual((len(colors), len(set(colors))), (len(looks) - 2, len(style.SLOTS)))

    def test_a_highlight_leaves_colour_to_those_it_names(self):
        names = ["standard", "rcme_calibrated", "poselib"]
        colors = {name: look.color for name, look in style.looks_of(names).items()}
        with sheet.use(sheet.Sheet(highlight=("poselib",))):
            looks = style.looks_of(names)
        self.assertEqual([looks[name].color for name in names], [style.REST, style.REST, colors["poselib"]])
        self.assertGreater(looks["poselib"].zorder, looks["standard"].zorder)
        self.assertGreater(looks["poselib"].line_width, looks["standard"].line_width)


class StyleFile(PlotTestCase):
    script, given = failure_rate, ["summary.csv", "style.toml"]

    def draw(self, settings, *more):
        """(exit code, standard error, the figure)."""
        drawn = []
        with mock.patch.object(style, "save", lambda figure, path, dpi: drawn.append(figure) or [path]):
            code, _, errors = self.run_script(self.write(failure_rate_test.TABLE), "--x", "outlier_ratio", "--quantities", "failure",
                                              "--out", self.folder / "figure", "--style", self.write(settings, "style.toml"), *more)
        return code, errors, *drawn

    def test_its_settings_are_those_of_the_figure_and_the_command_line_comes_first(self):
        text = 'width = 3.3\ncaption = false\n[labels]\nmine = "Ours"\nother = "Not here"\n[colors]\nmine = "#A50F4B"\n'
        code, errors, figure = self.draw(text)
        self.assertEqual((code, errors, figure.get_figwidth(), figure.texts), (0, "", 3.3, []))
        colors = {line.get_label(): line.get_color() for line in figure.axes[0].lines}
        self.assertEqual(colors["Ours"], "#A50F4B")
        self.assertNotEqual(colors["Standard"], "#A50F4B")  # which is taken
        self.assertEqual(self.draw(text, "--width", "7")[2].get_figwidth(), 7)

    def test_the_highlight_is_in_colour(self):
        figure = self.draw('highlight = ["mine"]')[2]
        self.assertEqual(next(line.get_color() for line in figure.axes[0].lines if line.get_label() == "Standard"), style.REST)

    def test_what_is_no_style_is_refused(self):
        for text, words in (("width =", "is no TOML"), ("wide = 3", "no setting 'wide'; allowed: width, caption"),
                            ('width = "3"', "width: expected a number of inches"), ("width = 99", "between 2.5"),
                            ('formats = ["eps"]', "eps"), ('[colors]\na = "red"', "#0072B2"),
                            ('[colors]\na = "#0072B2"\nb = "#0072b2"', "no two alike")):
            code, errors, *_ = self.draw(text)
            self.assertEqual(code, 2, text)
            self.assertIn(words, errors)


class DirectLabels(unittest.TestCase):
    def assert_places(self, found, known):
        for a, b in itertools.zip_longest(found, known):
            self.assertAlmostEqual(a, b)

    def test_names_keep_their_place_where_they_have_room(self):
        self.assert_places(direct_labels.spread([0.2, 0.5, 0.8], [0.1] * 3, 0, 1), [0.2, 0.5, 0.8])

    def test_names_that_would_touch_share_the_shift(self):
        self.assert_places(direct_labels.spread([0.5, 0.5, 0.9], [0.1] * 3, 0, 1), [0.45, 0.55, 0.9])
        self.assert_places(direct_labels.spread([0.5, 0.5], [0.2, 0.1], 0, 1), [0.425, 0.575])

    def test_none_leaves_the_panel(self):
        self.assert_places(direct_labels.spread([0, 0, 1, 1], [0.1] * 4, 0, 1), [0.05, 0.15, 0.85, 0.95])

    def test_names_of_many_lines_have_no_room(self):
        figure, _ = style.new_figure(1, 1)
        before = figure.get_figheight()
        self.assertTrue(direct_labels.make_room(figure, 1, ["one", "two"]))
        self.assertEqual(figure.get_figheight(), before)
        self.assertTrue(direct_labels.make_room(figure, 1, ["name"] * 18))
        self.assertGreater(figure.get_figheight(), before)
        self.assertFalse(direct_labels.make_room(figure, 1, ["name"] * 40))


if __name__ == "__main__":
    unittest.main()
