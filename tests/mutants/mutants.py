"""Mutation score of the tests; see --help, and CONTRIBUTING.md, "Mutants"."""

import argparse
import hashlib
import pathlib
import subprocess
import sys
import time
import zlib
from concurrent import futures

import entries
import judge
import reach
import results
import room_tests
import weave

MAX_MUTANTS = 65536  # as in selected_mutant.h

HEADER = """# Mutants

Faults put into the sources by hand, chosen before the tests were run on them; a room's own tests are to catch its mutants.
Equivalent ones do not count. Written by `scripts/mutants`; each mutant and the test that caught it: results.csv.

"""


def parse_arguments():
    parser = argparse.ArgumentParser(
        prog="scripts/mutants",
        description="Puts each fault of tests/mutants/ROOM.toml into the sources, runs the tests of the room that reach "
        "it, and prints how many are caught. All faults of a room are built at once, in build/mutants.")
    parser.add_argument("rooms", nargs="*", metavar="ROOM", help="default: all of " + ", ".join(entries.ROOMS))
    parser.add_argument("--only", metavar="NAME", action="append", default=[],
                        help="these mutants alone; the committed results stay as they are")
    parser.add_argument("--survivors", action="store_true",
                        help="those alone that the committed results do not call caught")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="processes at a time (default: 2)")
    parser.add_argument("--check", action="store_true",
                        help="only whether every entry still fits its source; builds nothing")
    arguments = parser.parse_args()
    unknown = sorted(set(arguments.rooms) - set(entries.ROOMS))
    if unknown:
        parser.error(f"unknown room {unknown[0]!r}; known: {', '.join(entries.ROOMS)}")
    arguments.rooms = arguments.rooms or list(entries.ROOMS)
    return arguments


def numbers_of(mutants):
    """A number each that does not depend on the others, so that a new entry leaves all other files as they were built."""
    numbers, taken = {}, set()
    for mutant in mutants:
        number = zlib.crc32(f"{mutant.room} {mutant.name}".encode()) % MAX_MUTANTS
        while number in taken:
            number = (number + 1) % MAX_MUTANTS
        taken.add(number)
        numbers[mutant] = number
    return numbers


def build(rooms, tree):
    folder = tree / "build/release"
    if not (folder / "build.ninja").exists():
        subprocess.run(["cmake", "--preset", "release", "-DRCME_BUILD_BENCHMARKS=OFF"], cwd=tree, check=True,
                       stdout=subprocess.DEVNULL)
    programs = {program for room in rooms for program in room_tests.programs_of(room)}
    if programs:
        subprocess.run(["ninja", "-C", str(folder), "-j2", "-k0", *sorted(programs)], check=True)
    return folder


def key_of(tests, folder):
    """Of the programs and files that the tests are in, and of the package that those of Python test."""
    digest = hashlib.sha256()
    package = folder.glob("python/rcme/*.so") if any(test.program.endswith(".py") for test in tests) else []
    for program in sorted({test.program for test in tests} | {str(path) for path in package}):
        digest.update(pathlib.Path(program).read_bytes())
    return digest.hexdigest()


def traced_tests(room, folder, tree, jobs):
    tests = room_tests.tests_of(room, folder, tree)
    path, key = tree.parent / f"trace_{room}.json", key_of(tests, folder)
    traced = reach.load(key, path)
    if traced is None:
        print(f"{room}: {len(tests)} tests without a mutant ...", flush=True)
        traced = reach.trace_tests(tests, tree, jobs)
        reach.save(traced, key, path)
    return traced


def judge_text(mutant, tests, tree):
    """Python is not woven: the text is changed for the time of the tests, of the package where it is built."""
    path = tree / ("build/release" if mutant.room == "python" else "") / mutant.file
    original = path.read_text()
    try:
        path.write_text(original[:mutant.begin] + mutant.now + original[mutant.end:])
        return judge.judge(mutant, 0, tests, tree)
    finally:
        path.write_text(original)


def judge_room(mutants, numbers, traced, tree, jobs):
    def judge_one(mutant):
        if mutant.equivalent:
            return judge.Verdict(mutant.room, mutant.file, mutant.name, "equivalent", mutant.equivalent)
        if mutant.file.endswith(".py"):
            return judge_text(mutant, [test for test in traced if mutant.file in test.reached], tree)
        number = numbers[mutant]
        return judge.judge(mutant, number, [test for test in traced if number in test.reached], tree)

    start, verdicts = time.monotonic(), []
    has_texts = any(mutant.file.endswith(".py") for mutant in mutants)
    with futures.ThreadPoolExecutor(1 if has_texts else jobs) as pool:
        for verdict in pool.map(judge_one, mutants):
            verdicts.append(verdict)
            left_s = (time.monotonic() - start) / len(verdicts) * (len(mutants) - len(verdicts))
            print(f"{verdict.room} {verdict.name}: {verdict.outcome} {verdict.by}  ({left_s:.0f} s left)", flush=True)
    return verdicts


def chosen(arguments, mutants, known):
    caught = {(v.room, v.name) for v in known if v.outcome == "caught"}
    return [m for m in mutants if (not arguments.only or m.name in arguments.only)
            and not (arguments.survivors and (m.room, m.name) in caught)]


def main():
    arguments = parse_arguments()
    every = entries.read_rooms()
    all_mutants = {room: every[room] for room in arguments.rooms}
    if arguments.check:
        print(", ".join(f"{room} {len(mutants)}" for room, mutants in all_mutants.items()) + ": all fit their sources")
        return 0
    numbers = numbers_of([mutant for mutants in every.values() for mutant in mutants])
    csv = entries.FOLDER / "results.csv"
    known = results.read_verdicts(csv)
    woven = {mutant: number for mutant, number in numbers.items() if mutant.room in arguments.rooms}
    tree = weave.write_tree(entries.SOURCE, entries.SOURCE / "build/mutants/tree", woven)
    folder = build(arguments.rooms, tree)
    verdicts = []
    for room, mutants in all_mutants.items():
        wanted = chosen(arguments, mutants, known)
        if wanted:
            verdicts += judge_room(wanted, numbers, traced_tests(room, folder, tree, arguments.jobs), tree,
                                   arguments.jobs)
    print("\n" + results.summary(verdicts, arguments.rooms))
    if not arguments.only:
        fresh = {(v.room, v.name): v for v in known} | {(v.room, v.name): v for v in verdicts}
        merged = [fresh[m.room, m.name] for m in numbers if (m.room, m.name) in fresh]
        results.write_verdicts(csv, merged)
        (entries.FOLDER / "RESULTS.md").write_text(HEADER + results.summary(merged, entries.ROOMS))
    return 0 if all(v.outcome in ("caught", "equivalent") for v in verdicts) else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (entries.EntryError, reach.BaselineError) as error:
        print(f"mutants: {error}", file=sys.stderr)
        sys.exit(2)
    except subprocess.CalledProcessError as error:
        print(f"mutants: {' '.join(map(str, error.cmd))} failed", file=sys.stderr)
        sys.exit(2)
