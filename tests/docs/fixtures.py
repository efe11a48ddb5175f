"""The reader's own things that pages speak of: matches.csv.gz, a folder of pairs, left.png and right.png, data sets of images."""

import gzip
import pathlib
import re
import shutil
import sqlite3
import subprocess

import matplotlib.image
import numpy as np


def make_pairs(folder, program):
    problems = folder / "exported"
    subprocess.run([program, "export", "studies/indoor_like.yaml", "--trials", "1", "--set", "outlier_ratio=0.2",
                    "--out", problems], cwd=folder, check=True, capture_output=True)
    files = sorted((problems / "matches").glob("*.csv"))
    (folder / "pairs").mkdir()
    for file in files:
        shutil.copy(file, folder / "pairs" / file.name)
    (folder / "matches.csv.gz").write_bytes(gzip.compress(files[0].read_bytes()))


def make_pairs_of_one_camera(folder, program):
    """Eight trials of one condition."""
    problems = folder / "exported_of_one_camera"
    subprocess.run([program, "export", "studies/failure_vs_outliers.yaml", "--trials", "8", "--set", "outlier_ratio=0.1",
                    "--out", problems], cwd=folder, check=True, capture_output=True)
    (folder / "one_camera").symlink_to(problems / "matches")


SIZE, K, POINTS = (640, 480), (535.4, 539.2, 320.1, 247.6), 2500
CENTERS = [(0.0, 0.0, 0.0), (0.22, 0.01, 0.03), (0.44, -0.02, 0.06)]


def blobs_in(center):
    """Points between 3 and 8 m before a camera that does not turn, each with its size and height: x, y, size, height in px."""
    rng = np.random.default_rng(2)
    points = np.column_stack([rng.uniform(-4, 4, POINTS), rng.uniform(-3, 3, POINTS), rng.uniform(3, 8, POINTS)]) - center
    size, height = K[0] * rng.uniform(0.01, 0.04, POINTS) / points[:, 2], 2 * rng.normal(size=POINTS)
    x, y = (K[axis] * points[:, axis] / points[:, 2] + K[2 + axis] for axis in (0, 1))
    return np.column_stack([x, y, size, height])


def draw(path, blobs, most=3):
    """Blobs of these places, sizes and heights; `most`: the brightest value that the image tells from others."""
    image = np.zeros(SIZE[::-1])
    for x, y, size, height in blobs:
        left, top = max(int(x - 4 * size), 0), max(int(y - 4 * size), 0)
        right, bottom = min(int(x + 4 * size), SIZE[0]), min(int(y + 4 * size), SIZE[1])
        if left < right and top < bottom:
            rows, columns = np.mgrid[top:bottom, left:right].astype(float)
            image[top:bottom, left:right] += height * np.exp(-((columns - x) ** 2 + (rows - y) ** 2) / (2 * size**2))
    path.parent.mkdir(parents=True, exist_ok=True)
    matplotlib.image.imsave(path, image, cmap="gray", vmin=-most, vmax=most)


def make_images(folder):
    """Two views of a textured plane: blobs of many sizes, the second shifted and stretched a little."""
    rng = np.random.default_rng(1)
    blobs = np.array([[rng.uniform(0, 640), rng.uniform(0, 480), rng.uniform(3, 25), rng.normal()] for _ in range(250)])
    for name, stretch, shift in (("left", 1.0, 0.0), ("right", 1.03, 12.0)):
        draw(folder / f"{name}.png", blobs * [stretch, stretch, 1, 1] + [shift, 0, 0, 0], most=2)


