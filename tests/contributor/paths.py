#!/usr/bin/env python3
"""Follows CONTRIBUTING.md, "How to add", to the letter: copies the committed tree, writes and registers the example of each
path (examples.py), builds, and runs the tests that the addition concerns. By hand: the first build is that of the tree.

    tests/contributor/paths.py                      every path by itself, one after the other in one copy
    tests/contributor/paths.py --only scene,claim   some of them
    tests/contributor/paths.py --together           all examples in one tree, built once

Wall time is that of this machine with what else it does; CPU time is of all processes of the build. With a compiler cache
(CMAKE_CXX_COMPILER_LAUNCHER) both are small for what was compiled before.
"""

import argparse
import dataclasses
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

from examples import ROOT, apply, read_examples

PRESET = "release"
MADE_HERE = ".git/copy_of_contributor_paths"
AFTER_LISTS = r"docs\.reference|architecture\."


@dataclasses.dataclass
class Report:
    title: str
    written: tuple
    edited: tuple
    num_lines: int
    build_seconds: float = 0.0
    cpu_seconds: float = 0.0
    num_tests: int = 0
    failures: tuple = ()  # in words


class Failed(Exception):
    """A step that did not end well; its text is the end of what it printed."""


class Tree:
    """A copy of the committed tree with its build folder."""

    def __init__(self, folder, jobs):
        if folder.exists() and not (folder / MADE_HERE).exists():
            raise Failed(f"--folder {folder}: is no copy that this script has made; give a new folder")
        self.folder, self.jobs = folder, jobs
        self.bin = folder / "build" / PRESET / "bin"
        if not folder.exists():
            self.run("git", "clone", "-q", str(ROOT), str(folder), cwd=ROOT)
            (folder / MADE_HERE).touch()
        if not (folder / "build" / PRESET / "build.ninja").exists():
            self.run("cmake", "--preset", PRESET)

    def run(self, *command, cwd=None):
        environment = {**os.environ, "PATH": f"{self.bin}:{os.environ['PATH']}"}
        done = subprocess.run(command, cwd=cwd or self.folder, env=environment, text=True, errors="replace",
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode != 0:
            raise Failed(f"{' '.join(command)}\n{done.stdout[-6000:]}")
        return done.stdout

    def build(self, targets):
        """(seconds, seconds of CPU time)."""
        def used():
            usage = resource.getrusage(resource.RUSAGE_CHILDREN)
            return time.monotonic(), usage.ru_utime + usage.ru_stime
        before = used()
        self.run("cmake", "--build", f"build/{PRESET}", f"-j{self.jobs}", "--target", *targets)
        return tuple(b - a for a, b in zip(before, used()))

    def test(self, pattern):
        """How many tests ran."""
        said = self.run("ctest", "--preset", PRESET, f"-j{self.jobs}", "--no-tests=error", "-R", pattern)
        return int(re.search(r"tests failed out of (\d+)", said).group(1))

    def revert(self):
        self.run("git", "reset", "-q", "--hard")
        self.run("git", "clean", "-fdq")


def commands_of(tree, example):
    """What a user does then, in a folder of its own beside the tree's results."""
    with tempfile.TemporaryDirectory() as scratch:
        for name in ("results", "studies"):
            (pathlib.Path(scratch) / name).symlink_to(tree.folder / name)
        for command in example.commands:
            print(f"$ {command}\n{tree.run('bash', '-c', command, cwd=scratch)}", flush=True)


def follow(tree, title, examples, extra_tests=()):
    """The path of one example, or of several at once."""
    report = Report(title, sum((e.written for e in examples), ()),
                    tuple(dict.fromkeys(sum((e.edited for e in examples), ()))), sum(e.num_registered for e in examples))
    targets = tuple(dict.fromkeys(sum((e.targets for e in examples), ())))
    failures = []

    def attempt(step):
        try:
            return step()
        except Failed as failed:
            print(failed, flush=True)
            failures.append(str(failed).splitlines()[0])
            return None

    for example in examples:
        apply(example, tree.folder)
    if built := attempt(lambda: tree.build(targets)):
        report.build_seconds, report.cpu_seconds = built
        patterns = [example.tests for example in examples]
        if any(example.is_listed for example in examples):
            attempt(lambda: tree.run("scripts/reference"))
            patterns.append(AFTER_LISTS)
        for pattern in [*patterns, *extra_tests]:
            report.num_tests += attempt(lambda: tree.test(pattern)) or 0
        for example in examples:
            attempt(lambda: commands_of(tree, example))
    report.failures = tuple(failures)
    return report


def show(report):
    print(f"{report.title}: {'PASSED' if not report.failures else 'FAILED'}\n"
          f"  written     {len(report.written)}: {', '.join(report.written) or '-'}\n"
          f"  registered  {report.num_lines} lines in {len(report.edited)} files: {', '.join(report.edited) or '-'}\n"
          f"  built       {report.build_seconds:.0f} s ({report.cpu_seconds:.0f} s of CPU time)\n"
          f"  tests       {report.num_tests}")
    for failure in report.failures:
        print(f"  failed      {failure}")
    sys.stdout.flush()


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", metavar="A,B", help="these paths")
    parser.add_argument("--together", action="store_true", help="all of them in one tree")
    parser.add_argument("--tests", default="", metavar="REGEX", help="run these tests too")
    parser.add_argument("--folder", type=pathlib.Path, metavar="FOLDER",
                        help="the copy, kept and used again; default: a temporary one beside this tree")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="default: %(default)s")
    return parser, parser.parse_args(arguments)


def main(arguments=None):
    parser, options = parse(arguments)
    examples = read_examples()
    names = options.only.split(",") if options.only else list(examples)
    if unknown := [name for name in names if name not in examples]:
        parser.error(f"--only {','.join(unknown)}: the paths are {', '.join(examples)}")
    chosen = [examples[name] for name in names]
    scratch = None if options.folder else pathlib.Path(tempfile.mkdtemp(prefix="paths_", dir=ROOT.parent))
    tree = Tree((options.folder or scratch / "tree").resolve(), options.jobs)
    extra = [options.tests] if options.tests else []
    reports = []
    for group in [chosen] if options.together else [[example] for example in chosen]:
        tree.revert()
        tree.build(dict.fromkeys(sum((example.targets for example in group), ())))  # what a contributor has already
        reports.append(follow(tree, " + ".join(example.path for example in group), group, extra))
        show(reports[-1])
    print("\nIn short:\n")
    for report in reports:
        show(report)
    if scratch:
        shutil.rmtree(scratch)
    return 1 if any(report.failures for report in reports) else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failed as failed:
        sys.exit(f"paths: {failed}")
