#!/usr/bin/python3
"""What `rcme calibrate-noise` learns from ten pairs of a camera, on ten others of it: noise and faults that are planted.

    calibrate_noise_planted.py OUT [--cameras 30] [--alarms 120] [--only NAME]

Scenes, cameras, noise and faults are those of this script, not of the simulator. Writes OUT/planted.csv (a row per kind of noise: motions
within their 95 % regions without and with the noise file, how much wider regions are, cameras whose fault is found) and
OUT/false_alarms.csv (cameras of independent noise of which something is found). The program is that of build/release/bin, or of the folder
that RCME_PROGRAMS names."""

import argparse
import csv
import json
import os
import pathlib
import subprocess
import tempfile

import numpy as np
from scipy.stats import beta, chi2, t

ROOT = pathlib.Path(__file__).resolve().parents[2]
RCME = pathlib.Path(os.environ.get("RCME_PROGRAMS", ROOT / "build/release/bin")) / "rcme"
WIDTH, HEIGHT, FOCAL = 640, 480, 700.0  # px
CENTRE = np.array([319.5, 239.5])
SIGMA, MATCHES, WRONG, PAIRS = 0.2, 300, 15, 10  # px; of a pair; of a camera, to learn from and again to check
REGION = chi2.ppf(0.95, 5)
TILE = 80  # px


def rotation(w):
    """Exp([w]x), Rodrigues."""
    angle = np.linalg.norm(w)
    if angle == 0:
        return np.eye(3)
    x, y, z = w / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def rotation_vector(R):
    """Log of a small rotation."""
    w = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2
    sine = np.linalg.norm(w)
    return w if sine == 0 else w * np.arctan2(sine, (np.trace(R) - 1) / 2) / sine


def draw_direction(rng):
    x = rng.standard_normal(3)
    return x / np.linalg.norm(x)


# --- Errors of key points that one image has, (n, 2) px from x (n, 2) px; each of SIGMA^2 in all.

def independent(x, rng):
    return SIGMA * rng.standard_normal(x.shape)


def field(share, reach):
    """`share` of the variance is a field of correlation exp(-distance / reach), by the Cholesky factor of its covariance."""
    def errors(x, rng):
        distances = np.linalg.norm(x[:, None] - x[None], axis=2)
        factor = np.linalg.cholesky(np.exp(-distances / reach) + 1e-9 * np.eye(len(x)))
        return np.sqrt(share) * SIGMA * factor @ rng.standard_normal(x.shape) + np.sqrt(1 - share) * independent(x, rng)
    return errors


