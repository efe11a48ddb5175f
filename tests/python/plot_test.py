"""Each figure draws the table's numbers on the axes that it is given."""

import unittest

import matplotlib
import numpy as np
import rcme
from small_study import STUDY

matplotlib.use("Agg")
from matplotlib.figure import Figure  # noqa: E402


class Plot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.run_file = rcme.run({**STUDY, "estimators": [*STUDY["estimators"], {"name": "rcme_calibrated"}]})
        cls.summary = rcme.summarize(cls.run_file)

    def setUp(self):
        self.ax = Figure().subplots()

    def test_rate(self):
        self.assertIs(rcme.plot.rate(self.ax, self.summary, "outlier_ratio", estimators=["standard"],
                                     labels={"standard": "S"}), self.ax)
        own = self.summary[(self.summary.estimator == "standard") & (self.summary.quantity == "failure")]
        np.testing.assert_allclose(self.ax.lines[0].get_xydata(), np.column_stack([[0.1, 0.4], 100 * own.value]))
        self.assertEqual(self.ax.get_legend_handles_labels()[1], ["S"])
        band = self.ax.collections[0].get_paths()[0].vertices
        self.assertAlmostEqual(band[:, 1].max(), 100 * own.upper.max())

    def test_a_level_is_one_however_it_is_written(self):
        for level in (0.1, "0.1", "0.10", "1e-1"):
            rcme.plot.rate(self.ax, self.summary, "condition", where={"outlier_ratio": level})
        with self.assertRaisesRegex(ValueError, "no row has outlier_ratio = 0.2"):
            rcme.plot.rate(self.ax, self.summary, "condition", where={"outlier_ratio": 0.2})

    def test_words_stand_side_by_side(self):
        frame = self.summary.assign(scene=self.summary.outlier_ratio.map({0.1: "room", 0.4: "street"}))
        rcme.plot.rate(self.ax, frame, "scene", "success")
        self.assertEqual([tick.get_text() for tick in self.ax.get_xticklabels()], ["room", "street"])
        self.assertEqual(len(self.ax.containers), 3)

    def test_paired_difference(self):
        frame = rcme.compare(self.run_file)
        rcme.plot.paired_difference(self.ax, frame, "outlier_ratio", "failure_or_refusal", estimators=["rcme_rank_aware"])
        own = frame[(frame.estimator == "rcme_rank_aware") & (frame.event == "failure_or_refusal")]
        np.testing.assert_allclose(self.ax.lines[0].get_ydata(), 100 * own.risk_difference)

    def test_reliability(self):
        measured = rcme.reliability(self.run_file)
        rcme.plot.reliability(self.ax, measured, "rcme_calibrated")
        entry = next(entry for entry in measured["entries"] if entry["estimator"] == "rcme_calibrated")
        self.assertEqual(len(self.ax.lines[1].get_xydata()), 2 * len(entry["curve"]))

    def test_audit(self):
        audited = rcme.audit(only="inlier.true_pose.as_printed")
        rcme.plot.audit(self.ax, audited, claim="inlier.true_pose")
        rows = audited[(audited.kind == "rate") & audited.verdict.notna()]
        self.assertGreater(len(rows), 3)
        self.assertEqual(len(self.ax.get_yticks()), len(rows))

    def test_matches(self):
        trial = rcme.simulate(STUDY, 1, 0)
        rcme.plot.matches(self.ax, trial)
        self.assertEqual(sum(len(line.get_xdata()) == 2 for line in self.ax.lines), 100)


if __name__ == "__main__":
    unittest.main()
