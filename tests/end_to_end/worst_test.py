#!/usr/bin/python3
"""`rcme worst` on a small study: its files, the same bytes after a kill, and that its region can be run again."""

import csv
import json
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time
import unittest

RCME = str(pathlib.Path(os.environ["RCME"]).resolve())
STUDY = """
name: small
seed: 4
trials: 1
data: {scene: uniform_volume, motion: sideways, noise: gaussian, outliers: uniform}
conditions:
  design: sobol
  number: 10
  ranges: {num_matches: [30, 80], outlier_ratio: [0, 0.9]}
estimators: [{name: standard, options: {solver: five_point, num_iterations: 30}}]
failure: {max_rotation_error_deg: 1, max_direction_error_deg: 5}
"""
ARGUMENTS = ["--estimator", "standard", "--trials", "1000", "--regions", "1", "--fresh", "40", "--claim", "0.1", "--threads", "1"]
FILES = ["worst.csv", "worst.txt", "worst.json", "region_1.yaml", "region_1.txt"]


def is_there(group):
    """Whether a process group has a process that runs."""
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, its_group = stat.read_text(errors="replace").rsplit(")", 1)[1].split()[:3]
        except OSError:  # it has just ended
            continue
        if int(its_group) == group and state != "Z":
            return True
    return False


class WorstTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        (self.folder / "small.yaml").write_text(STUDY, encoding="utf-8")

    def command(self, out, *more):
        return [RCME, "worst", str(self.folder / "small.yaml"), "--out", str(self.folder / out), *ARGUMENTS, *more]

    def finish(self, out, form):
        end = subprocess.run(self.command(out, "--format", form), capture_output=True, text=True, check=False)
        self.assertEqual(end.returncode, 0, end.stderr)
        return {name: (self.folder / out / name).read_bytes() for name in FILES}, end

    def start(self, command, out, num_requests):
        """The process, when some of its requests are answered (0: when the first is under way)."""
        work = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        trials = self.folder / out / "trials"
        while work.poll() is None and (len(list(trials.glob("*.json"))) < num_requests or not list(trials.glob("*.sqlite"))):
            time.sleep(0.01)
        return work

    def kill_after_some_trials(self, out):
        work = self.start(self.command(out), out, 5)
        os.killpg(work.pid, signal.SIGKILL)
        work.wait()

    def test_nothing_of_a_search_outlives_the_program(self):
        for number in (signal.SIGTERM, signal.SIGKILL):
            out = f"ended_{number}"
            command = ["30000" if word == "1000" else word for word in self.command(out)]  # takes half a minute
            work = self.start(command, out, 0)
            self.addCleanup(lambda group=work.pid: is_there(group) and os.killpg(group, signal.SIGKILL))
            os.kill(work.pid, number)  # the program alone, not its group
            work.wait()
            end = time.monotonic() + 5
            while is_there(work.pid) and time.monotonic() < end:
                time.sleep(0.02)
            self.assertFalse(is_there(work.pid))

    def test_a_killed_search_ends_as_an_undisturbed_one(self):
        whole, of_whole = self.finish("whole", "json")
        self.assertIn("trials", of_whole.stderr)  # the cost, beforehand
        self.assertTrue((self.folder / "whole" / "region_1.png").exists())
        self.kill_after_some_trials("killed")
        self.assertFalse((self.folder / "killed" / "worst.csv").exists())
        again, of_killed = self.finish("killed", "csv")
        self.assertEqual(again, whole)

        self.assertEqual(of_whole.stdout, whole["worst.json"].decode())
        self.assertEqual([float(row["rate"]) for row in csv.DictReader(of_killed.stdout.splitlines())],
                         [region["rate"] for region in json.loads(of_whole.stdout)["regions"]])

        row = next(csv.DictReader((self.folder / "whole" / "worst.csv").read_text().splitlines()))
        run = str(self.folder / "again.sqlite")
        subprocess.run([RCME, "run", str(self.folder / "whole" / "region_1.yaml"), "--out", run], check=True,
                       capture_output=True)
        raw = subprocess.run([RCME, "summarize", run, "--raw", "csv"], check=True, capture_output=True, text=True).stdout
        outcomes = [trial["outcome"] for trial in csv.DictReader(raw.splitlines())]
        self.assertEqual((outcomes.count("failure"), len(outcomes)), (int(row["events"]), int(row["trials"])))

        asked = self.folder / "killed" / "trials" / "explore_0_0.yaml"
        asked.write_text(asked.read_text().replace("trials: '1'", "trials: '2'").replace("trials: 1", "trials: 2"))
        other = subprocess.run(self.command("killed"), capture_output=True, text=True, check=False)
        self.assertEqual(other.returncode, 2)
        self.assertIn("asks for other trials", other.stderr)

        other = subprocess.run(self.command("whole", "--seed", "9"), capture_output=True, text=True, check=False)
        self.assertEqual(other.returncode, 2)
        self.assertIn("another study", other.stderr)

    def test_minutes_say_how_many_trials(self):
        command = [RCME, "worst", str(self.folder / "small.yaml"), "--out", str(self.folder / "minutes"), "--estimator", "standard",
                   "--minutes", "1", "--threads", "1"]
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True) as work:
            said = work.stderr.readline()  # the cost, by the time of the first draws
            os.killpg(work.pid, signal.SIGKILL)
        cost = re.match(r"worst: about (\d+) trials: ", said)
        self.assertTrue(cost, said)
        self.assertGreater(int(cost[1]), 500)  # the least that is ever spent

    def test_what_is_refused(self):
        for more, said in ((["--against", "standard"], "--quantity difference"), (["--quantity", "difference"], "--against")):
            end = subprocess.run(self.command("refused", *more), capture_output=True, text=True, check=False)
            self.assertEqual(end.returncode, 2)
            self.assertIn(said, end.stderr)

    def test_an_estimator_without_a_probability_ends_the_search_of_sure_failures(self):
        end = subprocess.run(self.command("unsure", "--quantity", "sure_failure"), capture_output=True, text=True, check=False)
        self.assertEqual(end.returncode, 2)
        self.assertIn("no answer of standard states a probability of failure", end.stderr)
        self.assertEqual(len(list((self.folder / "unsure" / "trials").glob("*.sqlite"))), 1)  # of the first answers


if __name__ == "__main__":
    unittest.main()
