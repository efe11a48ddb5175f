#!/usr/bin/python3
"""What `rcme conform` promises and keeps: on fresh draws of a population, and where problems have changed.

    conform_runs.py OUT [--conditions 1024] [--calibrations 10] [--checks 20]

Writes OUT/regions.csv, OUT/accept.csv and OUT/probabilities.csv (each estimator of studies/conform.yaml, cross-validated
and on as many fresh draws), and OUT/shift.csv (checks of studies/conform_shift.yaml: each calibration has a seed of its own and is
checked on fresh problems of other seeds, unchanged and changed). The program is that of build/release/bin, or of the folder that RCME_PROGRAMS
names."""

import argparse
import csv
import json
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
RCME = pathlib.Path(os.environ.get("RCME_PROGRAMS", ROOT / "build/release/bin")) / "rcme"
ESTIMATORS = ["rcme_calibrated", "standard_five_point", "opencv_magsac"]
PROMISE = ["--level", "0.9", "--wrong-and-accepted", "0.05"]
FRESH_SEED = 32  # of the draws that no rule has seen
# Name: what is changed.
SHIFTS = {
    "none": [],
    "noise twice as large": ["sigma_px=1"],
    "another lens": ["distortion_k1=-0.05"],
    "a coarse front end": ["noise=octave", "octave_growth=1", "num_matches=100"],
    "a car": ["motion=vehicle", "scene=street"],
}


def run(arguments):
    """The report of a command; exit code 1 is a shift or a broken promise."""
    done = subprocess.run([RCME, "conform", *arguments, "--format", "json"], capture_output=True, text=True, cwd=ROOT)
    if done.returncode not in (0, 1):
        raise SystemExit(f"rcme conform {' '.join(arguments)}: {done.stderr}")
    return json.loads(done.stdout)


def flat(row):
    """Intervals as two cells."""
    cells = {}
    for key, value in row.items():
        if key.endswith("_interval"):
            name = key.removesuffix("_interval")
            cells[f"{name}_lower"], cells[f"{name}_upper"] = value
        else:
            cells[key] = value
    return cells


def write(path, rows):
    columns = []
    for row in rows:
        columns += [key for key in row if key not in columns]
    with open(path, "w", newline="") as file:
        table = csv.DictWriter(file, columns, lineterminator="\n")
        table.writeheader()
        for row in rows:
            table.writerow({key: f"{value:.3g}" if isinstance(value, float) else value for key, value in row.items()})


def without_problems(row):
    """Without the share of all problems: the files have those of the answers."""
    return {key: value for key, value in row.items() if not key.startswith("wrong_of_problems")}


def population_tables(out, conditions):
    tables = {"regions": [], "accept": [], "probabilities": []}
    study = "studies/conform.yaml"
    if conditions != 1024:
        text = (ROOT / study).read_text().replace("number: 1024", f"number: {conditions}").replace("../", f"{ROOT}/")
        study = str(out / "fewer.yaml")
        pathlib.Path(study).write_text(text)
    for estimator in ESTIMATORS:
        rule = out / f"{estimator}.conform.json"
        made = run([study, "--estimator", estimator, "--out", str(rule), *PROMISE])
        fresh = run([study, "--check", str(rule), "--seed", str(FRESH_SEED)])
        for draws, report in (("cross-validated", made), ("fresh", fresh)):
            for name, rows in tables.items():
                rows += [{"estimator": estimator, "draws": draws, "answers": report["answers"], **flat(without_problems(row))}
                         for row in report[name] if row.get("accepted") != "in use"]
    for name, rows in tables.items():
        write(out / f"{name}.csv", rows)


def binomial_interval(k, n):
    """Clopper and Pearson's, 95 %."""
    from scipy.stats import beta
    return (0.0 if k == 0 else beta.ppf(0.025, k, n - k + 1)), (1.0 if k == n else beta.ppf(0.975, k + 1, n - k))


def shift_table(out, calibrations, checks):
    found = {name: [] for name in SHIFTS}
    for calibration in range(calibrations):
        rule = out / f"shift_{calibration}.conform.json"
        run(["studies/conform_shift.yaml", "--seed", str(1 + calibration), "--out", str(rule)])
        for name, changes in SHIFTS.items():
            number = checks if name == "none" else max(1, checks // 5)
            for check in range(number):
                changed = [argument for change in changes for argument in ("--set", change)]
                seed = 10_000 * (1 + calibration) + check
                report = run(["studies/conform_shift.yaml", "--check", str(rule), "--seed", str(seed), "--trials", "200", *changed])
                found[name].append((report["shift"]["noticed_after"], report["regions"][-1]["coverage"]))
    rows = []
    for name, results in found.items():
        after = sorted(number for number, _ in results if number is not None)
        low, high = binomial_interval(len(after), len(results))
        rows.append({"change": name, "checks": len(results), "noticed": len(after) / len(results), "lower": low, "upper": high,
                     "median_answers": after[len(after) // 2] if after else None,
                     "coverage": sum(coverage for _, coverage in results) / len(results)})
    write(out / "shift.csv", rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--conditions", type=int, default=1024)
    parser.add_argument("--calibrations", type=int, default=10)
    parser.add_argument("--checks", type=int, default=20, help="of each calibration on unchanged problems; a fifth on each changed one")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    shift_table(arguments.out, arguments.calibrations, arguments.checks)
    population_tables(arguments.out, arguments.conditions)


if __name__ == "__main__":
    main()
