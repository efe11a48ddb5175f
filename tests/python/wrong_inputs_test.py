"""Ten wrong inputs and more to each call: a ValueError that names the argument and says what is expected."""

import inspect
import os
import pathlib
import tempfile
import unittest

import matplotlib
import numpy as np
import pandas
import rcme
from small_study import STUDY

matplotlib.use("Agg")
from matplotlib.figure import Figure  # noqa: E402

X = np.arange(40.0).reshape(20, 2)
TURN = np.linalg.qr(np.arange(9.0).reshape(3, 3) + np.eye(3))[0]
K = [[700.0, 0, 320], [0, 700, 240], [0, 0, 1]]
CAMERA = {"model": "PINHOLE", "width": 640, "height": 480, "params": [700, 700, 320, 240]}


def camera(**changed):
    return {**CAMERA, **changed}


def study(**changed):
    return {**STUDY, **changed}


NO_STUDIES = [
    ("study", dict(study=3)), ("study", dict(study="/nowhere/study.yaml")), ("study", dict(study=b"")),
    ("study", dict(study={})), ("study", dict(study=study(trials=-1))), ("study", dict(study=study(factors={"colour": [1]}))),
    ("study", dict(study=study(data={"scene": "moon"}))), ("study", dict(study=study(data={"scene": object()}))),
    ("study", dict(study=study(seed=float("nan")))), ("study", dict(study=study(estimators=[]))),
    ("study", dict(study=study(estimators=[{"name": "nobody"}]))), ("overrides", dict(study=STUDY, overrides=[1])),
    ("overrides", dict(study=STUDY, overrides={"sigma_px": np.ones(2)})), ("colour", dict(study=STUDY, overrides={"colour": 1})),
    ("overrides", dict(study=STUDY, overrides={3: 1})),
]
NO_SEEDS = [("seed", dict(study=STUDY, seed=-1)), ("seed", dict(study=STUDY, seed="one")), ("seed", dict(study=STUDY, seed=1.5))]
NO_THREADS = [("threads", dict(study=STUDY, threads=-1)), ("threads", dict(study=STUDY, threads=True))]
NO_ESTIMATORS = [
    ("estimators", dict(study=STUDY, estimators=[max])), ("estimators", dict(study=STUDY, estimators={"a": 3})),
    ("estimators", dict(study=STUDY, estimators={"": max})), ("estimators", dict(study=STUDY, estimators={"a\nb": max})),
    ("estimators", dict(study=STUDY, estimators={"standard": max})),
    ("estimators", dict(study=STUDY, estimators={"a": {"name": "nobody"}})),
    ("estimators", dict(study=STUDY, estimators={"a": {"options": {}}})),
    ("estimators", dict(study=STUDY, estimators={"a": {"name": "rcme", "options": {"colour": 1}}})),
    ("estimators", dict(study=STUDY, estimators={"a": "/nowhere/tuned.yaml"})),
]
NO_RUNS = [("run", dict(run=3)), ("run", dict(run="/nowhere/run.sqlite")), ("run", dict(run=None)), ("run", dict(run="")),
           ("run", dict(run=b"\0"))]
AXES = object()

