"""`pip install .` into a fresh virtual environment, with the network shut off, and the package from another folder."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).parents[2]
BUILD = os.environ.get("RCME_BUILD_FOLDER", "")  # what is compiled there is not compiled again
NO_NETWORK = {"PIP_NO_INDEX": "1", "http_proxy": "http://127.0.0.1:9", "https_proxy": "http://127.0.0.1:9"}
SCRIPT = """
import pathlib, numpy as np, rcme
assert "site-packages" in rcme.__file__, rcme.__file__
folder = pathlib.Path(rcme.__file__).parent
assert (folder / "py.typed").exists() and (folder / "_rcme.pyi").exists()
rng = np.random.default_rng(1)
x1 = rng.uniform(0, 600, (50, 2))
pose, info = rcme.estimate_relative_pose(x1, x1 + rng.normal(size=(50, 2)), np.diag([700, 700, 1]), np.diag([700, 700, 1]))
print("status", info["status"])
assert len(rcme.conditions("no_outliers_low_noise")) > 0  # the package's own copy: the module knows no other place
assert SOURCE.encode() not in (folder / rcme._rcme.__file__).read_bytes(), "the module holds the path of its source tree"
"""


@unittest.skipUnless(BUILD and sys.prefix == sys.base_prefix, "runs in a build's own test suite")
class Pip(unittest.TestCase):
    def test_install(self):
        with tempfile.TemporaryDirectory() as folder:
            environment = {**os.environ, **NO_NETWORK, "PYTHONPATH": ""}
            # NumPy, pandas and pip are Debian's: a virtual environment without them would need the network.
            subprocess.run([sys.executable, "-m", "venv", "--without-pip", "--system-site-packages", f"{folder}/venv"], check=True)
            python = f"{folder}/venv/bin/python"
            subprocess.run([python, "-m", "pip", "install", "--quiet", str(ROOT), "--config-settings", f"build-dir={BUILD}"],
                           check=True, env=environment, cwd=folder)
            said = subprocess.run([python, "-c", f"SOURCE = {str(ROOT)!r}\n{SCRIPT}"], check=True, env=environment, cwd=folder, capture_output=True,
                                  text=True).stdout
            self.assertIn("status", said)
            listed = subprocess.run([python, "-m", "pip", "show", "--files", "rcme"], check=True, env=environment,
                                    capture_output=True, text=True).stdout
            self.assertIn("rcme/_rcme", listed)

            def rcme(*arguments):
                return subprocess.run([f"{folder}/venv/bin/rcme", *arguments], check=True, env=environment, cwd=folder,
                                      capture_output=True, text=True).stdout

            rcme("run", "no_outliers_low_noise", "--trials", "2", "--out", "run.sqlite")
            self.assertIn("failure", rcme("summarize", "run.sqlite"))
            rcme("report", "run.sqlite", "--out", "report.html")
            self.assertIn("<html", pathlib.Path(folder, "report.html").read_text(encoding="utf-8"))

    def test_metadata_needs_no_build(self):
        with tempfile.TemporaryDirectory() as folder:
            call = "import build_wheel, sys; print(build_wheel.prepare_metadata_for_build_wheel(sys.argv[1]))"
            info = subprocess.run([sys.executable, "-c", call, folder], check=True, capture_output=True, text=True,
                                  cwd=ROOT / "python/packaging").stdout.strip()
            self.assertIn("Name: rcme", pathlib.Path(folder, info, "METADATA").read_text(encoding="utf-8"))
            self.assertIn("rcme = rcme._program:main", pathlib.Path(folder, info, "entry_points.txt").read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main()
