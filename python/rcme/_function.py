"""A function of Python as an estimator: what it is given, and what may come back. Whatever it does is an answer with a
status; nothing of it is an exception of the run."""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

ANSWER = "(pose, info), a pose (R, t), or None"
MAX_MESSAGE = 500


class Unreadable(Exception):
    """What came back is no answer; the message says what it is."""


def estimator_of(function: Callable[..., Any]) -> Callable[..., dict[str, Any]]:
    """The function as the C++ half calls it: never raises, returns the fields of an answer."""

    def call(x1: np.ndarray, x2: np.ndarray, camera1: dict[str, Any], camera2: dict[str, Any], sigma_px: float,
             noise_scale: np.ndarray | None, seed: int) -> dict[str, Any]:
        num_matches = len(x1)
        options = {"sigma_px": sigma_px, "seed": seed}
        if noise_scale is not None:
            options["noise_scale"] = noise_scale
        try:
            result = function(x1, x2, camera1, camera2, options)
        except BaseException as error:  # noqa: BLE001 (also SystemExit: the run is not the function's to end)
            return {"status": "library_error", "message": _in_words(error)}
        try:
            return fields_of(result, num_matches)
        except BaseException as error:  # noqa: BLE001 (an object of the user's own may raise anything)
            return {"status": "unreadable_answer", "message": _in_words(error)}

    return call


def code_of(function: Callable[..., Any]) -> str:
    """A hash of the function's source: a result file is not continued by a function that has changed. What the function
    calls, and values that it holds, are not seen."""
    inner = getattr(function, "func", function)
    for candidate in (inner, type(inner)):
        try:
            text = inspect.getsource(candidate)
            break
        except (TypeError, OSError):
            text = getattr(inner, "__qualname__", type(inner).__qualname__)
    return hashlib.sha256(text.encode("utf-8", "replace")).hexdigest()[:16]


def fields_of(result: Any, num_matches: int) -> dict[str, Any]:
    """The fields of an answer; Unreadable where it is none."""
    pose, info = _split(result)
    status = info.get("status", "no_candidate" if pose is None else "ok")
    if not isinstance(status, str):
        raise Unreadable(f"info['status'] is a {type(status).__name__}; expected a text")
    fields: dict[str, Any] = {"status": status, "message": str(info.get("message", ""))[:MAX_MESSAGE]}
    if pose is not None:
        fields["R"], fields["t"] = _motion(pose)
    elif status == "ok":
        raise Unreadable("info['status'] is 'ok', but there is no pose")
    if info.get("pose_cov") is not None:
        fields["pose_cov"] = _array("info['pose_cov']", info["pose_cov"], (6, 6))
    if info.get("inliers") is not None:
        fields["inliers"] = _indices(info["inliers"], num_matches)
    if info.get("inlier_probabilities") is not None:
        fields["inlier_probabilities"] = _array("info['inlier_probabilities']", info["inlier_probabilities"],
                                                (num_matches,))
    for key in ("p_failure", "sigma"):
        if info.get(key) is not None:
            fields[key] = float(_array(f"info[{key!r}]", info[key], ()))
    return fields


def _in_words(error: BaseException) -> str:
    try:
        text = str(error)
    except Exception:  # noqa: BLE001
        text = "(its message cannot be shown)"
    name = "" if isinstance(error, Unreadable) else type(error).__name__ + ": "
    return (name + text.encode("utf-8", "replace").decode())[:MAX_MESSAGE]


def _split(result: Any) -> tuple[Any, Mapping[str, Any]]:
    is_pair = isinstance(result, tuple) and len(result) == 2
    if not is_pair or not (result[1] is None or isinstance(result[1], Mapping)):
        return result, {}
    return result[0], result[1] or {}


def _motion(pose: Any) -> tuple[np.ndarray, np.ndarray]:
    """R and t of a pair, a dict, an object with these attributes (PoseLib's CameraPose), or a 3 x 4 matrix."""
    if isinstance(pose, Mapping):
        if "R" not in pose or "t" not in pose:
            raise Unreadable(f"the pose is a dict without R or t; expected {ANSWER}")
        R, t = pose["R"], pose["t"]
    elif hasattr(pose, "R") and hasattr(pose, "t"):
        R, t = pose.R, pose.t
    elif isinstance(pose, (tuple, list)) and len(pose) == 2:
        R, t = pose
    else:
        matrix = _array("the pose", pose, (3, 4))
        R, t = matrix[:, :3], matrix[:, 3]
    t = np.asarray(t)
    return _array("R", R, (3, 3)), _array("t", t.reshape(3) if t.shape in ((3, 1), (1, 3)) else t, (3,))


def _array(name: str, value: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Real numbers of that shape; NaN is for the judge of answers."""
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "fiub":
            raise TypeError
        array = np.array(array, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError):
        raise Unreadable(f"{name} is {type(value).__name__}, no array of numbers; expected shape {shape}; "
                         f"an estimator returns {ANSWER}") from None
    if array.shape != shape:
        raise Unreadable(f"{name} has shape {array.shape}; expected {shape}")
    return array


def _indices(inliers: Any, num_matches: int) -> list[int]:
    """Of a mask (bool, or uint8 as OpenCV has it; N or N x 1), or of indices."""
    array = np.asarray(inliers)
    if array.ndim == 2 and 1 in array.shape:
        array = array.reshape(-1)
    if array.size == 0 and array.ndim == 1:
        return []
    if array.ndim != 1 or array.dtype.kind not in "biu":
        raise Unreadable(f"info['inliers'] is of shape {array.shape} and type {array.dtype}; expected a mask of {num_matches} "
                         "truth values, or indices")
    if array.dtype in (np.bool_, np.uint8):
        if len(array) != num_matches:
            raise Unreadable(f"info['inliers'] is a mask of {len(array)}; expected one of {num_matches}")
        return np.flatnonzero(array).tolist()
    if (array < 0).any() or (array >= num_matches).any():
        raise Unreadable(f"info['inliers'] has indices outside 0 to {num_matches - 1}")
    return array.tolist()
