#!/usr/bin/python3
"""Runs of `rcme gate` with known truth: A/A runs, in which both versions are equal in law, and planted faults.

    gate_runs.py --program build/release/bin/rcme_gate_faults --out results/gate --equal 200 --planted 20

Every run has a seed of its own. An A/A run compares an estimator with itself under another name, or (fresh) with itself on samples of its
own, so that trials change sides by chance. Rows are appended to OUT/runs.csv and a run that is there already is not run again; the
counts with exact 95 % intervals go to OUT/summary.csv. Beside other work, give a longer --max-time and compare the processor's seconds with
the budget."""

import argparse
import csv
import json
import math
import pathlib
import resource
import subprocess
import tempfile
import time

VERDICTS = {0: "not worse", 1: "worse", 3: "undecided"}
# Name: the old and the new version, as the options of an estimator file.
SAMPLE = {"name": "standard", "solver": "five_point"}
RUNS = {
    "equal": ({"name": "rcme_calibrated"}, {"name": "rcme_calibrated"}),
    "equal_fresh_samples": ({"name": "standard"}, {"name": "planted", "of": "standard", "fault": "fresh_samples"}),
    "sign_flip_1_percent": ({"name": "rcme_calibrated"}, {"name": "planted", "fault": "sign_flip", "size": 0.01}),
    "covariance_0.8": ({"name": "rcme_calibrated"}, {"name": "planted", "fault": "covariance", "size": 0.8}),
    "probability_halved": ({"name": "rcme_calibrated"}, {"name": "planted", "fault": "probability", "size": 0.5}),
    "slower_10_percent": ({"name": "rcme_calibrated"}, {"name": "planted", "fault": "slower", "size": 0.1}),
    "refusal_2_percent": ({"name": "rcme_calibrated"}, {"name": "planted", "fault": "refusal", "size": 0.02}),
    "threshold": (SAMPLE, {**SAMPLE, "significance_level": 0.5}),
    "worse_solver": (SAMPLE, {**SAMPLE, "solver": "eight_point"}),
    "fewer_samples": ({"name": "rcme_calibrated"}, {"name": "rcme_calibrated", "max_samples": 16, "min_samples": 16}),
}
COLUMNS = ["run", "seed", "exit_code", "verdict", "worse", "trials_per_condition", "seconds", "cpu_seconds"]


def estimator_file(folder, label, settings):
    options = "".join(f"  {key}: {value}\n" for key, value in settings.items() if key != "name")
    path = folder / f"{label}.yaml"
    path.write_text(f"name: {settings['name']}\nlabel: {label}\n" + (f"options:\n{options}" if options else ""))
    return str(path)


def cpu_seconds_of_children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def run_gate(arguments, name, seed):
    old, new = RUNS[name]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        command = [arguments.program, "gate", arguments.study, "--old", estimator_file(folder, "before", old),
                   "--new", estimator_file(folder, "after", new), "--seed", str(seed), "--threads", str(arguments.threads),
                   "--max-time", arguments.max_time, "--out", str(folder / "out")]
        start, cpu_start = time.monotonic(), cpu_seconds_of_children()
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode not in VERDICTS:
            raise SystemExit(f"{' '.join(command)}: {done.stderr}")
        gate = json.loads((folder / "out/gate.json").read_text())
        worse = " ".join(test["quantity"] for test in gate["tests"] if test["verdict"] == "worse")
        return {"run": name, "seed": seed, "exit_code": done.returncode, "verdict": VERDICTS[done.returncode], "worse": worse,
                "trials_per_condition": gate["trials_per_condition"], "seconds": f"{time.monotonic() - start:.1f}",
                "cpu_seconds": f"{cpu_seconds_of_children() - cpu_start:.1f}"}


def binomial_tail(k, n, p):
    """P(X >= k)."""
    return sum(math.comb(n, i) * p**i * (1 - p) ** (n - i) for i in range(k, n + 1))


def exact_interval(k, n):
    """Clopper and Pearson's, 95 %, by bisection."""
    def solve(is_low):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if is_low(middle) else (low, middle)
        return low
    lower = 0.0 if k == 0 else solve(lambda p: binomial_tail(k, n, p) < 0.025)
    upper = 1.0 if k == n else solve(lambda p: 1 - binomial_tail(k + 1, n, p) > 0.025)
    return lower, upper


def summarize(rows, path):
    with open(path, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["run", "n", "worse", "lower", "upper", "not_worse", "undecided", "median_trials_per_condition", "median_seconds",
                      "median_cpu_seconds", "most_cpu_seconds"])
        for name in RUNS:
            some = [row for row in rows if row["run"] == name]
            if not some:
                continue
            n, worse = len(some), sum(row["verdict"] == "worse" for row in some)
            middle = lambda key: sorted(float(row[key]) for row in some)[n // 2]
            out.writerow([name, n, worse, *(f"{end:.4f}" for end in exact_interval(worse, n)),
                          sum(row["verdict"] == "not worse" for row in some), sum(row["verdict"] == "undecided" for row in some),
                          f"{middle('trials_per_condition'):.0f}", f"{middle('seconds'):.1f}", f"{middle('cpu_seconds'):.1f}",
                          f"{max(float(row['cpu_seconds']) for row in some):.1f}"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, help="rcme_gate_faults")
    parser.add_argument("--study", default="regression_gate")
    parser.add_argument("--out", required=True)
    parser.add_argument("--equal", type=int, default=200, help="A/A runs of each kind")
    parser.add_argument("--planted", type=int, default=20, help="runs of each planted fault")
    parser.add_argument("--only", help="names, separated by commas")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--max-time", default="5m")
    parser.add_argument("--minutes", type=float, default=1e9, help="begin no run after this time")
    arguments = parser.parse_args()
    out = pathlib.Path(arguments.out)
    out.mkdir(parents=True, exist_ok=True)
    path = out / "runs.csv"
    rows = list(csv.DictReader(open(path))) if path.exists() else []
    known = {(row["run"], int(row["seed"])) for row in rows}
    start = time.monotonic()
    names = arguments.only.split(",") if arguments.only else list(RUNS)
    number = {name: arguments.equal if name.startswith("equal") else arguments.planted for name in names}
    for k in range(max(number.values())):
        for name in names:
            seed = 1000 + k
            if k >= number[name] or (name, seed) in known or time.monotonic() - start > 60 * arguments.minutes:
                continue
            rows.append(run_gate(arguments, name, seed))
            with open(path, "w", newline="") as file:
                table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
                table.writeheader()
                table.writerows(rows)
            print(rows[-1], flush=True)
    summarize(rows, out / "summary.csv")


if __name__ == "__main__":
    main()