def tiles(share):
    """`share` of the variance is one displacement for each tile of the image."""
    def errors(x, rng):
        columns = -(-WIDTH // TILE)
        of_tiles = rng.standard_normal((columns * -(-HEIGHT // TILE), 2))
        column, row = np.clip((x + 0.5) // TILE, 0, [columns - 1, -(-HEIGHT // TILE) - 1]).astype(int).T
        return np.sqrt(share) * SIGMA * of_tiles[row * columns + column] + np.sqrt(1 - share) * independent(x, rng)
    return errors


# --- What a camera does to rays (n, 2), px. The match files state FOCAL and CENTRE.

def pinhole(rays, focal=FOCAL, centre=CENTRE, k1=0.0):
    return focal * (1 + k1 * np.sum(rays**2, axis=1, keepdims=True)) * rays + centre


# Name: errors of key points, what the camera is in truth, and what is found if it is found.
KINDS = {
    "nothing": (independent, {}, None),
    "field of 30 % reaching 30 px": (field(0.3, 30), {}, "displacement_px"),
    "field of 30 % reaching 80 px": (field(0.3, 80), {}, "displacement_px"),
    "field of 30 % reaching 150 px": (field(0.3, 150), {}, "displacement_px"),
    "field of 10 % reaching 1000 px": (field(0.1, 1000), {}, "displacement_px"),
    "tiles of 80 px with 30 %": (tiles(0.3), {}, "displacement_px"),
    "k1 of 0.01": (independent, {"k1": 0.01}, "distortion"),
    "focal length 1 % too long": (independent, {"focal": FOCAL / 1.01}, "focal_length"),
    "principal point 5 px off": (independent, {"centre": CENTRE - [5, 0]}, "principal_point_x"),
}


FAULTS = ("distortion", "focal_length", "principal_point_x")


def draw_motion(rng):
    """Camera 2 from camera 1: turned by up to 10 degrees about any axis, moved by 1 in any direction."""
    return rotation(draw_direction(rng) * np.radians(10) * rng.random()), draw_direction(rng)


def draw_pair(errors, camera, rng):
    """Key points of both images (n, 4) px and the motion. Points lie uniformly over image 1 at depths of 4 to 16 baselines."""
    R, t_unit = draw_motion(rng)
    number, right = MATCHES - WRONG, np.zeros((0, 2, 2))
    while len(right) < number:
        rays = (rng.random((number, 2)) * [WIDTH, HEIGHT] - 0.5 - CENTRE) / FOCAL
        points = np.column_stack([rays, np.ones(number)]) * rng.uniform(4, 16, (number, 1))
        moved = points @ R.T + t_unit
        moved[moved[:, 2] < 1e-3] = [1e9, 0, 1]  # behind camera 2
        images = np.stack([pinhole(rays, **camera), pinhole(moved[:, :2] / moved[:, 2:], **camera)], axis=1)
        seen = np.all((images > -0.5) & (images < [WIDTH - 0.5, HEIGHT - 0.5]), axis=(1, 2))
        right = np.concatenate([right, images[seen]])[:number]
    right = right + np.stack([errors(right[:, 0], rng), errors(right[:, 1], rng)], axis=1)
    wrong = rng.random((WRONG, 2, 2)) * [WIDTH, HEIGHT] - 0.5
    return np.concatenate([right, wrong]).reshape(-1, 4), R, t_unit


def write_pair(path, matches):
    K = f"{FOCAL:g} {FOCAL:g} {CENTRE[0]:g} {CENTRE[1]:g}"
    header = "".join(f"# size{i}: {WIDTH} {HEIGHT}\n# K{i}_fx_fy_cx_cy: {K}\n" for i in (1, 2)) + "x1,y1,x2,y2\n"
    path.write_text(header + "".join(",".join(f"{x:.6f}" for x in row) + "\n" for row in matches))


def draw_pairs(folder, kind, rng):
    """Match files of one camera, and their motions."""
    folder.mkdir(parents=True, exist_ok=True)
    errors, camera, _ = KINDS[kind]
    motions = []
    for i in range(PAIRS):
        matches, R, t_unit = draw_pair(errors, camera, rng)
        write_pair(folder / f"pair_{i:02}.csv", matches)
        motions.append((R, t_unit))
    return motions


def run(*arguments):
    done = subprocess.run([RCME, *map(str, arguments)], capture_output=True, text=True, cwd=ROOT)
    if done.returncode != 0:
        raise SystemExit(f"rcme {' '.join(map(str, arguments))}: {done.stderr}")
    return done.stdout


def calibrate(pairs, noise_file):
    """Verdicts on what is found, by quantity."""
    report = json.loads(run("calibrate-noise", pairs, "--sigma", SIGMA, "--out", noise_file, "--format", "json"))
    return {row["quantity"]: row["verdict"] for row in report["rows"]}


def compute_nees(answer, R, t_unit):
    """Squared error of a motion over its covariance, and the standard deviation of a direction, a geometric mean of all five."""
    covariance = np.reshape(answer["pose_cov"], (6, 6))
    values, vectors = np.linalg.eigh(covariance)
    values, vectors = values[1:], vectors[:, 1:]  # rank 5: nothing varies along the translation
    error = np.concatenate([rotation_vector(R @ np.reshape(answer["R"], (3, 3)).T), t_unit - np.array(answer["t"])])
    return float(np.sum((vectors.T @ error) ** 2 / values)), float(np.exp(np.mean(np.log(values)) / 2))


def check_answers(pairs, motions, *how):
    """(within its region, standard deviation) of every pair; None without a motion."""
    checked = []
    for line, (R, t_unit) in zip(run("estimate", pairs, "--format", "jsonl", "--threads", 1, *how).splitlines(), motions, strict=True):
        answer = json.loads(line)
        if answer.get("pose_cov") is None:
            checked.append(None)
            continue
        nees, deviation = compute_nees(answer, R, t_unit)
        checked.append((nees < REGION, deviation))
    return checked


def cluster_interval(shares, sizes):
    """Korn and Graubard (1998): that of Clopper and Pearson at the number of independent motions that cameras are worth, 95 %."""
    shares, sizes = np.array(shares), np.array(sizes)
    n, m, p = sizes.sum(), len(sizes), np.sum(shares * sizes) / sizes.sum()
    between = m / (m - 1) * np.sum((sizes * (shares - p) / n) ** 2) if m > 1 else 0.0
    effect = max(1.0, between / (p * (1 - p) / n)) if 0 < p < 1 else 1.0
    worth = n / effect * (t.ppf(0.975, n - 1) / t.ppf(0.975, max(1, m - 1))) ** 2
    k = p * worth
    return p, (0.0 if k <= 0 else beta.ppf(0.025, k, worth - k + 1)), (1.0 if k >= worth else beta.ppf(0.975, k + 1, worth - k))


def width_interval(logs):
    """Of the geometric mean over cameras, Student's, 95 %; logs are those of each camera's motions."""
    means = [np.mean(each) for each in logs]
    if len(means) == 1:
        return [float(np.exp(means[0])), 0.0, np.inf]
    half = t.ppf(0.975, len(means) - 1) * np.std(means, ddof=1) / np.sqrt(len(means))
    return [float(np.exp(np.mean(means) + sign * half)) for sign in (0, -1, 1)]


def binomial_interval(k, n):
    """Clopper and Pearson's, 95 %."""
    return (0.0 if k == 0 else beta.ppf(0.025, k, n - k + 1)), (1.0 if k == n else beta.ppf(0.975, k + 1, n - k))


def is_found(verdicts, quantity):
    """Its test says so at 5 %."""
    return verdicts.get(quantity, "").startswith(("found", "named"))


def is_removed(verdicts, quantity):
    return "is removed" in verdicts.get(quantity, "")


def list_alarms(verdicts):
    """What independent noise has nothing of."""
    return {"camera fault named": any(verdict.startswith("named") for verdict in verdicts.values()),
            "camera fault removed": any(is_removed(verdicts, quantity) for quantity in verdicts),
            "displacement field found": is_found(verdicts, "displacement_px"),
            "displacement of all images found": is_found(verdicts, "systematic_px")}


def planted_row(scratch, kind, number, cameras):
    quantity = KINDS[kind][2]
    found, removed, before, after, logs = 0, 0, [], [], []
    for camera in range(cameras):
        rng = np.random.default_rng([31, number, camera])
        folder = scratch / f"{number}_{camera}"
        draw_pairs(folder / "learnt", kind, rng)
        motions = draw_pairs(folder / "checked", kind, rng)
        verdicts = calibrate(folder / "learnt", folder / "noise.yaml")
        found += is_found(verdicts, quantity)
        removed += is_removed(verdicts, quantity)
        both = [pair for pair in zip(check_answers(folder / "checked", motions, "--sigma", SIGMA),
                                     check_answers(folder / "checked", motions, "--noise", folder / "noise.yaml")) if all(pair)]
        before.append([without[0] for without, _ in both])
        after.append([with_file[0] for _, with_file in both])
        logs.append([np.log(with_file[1] / without[1]) for without, with_file in both])
    row = {"planted": kind, "cameras": cameras, "motions": sum(map(len, after))}
    for name, within in (("before", before), ("after", after)):
        share, lower, upper = cluster_interval([np.mean(each) for each in within], [len(each) for each in within])
        row |= {name: f"{share:.3f}", f"{name}_lower": f"{lower:.3f}", f"{name}_upper": f"{upper:.3f}"}
    width, lower, upper = width_interval(logs)
    return row | {"width": f"{width:.2f}", "width_lower": f"{lower:.2f}", "width_upper": f"{upper:.2f}",
                  "found": "-" if quantity is None else found,
                  "removed": removed if quantity in FAULTS else "-"}


def alarm_rows(scratch, cameras):
    counts = {}
    for camera in range(cameras):
        folder = scratch / f"alarm_{camera}"
        draw_pairs(folder, "nothing", np.random.default_rng([32, camera]))
        for name, is_alarm in list_alarms(calibrate(folder, folder / "noise.yaml")).items():
            counts[name] = counts.get(name, 0) + is_alarm
    for name, alarms in counts.items():
        lower, upper = binomial_interval(alarms, cameras)
        yield {"finding": name, "cameras": cameras, "alarms": alarms, "share": f"{alarms / cameras:.3f}", "lower": f"{lower:.3f}",
               "upper": f"{upper:.3f}"}


def write(path, rows):
    with open(path, "w", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--cameras", type=int, default=30, help="of each kind of noise")
    parser.add_argument("--alarms", type=int, default=120, help="cameras of independent noise")
    parser.add_argument("--only", choices=list(KINDS), help="one kind of noise")
    arguments = parser.parse_args()
    out = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        kinds = [(number, kind) for number, kind in enumerate(KINDS) if arguments.only in (None, kind)]
        write(out / "planted.csv", [planted_row(scratch, kind, number, arguments.cameras) for number, kind in kinds])
        write(out / "false_alarms.csv", list(alarm_rows(scratch, arguments.alarms)))


if __name__ == "__main__":
    main()
