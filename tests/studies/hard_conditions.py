#!/usr/bin/python3
"""Runs the studies of studies/hard_conditions and writes OUT/hard_conditions.csv, the rows of all their summaries:

    hard_conditions.py OUT [--trials 60] [--why]

--why also replays the failing trials of rcme_calibrated and counts what `rcme replay` says of them in
OUT/hard_conditions_why.csv: how many have no optimum near the true motion, and in how many the true motion, offered to the
estimator as a start, would have had a weight, with its median and how often it is above one half.

The program is that of build/release/bin, or of the folder that RCME_PROGRAMS names."""

import argparse
import csv
import io
import os
import pathlib
import re
import statistics
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
RCME = pathlib.Path(os.environ.get("RCME_PROGRAMS", ROOT / "build/release/bin")) / "rcme"


def run_rcme(*arguments):
    return subprocess.run([RCME, *arguments], check=True, capture_output=True, text=True).stdout


def explain(run):
    """A row: what the failing trials of rcme_calibrated in this run have in common."""
    rows = csv.DictReader(io.StringIO(run_rcme("summarize", run, "--raw", "csv")))
    failing = [row["trial"] for row in rows if row["estimator"] == "rcme_calibrated" and row["outcome"] == "failure"]
    weights, num_without = [], 0
    for trial in failing:
        said = run_rcme("replay", run, "--condition", "0", "--trial", trial).split("\nWhy\n")[1]
        of_ours = said[said.index("rcme_calibrated"):said.index("standard_five_point")]
        weights += map(float, re.findall(r"would have had probability ([0-9.e-]+)", of_ours))
        num_without += "no optimum within the bounds of the true motion" in of_ours
    return {"study": run.stem, "failed": len(failing), "no_optimum": num_without, "offered": len(weights),
            "median": f"{statistics.median(weights):.2g}" if weights else "-", "above_half": sum(w > 0.5 for w in weights)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--trials", type=int, default=60)
    parser.add_argument("--why", action="store_true")
    options = parser.parse_args()
    lines, reasons = [], []
    for study in sorted((ROOT / "studies/hard_conditions").glob("*.yaml")):
        run = options.out / f"{study.stem}.sqlite"
        run_rcme("run", study, "--trials", str(options.trials), "--out", run)
        lines += run_rcme("summarize", run, "--format", "csv").splitlines()[1 if lines else 0:]
        if options.why:
            reasons.append(explain(run))
    (options.out / "hard_conditions.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    if reasons:
        with open(options.out / "hard_conditions_why.csv", "w", encoding="utf-8", newline="") as file:
            table = csv.DictWriter(file, list(reasons[0]), lineterminator="\n")
            table.writeheader()
            table.writerows(reasons)


if __name__ == "__main__":
    main()
