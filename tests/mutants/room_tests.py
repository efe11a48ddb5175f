"""The tests of a room: which there are, what each costs, and running some of them under one mutant."""

import dataclasses
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

from entries import FOLDERS

# What is built for the mutants of a folder of the source tree; a room's mutants are to be caught by the room's own tests.
PROGRAMS = {"stats": ["stats_test"], "simulator": ["simulator_test"], "estimator": ["estimator_test"],
            "peers": ["peers_test"], "experiments": ["experiments_test", "end_to_end_test"], "plots": [],
            "python": ["rcme_python", "rcme"]}
# Of a room within another: its tests beside those of its own folder.
MORE_TESTS = {"calibrated": ["estimator/estimators/rcme_calibrated_test.cc"]}
NOT_RUN = {"pip_test.py"}  # builds the package anew
MAX_MEMORY_BYTES = 6 << 30


@dataclasses.dataclass(frozen=True)
class Test:
    program: str  # a gtest program, or a Python file of tests/plots or tests/python
    name: str     # of the test in its program; empty: the whole file


@dataclasses.dataclass
class Run:
    passed: bool
    cpu_s: float
    how: str = ""  # it ended, if not well: the failed test, "time limit", "signal 11"


def programs_of(room):
    return PROGRAMS[FOLDERS[room].split("/")[0]]


def gtest_tests(program):
    """(name, source file) of each test that is not disabled."""
    with tempfile.TemporaryDirectory() as scratch:
        listing = pathlib.Path(scratch) / "tests.json"
        subprocess.run([program, "--gtest_list_tests", f"--gtest_output=json:{listing}"], check=True, capture_output=True)
        suites = json.loads(listing.read_text())["testsuites"]
    return [(f"{suite['name']}.{test['name']}", test["file"]) for suite in suites for test in suite["testsuite"]
            if not test["name"].startswith("DISABLED_")]


def is_of_room(room, file):
    """Whether a test's source belongs to the room: everything of a program, or of a room within another its own folder."""
    folders = [FOLDERS[room], *MORE_TESTS.get(room, [])]
    return "/" not in FOLDERS[room] or any(f"tests/{folder}" in file for folder in folders)


def tests_of(room, build, tree):
    if room in ("plots", "python"):
        return [Test(str(path), "") for path in sorted((tree / "tests" / room).glob("*_test.py"))
                if path.name not in NOT_RUN]
    programs = [str(build / "bin" / name) for name in programs_of(room)]
    return [Test(program, name) for program in programs for name, file in gtest_tests(program) if is_of_room(room, file)]


def command_of(tests):
    if not tests[0].name:
        return [sys.executable, "-B", tests[0].program, "-f"]
    return [tests[0].program, "--gtest_brief=1", "--gtest_fail_fast", "--gtest_color=no",
            "--gtest_filter=" + ":".join(test.name for test in tests)]


def environment_of(tree):
    """Of the package and the program that tests of Python use."""
    build = pathlib.Path(tree) / "build/release"
    return dict(os.environ, GLOG_minloglevel="3", PYTHONDONTWRITEBYTECODE="1", PYTHONPATH=str(build / "python"),
                RCME=str(build / "bin/rcme"), RCME_BUILD_FOLDER=str(build))


def failure_of(output, return_code):
    for line in output.splitlines():
        if line.startswith("[  FAILED  ] "):
            return line.split("] ")[1].split(",")[0].split(" (")[0]
        if line.startswith(("FAIL: ", "ERROR: ")):
            return line.split(": ")[1]
    return f"signal {-return_code}" if return_code < 0 else f"exit code {return_code}"


def run_tests(tests, cwd, environment=None, max_cpu_s=None):
    """One process for tests of one program. The limit is of processor time, since a busy machine slows down all else;
    one of elapsed time stands behind it for what waits for ever."""

    def limit():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if max_cpu_s:
            resource.setrlimit(resource.RLIMIT_CPU, (int(max_cpu_s) + 1, int(max_cpu_s) + 3))
            resource.setrlimit(resource.RLIMIT_DATA, (MAX_MEMORY_BYTES, MAX_MEMORY_BYTES))

    process = subprocess.Popen(command_of(tests), cwd=cwd, env={**environment_of(cwd), **(environment or {})},
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                               preexec_fn=limit, start_new_session=True)
    start = time.monotonic()
    try:
        output, _ = process.communicate(timeout=120 + 20 * max_cpu_s if max_cpu_s else None)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        process.communicate()
        return Run(False, time.monotonic() - start, "time limit")
    if process.returncode in (-24, -9):  # SIGXCPU, SIGKILL
        return Run(False, max_cpu_s or 0.0, "time limit")
    if process.returncode == 0:
        return Run(True, time.monotonic() - start)
    return Run(False, time.monotonic() - start, failure_of(output, process.returncode))