SCRATCH = tempfile.TemporaryDirectory()
NEW_FOLDER = os.path.join(SCRATCH.name, "pairs")
PAIR = {"x1": X, "x2": X, "camera1": CAMERA, "camera2": CAMERA}
WRONG = {
    "estimate_relative_poses": [(name, dict(dict(pairs=[(X, X, K, K)]), **changed)) for name, changed in [
        ("pairs", dict(pairs=3)), ("pairs", dict(pairs=[X])), ("pairs[1]", dict(pairs=[(X, X, K, K), (X, X, K)])),
        ("pairs[1].x1", dict(pairs=[(X, X, K, K), (X * np.nan, X, K, K)])), ("pairs[0].x2", dict(pairs=[(X, X[:7], K, K)])),
        ("pairs[0].camera2", dict(pairs=[(X, X, K, 7)])), ("pairs[0].noise_scale", dict(pairs=[(X, X, K, K, np.ones(3))])),
        ("options", dict(options={"noise_scale": np.ones(20)})), ("options", dict(options={"estimator": "nobody"})),
        ("bounds", dict(bounds=[(1, 0)])), ("threads", dict(threads=-1))]],
    "estimate_relative_pose": [(name, dict(dict(x1=X, x2=X, camera1=K, camera2=K), **changed)) for name, changed in [
        ("x1", dict(x1=X[0])), ("x1", dict(x1=X.reshape(2, 20))), ("x1", dict(x1="points")), ("x1", dict(x1=None)),
        ("x1", dict(x1=X.astype(complex))), ("x1", dict(x1=X * np.nan)), ("x1", dict(x1=X * 1e9)),
        ("x1", dict(x1=[[1, 2], [3]])), ("x2", dict(x2=X[:7])), ("x2", dict(x2=X[:, :, None])),
        ("bounds", dict(bounds=3)), ("bounds", dict(bounds=[1, 5])), ("bounds", dict(bounds=[(1, 5, 9)])),
        ("bounds", dict(bounds=[(1, 0)])), ("bounds", dict(bounds=[(181, 5)])), ("bounds", dict(bounds=[("x", 5)])),
        ("bounds", dict(bounds=[(1, 5)], options={"estimator": "rcme"})),
        ("noise_scale", dict(options={"noise_scale": np.ones(19)})), ("noise_scale", dict(options={"noise_scale": np.zeros(20)})),
        ("noise_scale", dict(options={"noise_scale": 1.0})), ("noise_scale", dict(options={"noise_scale": [np.nan] * 20})),
        ("prior", dict(prior=3)), ("prior", dict(prior={"colour": 1})), ("prior", dict(prior={"rotation_sd_deg": 1})),
        ("rotation_sd_deg", dict(prior={"rotation": np.eye(3)})), ("rotation", dict(prior={"rotation": K, "rotation_sd_deg": 1})),
        ("rotation_sd_deg", dict(prior={"rotation": np.eye(3), "rotation_sd_deg": 0})),
        ("rotation_cov", dict(prior={"rotation": np.eye(3), "rotation_cov": np.zeros((3, 3))})),
        ("3e6 times the least", dict(prior={"rotation": np.eye(3), "rotation_cov": TURN @ np.diag([1e-10, 1e-4, 1e4]) @ TURN.T})),
        ("gravity2", dict(prior={"gravity1": [0, 1, 0], "gravity_sd_deg": 1})),
        ("gravity1", dict(prior={"gravity1": [0, 0, 0], "gravity2": [0, 1, 0], "gravity_sd_deg": 1})),
        ("direction", dict(prior={"direction": [1, 2], "direction_sd_deg": 1})),
        ("direction_sd_deg", dict(prior={"direction": [0, 0, 1], "direction_sd_deg": np.nan})),
        ("camera1", dict(camera1=7)), ("camera1", dict(camera1=np.eye(4))), ("camera1", dict(camera1=np.zeros((3, 3)))),
        ("camera1", dict(camera1=[[700.0, 5, 320], [0, 700, 240], [0, 0, 1]])), ("camera1", dict(camera1=np.diag([-700.0, 700, 1]))),
        ("camera2", dict(camera2={})), ("camera2", dict(camera2=camera(model="OPENCV"))),
        ("camera2", dict(camera2=camera(params=[1, 2]))), ("camera2", dict(camera2=camera(width=0))),
        ("camera2", dict(camera2=camera(params=[-700, 700, 320, 240]))), ("camera2", dict(camera2=camera(height="tall"))),
        ("camera2", dict(camera2=camera(params=[np.inf, 700, 320, 240]))),
        ("options", dict(options=3)), ("options", dict(options={"sigma_px": 0})), ("options", dict(options={"sigma_px": "x"})),
        ("options", dict(options={"seed": -1})), ("options", dict(options={"estimator": "nobody"})),
        ("options", dict(options={"estimator": "standard", "mu": 3})), ("options", dict(options={"colour": "red"})),
        ("options", dict(options={"estimator": "standard", "num_iterations": -3})),
        ("options", dict(options={"estimator_file": "/nowhere.yaml"})),
        ("estimators", dict(estimators=3)), ("estimators", dict(estimators={"mine": "standard"})),
        ("estimators['mine']", dict(estimators={"mine": lambda x1, x2: None})),
        ("options", dict(options={"estimator": "python"})), ("options", dict(options={1: 2})),
    ]],
    "conditions": NO_STUDIES,
    "simulate": NO_STUDIES + NO_SEEDS + [
        ("condition", dict(study=STUDY, condition=2)), ("condition", dict(study=STUDY, condition=-1)),
        ("condition", dict(study=STUDY, condition="first")), ("trial", dict(study=STUDY, trial=-1)),
        ("trial", dict(study=STUDY, trial=2**40)), ("trial", dict(study=STUDY, trial=None))],
    "replay": [(name, dict(dict(run=__file__, condition=0, trial=0), **changed)) for name, changed in [
        *NO_RUNS, ("wrong_inputs_test", {}), ("condition", dict(condition=-1)), ("condition", dict(condition=0.5)),
        ("trial", dict(trial="1")), ("allow_process", dict(allow_process=1)), ("estimators['f']", dict(estimators={"f": 3}))]],
    "write_pairs": [(name, dict(dict(folder=NEW_FOLDER, pairs=[PAIR]), **changed)) for name, changed in [
        ("folder", dict(folder=3)), ("folder", dict(folder="")), ("holds something", dict(folder=os.path.dirname(__file__))),
        ("pairs[0]", dict(pairs=[{}])), ("pairs[0]: x2", dict(pairs=[{**PAIR, "x2": X[:, :1]}])),
        ("pairs[0]: x1", dict(pairs=[{**PAIR, "x1": X[:7]}])), ("pairs[0]: camera2", dict(pairs=[{**PAIR, "camera2": K}])),
        ("pairs[0]: camera1", dict(pairs=[{**PAIR, "camera1": 3}])), ("pairs[0]: scene", dict(pairs=[{**PAIR, "scene": "a\nb"}])),
        ("pairs[0]: sigma_px", dict(pairs=[{**PAIR, "sigma_px": "x"}])),
        ("pairs[0]: noise_scale", dict(pairs=[{**PAIR, "noise_scale": np.ones(3)}])),
        ("pairs[0]: truth: R", dict(pairs=[{**PAIR, "truth": {"R": np.eye(2), "t": [1, 0, 0]}}])),
        ("pairs[0]: truth: t", dict(pairs=[{**PAIR, "truth": {"R": np.eye(3), "t": [0, 0, 0]}}]))]],
    "run": NO_STUDIES + NO_SEEDS + NO_THREADS + NO_ESTIMATORS + [
        ("trials", dict(study=STUDY, trials=0)), ("out", dict(study=STUDY, out=7)),
        ("/nowhere", dict(study=STUDY, out="/nowhere/run.sqlite"))],
    "tune": NO_STUDIES + NO_SEEDS + NO_THREADS + [("tune", dict(study=STUDY)), ("out", dict(study=STUDY, out=""))],
    "conform": [(name, {"estimator": "standard", "out": "conform.json", **wrong}) for name, wrong in
                NO_STUDIES + NO_SEEDS + NO_THREADS + NO_ESTIMATORS] + [
        ("out", dict(study=STUDY)), ("estimator", dict(study=STUDY, out="x.json")),
        ("estimator", dict(study=STUDY, check=__file__, estimator="standard")), ("check", dict(study=STUDY, check=3)),
        ("wrong_inputs_test", dict(study=STUDY, check=__file__)), ("nobody", dict(study=STUDY, out="x.json", estimator="nobody")),
        ("level", dict(study=STUDY, out="x.json", estimator="standard", level=1)),
        ("risk", dict(study=STUDY, out="x.json", estimator="standard", risk="x")),
        ("new", dict(study=STUDY, out="x.json", estimator="standard", new="car")),
        ("models", dict(study=STUDY, out="x.json", estimator="standard", models="/nowhere.json"))],
    "audit": NO_STUDIES + NO_SEEDS + NO_THREADS + NO_ESTIMATORS + [
        ("study", dict(estimators={"a": max})), ("budget", dict(study=STUDY, budget="large")),
        ("only", dict(study=STUDY, only=3)), ("nothing", dict(study=STUDY, only="nothing"))],
    "summarize": NO_RUNS + [("times", dict(run=__file__, times=1)), ("pooled", dict(run=__file__, pooled="yes")),
                            ("wrong_inputs_test", dict(run=__file__)), ("run", dict(run=["a"])), ("run", dict(run={}))],
    "trials": NO_RUNS + [("times", dict(run=__file__, times=1)), ("times", dict(run=__file__, times="yes")),
                         ("wrong_inputs_test", dict(run=__file__)), ("run", dict(run=["a"])), ("run", dict(run={}))],
    "compare": NO_RUNS + [("against", dict(run=__file__, against=3)), ("of", dict(run=__file__, of=3)),
                          ("of", dict(run=__file__, of=[])), ("anytime", dict(run=__file__, anytime=None)),
                          ("wrong_inputs_test", dict(run=__file__))],
    "reliability": NO_RUNS + [("by", dict(run=__file__, by=3)), ("by", dict(run=__file__, by="")),
                              ("by", dict(run=__file__, by=["a"])), ("wrong_inputs_test", dict(run=__file__)),
                              ("run", dict(run=pathlib.Path("/nowhere")))],
}
SUMMARY = pandas.DataFrame({"study": "s", "noise": [1, 1], "estimator": "a", "quantity": "failure", "kind": "rate",
                            "value": 0.1, "lower": 0.0, "upper": 0.2, "event": "failure", "risk_difference": 0.1, "p_holm": 1})
