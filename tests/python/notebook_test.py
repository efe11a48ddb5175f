"""The notebook: its cells in their order, as a notebook runs them; with a fifth of its work, which OpenCV's random samples are
most of."""

import importlib.util
import json
import pathlib
import time
import unittest

import matplotlib

matplotlib.use("Agg")

NOTEBOOK = pathlib.Path(__file__).parents[2] / "python/notebooks/own_estimator.ipynb"
SHORTER = {'"trials": 40': '"trials": 20', '"num_matches": 200': '"num_matches": 80', "cv2.RANSAC, 0.999": "cv2.RANSAC, 0.9"}


@unittest.skipUnless(importlib.util.find_spec("cv2"), "the notebook's estimator is OpenCV's (python3-opencv)")
class Notebook(unittest.TestCase):
    def test_runs(self):
        cells = [cell for cell in json.loads(NOTEBOOK.read_text())["cells"] if cell["cell_type"] == "code"]
        names, start = {}, time.process_time()
        sources = ["".join(cell["source"]) for cell in cells]
        for text, shorter in SHORTER.items():
            self.assertEqual("".join(sources).count(text), 1)
            sources = [source.replace(text, shorter) for source in sources]
        for number, source in enumerate(sources):
            exec(compile(source, f"cell {number}", "exec"), names)  # noqa: S102 (our own)
        self.assertLess(time.process_time() - start, 60)
        summary, best = names["summary"], names["best"]
        coverage = summary[(summary.quantity == "nees_coverage") & (summary.estimator == "opencv_2_sigma")]
        self.assertEqual(len(coverage), 3)
        self.assertIn(best, names["candidates"])
        self.assertFalse(names["audited"].empty)
        for axes in names["axes"]:
            self.assertTrue(axes.lines)


if __name__ == "__main__":
    unittest.main()
