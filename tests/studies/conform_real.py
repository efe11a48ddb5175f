#!/usr/bin/python3
"""What `rcme conform` promises and keeps on real pairs with known motion.

    conform_real.py OUT PAIRS [PAIRS ...]

Writes OUT/real_regions.csv and OUT/real_accept.csv: each estimator of studies/conform_real.yaml on the match files of all folders together,
cross-validated over pairs (a new pair is of the same scenes) and over scenes (a new pair is of another scene)."""

import argparse
import pathlib

import conform_runs

STUDY = "studies/conform_real.yaml"
ESTIMATORS = ["rcme_calibrated", "rcme_calibrated_robust", "standard_five_point", "standard_five_point_robust", "opencv_magsac"]
PROMISE = ["--level", "0.9", "--wrong-and-accepted", "0.05"]
# What a new problem is: the words of the table, and those of --new.
NEW = {"same scenes": "trial", "another scene": "condition"}


def collect(folders, into):
    """One folder with the match files of several."""
    into.mkdir(parents=True, exist_ok=True)
    for folder in folders:
        files = sorted(folder.glob("*.csv.gz"))
        if not files:
            raise SystemExit(f"{folder} holds no match files (*.csv.gz)")
        for file in files:
            (into / file.name).unlink(missing_ok=True)
            (into / file.name).symlink_to(file.resolve())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("pairs", type=pathlib.Path, nargs="+")
    arguments = parser.parse_args()
    pairs = arguments.out.resolve() / "pairs"
    collect(arguments.pairs, pairs)
    tables = {"regions": [], "accept": []}
    for estimator in ESTIMATORS:
        for words, new in NEW.items():
            rule = arguments.out / f"{estimator}.{new}.conform.json"
            report = conform_runs.run([STUDY, "--set", f"folder={pairs}", "--estimator", estimator, "--new", new, "--out", str(rule.resolve()), *PROMISE])
            for name, rows in tables.items():
                rows += [{"estimator": estimator, "new": words, "answers": report["answers"], **conform_runs.flat(conform_runs.without_problems(row))}
                         for row in report[name] if row.get("accepted") != "in use"]
    for name, rows in tables.items():
        conform_runs.write(arguments.out / f"real_{name}.csv", rows)


if __name__ == "__main__":
    main()