NO_AXES = [("ax", dict(ax=None)), ("ax", dict(ax=3))]
NO_TABLE = [("x", dict(x="colour")), ("x", dict(x=3)), ("x: ", dict(x="noise")), ("where", dict(where=3)),
            ("where", dict(where={"colour": 1})), ("where", dict(where={"noise": 2})),
            ("estimators", dict(estimators=["nobody"])), ("estimators", dict(estimators=3)),
            ("labels", dict(labels=3)), ("labels", dict(labels=["a"]))]
WRONG_PLOTS = {
    "rate": (dict(summary=SUMMARY, x="noise"), NO_AXES + NO_TABLE + [
        ("summary", dict(summary=3)), ("summary", dict(summary=SUMMARY[["study"]])), ("quantity", dict(quantity="colour"))]),
    "paired_difference": (dict(comparison=SUMMARY, x="noise"), NO_AXES + NO_TABLE + [
        ("comparison", dict(comparison=3)), ("event", dict(event=3))]),
    "reliability": (dict(measured={"entries": []}, estimator="a"), NO_AXES + [
        ("measured", dict(measured=value)) for value in (3, {}, [], None, "")] + [
        ("estimator", dict(estimator=value)) for value in ("b", 3, None)]),
    "audit": (dict(audited=SUMMARY), NO_AXES + [
        ("audited", dict(audited=value)) for value in (3, None, [], {}, SUMMARY, SUMMARY[["kind"]], "x", np.ones(3))]),
    "matches": (dict(trial=rcme.simulate(STUDY)), NO_AXES + [
        ("trial", dict(trial=value)) for value in (3, {}, None, [], "x")] + [
        ("inliers", dict(inliers=value)) for value in (3, [True], np.ones((2, 2)))]),
}


