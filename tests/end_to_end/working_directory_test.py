"""The Python that `rcme` starts for its figures imports no module from the working directory, which may be somebody's.

    RCME=build/release/bin/rcme python3 tests/end_to_end/working_directory_test.py"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

RCME = str(pathlib.Path(os.environ["RCME"]).resolve())
MARK = "imported_from_the_working_directory"
# One Python has loaded half of these when it begins, another one nothing.
NAMES = {*sys.stdlib_module_names, "numpy", "pandas", "matplotlib", "PIL", "dateutil", "pytz", "sitecustomize",
         "usercustomize"}
SUMMARY = ("study,condition,outlier_ratio,estimator,quantity,kind,value,lower,upper,standard_error,n\n"
           "demo,0,0.1,rcme,failure,rate,0.1,0.05,0.2,,100\n"
           "demo,1,0.2,rcme,failure,rate,0.2,0.1,0.3,,100\n")


class WorkingDirectory(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name).resolve()
        for name in NAMES:
            (self.folder / f"{name}.py").write_text(f"open({MARK!r}, 'a').write({name + ' '!r})\n")
        (self.folder / "summary.csv").write_text(SUMMARY)

    def traces(self, *command):
        """(process, what it took from the working directory, where it looked there for a module)."""
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
        done = subprocess.run(command, cwd=self.folder, env={**environment, "PYTHONVERBOSE": "2"}, capture_output=True,
                              text=True, check=False)
        mark = self.folder / MARK
        looked = [line for line in done.stderr.splitlines() if line.startswith(f"# trying {self.folder}/")]
        return done, mark.read_text() if mark.exists() else "", looked

    def test_both_traces_are_seen(self):
        _, taken, looked = self.traces(sys.executable, "-c", "import json")
        self.assertIn("json ", taken)
        self.assertGreater(len(looked), 0)
        (self.folder / MARK).unlink()
        _, _, looked = self.traces(sys.executable, "-c", "import importlib.util as u; u.find_spec('pandas')")
        self.assertGreater(len(looked), 0)

    def test_figures_leave_none(self):
        done, taken, looked = self.traces(RCME, "plot", "failure_rate", "summary.csv", "--x", "outlier_ratio",
                                          "--quantities", "failure", "--out", "figure")
        said = [line for line in done.stderr.splitlines() if not line.startswith(("#", "import "))]
        self.assertEqual((done.returncode, taken, looked), (0, "", []), "\n".join(said))
        self.assertTrue((self.folder / "figure.png").exists())
        self.assertIn("# trying ", done.stderr)  # it did say where it looked


if __name__ == "__main__":
    unittest.main()
