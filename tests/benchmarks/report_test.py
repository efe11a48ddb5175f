#!/usr/bin/python3
"""Tests of tests/benchmarks/report.py and of what rcme_ratios writes.

    tests/benchmarks/report_test.py                              the comparison
    RCME_RATIOS=build/release/bin/rcme_ratios tests/benchmarks/report_test.py      also the program's keys, and the figure
"""

import contextlib
import copy
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import report  # noqa: E402

BASELINES = HERE / "baselines"
THEN = "SomeMaker_6_85_AVX2.json"  # the baseline of result()
PLOT = HERE.parents[1] / "plots" / "benchmarks.py"


def result(**changes):
    """A result whose ratios are all 2 within [1.9, 2.1], but for the changes: name = (lower, value, upper)."""
    values = {name: (1.9, 2.0, 2.1) for name in report.REQUIRED} | changes
    run = {"processor": "SomeMaker 6 85", "instruction_set": "AVX2", "cores": 2, "rounds": 11, "load_average_at_start": 0.1, "problem": "a problem",
           "clock": "a clock", "poselib": "skipped"}
    time = {"median": 3.0, "lower": 2.0, "upper": 4.0}
    cases = [{"group": "stage", "name": name, "microseconds": time} for name in ("refine/fast", "refine/reference", "scan")]
    return {"run": run, "ratios": {name: value for name, (_, value, _) in values.items()},
            "intervals": {name: {"lower": low, "upper": high} for name, (low, _, high) in values.items()},
            "cases": cases, "speedups": {"refine": time}}


class Comparison(unittest.TestCase):
    def assert_regressions(self, names, **changes):
        lines, is_worse = report.verdict(result(**changes), result())
        found = [line.split()[1] for line in lines if line.startswith("regression: ")]
        self.assertEqual((found, is_worse), (names, bool(names)), lines)

    def test_the_same_again_is_none(self):
        self.assert_regressions([])

    def test_a_speedup_lost_by_more_than_the_margin_is_one(self):
        lost = 1.9 / (1 + report.MARGIN)
        self.assert_regressions(["rcme_vs_reference"], rcme_vs_reference=(1.2, 1.4, lost - 0.01))
        self.assert_regressions(["printed_score_fma_peak"], printed_score_fma_peak=(0.3, 0.31, 0.32))
        self.assert_regressions(["two_threads_vs_one"], two_threads_vs_one=(1.0, 1.1, 1.2))

    def test_noise_is_none(self):
        lost = 1.9 / (1 + report.MARGIN)
        self.assert_regressions([], rcme_vs_reference=(1.0, 1.4, lost + 0.01))  # wide: its upper end is within
        self.assert_regressions([], rcme_vs_reference=(1.6, 1.65, 1.7))         # sure, but less than the margin

    def test_better_is_none(self):
        self.assert_regressions([], rcme_vs_reference=(9.0, 10.0, 11.0), trial_vs_rcme_call=(0.9, 1.0, 1.1),
                                exponent_n=(0.5, 0.6, 0.7))

    def test_where_smaller_is_better_larger_is_worse(self):
        grown = 2.1 * (1 + report.MARGIN)
        self.assert_regressions(["trial_vs_rcme_call"], trial_vs_rcme_call=(grown + 0.01, 3, 3.1))
        self.assert_regressions([], trial_vs_rcme_call=(grown - 0.01, 3, 3.1))

    def test_exponents_have_an_absolute_margin(self):
        grown = 2.1 + report.EXPONENT_MARGIN
        self.assert_regressions(["exponent_trials"], exponent_trials=(grown + 0.01, 2.3, 2.4))
        self.assert_regressions([], exponent_trials=(grown - 0.01, 2.3, 2.4))

    def test_each_required_ratio_is_compared(self):
        for name in report.REQUIRED:
            worse = (19.0, 20.0, 21.0) if report.smaller_is_better(name) else (0.19, 0.2, 0.21)
            with self.subTest(name):
                self.assert_regressions([name], **{name: worse})

    def test_a_ratio_that_one_side_lacks_is_printed_and_not_compared(self):
        now = result(rcme_vs_poselib_relative_pose=(0.1, 0.2, 0.3))
        self.assertEqual(report.regressions(now, result()), [])
        self.assertIn("rcme_vs_poselib_relative_pose", "\n".join(report.report(now, result())))

    def test_threads_are_not_compared_on_a_busy_machine(self):
        now = result(two_threads_vs_one=(0.8, 0.9, 1.0), rcme_vs_reference=(0.1, 0.2, 0.3))
        now["run"]["load_average_at_start"] = 1.7
        lines, is_worse = report.verdict(now, result())
        self.assertTrue(is_worse)
        self.assertIn("load average was 1.70", lines[0])
        self.assertNotIn("regression: two_threads_vs_one", "\n".join(lines))