class WrongInputs(unittest.TestCase):
    def check(self, function, cases):
        self.assertGreaterEqual(len(cases), 10)
        for name, arguments in cases:
            with self.subTest(function=function.__name__, argument=name, arguments=str(arguments)[:200]):
                with self.assertRaises(ValueError) as caught:
                    function(**arguments)
                self.assertIn(name, str(caught.exception))
                self.assertNotIn("\n", str(caught.exception))
                self.assertLess(len(str(caught.exception)), 3000)

    def test_each_call(self):
        public = {name for name in rcme.__all__ if inspect.isfunction(getattr(rcme, name))} - {"estimators", "intrinsics"}
        self.assertEqual(public, set(WRONG))
        for name, cases in WRONG.items():
            self.check(getattr(rcme, name), cases)

    def test_each_figure(self):
        self.assertEqual(set(rcme.plot.__all__), set(WRONG_PLOTS))
        for name, (right, cases) in WRONG_PLOTS.items():
            ax = Figure().subplots()
            self.check(getattr(rcme.plot, name), [(argument, {"ax": ax, **right, **changed}) for argument, changed in cases])

    def test_shapes_are_named(self):
        with self.assertRaisesRegex(ValueError, r"x1: its shape is \(2, 20\); expected an N x 2 array"):
            rcme.estimate_relative_pose(X.T, X, K, K)
        with self.assertRaisesRegex(ValueError, r"x2: its shape is \(7, 2\); expected that of x1, \(20, 2\)"):
            rcme.estimate_relative_pose(X, X[:7], K, K)

    def test_what_to_do_is_said(self):
        with self.assertRaisesRegex(ValueError, "camera: None is not allowed"):
            rcme.intrinsics(None)
        for words, changed in ((r"convert with .reshape\(-1, 2\)", dict(x1=X[:, None])),
                               ("did you mean 'sigma_px'", dict(options={"sigma": 2})),
                               ("camera1: None is not allowed; expected a dict", dict(camera1=None)),
                               ("gravity_sd_deg is missing", dict(prior={"gravity1": [0, 1, 0], "gravity2": [0, 1, 0]}))):
            with self.assertRaisesRegex(ValueError, words):
                rcme.estimate_relative_pose(**{**dict(x1=X, x2=X, camera1=K, camera2=K), **changed})

    def test_a_damaged_result_file(self):
        with tempfile.NamedTemporaryFile(suffix=".sqlite") as file:
            content = pathlib.Path(rcme.run(STUDY, trials=2)).read_bytes()
            file.write(content[:len(content) // 2])
            file.flush()
            with self.assertRaises(ValueError):
                rcme.summarize(file.name)


if __name__ == "__main__":
    unittest.main()
