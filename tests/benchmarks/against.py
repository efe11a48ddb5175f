#!/usr/bin/python3
"""Two commits in one interleaved run: the time of every stage, call and workload of this tree over that of a commit.

The commit is built under build/against. Every round runs the benchmark programs of both, and both programs on each workload, in an order
of its own; what is compared is compared within a round, so that a load that lasts longer drops out. A ratio is the median over rounds with
the distribution-free interval of order statistics.

    scripts/benchmark --against COMMIT
"""

import argparse
import json
import math
import os
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
NEITHER_LONG = "-BM_Engine"  # what a study costs beside its estimators is among the workloads
LEAST_SECONDS = "0.02"  # of a case, per round
CONFIDENCE = 0.95
# Whole commands of `rcme`: name, arguments. {out} is a scratch folder of the program's own, kept from one workload to the next.
WORKLOADS = (
    ("run of five estimators", ["run", "failure_vs_parallax", "--trials", "20", "--out", "{out}/run.sqlite"]),
    ("summarize", ["summarize", "{out}/run.sqlite", "--format", "csv", "--out", "{out}/summary.csv"]),
    ("compare", ["compare", "{out}/run.sqlite", "--out", "{out}/compare.txt"]),
)


class AgainstError(Exception):
    """One sentence that names what is wrong, and what is allowed."""


