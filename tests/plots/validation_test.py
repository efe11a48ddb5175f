#!/usr/bin/python3
"""Tests of plots/validation.py; run as: /usr/bin/python3 tests/plots/validation_test.py"""

import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest
import warnings

PLOTS = pathlib.Path(__file__).resolve().parents[2] / "plots"
sys.path.insert(0, str(PLOTS))

import validation as script  # noqa: E402

warnings.simplefilter("error")


def test_of(name, ratio, verdict):
    interval = [None, None] if ratio is None else [0.8 * ratio, 1.3 * ratio]
    return {"test": name, "ratio": ratio, "interval": interval, "verdict": verdict, "n": 10}


def fake():
    """Two scenes; the second has no triples and too few neighbours."""
    def correlation(low, high, value):
        bounds = [None, None] if value is None else [value - 0.1, value + 0.1]
        return {"from_px": low, "to_px": high, "correlation": value or 0.0, "twin_correlation": 0.0, "difference_interval": bounds}
    def fault(value, verdict):
        bounds = [None, None] if value is None else [value - 0.001, value + 0.001]
        return {"fault": "focal_length", "nominal": 0.002, "verdict": verdict, "beside_others": {"value": value, "interval": bounds}}
    sets = [{"name": "hall", "camera_faults": [fault(0.004, "wrong")], "pairs": 12, "tests": [test_of("spatial_halves", 2.0, "too small"), test_of("random_halves", 1.0, "holds"),
                                                    test_of("closure", 3.0, "undecided")],
             "correlations": [correlation(0, 1, 0.8), correlation(1, 4, 0.1)]},
            {"name": "street", "camera_faults": [fault(None, "no data")], "pairs": 3, "tests": [test_of("spatial_halves", 0.5, "too large"), test_of("random_halves", 1.1, "holds"),
                                                     test_of("closure", None, "no data")],
             "correlations": [correlation(0, 1, None), correlation(1, 4, 0.0)]}]
    return {"format": script.FORMAT, "nominal_variance": 1.5, "nominal_correlation": 0.05, "sets": sets}


class Validation(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_on(self, content):
        path = self.folder / "validation.json"
        path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
        with contextlib.redirect_stderr(io.StringIO()) as errors, contextlib.redirect_stdout(io.StringIO()):
            code = script.main([str(path), "--out", str(self.folder / "figure")])
        return code, errors.getvalue()

    def test_draws_png_and_pdf(self):
        self.assertEqual(self.run_on(fake()), (0, ""))
        for suffix in ("png", "pdf"):
            self.assertGreater((self.folder / f"figure.{suffix}").stat().st_size, 1000)

    def test_every_test_with_a_ratio_stands_at_it(self):
        ratios = script.draw(fake()).axes[0]
        markers = [line.get_xdata()[0] for line in ratios.lines if line.get_marker() in "os^" and len(line.get_xdata()) == 1]
        self.assertEqual(markers, [2.0, 1.0, 3.0, 0.5, 1.1])

    def test_every_fault_stands_at_its_multiple_of_what_is_nominal(self):
        faults = script.draw(fake()).axes[2]
        self.assertEqual([line.get_xdata()[0] for line in faults.lines if line.get_marker() == "o"], [2.0])

    def test_what_is_no_validation_is_refused(self):
        for content in ("{", "[]", {"format": "rcme summary 1", "sets": [1]}, {**fake(), "sets": []}):
            code, errors = self.run_on(content)
            self.assertEqual(code, 2)
            self.assertIn("validation.json", errors)


if __name__ == "__main__":
    unittest.main()
