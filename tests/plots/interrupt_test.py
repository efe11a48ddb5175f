"""Ctrl-C ends a script with one line and exit code 130, while its modules load and while it works. Not statistical."""

import pathlib
import signal
import subprocess
import sys
import time
import unittest

from plot_test_case import PLOTS, PlotTestCase

SLOW_MODULE = """
import os, pathlib, time
pathlib.Path(os.environ["LOADING"]).touch()
time.sleep(100)
"""
SLOW_WORK = """
import sys, time
sys.path.insert(0, sys.argv[1])
from common.interrupt import end_on_interrupt
end_on_interrupt()
from common.command_line import run
from common.whole_file import write_whole
def write(part):
    open(part, "w").close()
    print("writing", flush=True)
    time.sleep(100)
sys.exit(run("slow", lambda _: write_whole({sys.argv[2]: write}), None))
"""


class InterruptTest(PlotTestCase):
    def assert_stopped(self, process):
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=20)[1]
        self.assertEqual((process.returncode, said), (130, "stopped\n"))

    def test_while_modules_load(self):
        (self.folder / "matplotlib.py").write_text(SLOW_MODULE, encoding="utf-8")
        loading = self.folder / "loading"
        for script in ("report", "show_trial", "surface_report"):
            with subprocess.Popen([sys.executable, PLOTS / "common" / "run_script.py", script], stderr=subprocess.PIPE, text=True,
                                  env={"PYTHONPATH": str(self.folder), "LOADING": str(loading)}) as process:
                while process.poll() is None and not loading.exists():
                    time.sleep(0.01)
                self.assert_stopped(process)
            loading.unlink()

    def test_while_a_file_is_written(self):
        out = self.folder / "out"
        with subprocess.Popen([sys.executable, "-c", SLOW_WORK, PLOTS, out], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            self.assertEqual(process.stdout.readline(), "writing\n")
            self.assert_stopped(process)
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    unittest.main()