def run_step(command, folder):
    """Runs a step of a build; its output is shown only if it fails."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        raise AgainstError(f"{' '.join(map(str, command))} failed:\n{(done.stdout + done.stderr)[-4000:]}")
    return done.stdout


def build_commit(commit, folder):
    """The folder of the programs of `commit`, built below `folder`; built before, it is taken as it is."""
    try:
        name = run_step(["git", "rev-parse", "--verify", "--quiet", f"{commit}^{{commit}}"], ROOT).strip()
    except AgainstError as error:
        raise AgainstError(f"--against {commit}: no commit of this repository; give a hash, a tag or a branch") from error
    tree = folder / name[:12]
    programs = tree / "build/release/bin"
    if not (tree / "built").exists():
        shutil.rmtree(tree, ignore_errors=True)
        tree.mkdir(parents=True)
        run_step(["bash", "-c", f"git archive {name} | tar -x -C '{tree}'"], ROOT)
        print(f"building {name[:12]} in {tree.relative_to(ROOT)}, which takes some minutes", file=sys.stderr)
        run_step(["cmake", "--preset", "release"], tree)
        run_step(["cmake", "--build", "build/release", "--target", "rcme_benchmark", "rcme"], tree)
        (tree / "built").touch()
    return programs


def measure_cases(programs):
    """Microseconds of CPU time of every case, by its name."""
    out = run_step([programs / "rcme_benchmark", f"--benchmark_filter={NEITHER_LONG}", f"--benchmark_min_time={LEAST_SECONDS}",
                    "--benchmark_format=json"], ROOT)
    per_microsecond = {"ns": 1e-3, "us": 1.0, "ms": 1e3, "s": 1e6}
    return {case["name"]: case["cpu_time"] * per_microsecond[case["time_unit"]] for case in json.loads(out)["benchmarks"]}


def measure_workload(programs, arguments, scratch, is_old):
    """(seconds of wall time, MB of memory at most) of a command of `rcme`; None where a program of before (`is_old`) does not know it."""
    command = [programs / "rcme", *(word.format(out=scratch) for word in arguments)]
    for word in command:
        if str(word).endswith("run.sqlite") and arguments[0] == "run":
            pathlib.Path(word).unlink(missing_ok=True)
    start = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL if is_old else None)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0 and not is_old:
        raise AgainstError(f"{' '.join(map(str, command))} ended with {child.returncode}")
    return (time.monotonic() - start, usage.ru_maxrss / 1024) if child.returncode == 0 else None


def measure_round(programs, scratch, with_workloads, is_old):
    """{name: value} of one program: microseconds of cases, seconds and MB of workloads."""
    values = {name: {"time": microseconds} for name, microseconds in measure_cases(programs).items()}
    for name, arguments in WORKLOADS if with_workloads else ():
        measured = measure_workload(programs, arguments, scratch, is_old)
        if measured:
            values[f"rcme {name}"] = {"time": 1e6 * measured[0], "memory": measured[1]}
    return values


def median_interval(values):
    """(lower, median, upper): order statistics that hold the median with the confidence; ends of the range where n is too small."""
    ordered, n = sorted(values), len(values)
    below, k = 0.0, 0
    while k < (n - 1) // 2:
        below += math.comb(n, k) / 2**n
        if 2 * below > 1 - CONFIDENCE:
            break
        k += 1
    k = max(k, 1)
    return ordered[k - 1], statistics.median(ordered), ordered[n - k]


def compare(rounds):
    """Rows {name, quantity, ratio, lower, upper, now, before}: a case's `time` in us, of this tree and of the commit; names that one side
    lacks have no ratio."""
    rows = []
    for name in dict.fromkeys(name for both in rounds for side in both for name in side):
        for quantity in ("time", "memory"):
            pairs = [(now[name][quantity], before[name][quantity]) for now, before in rounds
                     if quantity in now.get(name, {}) and quantity in before.get(name, {})]
            if len(pairs) == len(rounds):
                lower, ratio, upper = median_interval([now / before for now, before in pairs])
                now, before = (statistics.median(side) for side in zip(*pairs))
                rows.append({"name": name, "quantity": quantity, "ratio": ratio, "lower": lower, "upper": upper, "now": now, "before": before})
            elif quantity == "time":
                now, before = (sum(name in side for side in sides) for sides in zip(*rounds))
                rows.append({"name": name, "quantity": "only now" if before == 0 else "only before" if now == 0 else "failed at times"})
    return rows


def format_rows(rows, commit):
    """Lines of the table, the slower first."""
    yield f"{'case':<42} {'now / ' + commit:>14}   {'95 % interval':<16} {'before':>10} {'now':>10}"
    for row in sorted((row for row in rows if "ratio" in row), key=lambda row: -row["ratio"]):
        name = row["name"] if row["quantity"] == "time" else f"{row['name']}, MB"
        interval = f"[{row['lower']:.3f}, {row['upper']:.3f}]"
        yield f"{name:<42} {row['ratio']:14.3f}   {interval:<16} {row['before']:10.4g} {row['now']:10.4g}"
    for side in ("only now", "only before", "failed at times"):
        names = [row["name"] for row in rows if row["quantity"] == side]
        if names:
            yield f"{side}: {', '.join(names)}"


def main(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("commit", help="hash, tag or branch")
    parser.add_argument("--rounds", type=int, default=15, help="at least 6, for an interval of 95 %%; default 15")
    parser.add_argument("--no-workloads", action="store_true", help="stages and calls alone")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/release/bin", help="folder of this tree's programs")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/against.json")
    arguments = parser.parse_args(argv)
    try:
        if arguments.rounds < 6:
            raise AgainstError(f"--rounds {arguments.rounds}: at least 6, for an interval of 95 %")
        sides = arguments.programs, build_commit(arguments.commit, ROOT / "build/against")
        rounds, start = [], time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            scratches = [pathlib.Path(folder) / side for side in ("now", "before")]
            for scratch in scratches:
                scratch.mkdir()
            for number in range(arguments.rounds):
                measured = {}
                for side in random.Random(number).sample([0, 1], 2):
                    measured[side] = measure_round(sides[side], scratches[side], not arguments.no_workloads, side == 1)
                rounds.append((measured[0], measured[1]))
                left = (time.monotonic() - start) / (number + 1) * (arguments.rounds - number - 1)
                print(f"round {number + 1} of {arguments.rounds}, {left:.0f} s left", file=sys.stderr)
    except AgainstError as error:
        print(f"against: {error}", file=sys.stderr)
        return 2
    rows = compare(rounds)
    print("\n".join(format_rows(rows, arguments.commit)))
    print(f"{arguments.rounds} interleaved rounds; cases: us of CPU time; workloads: us of wall time, and the most memory in MB.")
    arguments.out.write_text(json.dumps({"against": arguments.commit, "rounds": arguments.rounds, "rows": rows}, indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
