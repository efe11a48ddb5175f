"""rcme.conform: a function is made to keep its word, its file is an estimator, and a change of the problems is noticed."""

import os
import tempfile
import unittest

import numpy as np
import rcme
from small_study import STUDY


def overconfident(x1, x2, camera1, camera2, options):
    """The project's own estimator with a covariance that is too small by a factor of a hundred."""
    pose, info = rcme.estimate_relative_pose(x1, x2, camera1, camera2, {"estimator": "standard", **options})
    if pose is not None and info["pose_cov"] is not None:
        info["pose_cov"] = info["pose_cov"] / 100
    return pose, {"pose_cov": info["pose_cov"], "inliers": info["inliers"]} if pose is not None else None


class Conform(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = os.path.join(folder.name, "mine.conform.json")
        self.functions = {"mine": overconfident}

    def make(self):
        return rcme.conform(STUDY, estimator="mine", estimators=self.functions, out=self.file, trials=100)

    def test_a_function_keeps_its_word(self):
        report = self.make()
        coverage = {row["region"]: row["coverage"] for row in report["regions"]}
        self.assertLess(coverage["stated"], 0.5)
        self.assertGreater(coverage["conformed"], 0.9)  # n = 200: .95 with a standard deviation of .02
        self.assertTrue(report["promises"])

    def test_the_file_is_an_estimator(self):
        self.make()
        run = rcme.run(STUDY, {**self.functions, "kept": {"name": "conform", "options": {"file": self.file, "accept_rule": "ignore"}}}, trials=40, seed=5)
        table = rcme.summarize(run)
        covered = table[table.quantity == "nees_coverage"].groupby("estimator")["value"].mean()
        self.assertGreater(covered["kept"], covered["mine"] + 0.3)

    def test_the_file_of_a_function_is_an_estimator_of_single_calls(self):
        self.make()
        trial = rcme.simulate(STUDY, 0, 3)
        pair = [trial[key] for key in ("x1", "x2", "camera1", "camera2")]
        options = {"estimator": "conform", "file": self.file, "accept_rule": "ignore"}
        _, alone = rcme.estimate_relative_pose(*pair, {"estimator": "mine"}, estimators=self.functions)
        pose, kept = rcme.estimate_relative_pose(*pair, options, estimators=self.functions)
        self.assertIsNotNone(pose)
        self.assertGreater(np.trace(kept["pose_cov"]), 10 * np.trace(alone["pose_cov"]))
        many = rcme.estimate_relative_poses([pair] * 3, options, estimators=self.functions)
        np.testing.assert_array_equal(many.R[2], pose.R)
        np.testing.assert_array_equal(many.pose_cov[2], kept["pose_cov"])
        with self.assertRaisesRegex(ValueError, "'mine' is not there"):
            rcme.estimate_relative_pose(*pair, options)
        with self.assertRaisesRegex(ValueError, "'mine' has changed"):
            rcme.estimate_relative_pose(*pair, options, estimators={"mine": lambda *arguments: None})

    def test_a_change_is_noticed(self):
        self.make()
        same = rcme.conform(STUDY, check=self.file, estimators=self.functions, trials=40, seed=6)["shift"]
        noisy = rcme.conform(STUDY, check=self.file, estimators=self.functions, trials=40, seed=6, overrides={"sigma_px": 2})["shift"]
        self.assertIsNone(same["noticed_after"])
        self.assertIsNotNone(noisy["noticed_after"])

    def test_wrong_arguments_are_named(self):
        for words, arguments in (("out", {}), ("out", {"out": self.file, "check": self.file}), ("estimator", {"out": self.file}),
                                 ("new", {"out": self.file, "estimator": "standard", "new": "x"}),
                                 ("level", {"out": self.file, "estimator": "standard", "level": 1}),
                                 ("nobody", {"out": self.file, "estimator": "nobody"}),
                                 ("check", {"check": "/nowhere.json"}),
                                 ("trials", {"out": self.file, "estimator": "standard", "trials": 0})):
            with self.assertRaisesRegex(ValueError, words):
                rcme.conform(STUDY, **arguments)

    def test_an_estimate_by_the_file(self):
        rcme.conform(STUDY, estimator="standard", out=self.file, trials=100)
        trial = rcme.simulate(STUDY, 0, 3)
        options = {"estimator": "conform", "file": self.file, "accept_rule": "ignore"}
        pose, info = rcme.estimate_relative_pose(trial["x1"], trial["x2"], trial["camera1"], trial["camera2"], options)
        self.assertIsNotNone(pose)
        self.assertTrue(0 <= info["p_failure"] <= 1)
        self.assertIn(info["p_failure_domain"], ("verified", "extrapolated"))
        self.assertTrue(np.all(np.isfinite(info["pose_cov"])))


if __name__ == "__main__":
    unittest.main()
