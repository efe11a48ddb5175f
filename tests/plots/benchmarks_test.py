#!/usr/bin/python3
"""Tests of plots/benchmarks.py; run as: /usr/bin/python3 tests/plots/benchmarks_test.py"""

import unittest

from plot_test_case import PlotTestCase

import benchmarks as script


def content():
    time = {"median": 10, "lower": 9, "upper": 12}
    cases = [{"group": group, "name": name, "microseconds": time} for group, name in (
        ("stage", "stage/fast"), ("estimator", "rcme_calibrated"), ("estimator", "rcme_calibrated_half_wrong"),
        ("peer", "opencv_usac_magsac"), ("trial", "trial"))]
    series = {name: [{"size": size, **time} for size in (100, 1000)] for name in ("n", "n_scoring", "iterations", "trials")}
    return {"run": {"problem": "500 matches", "rounds": 30, "clock": "processor time", "instruction_set": "AVX2", "cores": 2},
            "ratios": {f"exponent_{name}": 1.0 for name in series}, "cases": cases, "series": series}


class Benchmarks(PlotTestCase):
    script, given = script, ["benchmarks.json"]

    def test_estimators_have_names_in_words(self):
        names = [label.get_text().replace("\n", " ") for axes in script.draw(content()).axes for label in axes.get_yticklabels()]
        self.assertLessEqual({"RCME, calibrated", "RCME, calibrated, half of the matches wrong", "OpenCV USAC_MAGSAC"}, set(names))
        self.assertFalse([name for name in names if name.startswith("Rcme")])

    def test_what_is_no_benchmark_is_refused(self):
        self.assert_refused(self.run_script(self.write({"run": {}}), "--out", self.folder / "figure"), "rcme_ratios")


if __name__ == "__main__":
    unittest.main()
