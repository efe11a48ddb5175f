"""run with functions of Python: the same trials, the same numbers on any number of threads, and nothing that a function does
ends a run; then the tables of a run, and tune."""

import os
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings

import numpy as np
import rcme
from program import PROGRAM
from rcme._function import code_of
from small_study import STUDY, TUNED_STUDY


def estimate_again(x1, x2, camera1, camera2, options):
    """The project's own estimator behind a function: must do as well as it does alone."""
    return rcme.estimate_relative_pose(x1, x2, camera1, camera2,
                                       {"estimator": "standard", "num_iterations": 50, **options})


def identity(*arguments):
    return np.eye(3), np.array([1.0, 0, 0])


def raise_error(*arguments):
    raise KeyError("of the function")


def leave(*arguments):
    sys.exit(3)


class NoRepresentation:
    def __repr__(self):
        raise RuntimeError("no repr")

    R = property(lambda self: 1 / 0)
    t = 1


# What comes back, and the status that it is. None of it may end the run.
ANSWERS = {
    "nothing": (None, "no_candidate"),
    "text": ("a pose", "unreadable_answer"),
    "number": (3.0, "unreadable_answer"),
    "shape": ((np.eye(4), np.ones(3)), "unreadable_answer"),
    "object": (NoRepresentation(), "unreadable_answer"),
    "no_rotation": ((2 * np.eye(3), np.ones(3)), "invalid_motion"),
    "mirrored": ((np.diag([1.0, 1, -1]), np.ones(3)), "invalid_motion"),
    "nan": ((np.full((3, 3), np.nan), np.ones(3)), "invalid_motion"),
    "no_length": ((np.eye(3), np.zeros(3)), "invalid_motion"),
    "inliers": (((np.eye(3), np.ones(3)), {"inliers": [5000]}), "unreadable_answer"),
    "twice": (((np.eye(3), np.ones(3)), {"inliers": [1, 1], "pose_cov": np.eye(6)}), "unreadable_answer"),
    "integers": (((np.eye(3), np.ones(3)), {"inliers": np.arange(100) % 2}), "unreadable_answer"),
    "list_of_integers": (((np.eye(3), np.ones(3)), {"inliers": [0, 1] * 50}), "unreadable_answer"),
    "key": (((np.eye(3), np.ones(3)), {"covariance": np.eye(6)}), "unreadable_answer"),
    "key_of_the_pose": ({"R": np.eye(3), "t": np.ones(3), "pose_cov": np.eye(6)}, "unreadable_answer"),
    "mask": (((np.eye(3), np.ones(3)), {"inliers": np.ones(7, dtype=bool)}), "unreadable_answer"),
    "covariance_shape": (((np.eye(3), np.ones(3)), {"pose_cov": np.eye(5)}), "unreadable_answer"),
    "covariance": (((np.eye(3), np.ones(3)), {"pose_cov": -np.eye(6)}), "invalid_covariance"),
    "covariance_nan": (((np.eye(3), np.ones(3)), {"pose_cov": np.full((6, 6), np.nan)}), "invalid_covariance"),
    "probability": (((np.eye(3), np.ones(3)), {"p_failure": 1.5}), "invalid_motion"),
    "probability_nan": (((np.eye(3), np.ones(3)), {"p_failure": np.nan}), "unreadable_answer"),
    "infinite_sigma": (((np.eye(3), np.ones(3)), {"sigma": np.inf}), "unreadable_answer"),
    "status": ((None, {"status": "fine"}), "unreadable_answer"),
    "ok_without": ((None, {"status": "ok"}), "unreadable_answer"),
    "of_the_judge": ((None, {"status": "invalid_motion"}), "unreadable_answer"),
    "refusal": ((None, {"status": "too_uncertain", "message": "no idea"}), "too_uncertain"),
    "own_dict": (({"R": np.eye(3), "t": [[1.0], [0], [0]]}, {"pose_cov": np.eye(6)}), "ok"),
    "matrix": ((np.hstack([np.eye(3), np.ones((3, 1))]), {"pose_cov": np.eye(6)}), "ok"),
    "no_covariance": (((np.eye(3), np.ones(3)), {"inliers": [0, 1, 2]}), "invalid_covariance"),
}


def statuses_of(run, label):
    """{status: rate} of one estimator over the whole run."""
    frame = rcme.summarize(run, pooled=True)
    own = frame[frame.estimator == label].set_index("quantity")
    statuses = ["no_candidate", "library_error", "unreadable_answer", "invalid_motion", "invalid_covariance", "too_uncertain"]
    return {status: own.value[status] for status in statuses if status in own.value and own.value[status] > 0}


