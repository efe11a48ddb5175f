#!/usr/bin/python3
"""Runs the studies of studies/hard_conditions and writes OUT/hard_conditions.csv, the rows of all their summaries:

    hard_conditions.py OUT [--trials 60]

The program is that of build/release/bin, or of the folder that RCME_PROGRAMS names."""

import argparse
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
RCME = pathlib.Path(os.environ.get("RCME_PROGRAMS", ROOT / "build/release/bin")) / "rcme"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--trials", type=int, default=60)
    options = parser.parse_args()
    lines = []
    for study in sorted((ROOT / "studies/hard_conditions").glob("*.yaml")):
        run = options.out / f"{study.stem}.sqlite"
        subprocess.run([RCME, "run", study, "--trials", str(options.trials), "--out", run], check=True, capture_output=True)
        summary = subprocess.run([RCME, "summarize", run, "--format", "csv"], check=True, capture_output=True, text=True).stdout
        lines += summary.splitlines()[1 if lines else 0:]
    (options.out / "hard_conditions.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
