"""The reader's own things that pages speak of: matches.csv.gz, a folder of pairs, left.png and right.png."""

import gzip
import pathlib
import shutil
import subprocess

import matplotlib.image
import numpy as np


def make_pairs(folder, program):
    problems = folder / "exported"
    subprocess.run([program, "export", "experiments/studies/indoor_like.yaml", "--trials", "1", "--set", "outlier_ratio=0.2",
                    "--out", problems], cwd=folder, check=True, capture_output=True)
    files = sorted((problems / "matches").glob("*.csv"))
    (folder / "pairs").mkdir()
    for file in files:
        shutil.copy(file, folder / "pairs" / file.name)
    (folder / "matches.csv.gz").write_bytes(gzip.compress(files[0].read_bytes()))


def make_images(folder):
    """Two views of a textured plane: blobs of many sizes, the second shifted and stretched a little."""
    rows, columns = np.mgrid[0:480, 0:640].astype(float)
    for name, stretch, shift in (("left", 1.0, 0.0), ("right", 1.03, 12.0)):
        rng = np.random.default_rng(1)
        image = np.zeros((480, 640))
        for _ in range(250):
            x, y, size, height = rng.uniform(0, 640), rng.uniform(0, 480), rng.uniform(3, 25), rng.normal()
            image += height * np.exp(-((columns - stretch * x - shift) ** 2 + (rows - stretch * y) ** 2) / (2 * size**2))
        matplotlib.image.imsave(folder / f"{name}.png", image, cmap="gray", vmin=-2, vmax=2)


def make_fixtures(folder, program):
    folder = pathlib.Path(folder)
    make_pairs(folder, program)
    make_images(folder)
