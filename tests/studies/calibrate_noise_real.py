#!/usr/bin/python3
"""Real pairs with the noise file that `rcme calibrate-noise` learns from the other half of their scene, and without.

    calibrate_noise_real.py OUT FOLDER ... [--at-least 12]

FOLDER holds match files; they stay where they are, and OUT has links to them. The pairs of a scene, in the order of their names, are two
halves. Writes OUT/real.csv: a row per scene with the pairs of both halves, how many differences of halves of images and closures of loops
lie within their 95 % regions (`rcme validate`), and how many motions within theirs of the stated truth where its grade is A, without and
with the file. Scenes of fewer pairs than --at-least or of several cameras are left out. The program is that of build/release/bin, or of
the folder that RCME_PROGRAMS names."""

import argparse
import csv
import gzip
import json
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np
from scipy.stats import chi2

ROOT = pathlib.Path(__file__).resolve().parents[2]
RCME = pathlib.Path(os.environ.get("RCME_PROGRAMS", ROOT / "build/release/bin")) / "rcme"
REGION = chi2.ppf(0.95, 5)
SIGMA = 0.5  # px, assumed without a file
TESTS = {"spatial_halves": "halves", "closure": "loops"}


def run(*arguments):
    done = subprocess.run([RCME, *map(str, arguments)], capture_output=True, text=True, cwd=ROOT)
    if done.returncode != 0:
        raise SystemExit(f"rcme {' '.join(map(str, arguments))}: {done.stderr}")
    return done.stdout


def read_header(path):
    header = {}
    with gzip.open(path, "rt") as file:
        for line in file:
            if not line.startswith("#"):
                break
            key, _, value = line[1:].partition(":")
            header[key.strip()] = value.strip()
    return header


def group_scenes(folders):
    """{scene: [(file, header)]} in the order of the files' names."""
    scenes = {}
    for folder in folders:
        for path in sorted(folder.glob("*.csv.gz")):
            header = read_header(path)
            scenes.setdefault(header["scene"], []).append((path, header))
    return scenes


def count_cameras(pairs):
    """Intrinsics that differ by more than rounding."""
    stated = np.array([[float(x) for x in f"{header[f'size{i}']} {header[f'K{i}_fx_fy_cx_cy']}".split()]
                       for _, header in pairs for i in (1, 2)])
    return 1 if np.all(np.abs(stated - stated[0]) < 1e-4 * np.abs(stated[0]).max()) else len(np.unique(stated, axis=0))


def link_half(folder, pairs):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for path, _ in pairs:
        (folder / path.name).symlink_to(path.resolve())
    return folder


def check_half(half, pairs, out, *how):
    """{test: (number, number within)} of a folder's pairs."""
    run("validate", half, "--twins", 1, "--no-advice", "--no-figure", "--out", out, *how)
    counts = {}
    with open(out / "validation.csv", newline="") as file:
        for row in csv.DictReader(file):
            if row["test"] in TESTS:
                number = int(row["n"])
                counts[TESTS[row["test"]]] = np.array([number, round(float(row["coverage"] or 0) * number)])
    lines = run("estimate", half, "--format", "jsonl", "--threads", 1, *how).splitlines()
    answers = [json.loads(line) for (_, header), line in zip(pairs, lines, strict=True) if header.get("gt_grade") == "A"]
    nees = [answer["nees"] for answer in answers if answer.get("nees") is not None]
    counts["truths"] = np.array([len(nees), sum(value < REGION for value in nees)])
    return counts, read_sizes(lines)


def scene_row(name, pairs, out):
    middle = len(pairs) // 2
    halves = [pairs[:middle], pairs[middle:]]
    folders = [link_half(out / f"{name}_{i}", half) for i, half in enumerate(halves)]
    sums, ratios = {"before": {}, "after": {}}, []
    for i, (half, folder) in enumerate(zip(halves, folders)):
        noise = out / f"{name}_{1 - i}.yaml"  # of the other half
        run("calibrate-noise", folders[1 - i], "--out", noise)
        sizes = {}
        for when, how in (("before", ["--sigma", SIGMA]), ("after", ["--noise", noise])):
            counts, sizes[when] = check_half(folder, half, out / f"{name}_{i}_{when}", *how)
            for what, count in counts.items():
                sums[when][what] = sums[when].get(what, 0) + count
        ratios += [np.mean(np.log(after / before)) / 2 for before, after in zip(sizes["before"], sizes["after"])
                   if before is not None and after is not None]
    row = {"scene": name, "pairs": len(pairs)}
    for what in (*TESTS.values(), "truths"):
        row |= {f"{what}_{when}": counts[what] for when, counts in sums.items()}
    return row | {"width": f"{np.exp(np.mean(ratios)):.2f}"}


def read_sizes(lines):
    """The five eigenvalues of each motion's covariance; None without a motion."""
    covariances = [json.loads(line).get("pose_cov") for line in lines]
    return [None if each is None else np.linalg.eigvalsh(np.reshape(each, (6, 6)))[1:] for each in covariances]


def flatten(row):
    """Two counts as "within of number"."""
    return {key: f"{value[1]} of {value[0]}" if isinstance(value, np.ndarray) else value for key, value in row.items()}


def add_up(rows):
    counts = {key: sum(row[key] for row in rows) for key, value in rows[0].items() if isinstance(value, np.ndarray)}
    return {"scene": "all", "pairs": sum(row["pairs"] for row in rows), **counts, "width": "-"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("folders", type=pathlib.Path, nargs="+")
    parser.add_argument("--at-least", type=int, default=12, help="pairs of a scene")
    parser.add_argument("--scene", help="only this one")
    arguments = parser.parse_args()
    out = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    rows = []
    for name, pairs in sorted(group_scenes(arguments.folders).items()):
        if arguments.scene not in (None, name):
            continue
        if len(pairs) < arguments.at_least or count_cameras(pairs) > 1:
            print(f"{name}: left out: {len(pairs)} pairs of {count_cameras(pairs)} cameras", file=sys.stderr)
            continue
        rows.append(scene_row(name, pairs, out))
    rows.append(add_up(rows))
    with open(out / "real.csv", "w", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        table.writeheader()
        table.writerows(map(flatten, rows))


if __name__ == "__main__":
    main()
