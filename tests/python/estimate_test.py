"""estimate_relative_pose and simulate: right numbers in the stated conventions."""

import json
import os
import signal
import subprocess
import threading
import time
import unittest

import numpy as np
import rcme
from program import PROGRAM, write_matches
from small_study import STUDY, angle, rotation_angle, vector_of


class Estimate(unittest.TestCase):
    def setUp(self):
        self.trial = rcme.simulate(STUDY, condition=1, trial=3)
        self.arguments = [self.trial[key] for key in ("x1", "x2", "camera1", "camera2")]

    def test_the_default_finds_the_motion_and_says_how_sure_it_is(self):
        pose, info = rcme.estimate_relative_pose(*self.arguments)
        truth = self.trial["truth"]
        self.assertEqual((info["status"], info["estimator"]), ("ok", "rcme_calibrated"))
        self.assertLess(rotation_angle(pose.R, truth["R"]), 1.0)
        self.assertLess(angle(pose.t, truth["t"]), 5.0)
        self.assertAlmostEqual(np.linalg.norm(pose.t), 1.0, places=12)
        self.assertEqual(info["inliers"].dtype, bool)
        self.assertEqual(info["num_inliers"], info["inliers"].sum())
        self.assertGreater((info["inliers"] & truth["inliers"]).sum(), 0.8 * truth["inliers"].sum())
        self.assertTrue(0 <= info["p_failure"] <= 0.5)
        self.assertTrue(0.3 < info["sigma"] < 0.8)
        self.assertEqual(info["inlier_probabilities"].shape, (100,))

    def test_other_bounds_are_of_the_same_fit(self):
        _, info = rcme.estimate_relative_pose(*self.arguments, bounds=[(1, 5), (3, 15), (1e-6, 1e-6)])
        of = info["p_failure_for_bounds"]
        self.assertEqual([(p["rotation_deg"], p["direction_deg"]) for p in of], [(1, 5), (3, 15), (1e-6, 1e-6)])
        self.assertAlmostEqual(of[1]["p_failure"], info["p_failure"], places=9)
        self.assertGreaterEqual(of[0]["p_failure"], of[1]["p_failure"])
        self.assertAlmostEqual(of[2]["p_failure"], 1.0, places=6)
        self.assertEqual(of[2]["domain"], "extrapolated")
        self.assertEqual(rcme.estimate_relative_pose(*self.arguments)[1]["p_failure"], info["p_failure"])

    def test_cameras_that_cannot_be_those_of_the_images_are_noticed(self):
        x1, x2, camera, _ = self.arguments
        fx, fy, cx, cy = camera["params"]
        half = {**camera, "params": [fx / 2, fy / 2, cx / 2, cy / 2]}
        with self.assertWarnsRegex(UserWarning, "camera1: .*if it was scaled"):
            rcme.estimate_relative_pose(x1, x2, half, half)
        outside = {**camera, "params": [fx, fy, 3 * camera["width"], cy]}
        with self.assertRaisesRegex(ValueError, "camera1: .*outside of the image"):
            rcme.estimate_relative_pose(x1, x2, outside, camera)
        with self.assertRaisesRegex(ValueError, "camera1: key 'k1' is not allowed"):
            rcme.estimate_relative_pose(x1, x2, {**camera, "k1": -0.3}, camera)

    def test_draws_are_of_the_distribution_that_the_probabilities_are_computed_from(self):
        pose, info = rcme.estimate_relative_pose(*self.arguments, bounds=[(0.2, 1), (1, 5), (3, 15)], draws=20_000)
        R, t = info["draws"]["R"], info["draws"]["t"]
        self.assertEqual((R.shape, t.shape), ((20_000, 3, 3), (20_000, 3)))
        is_none = np.isnan(t[:, 0])
        self.assertTrue((np.isnan(R).any(axis=(1, 2)) == is_none).all())
        cosine = (np.einsum("nij,ij->n", R, pose.R) - 1.0) / 2.0
        rotation, direction = (np.degrees(np.arccos(np.clip(c, -1.0, 1.0))) for c in (cosine, t @ pose.t))
        for p in info["p_failure_for_bounds"]:
            beyond = is_none | (rotation > p["rotation_deg"]) | (direction > p["direction_deg"])
            # Five standard deviations of the share, and what the points behind p_failure err by.
            tolerance = 5 * np.sqrt(p["p_failure"] * (1 - p["p_failure"]) / 20_000) + 0.005
            self.assertAlmostEqual(beyond.mean(), p["p_failure"], delta=tolerance)
        self.assertTrue(0.05 < info["p_failure_for_bounds"][0]["p_failure"] < 0.95, "no power")
        x1, x2, *cameras = self.arguments
        other_pose, other = rcme.estimate_relative_pose(x1[1:], x2[1:], *cameras, draws=20_000)
        pairs = zip(R @ pose.R.T, other["draws"]["R"] @ other_pose.R.T)
        offsets = np.array([(a[2, 1] - a[1, 2], b[2, 1] - b[1, 2]) for a, b in pairs if np.isfinite([a, b]).all()])
        self.assertLess(abs(np.corrcoef(offsets.T)[0, 1]), 0.04, "pairs share their random numbers")  # five standard deviations
        again = rcme.estimate_relative_pose(*self.arguments, draws=3)[1]["draws"]
        np.testing.assert_array_equal(again["t"], t[:3])
        self.assertIsNone(rcme.estimate_relative_pose(*self.arguments)[1]["draws"])
        with self.assertRaisesRegex(ValueError, "draws: only rcme_calibrated"):
            rcme.estimate_relative_pose(*self.arguments, {"estimator": "standard"}, draws=1)
        with self.assertRaisesRegex(ValueError, "draws"):
            rcme.estimate_relative_pose(*self.arguments, draws=-1)

    def test_protection_levels_are_of_the_covariance_the_probability_and_the_risk(self):
        """An isotropic covariance has closed forms, but no estimator states one: the levels lie between those of the least and
        of the greatest standard deviation in all directions."""
        _, info = rcme.estimate_relative_pose(*self.arguments, {"estimator": "standard", "integrity_risk": 0.01})
        levels, cov = info["protection_levels"], info["pose_cov"]
        self.assertEqual(levels["risk"], 0.01)
        for name, block, quantile in (("rotation", cov[:3, :3], 3.3682), ("direction", cov[3:, 3:], 3.0349)):
            sd = np.sqrt(np.linalg.eigvalsh(block)[-1])
            self.assertTrue(2.5758 * sd * 0.999 < levels[name] < quantile * sd * 1.001, name)
        stated = rcme.estimate_relative_pose(*self.arguments, {"integrity_risk": 0.9})[1]
        self.assertLess(stated["protection_levels"]["rotation"], 1.0)
        nothing = rcme.estimate_relative_pose(*self.arguments, {"integrity_risk": 1e-12})[1]
        self.assertGreater(nothing["protection_levels"]["rotation"], stated["protection_levels"]["rotation"])
        default = rcme.estimate_relative_pose(*self.arguments)[1]["protection_levels"]
        self.assertEqual(default["risk"], 1e-3)
        few = [array[:3] for array in self.arguments[:2]] + self.arguments[2:]
        self.assertIsNone(rcme.estimate_relative_pose(*few)[1]["protection_levels"])
        with self.assertRaisesRegex(ValueError, "integrity_risk"):
            rcme.estimate_relative_pose(*self.arguments, {"integrity_risk": 0})

    def test_pose_cov_is_of_rotation_and_translation_in_this_order(self):
        pose, info = rcme.estimate_relative_pose(*self.arguments, {"estimator": "standard"})
        cov = info["pose_cov"]
        self.assertEqual(cov.shape, (6, 6))
        np.testing.assert_allclose(cov, cov.T, atol=1e-15)
        self.assertEqual(np.linalg.matrix_rank(cov, tol=1e-12), 5)
        np.testing.assert_allclose(cov[3:, 3:] @ pose.t, 0, atol=1e-12)  # nothing along t

    def test_the_truth_lies_in_the_covariance_as_often_as_it_says(self):
        """NEES of rotation and direction with the stated convention, 5 degrees of freedom: of 200 good answers to problems
        without outliers, 95 % are below 11.07. Fewer than 180 or a mean outside 4 to 6 have probability < 0.002 each if the
        covariance is right; with w of camera 1's frame, or dt before w, the mean is far outside."""
        study = {**STUDY, "factors": {"outlier_ratio": [0.0]}, "data": {**STUDY["data"], "sigma_px": 0.1}}
        values = []
        for number in range(200):
            trial = rcme.simulate(study, 0, number)
            pose, info = rcme.estimate_relative_pose(trial["x1"], trial["x2"], trial["camera1"], trial["camera2"],
                                                     {"estimator": "standard", "sigma_px": 0.1})
            w = vector_of(trial["truth"]["R"] @ pose.R.T)
            basis = np.linalg.svd(np.outer(pose.t, pose.t))[0][:, 1:]  # any two directions normal to t
            J = np.block([[np.eye(3), np.zeros((3, 3))], [np.zeros((2, 3)), basis.T]])
            error = J @ np.concatenate([w, trial["truth"]["t"] - pose.t])
            values.append(error @ np.linalg.solve(J @ info["pose_cov"] @ J.T, error))
        self.assertGreater(np.sum(np.array(values) < 11.0705), 180)
        self.assertTrue(4.0 < np.mean(values) < 6.0, np.mean(values))

    def test_the_same_numbers_as_the_program(self):
        path = write_matches(self.trial)
        text = subprocess.run([PROGRAM, "estimate", path, "--format", "json", "--seed", "5", "--sigma", "0.7"], check=True,
                              capture_output=True, text=True).stdout
        said = json.loads(text)
        pose, info = rcme.estimate_relative_pose(*self.arguments, {"seed": 5, "sigma_px": 0.7})
        np.testing.assert_array_equal(pose.R.ravel(), said["R"])
        np.testing.assert_array_equal(pose.t, said["t"])
        self.assertEqual(info["p_failure"], said["failure_probability"])
        np.testing.assert_array_equal(info["pose_cov"].ravel(), said["pose_cov"])
        self.assertEqual(len(info["other_motions"]), len(said["other_modes"]))
        for here, there in zip(info["other_motions"], said["other_modes"]):
            np.testing.assert_array_equal(here["pose_cov"].ravel(), there["pose_cov"])

    def test_a_prior_is_used_or_contradicted(self):
        truth = self.trial["truth"]["R"]
        _, info = rcme.estimate_relative_pose(*self.arguments)
        self.assertEqual((info["prior"], info["prior_p_value"]), ("none", None))
        pose, info = rcme.estimate_relative_pose(*self.arguments, prior={"rotation": truth, "rotation_sd_deg": 1e-3})
        self.assertEqual(info["prior"], "used")
        self.assertLess(np.linalg.norm(pose.R - truth), 1e-4)
        down = np.array([0.0, 1.0, 0.0])
        sensors = {"gravity1": 9.81 * down, "gravity2": 9.81 * truth @ down, "gravity_sd_deg": 0.01,
                   "direction": self.trial["truth"]["t"], "direction_sd_deg": 5, "rotation": truth,
                   "rotation_cov": 1e-4 * np.eye(3)}
        pose, info = rcme.estimate_relative_pose(*self.arguments, prior=sensors)
        self.assertEqual(info["prior"], "used")
        self.assertLess(np.linalg.norm((pose.R - truth) @ down), 1e-3)
        turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        _, info = rcme.estimate_relative_pose(*self.arguments, prior={"rotation": turn @ truth, "rotation_sd_deg": 1})
        self.assertEqual(info["prior"], "contradicted")
        self.assertLess(info["prior_p_value"], 1e-3)

    def test_many_pairs_have_the_answers_of_single_calls(self):
        trials = [rcme.simulate(STUDY, condition=1, trial=number) for number in range(7)]
        pairs = [tuple(trial[key] for key in ("x1", "x2", "camera1", "camera2")) for trial in trials]
        pairs[2] = tuple(part[:3] for part in pairs[2][:2]) + pairs[2][2:]  # too few matches
        pairs[4] += (np.linspace(0.5, 2.0, len(pairs[4][0])),)
        options, bounds = {"sigma_px": 0.7, "seed": 5}, [(1, 5), (10, 40)]
        found = rcme.estimate_relative_poses(pairs, options, bounds, threads=2)
        self.assertEqual(found.R.shape, (7, 3, 3))
        self.assertEqual(found.status[2], "too_few_matches")
        self.assertTrue(np.isnan(found.R[2]).all() and np.isnan(found.pose_cov[2]).all() and np.isnan(found.p_failure[2]))
        for i, pair in enumerate(pairs):
            scales = {"noise_scale": pair[4]} if len(pair) == 5 else {}
            pose, info = rcme.estimate_relative_pose(*pair[:4], {**options, **scales}, bounds)
            self.assertEqual(found.status[i], info["status"])
            np.testing.assert_array_equal(found.inliers[i], info["inliers"])
            self.assertEqual(found.num_inliers[i], info["num_inliers"])
            self.assertEqual(found.p_failure_domain[i], info["p_failure_domain"])
            if pose is None:
                continue
            for here, there in ((found.R[i], pose.R), (found.t[i], pose.t), (found.pose_cov[i], info["pose_cov"]),
                                (found.p_failure[i], info["p_failure"]), (found.sigma[i], info["sigma"]),
                                (found.p_failure_for_bounds[i], [p["p_failure"] for p in info["p_failure_for_bounds"]])):
                np.testing.assert_array_equal(here, there)
        for threads in (1, 8):
            again = rcme.estimate_relative_poses(pairs, options, bounds, threads)
            for here, there in zip(found[:-1], again[:-1]):
                np.testing.assert_array_equal(here, there)
        self.assertEqual(rcme.estimate_relative_poses([]).R.shape, (0, 3, 3))

    def test_threads_of_python_may_call_at_a_time_and_an_interrupt_still_comes(self):
        pairs = [tuple(self.arguments)] * 40
        found = []
        callers = [threading.Thread(target=lambda n=n: found.append(rcme.estimate_relative_poses(pairs[:n]))) for n in (5, 20, 40)]
        for caller in callers:
            caller.start()
        for caller in callers:
            caller.join()
        self.assertEqual(sorted(len(poses.status) for poses in found), [5, 20, 40])
        with self.assertRaises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(5)

    def test_an_interrupt_ends_the_call(self):
        pairs = [tuple(self.arguments)] * 200
        timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaisesRegex(KeyboardInterrupt, "stopped"):  # Python's own, between two calls, has no words
            rcme.estimate_relative_poses(pairs, {"estimator": "standard", "num_iterations": 200_000}, threads=1)

    def test_cameras_in_every_form(self):
        fx, fy, cx, cy = self.trial["camera1"]["params"]
        K = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
        simple = {"model": "SIMPLE_PINHOLE", "width": self.trial["camera1"]["width"],
                  "height": self.trial["camera1"]["height"], "params": [fx, cx, cy]}
        first, _ = rcme.estimate_relative_pose(*self.arguments, {"estimator": "standard"})
        for camera in (self.trial["camera1"], K, 2 * K, K.tolist(), simple):
            np.testing.assert_array_equal(rcme.intrinsics(camera), K)
        for camera in (K, K.tolist(), simple):
            pose, info = rcme.estimate_relative_pose(*self.arguments[:2], camera, camera, {"estimator": "standard"})
            np.testing.assert_array_equal(pose.R, first.R)

    def test_lenses_are_undone(self):
        """Matches through OpenCV's fisheye model, written out: those of the pinhole come back."""
        fx, fy, cx, cy = self.trial["camera1"]["params"]
        size = {key: self.trial["camera1"][key] for key in ("width", "height")}

        def distorted(points, coefficients):
            rays = (np.asarray(points) - [cx, cy]) / [fx, fy]
            r = np.linalg.norm(rays, axis=1, keepdims=True)
            theta = np.arctan(r)
            return theta * (1 + coefficients[0] * theta**2 + coefficients[1] * theta**4) / r * rays * [fx, fy] + [cx, cy]

        coefficients = [0.02, -0.01, 0.0, 0.0]
        lens = {"model": "OPENCV_FISHEYE", "params": [fx, fy, cx, cy, *coefficients], **size}
        images = [distorted(points, coefficients) for points in self.arguments[:2]]
        first, _ = rcme.estimate_relative_pose(*self.arguments)
        pose, info = rcme.estimate_relative_pose(*images, lens, lens)
        self.assertEqual(info["status"], "ok")
        self.assertLess(np.linalg.norm(pose.R - first.R), 2e-3)  # noise is weighed in another way
        together = rcme.estimate_relative_poses([(*images, lens, lens)])
        np.testing.assert_array_equal(together.R[0], pose.R)
        wrong, _ = rcme.estimate_relative_pose(*images, *self.arguments[2:])
        self.assertGreater(np.linalg.norm(wrong.R - first.R), np.linalg.norm(pose.R - first.R))
        self.assertTrue(0.3 < info["sigma"] < 0.8)  # of the images as they are, not of their undistorted points

    def test_a_match_that_has_no_ray_is_no_inlier(self):
        fx, fy, cx, cy = self.trial["camera1"]["params"]
        lens = {**self.trial["camera1"], "model": "OPENCV_FISHEYE", "params": [fx, fy, cx, cy, 0.0, 0.0, 0.0, 0.0]}
        x1, x2, camera1, camera2 = self.arguments
        row = int(np.flatnonzero(self.trial["truth"]["inliers"])[3])
        far = x1.copy()
        far[row] = [cx + 1.6 * fx, cy]  # 92 deg from the axis
        for _, info in (rcme.estimate_relative_pose(x1, x2, lens, lens), rcme.estimate_relative_pose(far, x2, lens, lens)):
            self.assertEqual((len(info["inliers"]), len(info["inlier_probabilities"])), (100, 100))
        self.assertFalse(info["inliers"][row])
        self.assertEqual(info["inlier_probabilities"][row], 0.0)
        many = rcme.estimate_relative_poses([(far, x2, lens, lens)])
        np.testing.assert_array_equal(many.inliers[0], info["inliers"])

    def test_pixels_that_count_from_the_principal_point(self):
        """K says the size of the image only where it holds the points."""
        x1, x2, camera1, camera2 = self.arguments
        fx, fy, cx, cy = camera1["params"]
        centre = np.array([cx, cy])
        K, centred = (np.array([[fx, 0, c[0]], [0, fy, c[1]], [0, 0, 1.0]]) for c in (centre, (0, 0)))
        expected, of = rcme.estimate_relative_pose(x1, x2, K, K)
        pose, info = rcme.estimate_relative_pose(x1 - centre, x2 - centre, centred, centred)
        self.assertLess(np.linalg.norm(pose.R - expected.R), 1e-4)
        self.assertLess(abs(np.log(info["p_failure"] / of["p_failure"])), 0.7)
        self.assertLess(abs(np.log(np.trace(info["pose_cov"]) / np.trace(of["pose_cov"]))), 0.5)

    def test_an_interrupt_within_a_function_is_one(self):
        def interrupted(*_):
            raise KeyboardInterrupt
        with self.assertRaises(KeyboardInterrupt):
            rcme.estimate_relative_pose(*self.arguments, {"estimator": "f"}, estimators={"f": interrupted})

    def test_what_a_generator_raises_is_its_own(self):
        def pairs():
            yield tuple(self.arguments)
            raise TypeError("of the generator")
        with self.assertRaisesRegex(TypeError, "of the generator"):
            rcme.estimate_relative_poses(pairs())
        masked = np.ma.array(self.arguments[0], mask=False)
        masked[:3] = np.ma.masked
        with self.assertRaisesRegex(ValueError, "x1: some of its numbers are masked"):
            rcme.estimate_relative_pose(masked, *self.arguments[1:])

    def test_every_estimator_with_its_options(self):
        known = rcme.estimators()
        self.assertIn("rcme_calibrated", known)
        for name in known:
            if name in ("process", "answers", "conform"):  # nothing to ask is given
                continue
            pose, info = rcme.estimate_relative_pose(*self.arguments, {"estimator": name})
            self.assertIn(info["status"], ("ok", "no_candidate"), name)
            self.assertEqual(pose is None, info["status"] != "ok")
        _, info = rcme.estimate_relative_pose(*self.arguments, {"estimator": "standard", "num_iterations": 1})
        self.assertIsNone(info["p_failure"])

    def test_a_refusal_is_a_status(self):
        few = [points[:4] for points in self.arguments[:2]]
        pose, info = rcme.estimate_relative_pose(*few, *self.arguments[2:])
        self.assertIsNone(pose)
        self.assertEqual(info["status"], "too_few_matches")
        self.assertIsNone(info["pose_cov"])
        pose, info = rcme.estimate_relative_pose(np.zeros((0, 2)), np.zeros((0, 2)), *self.arguments[2:])
        self.assertEqual(info["status"], "too_few_matches")

    def test_arrays_of_any_layout_and_type(self):
        first, _ = rcme.estimate_relative_pose(*self.arguments, {"estimator": "standard"})
        again, _ = rcme.estimate_relative_pose(np.asfortranarray(self.arguments[0]), self.arguments[1].tolist(),
                                               *self.arguments[2:], {"estimator": "standard"})
        np.testing.assert_array_equal(first.R, again.R)
        pose, info = rcme.estimate_relative_pose(self.arguments[0].astype(np.float32), self.arguments[1].round().astype(int),
                                                 *self.arguments[2:])
        self.assertEqual(info["status"], "ok")