def make_datasets(folder):
    """The same three images as KITTI, EuRoC and TUM have them, as a folder, and their points as a database of COLMAP
    and as matches of learned features."""
    images = [folder / f"corridor/{i}.png" for i in range(3)]
    for image, center in zip(images, CENTERS):
        draw(image, blobs_in(center))
    files = {
        "dataset/sequences/04/calib.txt": f"P0: {K[0]} 0 {K[2]} 0 0 {K[1]} {K[3]} 0 0 0 1 0\n",
        "dataset/sequences/04/times.txt": "0\n0.1\n0.2\n",
        "dataset/poses/04.txt": "".join(f"1 0 0 {x} 0 1 0 {y} 0 0 1 {z}\n" for x, y, z in CENTERS),
        "MH_01_easy/mav0/cam0/sensor.yaml":
            "T_BS:\n  cols: 4\n  rows: 4\n  data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\nresolution: [640, 480]\n"
            f"intrinsics: {list(K)}\ndistortion_model: radial-tangential\ndistortion_coefficients: [0, 0, 0, 0]\n",
        "MH_01_easy/mav0/cam0/data.csv": "".join(f"{i}00000000,{i}.png\n" for i in range(1, 4)),
        "MH_01_easy/mav0/state_groundtruth_estimate0/data.csv":
            "".join(f"{i}00000000,{x},{y},{z},1,0,0,0\n" for i, (x, y, z) in enumerate(CENTERS, 1)),
        "rgbd_dataset_freiburg3_office/rgb.txt": "".join(f"0.{i} rgb/{i}.png\n" for i in range(1, 4)),
        "rgbd_dataset_freiburg3_office/groundtruth.txt":
            "".join(f"0.{i} {x} {y} {z} 0 0 0 1\n" for i, (x, y, z) in enumerate(CENTERS, 1)),
    }
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    for to, name in (("dataset/sequences/04/image_0", "{:06}.png"), ("MH_01_easy/mav0/cam0/data", "{}.png"),
                     ("rgbd_dataset_freiburg3_office/rgb", "{}.png")):
        (folder / to).mkdir()
        for number, image in enumerate(images, 0 if "06" in name else 1):
            shutil.copy(image, folder / to / name.format(number))
    (folder / "project").mkdir()
    with sqlite3.connect(folder / "project/database.db") as database:
        database.executescript(
            "CREATE TABLE cameras (camera_id INTEGER PRIMARY KEY, model INTEGER, width INTEGER, height INTEGER, params BLOB);"
            "CREATE TABLE images (image_id INTEGER PRIMARY KEY, name TEXT, camera_id INTEGER);"
            "CREATE TABLE keypoints (image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB);"
            "CREATE TABLE matches (pair_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB);")
        database.execute("INSERT INTO cameras VALUES (1, 1, 640, 480, ?)", (np.array([K[0], K[1], K[2] + 0.5, K[3] + 0.5]).tobytes(),))
        for image in (1, 2, 3):
            points = (blobs_in(CENTERS[image - 1])[:, :2] + 0.5 + np.random.default_rng(image).normal(0, 0.3, (POINTS, 2))).astype(np.float32)
            database.execute("INSERT INTO images VALUES (?, ?, 1)", (image, f"{image}.png"))
            database.execute("INSERT INTO keypoints VALUES (?, ?, 2, ?)", (image, POINTS, points.tobytes()))
        same = np.column_stack([np.arange(POINTS)] * 2).astype(np.uint32).tobytes()
        for first, second in ((1, 2), (1, 3), (2, 3)):
            database.execute("INSERT INTO matches VALUES (?, ?, 2, ?)", (2147483647 * first + second, POINTS, same))
    make_learned_matches(folder / "superglue_output")


def make_learned_matches(folder):
    """The points of the first two images as SuperGlue's users write them: every tenth key point has no match."""
    folder.mkdir()
    points = [(blobs_in(center)[:, :2] + np.random.default_rng(image).normal(0, 0.3, (POINTS, 2))).astype(np.float32)
              for image, center in enumerate(CENTERS[:2])]
    matches = np.where(np.arange(POINTS) % 10 == 0, -1, np.arange(POINTS))
    np.savez(folder / "0_1_matches.npz", keypoints0=points[0], keypoints1=points[1], matches=matches,
             match_confidence=np.where(matches < 0, 0, 0.9).astype(np.float32))


def make_fixtures(folder, program, commands):
    """What these commands speak of; an image or a run of the program is not made for those that do not."""
    folder, text = pathlib.Path(folder), "\n".join(commands)
    if re.search(r"\bmatches\.csv\.gz\b|\bpairs\b", text):
        make_pairs(folder, program)
    if "one_camera" in text:
        make_pairs_of_one_camera(folder, program)
    if "left.png" in text:
        make_images(folder)
    if "rcme pairs" in text:
        make_datasets(folder)
