"""Reads the JSON file of one trial, which `rcme show --json` writes. It checks and names; it computes nothing.

What it holds stands in experiments/statistics/trial_output.h. Lists over matches become arrays with a row per match; None is "not
known" or "not defined".
"""

import json
from dataclasses import dataclass

import numpy as np

from common.command_line import PlotError
from common.regular_file import read_bytes

FORMAT = "rcme trial 2"
KINDS = ("inlier", "outlier", "undetectable")
OUTCOMES = ("success", "failure", "refusal", "not_scored")


@dataclass(frozen=True)
class Estimate:
    label: str
    status: str
    message: str
    outcome: str
    rotation_error_deg: float
    direction_error_deg: float
    precision: float
    recall: float
    inliers: np.ndarray  # indices of matches
    F: np.ndarray
    centre2_m: np.ndarray  # camera 2's centre in camera 1's frame, at the true baseline's length


@dataclass(frozen=True)
class View:
    centre_m: np.ndarray
    edges: np.ndarray  # 4x3: rays of the image's left, right, upper and lower edge; all in camera 1's frame


@dataclass(frozen=True)
class Trial:
    facts: dict  # study, seed, condition, trial, factors, bounds, ... as in the file
    severity: dict
    sizes: list  # (width, height) of each image, px
    matches: np.ndarray  # nx4, px
    kinds: np.ndarray
    points_m: np.ndarray  # nx3, camera 1's frame
    views: list
    truth: dict
    F_true: np.ndarray
    selected: list
    drawn: list  # Estimates
    estimates: list

    @property
    def baseline_m(self):
        return self.truth["baseline_m"] if self.truth else None


def array(values, shape):
    return None if values is None else np.array(values, dtype=float).reshape(shape)


def read_estimate(value):
    if value["outcome"] not in OUTCOMES:
        raise ValueError(f"outcome '{value['outcome']}'; known: {', '.join(OUTCOMES)}")
    return Estimate(value["label"], value["status"], value["message"], value["outcome"], value["rotation_error_deg"],
                    value["direction_error_deg"], value["inlier_precision"], value["inlier_recall"],
                    np.array(value["inliers"], dtype=int), array(value["F"], (3, 3)),
                    array(value["centre2_in_cam1_m"], 3))


def read_kinds(names, count):
    if names is None:
        return None
    if len(names) != count or not set(names) <= set(KINDS):
        raise ValueError(f"kinds: one of {', '.join(KINDS)} is needed for each match")
    return np.array(names, dtype=str)


def trial_of(value):
    if value["format"] != FORMAT:
        raise ValueError(f"format '{value['format']}' is not '{FORMAT}'")
    matches = array(value["matches"], (-1, 4))
    estimates = [read_estimate(estimate) for estimate in value["estimators"]]
    views = value["views"] and [View(array(view["centre_in_cam1_m"], 3), array(view["edges_in_cam1"], (4, 3)))
                                for view in value["views"]]
    return Trial(value, value["severity"], [(camera["width"], camera["height"]) for camera in value["cameras"]], matches,
                 read_kinds(value["kinds"], len(matches)), array(value["points_in_cam1_m"], (len(matches), 3)), views,
                 value["truth"], array(value["truth"] and value["truth"]["F"], (3, 3)), value["selected"],
                 [estimates[number] for number in value["drawn"]], estimates)


def read_trial(path):
    """The Trial in the file `path`; a cut-off or foreign file is an error."""
    content = read_bytes(path)
    try:
        return trial_of(json.loads(content.decode()))
    except KeyError as error:
        raise PlotError(f"{path}: has no key {error}; expected what 'rcme show --json' writes.")
    except (ValueError, TypeError, IndexError, RecursionError) as error:
        raise PlotError(f"{path}: is not a whole file of 'rcme show --json' ({error}).")
