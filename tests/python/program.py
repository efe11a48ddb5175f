"""The program `rcme` of this build, and files for it."""

import os
import tempfile

PROGRAM = os.environ.get("RCME", "rcme")


def write_matches(trial):
    """The matches of a trial as a match file; every number as it is."""
    handle, path = tempfile.mkstemp(suffix=".csv")
    with os.fdopen(handle, "w") as file:
        for number in (1, 2):
            camera = trial[f"camera{number}"]
            file.write(f"# size{number}: {camera['width']} {camera['height']}\n")
            file.write(f"# K{number}_fx_fy_cx_cy: {' '.join(map(repr, camera['params']))}\n")
        for row1, row2 in zip(trial["x1"].tolist(), trial["x2"].tolist()):
            file.write(",".join(map(repr, row1 + row2)) + "\n")
    return path