class Simulate(unittest.TestCase):
    def test_a_trial_is_a_function_of_its_name(self):
        first, again, other = (rcme.simulate(STUDY, 1, trial) for trial in (7, 7, 8))
        np.testing.assert_array_equal(first["x1"], again["x1"])
        self.assertFalse(np.array_equal(first["x1"], other["x1"]))
        self.assertFalse(np.array_equal(first["x1"], rcme.simulate(STUDY, 1, 7, seed=2)["x1"]))

    def test_truth_fits_the_matches(self):
        """Without noise, true matches obey x2' K^-T [t]x R K^-1 x1 = 0; wrong ones do not."""
        trial = rcme.simulate(STUDY, 1, 0, overrides={"sigma_px": 1e-9})
        R, t = trial["truth"]["R"], trial["truth"]["t"]
        fx, fy, cx, cy = trial["camera1"]["params"]
        rays = [np.column_stack([(x - [cx, cy]) / [fx, fy], np.ones(len(x))]) for x in (trial["x1"], trial["x2"])]
        cross = np.array([[0, -t[2], t[1]], [t[2], 0, -t[0]], [-t[1], t[0], 0]])
        residuals = np.abs(np.einsum("ij,jk,ik->i", rays[1], cross @ R, rays[0]))
        is_inlier = trial["truth"]["inliers"]
        self.assertEqual(is_inlier.sum(), 60)
        self.assertLess(residuals[is_inlier].max(), 1e-9)
        self.assertGreater(np.median(residuals[~is_inlier]), 1e-3)
        self.assertEqual(trial["levels"], {"outlier_ratio": "0.4"})
        self.assertGreater(trial["severity"]["crb_direction_deg"], 0)

    def test_conditions(self):
        frame = rcme.conditions(STUDY)
        self.assertEqual(frame.outlier_ratio.tolist(), ["0.1", "0.4"])
        self.assertEqual(frame.trials.tolist(), [20, 20])


if __name__ == "__main__":
    unittest.main()
