"""Pairs that were made in Python, as match files that studies run on."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Iterable, Mapping
from typing import Any, Union

import numpy as np

from rcme import _check, _rcme
from rcme._estimate import motion_prior


def write_pairs(folder: Union[str, "os.PathLike[str]"], pairs: Iterable[Mapping[str, Any]]) -> str:
    """Writes pairs as match files, for a study with the data {"scene": "match_files", "folder": folder}.

    This is how a scene, a noise law or wrong matches of yours, written in Python, run in a study: make each pair, or take one of
    `simulate` and change it.

    Parameters
    ----------
    folder : where to write 000000.csv, 000001.csv, ...; it is made, and must hold nothing
    pairs : dicts with the keys that `simulate` returns
        - x1, x2 (N, 2; px) and camera1, camera2 (dicts {model, width, height, params} with a model of COLMAP)
        - optional: truth, a dict of R (3, 3) and t (3), X2 = R X1 + t; sigma_px, the noise level that estimators assume (0.5); noise_scale
          (N), how noisy each match is beside the others; prior, as `estimate_relative_pose` takes it (of rotation_cov the diagonal);
          scene, a name: pairs of one scene are one condition of the study.
          Other keys are ignored.

    Returns
    -------
    str : the folder. Trial t of a condition is its pair number t, in the order in which they were given; the study's `trials`
    counts passes over all of them.

    Raises
    ------
    ValueError : a pair that is wrong, a folder that holds something.
    """
    path = pathlib.Path(_check.path("folder", folder, "a folder"))
    elements = _check.iterable("pairs", pairs, "dicts as of `simulate`")
    try:
        path.mkdir(parents=True, exist_ok=True)
        holds_something = any(path.iterdir())
    except OSError as error:
        raise ValueError(f"folder: {path} cannot be made: {error.strerror}; give a new folder") from None
    if holds_something:
        raise ValueError(f"folder: {path} holds something; give a new folder")
    for number, pair in enumerate(elements):
        _rcme.write_file(str(path / f"{number:06d}.csv"), _match_file(f"pairs[{number}]", pair))
    return str(path)


def _match_file(name: str, pair: Mapping[str, Any]) -> str:
    if not isinstance(pair, Mapping):
        raise ValueError(f"{name}: {_check.words(pair)} is not allowed; expected a dict with x1, x2, camera1 and camera2")
    missing = [key for key in ("x1", "x2", "camera1", "camera2") if key not in pair]
    if missing:
        raise ValueError(f"{name}: {missing[0]} is missing; expected x1, x2, camera1 and camera2")
    x1, x2 = (_check.points(f"{name}: {key}", pair[key]) for key in ("x1", "x2"))
    if len(x1) != len(x2):
        raise ValueError(f"{name}: x1 has {len(x1)} rows and x2 {len(x2)}; expected as many")
    lines = [f"# scene: {_check.plain(f'{name}: scene', pair.get('scene', 'python'))}"]
    for number in (1, 2):
        lines += _camera_lines(f"{name}: camera{number}", number, pair[f"camera{number}"])
    truth = {} if pair.get("truth") is None else pair["truth"]
    if not isinstance(truth, Mapping):
        raise ValueError(f"{name}: truth: {_check.words(truth)} is not allowed; expected a dict of R and t")
    if (truth.get("R") is None) != (truth.get("t") is None):
        raise ValueError(f"{name}: truth: R and t are not both there (the direction of a pure rotation is not known); expected both, "
                         "or no truth, which is not scored")
    if truth.get("R") is not None:
        R = _check.rotation(f"{name}: truth: R", _check.shaped(f"{name}: truth: R", truth["R"], (3, 3), "a rotation"))
        t = _check.direction(f"{name}: truth: t", _check.shaped(f"{name}: truth: t", truth["t"], (3,), "a translation"))
        lines += [f"# R_rowmajor: {_row(R.ravel(), ' ')}", f"# t_unit: {_row(t, ' ')}"]
    scales = _check.scales(f"{name}: noise_scale", pair.get("noise_scale"), len(x1))
    sigma = _check.number(f"{name}: sigma_px", 0.5 if pair.get("sigma_px") is None else pair["sigma_px"], 1e-9, 1000.0)
    # The file's level is that of the match of median noise; its column counts relative to that.
    lines.append(f"# sigma_px: {sigma * (float(np.median(scales)) if scales else 1.0)!r}")
    try:
        prior = motion_prior(pair.get("prior"))
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None
    if prior is not None:
        lines += _rcme.format_prior(prior).splitlines()
    lines.append("x1,y1,x2,y2" + (",sigma_px" if scales else ""))
    lines += [_row([*first, *second, *([scales[i]] if scales else [])], ",") for i, (first, second) in enumerate(zip(x1, x2))]
    return "\n".join(lines) + "\n"


def _camera_lines(name: str, number: int, camera: Mapping[str, Any]) -> list[str]:
    _check.camera(name, camera)
    if not isinstance(camera, Mapping):
        raise ValueError(f"{name}: expected a dict with model, width, height and params")
    size, params = f"{camera['width']} {camera['height']}", _row(camera["params"], " ")
    if camera["model"] == "PINHOLE":
        return [f"# size{number}: {size}", f"# K{number}_fx_fy_cx_cy: {params}"]
    return [f"# camera{number}: {camera['model']} {size} {params}"]


def _row(values: Iterable[float], between: str) -> str:
    """All digits."""
    return between.join(repr(float(value)) for value in values)
