#!/usr/bin/python3
"""Tests of tests/benchmarks/against.py, with two programs that only say how long they took."""

import contextlib
import io
import pathlib
import random
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import against  # noqa: E402

BENCHMARK = """#!/bin/sh
echo '{{"benchmarks": [{{"name": "refine", "cpu_time": {refine}, "time_unit": "us"}}, {{"name": "{own}", "cpu_time": 1.0, "time_unit": "ms"}}]}}'
"""
RCME = """#!/bin/sh
[ "$1" != {unknown} ] || exit 2
for last; do :; done
: > "$last"
"""


class Intervals(unittest.TestCase):
    def test_they_are_order_statistics_of_the_binomial(self):
        # B binomial with p = 1/2: 2 P(B <= 0) = .031 of 6; 2 P(B <= 3) = .035 and 2 P(B <= 4) = .118 of 15; .043 and .099 of 30.
        for n, rank in ((6, 1), (15, 4), (30, 10)):
            values = list(range(1, n + 1))
            random.Random(1).shuffle(values)
            self.assertEqual(against.median_interval(values), (rank, (n + 1) / 2, n + 1 - rank))

    def test_they_hold_the_median_as_often_as_they_say(self):
        rng, held, trials = random.Random(2), 0, 4000
        for _ in range(trials):
            lower, _, upper = against.median_interval([rng.gauss(0, 1) for _ in range(15)])
            held += lower <= 0 <= upper
        # 15 values: 96.5 %; a band of four standard deviations, false alarms 6e-5. Ranks 5 and 11 would give 88 %.
        self.assertAlmostEqual(held / trials, 0.965, delta=4 * (0.965 * 0.035 / trials) ** 0.5)


class Comparison(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def make_programs(self, name, refine, own, unknown):
        folder = self.folder / name
        folder.mkdir()
        for program, text in (("rcme_benchmark", BENCHMARK.format(refine=refine, own=own)), ("rcme", RCME.format(unknown=unknown))):
            (folder / program).write_text(text)
            (folder / program).chmod(0o755)
        return folder

    def test_a_row_per_case_and_workload_and_what_one_side_lacks(self):
        sides = self.make_programs("now", 3.0, "new", "none"), self.make_programs("before", 2.0, "old", "compare")
        rounds = [tuple(against.measure_round(side, self.folder, True, side is sides[1]) for side in sides) for _ in range(6)]
        rows = against.compare(rounds)
        refine = next(row for row in rows if row["name"] == "refine")
        self.assertEqual([refine[key] for key in ("ratio", "lower", "upper", "now", "before")], [1.5, 1.5, 1.5, 3.0, 2.0])
        self.assertEqual([row["name"] for row in rows if row["quantity"] == "only before"], ["old"])
        self.assertEqual([row["name"] for row in rows if row["quantity"] == "only now"], ["new", "rcme compare"])
        self.assertEqual([row["name"] for row in rows if row["quantity"] == "memory"], ["rcme run of five estimators", "rcme summarize"])
        text = "\n".join(against.format_rows(rows, "abc"))
        self.assertIn("refine                                              1.500   [1.500, 1.500]            2          3", text)
        self.assertIn("only before: old", text)

    def test_a_workload_that_this_tree_cannot_run_is_an_error(self):
        with self.assertRaisesRegex(against.AgainstError, "rcme compare .* ended with 2"):
            against.measure_round(self.make_programs("now", 3.0, "new", "compare"), self.folder, True, False)

    def test_what_it_refuses(self):
        for arguments, said in ((["no-such-commit"], "--against no-such-commit: no commit"), (["HEAD", "--rounds", "5"], "--rounds 5: at least 6")):
            with contextlib.redirect_stderr(io.StringIO()) as err:
                self.assertEqual(against.main(arguments), 2)
            self.assertIn(said, err.getvalue())

    def test_a_step_that_fails_is_named_with_its_output(self):
        with self.assertRaisesRegex(against.AgainstError, "(?s)sh -c echo broken.* failed:\nbroken"):
            against.run_step(["sh", "-c", "echo broken; exit 3"], self.folder)


if __name__ == "__main__":
    unittest.main()