class Files(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def write(self, name, content):
        path = self.folder / name
        path.write_text(json.dumps(content), encoding="utf-8")
        return str(path)

    def run_main(self, now, baseline, *options):
        """(exit code, standard output, standard error) of a comparison of two contents."""
        out, err = io.StringIO(), io.StringIO()
        if baseline:
            self.write(THEN, baseline)
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = report.main([self.write("now.json", now), "--baselines", str(self.folder), *options])
        return code, out.getvalue(), err.getvalue()

    def test_exit_codes(self):
        self.assertEqual(self.run_main(result(), result())[0], 0)
        code, out, _ = self.run_main(result(rcme_vs_reference=(0.1, 0.2, 0.3)), result())
        self.assertEqual(code, 1)
        self.assertIn("regression: rcme_vs_reference is 0.2 [0.1, 0.3], wholly below 1.52; the baseline is 2.", out)

    def test_a_missing_key_is_named(self):
        for name in report.REQUIRED:
            lacking = result()
            del lacking["ratios"][name]
            for now, baseline, file in ((lacking, result(), "now.json"), (result(), lacking, THEN)):
                code, _, err = self.run_main(now, baseline)
                self.assertEqual(code, 2)
                self.assertIn(f"{file}: ratios lacks {name}", err)

    def test_a_number_without_its_interval_is_named(self):
        for bounds in ({}, {"lower": 1.0, "upper": None}, {"lower": 3.0, "upper": 4.0}):
            now = result()
            now["intervals"]["exponent_n"] = bounds
            code, _, err = self.run_main(now, result())
            self.assertEqual(code, 2)
            self.assertIn("now.json: exponent_n must be a number", err)

    def test_a_file_that_is_not_json(self):
        (self.folder / "cut.json").write_text('{"ratios": {', encoding="utf-8")
        with contextlib.redirect_stderr(io.StringIO()) as err:
            code = report.main([str(self.folder / "cut.json"), "--baselines", str(BASELINES)])
        self.assertEqual(code, 2)
        self.assertIn("cut.json: cannot be read", err.getvalue())

    def test_an_updated_baseline_holds_ratios_and_no_times(self):
        path = self.folder / THEN
        now = result(rcme_vs_reference=(5.0, 6.0, 7.0))
        code, _, _ = self.run_main(now, result(), "--update-baseline")
        written = json.loads(path.read_text(encoding="utf-8"))
        self.assertEqual(code, 0)
        self.assertEqual(sorted(written), ["intervals", "ratios", "run"])
        self.assertEqual(report.verdict(copy.deepcopy(now), report.read(str(path)))[1], False)

    def test_each_committed_baseline_is_whole_and_named_by_its_processor(self):
        for path in BASELINES.glob("*"):
            baseline = report.read(str(path))
            self.assertLessEqual(set(report.REQUIRED), set(baseline["ratios"]))
            self.assertEqual(report.baseline_path(BASELINES, baseline), path)

    def test_another_processor_or_instruction_set_has_no_baseline(self):
        for key, other in (("processor", "SomeMaker 6 86"), ("instruction_set", "AVX3")):
            now = result(rcme_vs_reference=(0.1, 0.2, 0.3))
            now["run"][key] = other
            code, out, _ = self.run_main(now, result())
            self.assertEqual(code, 0)
            self.assertIn(f"No baseline for {now['run']['processor']} with {now['run']['instruction_set']}: nothing is compared.", out)
            self.run_main(now, None, "--update-baseline")
            self.assertEqual(self.run_main(now, result())[0], 0)  # its own


@unittest.skipUnless("RCME_RATIOS" in os.environ, "RCME_RATIOS does not name the program")
class Program(unittest.TestCase):
    """What the program writes, in its smallest extent, is what the report and the figure read."""

    def test_every_ratio_has_its_interval_and_its_meaning(self):
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/benchmarks.json"
            subprocess.run([os.environ["RCME_RATIOS"], "--tiny", "--out", path], check=True)
            content = report.read(path)
            self.assertEqual(set(content["ratios"]), set(content["intervals"]))
            self.assertEqual(set(content["ratios"]), set(content["meanings"]))
            printed = "\n".join(report.report(content, None))
            for name in report.REQUIRED:
                self.assertIn(name, printed)
            subprocess.run([sys.executable, PLOT, path, "--out", f"{folder}/figure"], check=True, capture_output=True)
            self.assertGreater((pathlib.Path(folder) / "figure.png").stat().st_size, 10_000)


if __name__ == "__main__":
    unittest.main()
