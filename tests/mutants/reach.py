"""One run of every test without any mutant: its cost, and which mutants it reaches."""

import ast
import dataclasses
import json
import os
import pathlib
import subprocess
import tempfile
from concurrent import futures

from room_tests import Test, command_of, environment_of, failure_of


@dataclasses.dataclass(frozen=True)
class TracedTest:
    test: Test
    cpu_s: float
    reached: frozenset  # numbers of mutants; files of Python


class BaselineError(Exception):
    """A test fails without any mutant."""


def imported_files(python_file, plots):
    """The modules of plots/ that a test imports, and those that these import."""
    seen, todo = set(), [pathlib.Path(python_file)]
    while todo:
        for node in ast.walk(ast.parse(todo.pop().read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else \
                [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)] \
                if isinstance(node, ast.ImportFrom) and node.module else []
            for name in names:
                path = plots / (name.replace(".", "/") + ".py")
                if path.exists() and path not in seen:
                    seen.add(path)
                    todo.append(path)
    return frozenset(f"plots/{path.relative_to(plots)}" for path in seen)


def files_reached(test, tree):
    """Files of Python that a mutant may be in: those of plots/ that the test imports, all of the package."""
    if test.name:
        return set()
    if pathlib.Path(test.program).parent.name == "python":
        return {str(path.relative_to(tree)) for path in (tree / "python/rcme").glob("*.py")}
    return imported_files(test.program, tree / "plots")


def numbers_reached(trace):
    """The mutants in a trace of selected_mutant.h: byte i is 1 if mutant i was reached."""
    return {number for number, byte in enumerate(trace.read_bytes()) if byte} if trace.exists() else set()


def trace_one(test, tree):
    with tempfile.TemporaryDirectory() as scratch:
        trace = pathlib.Path(scratch) / "reached"
        process = subprocess.Popen(command_of([test]), cwd=tree, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   env=dict(environment_of(tree), RCME_MUTANT_TRACE=str(trace)), text=True, errors="replace")
        output = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        code = os.waitstatus_to_exitcode(status)
        if code != 0:
            raise BaselineError(f"{test.program} {test.name} fails without any mutant: {failure_of(output, code)}\n"
                                + output[-3000:])
        cpu_s = usage.ru_utime + usage.ru_stime
        return TracedTest(test, cpu_s, frozenset(numbers_reached(trace) | files_reached(test, tree)))


def trace_tests(tests, tree, jobs):
    with futures.ThreadPoolExecutor(jobs) as pool:
        return list(pool.map(lambda test: trace_one(test, tree), tests))


def save(traced, key, path):
    rows = [[t.test.program, t.test.name, t.cpu_s, sorted(t.reached, key=str)] for t in traced]
    path.write_text(json.dumps({"key": key, "tests": rows}))


def load(key, path):
    """What was traced before with the same programs; nothing if they have changed."""
    if not path.exists():
        return None
    stored = json.loads(path.read_text())
    if stored["key"] != key:
        return None
    return [TracedTest(Test(program, name), cpu_s, frozenset(reached))
            for program, name, cpu_s, reached in stored["tests"]]
