#!/usr/bin/python3
"""Tests of the lists of mutants and of what is made of them; run as: /usr/bin/python3 tests/mutants/mutants_test.py"""

import os
import pathlib
import subprocess
import tempfile
import unittest

import entries
import reach
import results
import weave
from judge import Verdict, batches
from reach import TracedTest
from room_tests import Test, failure_of

SOURCE = "double Half(double a, double b) {\n  double sum = a + b;\n  sum *= 0.5;\n  return sum;\n}\n"


class Entries(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        (self.folder / "stats").mkdir()
        (self.folder / "stats/half.cc").write_text(SOURCE)

    def read(self, line):
        (self.folder / "stats.toml").write_text('["stats/half.cc"]\n' + line + "\n")
        return entries.read_rooms(self.folder, self.folder)["stats"]

    def assert_refused(self, line, *parts):
        with self.assertRaises(entries.EntryError) as error:
            self.read(line)
        for part in parts:
            self.assertIn(part, str(error.exception))

    def test_every_entry_of_every_room_fits_its_source(self):
        for mutants in entries.read_rooms().values():
            for mutant in mutants:
                weave.weave((entries.SOURCE / mutant.file).read_text(), [(mutant, 0)])

    def test_an_entry_that_no_longer_fits_is_named(self):
        self.assert_refused("gone = { was = 'a * b', now = 'a - b' }", "stats.toml", "half.cc", "gone", "not found")
        self.assert_refused("twice = { was = 'sum', now = 'a' }", "twice", "stands 3 times")
        self.assert_refused("same = { was = 'a + b', now = 'a + b' }", "same")
        self.assert_refused("half = { was = 'a + b' }", "half", "was and now")
        self.assert_refused("odd = { was = 'sum *= 0.5;', now = 'sum' }", "odd", "statements")
        self.assert_refused("open = { was = 'a", "stats.toml")

    def test_a_piece_of_code_that_is_not_whole_is_refused(self):
        for was, now in (("+ b", "- b"), ("a +", "a -"), ("Half(double a,", "Half(float a,"), ("return sum", "return a"),
                         ("double sum = a + b;", "double sum = a - b;")):
            self.assert_refused(f"half = {{ was = '{was}', now = '{now}' }}", "half", "whole")
        self.assertTrue(entries.is_whole("*given"))
        self.assertTrue(entries.is_whole("f(\"(\", '{')"))

    def test_the_room_is_the_innermost_that_the_file_is_in(self):
        self.assertEqual(entries.room_of("estimator/ransac_loop.h"), "estimator")
        self.assertEqual(entries.room_of("estimator/calibrated/influence.cc"), "calibrated")
        self.assertEqual(entries.room_of("experiments/real/truth_free/twin.cc"), "truth_free")
        self.assertIsNone(entries.room_of("robot/pose_graph.cc"))

    def test_a_text_around_it_chooses_one_of_several(self):
        mutant, = self.read("exchanged = { was = 'sum', now = 'a', in = 'return sum' }")
        self.assertEqual(mutant.begin, SOURCE.index("return sum") + 7)


class Weaving(Entries):
    def woven(self, lines):
        mutants = self.read(lines)
        return weave.weave(SOURCE, [(mutant, number) for number, mutant in enumerate(mutants)])

    def test_expressions_statements_and_one_within_another(self):
        woven = self.woven("difference = { was = 'a + b', now = 'a - b' }\n"
                           "first = { was = 'a', now = 'b', in = 'a + b' }\n"
                           "whole = { was = 'sum *= 0.5;', now = 'sum *= 1.0;' }")
        is_on = "::rcme::mutants::IsOn"
        self.assertIn(f"double sum = ({is_on}(0) ? (a - b) : (({is_on}(1) ? (b) : (a)) + b));", woven)
        self.assertIn(f"{{ if ({is_on}(2)) {{ sum *= 1.0; }} else {{ sum *= 0.5; }} }}", woven)
        self.assertTrue(woven.startswith(weave.INCLUDE))

    def test_mutants_that_overlap_are_refused(self):
        with self.assertRaises(entries.EntryError):
            self.woven("one = { was = 'sum = a', now = 'a' }\ntwo = { was = 'a + b', now = 'b' }")

    def test_a_header_includes_behind_its_guard(self):
        self.assertEqual(weave.weave("// x\n#pragma once\nint a;\n", []),
                         "// x\n#pragma once\n" + weave.INCLUDE + "int a;\n")


# Mutant 3 is reached by a process that is limited as an isolated call is and then killed, 5 by its parent, which is killed too.
FORKING_PROGRAM = """#include "tests/mutants/selected_mutant.h"
#include <sys/resource.h>
#include <sys/wait.h>
#include <csignal>
int main() {
  if (fork() == 0) {
    const rlimit none{};
    setrlimit(RLIMIT_NOFILE, &none);
    setrlimit(RLIMIT_FSIZE, &none);
    rcme::mutants::IsOn(3);
    raise(SIGKILL);
  }
  int status = 0;
  if (wait(&status) < 0 || !WIFSIGNALED(status) || WTERMSIG(status) != SIGKILL) return 1;
  if (!rcme::mutants::IsOn(5)) return 2;
  raise(SIGKILL);
}
"""


class Tracing(unittest.TestCase):
    def test_forked_and_killed_processes_count(self):
        with tempfile.TemporaryDirectory() as scratch:
            program, trace = pathlib.Path(scratch) / "forking", pathlib.Path(scratch) / "trace"
            subprocess.run([os.environ.get("CXX", "c++"), "-std=c++20", "-x", "c++", "-", "-I", entries.SOURCE, "-o", program],
                           input=FORKING_PROGRAM, text=True, check=True)
            run = subprocess.run([program], env=dict(os.environ, RCME_MUTANT="5", RCME_MUTANT_TRACE=str(trace)))
            self.assertEqual(run.returncode, -9)
            self.assertEqual(reach.numbers_reached(trace), {3, 5})
            self.assertEqual(reach.numbers_reached(pathlib.Path(scratch) / "none"), set())


class Judging(unittest.TestCase):
    def test_cheapest_first_in_batches_that_double(self):
        traced = [TracedTest(Test("p", str(cost)), cost, frozenset()) for cost in (3.0, 0.4, 0.1, 0.6, 5.0, 0.2)]
        costs = [[test.cpu_s for test in batch] for batch in batches(traced)]
        self.assertEqual(costs, [[0.1, 0.2, 0.4, 0.6], [3.0], [5.0]])

    def test_how_a_test_ended(self):
        self.assertEqual(failure_of("[ RUN ]\n[  FAILED  ] A.B (3 ms)\n", 1), "A.B")
        self.assertEqual(failure_of("[  FAILED  ] A.B/1, where GetParam() = 3 (3 ms)\n", 1), "A.B/1")
        self.assertEqual(failure_of("FAIL: test_it (__main__.Drawn.test_it)\n", 1), "test_it (__main__.Drawn.test_it)")
        self.assertEqual(failure_of("", -11), "signal 11")


class Results(unittest.TestCase):
    def test_clopper_pearson_is_that_of_r(self):
        # R 4.2: binom.test(k, n)$conf.int.
        for (k, n), expected in {(10, 10): (0.6915, 1.0), (8, 10): (0.4439, 0.9748), (0, 5): (0.0, 0.5218)}.items():
            for end, value in zip(results.clopper_pearson(k, n), expected):
                self.assertAlmostEqual(end, value, places=4)

    def test_equivalent_mutants_do_not_count(self):
        verdicts = [Verdict("stats", "a.cc", f"m{i}", outcome, "") for i, outcome in enumerate(
            ["caught"] * 8 + ["survived", "not reached", "equivalent"])]
        text = results.summary(verdicts, ["stats"])
        self.assertIn("| stats | 11 | 1 | 8 | 2 | 80.0 % [44.4, 97.5] |", text)
        self.assertIn("- stats `m8` (a.cc)", text)


if __name__ == "__main__":
    unittest.main()
