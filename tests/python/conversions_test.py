"""What goes in and out of the C++ half, number for number: cameras, masks, answers of functions, tables."""

import json
import sqlite3
import unittest
from contextlib import closing

import numpy as np
import rcme
from rcme import _check, _function, _tables, plot
from small_study import STUDY


class Cameras(unittest.TestCase):
    def setUp(self):
        self.given = []
        self.original = _check._rcme.Camera
        _check._rcme.Camera = lambda model, params, width, height: self.given.append((model, params, width, height))
        self.addCleanup(setattr, _check._rcme, "Camera", self.original)

    def test_of_every_form(self):
        K = np.array([[500.0, 0, 320.0], [0, 600.0, 200.0], [0, 0, 1]])
        _check.camera("camera1", K)
        _check.camera("camera1", 2 * K)  # of any scale
        self.assertEqual(self.given, [("PINHOLE", [500.0, 600.0, 320.0, 200.0], 641, 401)] * 2)
        sizes = {"width": 640, "height": 480}
        _check.camera("camera1", {"model": "PINHOLE", "params": [1.0, 2.0, 3.0, 4.0], **sizes})
        _check.camera("camera1", {"model": "SIMPLE_PINHOLE", "params": [7.0, 3.0, 4.0], **sizes})
        _check.camera("camera1", {"model": "RADIAL", "params": [7.0, 3.0, 4.0, -0.1, 0.2], **sizes})
        self.assertEqual(self.given[2:], [("PINHOLE", [1.0, 2.0, 3.0, 4.0], 640, 480), ("SIMPLE_PINHOLE", [7.0, 3.0, 4.0], 640, 480),
                                          ("RADIAL", [7.0, 3.0, 4.0, -0.1, 0.2], 640, 480)])
        with self.assertRaisesRegex(ValueError, "camera1: fx = 7, fy = -1"):  # the second number of an OPENCV is fy
            _check.camera("camera1", {"model": "OPENCV", "params": [7.0, -1.0, 4.0, 5.0, 0, 0, 0, 0], **sizes})


class Points(unittest.TestCase):
    def test_coordinates_up_to_a_million(self):
        self.assertEqual(_check.points("x1", [[1e6, -1e6]]).tolist(), [[1e6, -1e6]])
        with self.assertRaisesRegex(ValueError, "x1: row 0"):
            _check.points("x1", [[1.1e6, 0]])

    def test_both_images_have_as_many(self):
        camera = {"model": "PINHOLE", "width": 640, "height": 480, "params": [500, 500, 320, 240]}
        points = np.random.default_rng(1).uniform(0, 400, (30, 2))
        with self.assertRaisesRegex(ValueError, "x2: its shape"):
            rcme.estimate_relative_pose(points, points[:20], camera, camera)


class AnswersOfFunctions(unittest.TestCase):
    POSE = (np.eye(3), np.ones(3))

    def inliers(self, given, num_matches=3):
        return _function.fields_of((self.POSE, {"inliers": given}), num_matches)["inliers"]

    def test_masks_and_indices(self):
        self.assertEqual(self.inliers([True, False, True]), [0, 2])
        self.assertEqual(self.inliers(np.array([[1], [0], [1]], np.uint8)), [0, 2])  # as OpenCV has it
        self.assertEqual(self.inliers(np.array([0, 2])), [0, 2])
        for beyond in ([3], [-1]):
            with self.assertRaises(_function.Unreadable):
                self.inliers(beyond)

    def test_poses_of_every_form(self):
        column = np.array([[1.0], [2.0], [3.0]])
        for pose in ((np.eye(3), column), {"R": np.eye(3), "t": [1, 2, 3]}, np.hstack([np.eye(3), column])):
            fields = _function.fields_of(pose, 3)
            self.assertEqual(fields["t"].tolist(), [1, 2, 3])
            self.assertEqual(fields["status"], "ok")

    def test_a_run_keeps_what_a_function_says(self):
        """The scene's motion, five inliers, a noise of 0.3125 px and a probability of 0.25, of 90 true matches."""
        def says(x1, x2, camera1, camera2, options):
            trial = rcme.simulate(STUDY, 0, 0)
            np.testing.assert_array_equal(x1, trial["x1"])
            np.testing.assert_array_equal(x2, trial["x2"])
            return ((trial["truth"]["R"], trial["truth"]["t"]),
                    {"inliers": [0, 1, 2, 3, 4, 7, 8], "sigma": 0.3125, "p_failure": 0.25, "pose_cov": 1e-6 * np.eye(6)})

        run = rcme.run({**STUDY, "factors": {"outlier_ratio": [0.1]}}, {"says": says}, trials=1, threads=1)
        with closing(sqlite3.connect(run)) as database:
            columns = [row[1] for row in database.execute("PRAGMA table_info(trials)")]
            rows = [dict(zip(columns, row)) for row in database.execute("SELECT * FROM trials")]
        said = [row for row in rows if row["sigma_estimated_px"] == 0.3125]
        self.assertEqual(len(said), 1, columns)
        self.assertEqual(said[0]["num_inliers"], 7)
        self.assertEqual(said[0]["failure_probability"], 0.25)


