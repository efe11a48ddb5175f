"""The tests of a room: which there are, what each costs, and running some of them under one mutant."""

import dataclasses
import os
import resource
import subprocess
import sys
import time

# A room's mutants are to be caught by the room's own tests.
PROGRAMS = {"stats": ["stats_test"], "simulator": ["simulator_test"], "estimator": ["estimator_test"],
            "peers": ["peers_test"], "experiments": ["experiments_test", "end_to_end_test"]}
MAX_MEMORY_BYTES = 6 << 30


@dataclasses.dataclass(frozen=True)
class Test:
    program: str  # a gtest program, or a Python file of tests/plots
    name: str     # of the test in its program; empty: the whole file


@dataclasses.dataclass
class Run:
    passed: bool
    cpu_s: float
    how: str = ""  # it ended, if not well: the failed test, "time limit", "signal 11"


def gtest_names(program):
    listing = subprocess.run([program, "--gtest_list_tests"], check=True, capture_output=True, text=True).stdout
    names, suite = [], ""
    for line in listing.splitlines():
        if line.startswith("  "):
            name = line.split("#")[0].strip()
            if not name.startswith("DISABLED_"):
                names.append(suite + name)
        elif line.endswith(".") or "# TypeParam" in line:
            suite = line.split("#")[0].strip()
    return names


def tests_of(room, build, tree):
    if room == "plots":
        return [Test(str(path), "") for path in sorted((tree / "tests/plots").glob("*_test.py"))]
    programs = [str(build / "bin" / name) for name in PROGRAMS[room]]
    return [Test(program, name) for program in programs for name in gtest_names(program)]


def command_of(tests):
    if not tests[0].name:
        return [sys.executable, tests[0].program, "-f"]
    return [tests[0].program, "--gtest_brief=1", "--gtest_fail_fast", "--gtest_color=no",
            "--gtest_filter=" + ":".join(test.name for test in tests)]


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

    process = subprocess.Popen(command_of(tests), cwd=cwd, env=dict(os.environ, GLOG_minloglevel="3",
                                                                    **(environment or {})),
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