class Run(unittest.TestCase):
    def test_a_function_does_as_well_as_what_it_calls(self):
        run = rcme.run(STUDY, {"mine": estimate_again})
        frame = rcme.summarize(run)
        rates = frame[frame.quantity == "success"].pivot(index="outlier_ratio", columns="estimator", values="value")
        self.assertEqual(set(rates.columns), {"standard", "rcme_rank_aware", "mine"})
        self.assertLess((rates.mine - rates.standard).abs().max(), 0.25)  # other samples, the same law
        coverage = frame[(frame.quantity == "nees_coverage") & (frame.estimator == "mine")]
        self.assertGreater(coverage.n.sum(), 20)
        self.assertGreater(np.average(coverage.value, weights=coverage.n), 0.6)

    def test_the_same_records_on_any_number_of_threads(self):
        tables = []
        for threads in (1, 4):
            with tempfile.TemporaryDirectory() as folder:
                run = rcme.run(STUDY, {"mine": estimate_again}, threads=threads, out=os.path.join(folder, "run.sqlite"))
                tables.append(rcme.summarize(run))
        self.assertTrue(tables[0].equals(tables[1]))

    def test_errors_name_the_argument_not_the_option_of_the_program(self):
        run = rcme.run(STUDY, trials=2)
        for name, call in {"of": lambda: rcme.compare(run, of="colour"), "by": lambda: rcme.reliability(run, by="colour"),
                           "overrides": lambda: rcme.run(STUDY, overrides={"colour": 1})}.items():
            with self.assertRaisesRegex(ValueError, f"^{name}: "):
                call()

    def test_nothing_that_comes_back_ends_a_run(self):
        functions = {name: (lambda answer: lambda *arguments: answer)(answer) for name, (answer, _) in ANSWERS.items()}
        run = rcme.run(STUDY, {**functions, "raises": raise_error, "leaves": leave}, trials=2, threads=2)
        expected = {name: status for name, (_, status) in ANSWERS.items()} | {"raises": "library_error",
                                                                              "leaves": "library_error"}
        for name, status in expected.items():
            self.assertEqual(statuses_of(run, name), {} if status == "ok" else {status: 1.0}, name)

    def test_what_went_wrong_is_said(self):
        """The first exception with its line, what is no answer with what to do; nothing of a function that does well."""
        functions = {"raises": raise_error, "key": lambda *arguments: ((np.eye(3), np.ones(3)), {"inlier_mask": None, "inlers": 1}),
                     "mask": lambda x1, *arguments: ((np.eye(3), np.ones(3)), {"inliers": [0, 1] * (len(x1) // 2)}), "well": identity}
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            rcme.run(STUDY, functions, trials=2)
        said = [str(warning.message) for warning in caught if warning.category is RuntimeWarning]
        line = raise_error.__code__.co_firstlineno + 1
        self.assertEqual(len(said), 3)
        self.assertTrue(all(warning.filename == __file__ for warning in caught))
        by_label = {text.split("'")[1]: text for text in said}
        self.assertIn(f"raised an exception in 4 of 4 calls (library_error); first: KeyError: 'of the function' in run_test.py:{line}",
                      by_label["raises"])
        self.assertIn("info['inlier_mask'] is not known (did you mean 'inliers'?); expected keys among: inliers, pose_cov", by_label["key"])
        self.assertIn("convert with .astype(bool)", by_label["mask"])

    def test_a_function_of_other_parameters_is_refused(self):
        for function in (lambda x1, x2: None, lambda x1, x2, camera1, camera2, *, options: None):
            with tempfile.TemporaryDirectory() as folder:
                out = os.path.join(folder, "run.sqlite")
                with self.assertRaisesRegex(ValueError, r"estimators\['mine'\].*\(x1, x2, camera1, camera2, options\)"):
                    rcme.run(STUDY, {"mine": function}, out=out)
                self.assertFalse(os.path.exists(out))

    def test_what_others_return_can_be_passed_on(self):
        info = {"inliers": np.ones(100, dtype=np.uint8), "num_inliers": 100, "iterations": 3, "pose_cov": np.eye(6)}
        run = rcme.run(STUDY, {"mine": lambda *arguments: ((np.eye(3), np.ones(3)), info)}, trials=2)
        self.assertEqual(statuses_of(run, "mine"), {})

    def test_arguments_are_the_problem_and_nothing_else(self):
        seen = []

        def look(*arguments):
            seen.append(arguments)
            arguments[0][:] = 0  # its own copy
            return None

        rcme.run(STUDY, {"look": look}, trials=1, threads=1)
        x1, x2, camera1, camera2, options = seen[0]
        trial = rcme.simulate(STUDY, 0, 0)
        np.testing.assert_array_equal(x2, trial["x2"])
        self.assertEqual((camera1, camera2), (trial["camera1"], trial["camera2"]))
        self.assertEqual(set(options), {"sigma_px", "seed"})
        self.assertEqual(len({arguments[4]["seed"] for arguments in seen}), 2)

    def test_a_changed_function_does_not_continue_a_run(self):
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "run.sqlite")
            rcme.run(STUDY, {"mine": identity}, trials=1, out=out)
            rcme.run(STUDY, {"mine": identity}, trials=2, out=out)  # the same: extended
            with self.assertRaisesRegex(ValueError, "another study|difference"):
                rcme.run(STUDY, {"mine": raise_error}, trials=2, out=out)

    def test_functions_without_a_source_differ_by_what_they_do(self):
        def made(body):
            names = {}
            exec(f"def f(*_): {body}", names)
            return names["f"]
        pairs = [(made("return None"), made("raise RuntimeError")), (lambda *_: None, lambda *_: 1)]
        for first, second in pairs:
            self.assertNotEqual(code_of(first), code_of(second))
        self.assertEqual(code_of(made("return None")), code_of(made("return None")))

    def test_a_run_within_a_run_is_an_error_not_a_wait(self):
        words = []

        def nested(*arguments):
            try:
                rcme.run(STUDY, trials=1)
            except RuntimeError as error:
                words.append(str(error))

        rcme.run(STUDY, {"nested": nested}, trials=1)
        self.assertIn("has not ended", words[0])

    def test_runs_from_another_thread(self):
        runs = []
        thread = threading.Thread(target=lambda: runs.append(rcme.run(STUDY, {"mine": identity}, trials=2)))
        thread.start()
        thread.join(60)
        self.assertEqual(len(rcme.summarize(runs[0]).estimator.unique()), 4)  # with the scene itself

    def test_other_estimators_by_name_and_file_and_settings(self):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write("name: standard\noptions: {num_iterations: 10}\n")
            file.flush()
            run = rcme.run(STUDY, {"by_name": {"name": "prcme", "options": {"num_iterations": 20}}, "by_file": file.name},
                           trials=3, seed=4, overrides={"outlier_ratio": 0.2, "by_name.num_iterations": 30})
        frame = rcme.summarize(run)
        self.assertNotIn("outlier_ratio", frame)  # a factor that is set is none
        self.assertEqual(frame[(frame.quantity == "success")].n.tolist(), [3] * 4)
        self.assertLessEqual({"by_name", "by_file"}, set(frame.estimator))


class Tables(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.run_file = rcme.run(STUDY, {"worse": identity})

    def test_a_trial_is_replayed_with_its_function_and_by_the_program_without_it(self):
        with tempfile.TemporaryDirectory() as folder:
            path = rcme.run(STUDY, {"mine": estimate_again}, out=os.path.join(folder, "run.sqlite"))
            frame = rcme.replay(path, 1, 3, {"mine": estimate_again})
            stored = rcme.trials(path).query("condition == 1 and trial == 3")
            self.assertEqual(list(frame.estimator), list(stored.estimator))
            self.assertTrue(frame.same.all())
            np.testing.assert_allclose(frame.rotation_error_deg, stored.rotation_error_deg, rtol=1e-6)
            self.assertIsNone(rcme.replay(path, 1, 5000, {"mine": estimate_again}).same[0])
            with self.assertRaisesRegex(ValueError, "function 'mine' is not there"):
                rcme.replay(path, 1, 3)
            with self.assertRaisesRegex(ValueError, "has changed since"):
                rcme.replay(path, 1, 3, {"mine": identity})
            with self.assertRaisesRegex(ValueError, "condition: 2 is not allowed"):
                rcme.replay(path, 2, 3, {"mine": estimate_again})
            said = subprocess.run([PROGRAM, "replay", path, "--condition", "1", "--trial", "3"], capture_output=True, text=True,
                                  check=True).stdout
            self.assertIn("mine: a function of Python", said)
            self.assertEqual(said.count("the record in the file:   the same"), 2)

    def test_measurements_of_sensors_are_given_and_written(self):
        sensors = {"prior_rotation_sd_deg": 0.5, "prior_gravity_sd_deg": 2, "prior_direction_sd_deg": 5}
        study = {**STUDY, "factors": {}, "data": {**STUDY["data"], **sensors}}
        pair = rcme.simulate(study)
        prior = pair["prior"]
        np.testing.assert_allclose(prior["rotation_cov"], np.radians(0.5) ** 2 * np.eye(3), atol=1e-12)
        self.assertAlmostEqual(prior["gravity_sd_deg"], 2)
        self.assertAlmostEqual(prior["direction_sd_deg"], 5)
        angle = np.degrees(np.arccos((np.trace(prior["rotation"].T @ pair["truth"]["R"]) - 1) / 2))
        self.assertLess(angle, 3)  # six standard deviations
        _, info = rcme.estimate_relative_pose(pair["x1"], pair["x2"], pair["camera1"], pair["camera2"], prior=prior)
        self.assertEqual(info["prior"], "used")
        with tempfile.TemporaryDirectory() as folder:
            written = rcme.write_pairs(os.path.join(folder, "pairs"), [pair])
            read = rcme.simulate({**STUDY, "trials": 1, "factors": {}, "data": {"scene": "match_files", "folder": written}})["prior"]
        for key, value in prior.items():
            np.testing.assert_allclose(read[key], value, rtol=1e-9, atol=1e-12, err_msg=key)

    def test_pairs_from_python_are_those_of_the_study(self):
        study = {**STUDY, "factors": {"outlier_ratio": [0.4]}}
        pairs = [{**rcme.simulate(study, trial=i), "scene": "mine"} for i in range(20)]
        with tempfile.TemporaryDirectory() as folder:
            written = rcme.write_pairs(os.path.join(folder, "pairs"), pairs)
            of_files = {**STUDY, "trials": 1, "factors": {}, "data": {"scene": "match_files", "folder": written}}
            for i, pair in enumerate(pairs):
                read = rcme.simulate(of_files, trial=i)
                for got, expected in ((read["x1"], pair["x1"]), (read["x2"], pair["x2"]), (read["truth"]["R"], pair["truth"]["R"])):
                    np.testing.assert_array_equal(got, expected)
                self.assertEqual((read["camera1"], read["sigma_px"]), (pair["camera1"], pair["sigma_px"]))
            self.assertEqual(len(rcme.trials(rcme.run(of_files))), 2 * len(pairs))
            with self.assertRaisesRegex(ValueError, "holds something"):
                rcme.write_pairs(written, pairs)
        self.assertIsNone(pairs[0]["prior"])
        for key, value, message in (("prior", {"rotation": np.eye(3)}, "prior: rotation_sd_deg"), ("x2", np.zeros((3, 2)), "x2 3"), ("camera1", np.eye(3), "camera1"),
                                    ("truth", {"R": 2 * np.eye(3), "t": [1, 0, 0]}, "truth: R"), ("truth", [1], "truth"),
                                    ("truth", {"R": np.eye(3), "t": None}, "R and t are not both there"),
                                    ("sigma_px", -1.0, "sigma_px"), ("sigma_px", 1e6, "sigma_px"), ("scene", "mine ", "scene")):
            with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(ValueError, rf"pairs\[0\].*{message}"):
                rcme.write_pairs(folder, [{**pairs[0], key: value}])
        with tempfile.NamedTemporaryFile() as file, self.assertRaisesRegex(ValueError, "folder: .*cannot be made"):
            rcme.write_pairs(file.name, pairs)
        with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(ValueError, r"pairs\[0\]: 3 is not allowed"):
            rcme.write_pairs(folder, [3])

    def test_noise_of_written_matches_is_that_of_the_pair(self):
        """A file counts noise relative to the match of median noise."""
        pair = {**rcme.simulate({**STUDY, "factors": {}}), "sigma_px": 0.4}
        scales = np.linspace(2.0, 6.0, len(pair["x1"]))
        with tempfile.TemporaryDirectory() as folder:
            written = rcme.write_pairs(os.path.join(folder, "pairs"), [{**pair, "noise_scale": scales}])
            read = rcme.simulate({**STUDY, "trials": 1, "factors": {}, "data": {"scene": "match_files", "folder": written}})
        np.testing.assert_allclose(read["sigma_px"] * np.array(read["noise_scale"]), 0.4 * scales, rtol=1e-9)

    def test_the_package_s_own_function_is_an_estimator(self):
        run = rcme.run({**STUDY, "factors": {}, "trials": 3}, {"itself": rcme.estimate_relative_pose})
        trials = rcme.trials(run)
        self.assertEqual(set(trials[trials.estimator == "itself"].status), {"ok"})

    def test_names_of_scenes_are_texts(self):
        pairs = [{**rcme.simulate(STUDY, trial=i), "scene": name} for i, name in enumerate(("00", "01", "1"))]
        with tempfile.TemporaryDirectory() as folder:
            written = rcme.write_pairs(os.path.join(folder, "pairs"), pairs)
            study = {**STUDY, "trials": 1, "factors": {}, "data": {"scene": "match_files", "folder": written}}
            run = rcme.run(study)
            for frame in (rcme.conditions(study), rcme.summarize(run), rcme.trials(run)):
                self.assertEqual(list(dict.fromkeys(frame.pair_scene)), ["00", "01", "1"])

    def test_a_label_that_a_list_could_not_hold_is_refused_before_the_run(self):
        with self.assertRaisesRegex(ValueError, "without a comma"):
            rcme.run(STUDY, {"a, b": {"name": "standard"}})

    def test_a_process_that_was_forked_leaves_the_runs_of_the_other(self):
        code = f"""
import os, rcme, sys
study = {STUDY!r}
run = rcme.run(study, trials=1)
if os.fork() == 0:
    sys.exit(0)
os.wait()
print(os.path.exists(run), os.path.exists(rcme.run(study, trials=1)))
"""
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout.strip(), "True True", done.stderr)

    def test_summarize(self):
        frame = rcme.summarize(self.run_file, times=True)
        self.assertIn("time_ms", set(frame.quantity))
        rates = frame[frame.kind == "rate"]
        self.assertTrue(((rates.lower <= rates.value) & (rates.value <= rates.upper) | (rates.n == 0)).all())
        self.assertEqual(len(rcme.summarize(self.run_file, pooled=True).condition.unique()), 1)

    def test_trials(self):
        frame = rcme.trials(self.run_file)
        self.assertEqual(len(frame), 2 * 20 * 3)
        self.assertEqual(list(frame.columns[:7]), ["study", "condition", "outlier_ratio", "trial", "estimator", "outcome", "status"])
        rates = rcme.summarize(self.run_file)
        rates = rates[rates.quantity == "success"].set_index(["condition", "estimator"]).value
        counted = (frame.outcome == "success").groupby([frame.condition, frame.estimator]).mean()
        np.testing.assert_allclose(counted, rates[counted.index], atol=1e-9)
        self.assertEqual(frame.rotation_error_deg.dtype, float)
        self.assertNotIn("seconds", frame)
        self.assertIn("seconds", rcme.trials(self.run_file, times=True))

    def test_compare(self):
        frame = rcme.compare(self.run_file, "standard", of=["failure", "auc_10_deg"])
        worse = frame[(frame.estimator == "worse") & (frame.event == "failure") & (frame.condition == 0)]
        self.assertTrue((worse.risk_difference > 0.3).all() and (worse.p_holm < 0.05).all())
        self.assertEqual(set(frame.reference), {"standard"})

    def test_reliability(self):
        study = {**STUDY, "estimators": [{"name": "rcme_calibrated"}]}
        measured = rcme.reliability(rcme.run(study, trials=10))
        self.assertEqual(measured["entries"][0]["source"], "stated")
        self.assertEqual(measured["entries"][0]["n"], 20)

    def test_audit_of_a_function(self):
        """A covariance that is 100 times too small is found; the claim about it does not hold."""
        def too_sure(*arguments):
            pose, info = estimate_again(*arguments)
            return pose, {**info, "pose_cov": info["pose_cov"] / 1e4} if pose else info

        frame = rcme.audit({**STUDY, "factors": {"outlier_ratio": [0.0]}}, {"too_sure": too_sure},
                           only="estimator")
        own = frame[frame.claim.str.contains("too_sure")]
        self.assertGreater(len(own), 0)
        self.assertIn("does not hold", set(own.verdict))

    def test_tune(self):
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "tuned.yaml")
            tuned = rcme.tune(TUNED_STUDY, out=out)
            self.assertEqual(len(tuned["settings"]), 3)
            if tuned["tuned"]:
                run = rcme.run(STUDY, {"tuned": out}, trials=2, seed=2)
                self.assertIn("tuned", set(rcme.summarize(run).estimator))
            else:
                self.assertTrue(tuned["why"])


class Names(unittest.TestCase):
    def test_a_study_of_the_program_is_known_by_its_name(self):
        named = rcme.conditions("failure_vs_outliers")
        self.assertGreater(len(named), 3)
        self.assertIn("outlier_ratio", named.columns)
        for wrong in ("failure_vs_outlier", "no_study_at_all"):
            with self.assertRaisesRegex(ValueError, wrong):
                rcme.conditions(wrong)


if __name__ == "__main__":
    unittest.main()
