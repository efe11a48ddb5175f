#!/usr/bin/python3
"""Tests of plots/validation.py; run as: /usr/bin/python3 tests/plots/validation_test.py"""

import unittest

from plot_test_case import PlotTestCase

import validation as script


def test_of(one_set, name, ratio, verdict):
    interval = [None, None] if ratio is None else [0.8 * ratio, 1.3 * ratio]
    return {"set": one_set, "test": name, "ratio": ratio, "ratio_interval": interval, "verdict": verdict, "n": 10}


def fake():
    """Two scenes; the second has no triples and too few neighbours."""
    def correlation(one_set, low, high, value):
        bounds = [None, None] if value is None else [value - 0.1, value + 0.1]
        return {"set": one_set, "from_px": low, "to_px": high, "correlation": value or 0.0, "twin_correlation": 0.0,
                "difference_interval": bounds}
    def fault(one_set, value, verdict):
        bounds = [None, None] if value is None else [value - 0.001, value + 0.001]
        return {"set": one_set, "fault": "focal_length", "nominal": 0.002, "verdict": verdict, "beside_others": value,
                "beside_others_interval": bounds}
    return {"format": script.FORMAT, "nominal_variance": 1.5, "nominal_correlation": 0.05,
            "sets": [{"set": "hall", "pairs": 12}, {"set": "street", "pairs": 3}],
            "camera_faults": [fault("hall", 0.004, "wrong"), fault("street", None, "no data")],
            "tests": [test_of("hall", "spatial_halves", 2.0, "too small"), test_of("hall", "random_halves", 1.0, "holds"),
                      test_of("hall", "closure", 3.0, "undecided"), test_of("street", "spatial_halves", 0.5, "too large"),
                      test_of("street", "random_halves", 1.1, "holds"), test_of("street", "closure", None, "no data")],
            "correlations": [correlation("hall", 0, 1, 0.8), correlation("hall", 1, 4, 0.1),
                             correlation("street", 0, 1, None), correlation("street", 1, 4, 0.0)]}


class Validation(PlotTestCase):
    script, given = script, ["validation.json"]

    def run_on(self, content):
        return self.run_script(self.write(content), "--out", self.folder / "figure")

    def test_draws_png_and_pdf(self):
        code, _, errors = self.run_on(fake())
        self.assertEqual((code, errors), (0, ""))
        for suffix in ("png", "pdf"):
            self.assertGreater((self.folder / f"figure.{suffix}").stat().st_size, 1000)

    def test_a_file_that_is_not_whole_is_refused(self):
        for content in ({"sets": [1]}, {"sets": [{"set": "hall"}]}):
            self.assert_refused(self.run_on({"format": script.FORMAT} | content), "validation.json", "not a whole file")

    def test_every_test_with_a_ratio_stands_at_it(self):
        ratios = script.draw(fake()).axes[0]
        markers = [line.get_xdata()[0] for line in ratios.lines if line.get_marker() not in ("None", "_") and len(line.get_xdata()) == 1]
        self.assertEqual(markers, [2.0, 1.0, 3.0, 0.5, 1.1])

    def test_every_fault_stands_at_its_multiple_of_what_is_nominal(self):
        faults = script.draw(fake()).axes[2]
        self.assertEqual([line.get_xdata()[0] for line in faults.lines if line.get_marker() == "o"], [2.0])

    def test_what_is_far_from_nominal_is_not_cut_at_the_frame(self):
        content = fake()
        content["camera_faults"][0] |= {"beside_others": 2.0, "beside_others_interval": [-3.0, 0.1]}
        faults = script.draw(content).axes[2]
        mark, = (line for line in faults.lines if line.get_marker() == "o")
        bar, = (line for line in faults.lines if list(line.get_xdata()) == [-script.EDGE, 50])
        self.assertEqual((mark.get_xdata()[0], mark.get_clip_on()), (script.FARTHEST_FAULT, False))
        self.assertEqual(faults.get_xlim(), (-script.EDGE, script.EDGE))
        self.assertLess(mark.get_xdata()[0], script.EDGE)
        self.assertEqual(bar.get_color(), mark.get_color())

    def test_a_colour_has_one_meaning(self):
        """Verdicts in (a) have colours, sets in (b) have others, faults in (c) are grey."""
        content = fake()
        content["sets"] += [{"set": f"set {number}", "pairs": 5} for number in range(10)]
        content["correlations"] += [{**content["correlations"][0], "set": f"set {number}"} for number in range(10)]
        content["camera_faults"].append({**content["camera_faults"][0], "fault": "distortion"})
        figure = script.draw(content)
        colors = {line.get_color() for line in figure.axes[1].lines if len(line.get_xdata()) and line.get_label()[0] != "_"}
        self.assertEqual(len(colors), 12)
        self.assertFalse(colors & set(script.COLORS.values()))
        faults = [line for line in figure.axes[2].lines if line.get_marker() in script.MARKERS]
        self.assertEqual({line.get_color() for line in faults}, {script.FAULT_COLOR})
        self.assertEqual(len({line.get_marker() for line in faults}), 2)

    def test_each_panel_has_its_own_legend_and_names_are_words(self):
        content = fake()
        for part in ("sets", "camera_faults", "tests", "correlations"):
            for row in content[part]:
                row["set"] = row["set"].replace("hall", "kitti00").replace("street", "my_street")
        figure = script.draw(content)
        self.assertEqual(figure.legends, [])
        texts = [[text.get_text() for text in axes.get_legend().get_texts()] for axes in (figure.axes[0], figure.axes[2])]
        self.assertIn("covariance holds", texts[0])
        self.assertEqual(texts[1], ["focal length", "hollow: undecided"])
        self.assertEqual([label.get_text() for label in figure.axes[0].get_yticklabels()], ["KITTI 00 (12)", "my street (3)"])
        self.assertIn("KITTI 00", [text.get_text() for text in figure.axes[1].texts])

    def test_sets_without_a_fault_that_could_be_measured_are_left_out_of_its_panel(self):
        ratios, _, faults = script.draw(fake()).axes
        self.assertEqual([label.get_text() for label in ratios.get_yticklabels()], ["hall (12)", "street (3)"])
        self.assertEqual([label.get_text() for label in faults.get_yticklabels()], ["hall"])

    def test_without_any_such_set_there_is_no_panel(self):
        content = fake()
        content["camera_faults"][0] |= {"beside_others": None, "beside_others_interval": [None, None]}
        self.assertEqual(len(script.draw(content).axes), 2)

    def test_a_test_and_a_fault_that_this_script_does_not_know_are_drawn_by_their_names(self):
        content = fake()
        content["tests"].append(test_of("hall", "new_test", 1.2, "holds"))
        content["camera_faults"].append({**content["camera_faults"][0], "fault": "new_fault"})
        ratios, _, faults = script.draw(content).axes
        for axes, name in ((ratios, "new test"), (faults, "new fault")):
            self.assertIn(name, [text.get_text() for text in axes.get_legend().get_texts()])

    def test_what_is_no_validation_is_refused(self):
        for content in ("{", "[]", {"format": "rcme summary 1", "sets": [1]}, {**fake(), "sets": []}):
            self.assert_refused(self.run_on(content), "validation.json")


if __name__ == "__main__":
    unittest.main()