class Estimates(unittest.TestCase):
    def answer(self, **more):
        return {"status": "ok", "message": "", "estimator": "x", "motion": None, "inliers": [1], "p_failure": np.nan,
                "p_failure_domain": "not_stated", "p_failure_for_bounds": [], "draws": None, "protection_levels": None, "sigma": 0.5,
                "sigma_sd": np.nan, "prior": "none", "prior_p_value": np.nan, "calibration_error_probability": np.nan,
                "inlier_probabilities": [], "other_motions": [], **more}

    def test_unknown_numbers_are_none(self):
        from rcme import _estimate
        pose, info = _estimate._pose_and_info(self.answer(), 3)
        self.assertIsNone(pose)
        self.assertEqual([info[key] for key in ("p_failure", "sigma", "sigma_sd", "prior_p_value", "calibration_error_probability")],
                         [None, 0.5, None, None, None])
        self.assertEqual(info["inliers"].tolist(), [False, True, False])
        self.assertIsNone(info["inlier_probabilities"])

    def test_a_rotation_alone_has_the_covariance_of_the_rotation(self):
        """Far points: the direction cannot be observed, the rotation is given with its own covariance."""
        study = {**STUDY, "data": {"scene": "uniform_volume", "num_matches": 200, "sigma_px": 0.5, "motion": "pure_rotation"}}
        study["factors"] = {"outlier_ratio": [0.0]}
        trial = rcme.simulate(study, 0, 0)
        pose, info = rcme.estimate_relative_pose(*(trial[key] for key in ("x1", "x2", "camera1", "camera2")),
                                                 {"estimator": "rcme", "observability_significance_level": 1e-3})
        self.assertEqual(info["status"], "direction_not_observable")
        self.assertTrue(np.isnan(pose.t).all())
        self.assertTrue((np.diag(info["pose_cov"])[:3] > 0).all())
        self.assertTrue(np.isnan(info["pose_cov"][3:]).all())


class Tables(unittest.TestCase):
    def test_rows_of_an_audit(self):
        target = {"quantity": "coverage", "kind": "rate", "measured": 0.5, "interval": [0.4, 0.6], "n": 10,
                  "verdict": "holds", "nominal": 0.5, "low": 0.3, "high": 0.7}
        file = {"claims": [{"id": "a.b", "family": "a", "reading": "", "verdict": "holds",
                            "evidence": [{"conditions": {"outliers": 3}, "targets": [target]}]}]}
        row, = _tables._audit_rows(json.loads(json.dumps(file)))
        self.assertEqual((row["lower"], row["value"], row["upper"]), (0.4, 0.5, 0.6))
        self.assertEqual((row["claim"], row["claim_verdict"], row["conditions"]), ("a.b", "holds", "outliers 3"))

    def test_arms_reach_from_the_value_to_the_interval(self):
        arms = plot._arms(np.array([0.5, np.nan]), np.array([0.4, np.nan]), np.array([0.8, np.nan]))
        np.testing.assert_allclose(arms, [[0.1, 0.0], [0.3, 0.0]])

    def test_conditions_end_with_the_last(self):
        self.assertEqual(rcme.simulate(STUDY, 1, 0)["condition"], 1)
        with self.assertRaisesRegex(ValueError, "conditions 0 to 1"):
            rcme.simulate(STUDY, 2, 0)

    def test_trials_of_the_call(self):
        summary = rcme.summarize(rcme.run(STUDY, trials=3))
        self.assertEqual(set(summary[summary.quantity == "failure"].n), {3})


if __name__ == "__main__":
    unittest.main()
