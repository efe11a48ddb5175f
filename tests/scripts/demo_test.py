"""The program of scripts/demo against `rcme` itself. RCME and RCME_DEMO name the two."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
STUDY = """seed: 3
trials: 4
data: {scene: uniform_volume, num_matches: 60, outlier_ratio: 0.2}
estimators: [{name: standard}, {name: opencv_usac}, {name: opengv_ransac}]
"""


def call(program, *words, folder=None):
    return subprocess.run([pathlib.Path(os.environ[program]).resolve(), *words], cwd=folder, capture_output=True, text=True, check=False)


def commands_of(program):
    """The description of each command, from the help."""
    return dict(re.findall(r"^  ([a-z-]+) {2,}(\w.*)$", call(program, "--help").stdout, re.MULTILINE))


class Demo(unittest.TestCase):
    def test_its_commands_are_among_those_of_rcme(self):
        few, every = commands_of("RCME_DEMO"), commands_of("RCME")
        self.assertGreaterEqual(few.keys(), {"run", "summarize", "compare", "report", "plot", "failures", "check", "help"})
        self.assertLess(few.items(), every.items())

    def test_it_has_what_the_script_calls(self):
        called = set(re.findall(r'^"\$rcme" ([a-z-]+)', (ROOT / "scripts/demo").read_text(), re.MULTILINE))
        self.assertGreaterEqual(called, {"run", "summarize", "plot"})
        self.assertLessEqual(called, commands_of("RCME_DEMO").keys())

    def test_it_gives_the_same_numbers(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "study.yaml").write_text(STUDY)
            for program in ("RCME", "RCME_DEMO"):
                ran = call(program, "run", "study.yaml", "--out", f"{program}.sqlite", folder=folder)
                self.assertEqual(ran.returncode, 0, ran.stderr)
            tables = [call(by, "summarize", f"{of}.sqlite", "--format", "csv", folder=folder)
                      for by, of in (("RCME", "RCME"), ("RCME_DEMO", "RCME_DEMO"), ("RCME", "RCME_DEMO"))]
            self.assertEqual([table.returncode for table in tables], [0, 0, 0], tables[1].stderr)
            self.assertIn("opencv_usac", tables[0].stdout)
            self.assertEqual(len({table.stdout for table in tables}), 1)

    def test_of_another_command_it_says_how_to_build_it(self):
        for words in (["audit"], ["audit", "--out", "x"], ["help", "audit"], ["lists"]):
            told = call("RCME_DEMO", *words)
            self.assertEqual(told.returncode, 2, words)
            self.assertEqual(told.stderr.count("`scripts/build release program` builds rcme with all of them"), 1, told.stderr)
        self.assertNotIn("scripts/build", call("RCME", "audits").stderr)
        self.assertNotIn("scripts/build", call("RCME_DEMO", "run", "--nothing").stderr)

    def test_the_presets_of_the_script_exist(self):
        presets = re.findall(r"scripts/build release (\w+)", (ROOT / "scripts/demo").read_text())
        for preset in set(presets):
            self.assertIn(f'"name": "{preset}"', (ROOT / "CMakePresets.json").read_text())


if __name__ == "__main__":
    unittest.main()
