"""The notebook: its cells in their order, as a notebook runs them, within its time."""

import importlib.util
import json
import pathlib
import time
import unittest

import matplotlib

matplotlib.use("Agg")

NOTEBOOK = pathlib.Path(__file__).parents[2] / "python/notebooks/own_estimator.ipynb"


@unittest.skipUnless(importlib.util.find_spec("cv2"), "the notebook's estimator is OpenCV's (python3-opencv)")
class Notebook(unittest.TestCase):
    def test_runs(self):
        cells = [cell for cell in json.loads(NOTEBOOK.read_text())["cells"] if cell["cell_type"] == "code"]
        names, start = {}, time.monotonic()
        for number, cell in enumerate(cells):
            exec(compile("".join(cell["source"]), f"cell {number}", "exec"), names)  # noqa: S102 (our own)
        self.assertLess(time.monotonic() - start, 300)
        summary, best = names["summary"], names["best"]
        coverage = summary[(summary.quantity == "nees_coverage") & (summary.estimator == "opencv_2_sigma")]
        self.assertEqual(len(coverage), 3)
        self.assertIn(best, names["candidates"])
        self.assertFalse(names["audited"].empty)
        for axes in names["axes"]:
            self.assertTrue(axes.lines)


if __name__ == "__main__":
    unittest.main()
