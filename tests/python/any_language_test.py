"""One estimator of OpenCV by every way in: a function, a process, and export and import give the same numbers."""

import importlib.util
import json
import pathlib
import re
import sqlite3
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import rcme
from program import PROGRAM
from small_study import STUDY

ROOT = pathlib.Path(__file__).parents[2]
EXAMPLE = ROOT / "examples/any_language/opencv_estimator.py"
SCHEMA = json.loads((ROOT / "docs/estimator.schema.json").read_text())["$defs"]
LEFT_OUT = {"seconds", "estimator", "checksum"}


def example():
    spec = importlib.util.spec_from_file_location("opencv_estimator", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def records_of(run, label):
    """Every number of every trial of one estimator, but times."""
    database = sqlite3.connect(run)
    database.row_factory = sqlite3.Row
    (number,) = database.execute("SELECT estimator FROM estimators WHERE label = ?", (label,)).fetchone()
    rows = database.execute("SELECT * FROM trials WHERE estimator = ? ORDER BY condition, trial", (number,)).fetchall()
    database.close()
    return [{key: row[key] for key in row.keys() if key not in LEFT_OUT} for row in rows]


@unittest.skipUnless(importlib.util.find_spec("cv2"), "the example is OpenCV's (python3-opencv)")
class AnyLanguage(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)
        self.study = self.folder / "study.yaml"
        self.study.write_text(json.dumps({**STUDY, "trials": 15}))

    def program(self, *arguments, **options):
        return subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True, text=True, **options)

    def test_the_same_numbers_by_every_way(self):
        by_function = rcme.run(self.study, {"opencv": example().estimate})
        estimator = self.folder / "opencv.yaml"
        estimator.write_text(f"process: \"{sys.executable} {EXAMPLE}\"\nlabel: opencv\noptions: {{timeout_s: 100}}\n")
        by_process = self.folder / "process.sqlite"
        self.program("run", self.study, "--add-estimator", estimator, "--allow-process", "--out", by_process)
        self.program("export", self.study, "--out", self.folder / "problems")
        answers = self.folder / "answers.jsonl"
        with open(self.folder / "problems/problems.jsonl") as problems, open(answers, "w") as out:
            subprocess.run([sys.executable, EXAMPLE], stdin=problems, stdout=out, check=True)
        by_import = self.folder / "import.sqlite"
        self.program("import", answers, "--study", self.folder / "problems/study.yaml", "--label", "opencv", "--out", by_import)
        expected = records_of(by_function, "opencv")
        self.assertEqual(len(expected), 30)
        self.assertGreater(sum(record["status"] == "ok" for record in expected), 20)
        self.assertEqual(records_of(by_process, "opencv"), expected)
        self.assertEqual(records_of(by_import, "opencv"), expected)
        self.assertEqual(records_of(by_process, "standard"), records_of(by_import, "standard"))
        self.assertIn("opencv", set(rcme.compare(str(by_import)).estimator))  # both in one comparison

    def test_the_schema_is_what_is_written_and_read(self):
        self.program("export", self.study, "--trials", "2", "--out", self.folder / "problems")
        lines = (self.folder / "problems/problems.jsonl").read_text().splitlines()
        self.assertEqual(len(lines), 4)
        for line in lines:
            problem = json.loads(line)
            self.assertEqual(set(problem), set(SCHEMA["problem"]["required"]))
            self.assertEqual(set(problem) | {"noise_scale"}, set(SCHEMA["problem"]["properties"]))  # which is optional
            self.assertEqual(set(problem["camera1"]), set(SCHEMA["camera"]["required"]))
            answer = example().answer_to(problem)
            self.assertLessEqual(set(answer), set(SCHEMA["answer"]["properties"]))
            matches = self.folder / f"problems/matches/{problem['id']}.csv"
            self.program("estimate", matches, "--estimator", "standard")
            self.assertNotIn("R_rowmajor", matches.read_text())
        read = re.findall(r'find\("(\w+)"\)', (ROOT / "peers/answer_json.cc").read_text())
        self.assertEqual(set(read), set(SCHEMA["answer"]["properties"]))

    def test_truth_is_apart(self):
        self.program("export", self.study, "--trials", "1", "--out", self.folder / "problems")
        problem = json.loads((self.folder / "problems/problems.jsonl").read_text().splitlines()[0])
        truth = json.loads((self.folder / "problems/truth.jsonl").read_text().splitlines()[0])
        trial = rcme.simulate(str(self.study), 0, 0)
        self.assertEqual(problem["x1"], trial["x1"].tolist())
        self.assertEqual((truth["id"], truth["R"]), (problem["id"], trial["truth"]["R"].ravel().tolist()))
        self.assertEqual(truth["is_inlier"], trial["truth"]["inliers"].tolist())

    def test_match_files_carry_the_noise_that_estimators_assume(self):
        self.program("export", self.study, "--trials", "1", "--set", "sigma_px=2", "--out", self.folder / "problems")
        pairs = {**STUDY, "data": {"scene": "match_files", "folder": str(self.folder / "problems/matches")}, "factors": {}}
        self.assertEqual(rcme.simulate(pairs, 0, 0)["sigma_px"], 2)
        self.assertEqual(rcme.simulate(pairs, 0, 0, overrides={"sigma_px": 0.7})["sigma_px"], 0.7)

    def test_what_is_missing_or_nonsense_in_an_import_is_a_status(self):
        self.program("export", self.study, "--trials", "2", "--out", self.folder / "problems")
        ids = [json.loads(line)["id"] for line in (self.folder / "problems/problems.jsonl").read_text().splitlines()]
        answers = self.folder / "answers.jsonl"
        answers.write_text(json.dumps({"id": ids[0], "status": "too_uncertain"}) + "\n" +
                           json.dumps({"id": ids[1], "R": [1, 2]}) + "\n")
        run = self.folder / "run.sqlite"
        said = self.program("import", answers, "--study", self.folder / "problems/study.yaml", "--label", "mine", "--out", run)
        self.assertIn("2 of 4 trials have no answer", said.stderr)
        self.assertEqual([record["status"] for record in records_of(run, "mine")],
                         ["too_uncertain", "unreadable_answer", "no_answer", "no_answer"])

    def test_a_command_in_a_file_needs_permission(self):
        marker, theirs = self.folder / "it_ran", self.folder / "theirs.yaml"
        command = f"touch {marker}; exit 1"
        theirs.write_text(f"process: {json.dumps(command)}\nlabel: theirs\n")
        study = {**STUDY, "trials": 1, "estimators": [{"process": command, "label": "theirs"}]}
        x = np.random.default_rng(1).uniform(0, 480, (20, 2))
        matrix = [[700.0, 0, 320], [0, 700, 240], [0, 0, 1]]
        for call in (lambda **more: rcme.run(study, **more), lambda **more: rcme.run(self.study, {"theirs": theirs}, **more),
                     lambda **more: rcme.audit(study, only="estimator", **more),
                     lambda **more: rcme.tune({**study, "tune": {"estimator": "theirs", "options": {"timeout_s": [5, 6]},
                                                                 "target": "failure", "at_most": 0.5}}, **more),
                     lambda **more: rcme.estimate_relative_pose(x, x, matrix, matrix, {"estimator_file": theirs, **more})):
            with self.assertRaisesRegex(ValueError, "it_ran.*allow_process=True"):
                call()
            with self.assertRaisesRegex(ValueError, "it_ran.*allow_process=True"):
                call(allow_process=False)
            self.assertFalse(marker.exists())
        rcme.simulate(study)  # asks no estimator
        self.assertFalse(marker.exists())
        rcme.estimate_relative_pose(x, x, matrix, matrix, {"estimator_file": theirs, "allow_process": True})
        self.assertTrue(marker.exists())
        marker.unlink()
        # What a call gives itself is the caller's own.
        rcme.estimate_relative_pose(x, x, matrix, matrix, {"estimator": "process", "command": command})
        self.assertTrue(marker.exists())

    def test_wrong_files_are_bad_input(self):
        cases = {"answers": "no JSON\n", "answers.twice": '{"id": "a"}\n{"id": "a"}\n', "answers.bare": '{"R": 1}\n'}
        for name, text in cases.items():
            path = self.folder / name
            path.write_text(text)
            ended = subprocess.run([PROGRAM, "import", path, "--study", self.study, "--label", "mine", "--out",
                                    self.folder / "x.sqlite"], capture_output=True, text=True)
            self.assertEqual(ended.returncode, 2, ended.stderr)
            self.assertIn(name, ended.stderr)
        for text in ("process: a\nanswers: b\n", "process: a\nname: rcme\n", "process: ''\n", "answers: /nowhere\n"):
            path = self.folder / "estimator.yaml"
            path.write_text(text)
            ended = subprocess.run([PROGRAM, "run", self.study, "--add-estimator", path, "--out", self.folder / "x.sqlite"],
                                   capture_output=True, text=True)
            self.assertEqual(ended.returncode, 2, text)


if __name__ == "__main__":
    unittest.main()
