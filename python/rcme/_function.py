"""A function of Python as an estimator: what it is given, and what may come back. Whatever it does is an answer with a
status; nothing of it is an exception of the run."""

from __future__ import annotations

import difflib
import hashlib
import inspect
import math
import os
import traceback
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np

ANSWER = "(pose, info), a pose (R, t), or None"
MAX_MESSAGE = 500
KEYS = ("inliers", "pose_cov", "p_failure", "sigma", "inlier_probabilities", "status", "message")
# More of what `estimate_relative_pose` and PoseLib return with a pose; not read, so that a function can pass it on.
PASSED_ON = ("estimator", "num_inliers", "sigma_sd", "prior", "prior_p_value", "calibration_error_probability", "p_failure_domain", "p_failure_for_bounds",
             "draws", "protection_levels", "other_motions", "refinements", "iterations", "inlier_ratio", "model_score")


class Unreadable(Exception):
    """What came back is no answer; the message says what it is."""


class FunctionEstimator:
    """The function as the C++ half calls it: never raises, returns the fields of an answer. It remembers what the function
    raised, and which answers could not be read."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function
        self.num_calls = 0
        self.counts = {"library_error": 0, "unreadable_answer": 0}
        self.first: dict[str, str] = {}
        self.interrupt: BaseException | None = None  # of Ctrl-C, or of a signal handler that ends the program

    def __call__(self, x1: np.ndarray, x2: np.ndarray, camera1: dict[str, Any], camera2: dict[str, Any], sigma_px: float,
                 noise_scale: np.ndarray | None, seed: int) -> dict[str, Any]:
        num_matches = len(x1)
        self.num_calls += 1
        options = {"sigma_px": sigma_px, "seed": seed}
        if noise_scale is not None:
            options["noise_scale"] = noise_scale
        try:
            result = self.function(x1, x2, camera1, camera2, options)
        except BaseException as error:  # noqa: BLE001 (also SystemExit: the run is not the function's to end)
            if isinstance(error, KeyboardInterrupt):
                self.interrupt = error
            return self._note("library_error", _in_words(error) + _place_of(error, self.function))
        try:
            return fields_of(result, num_matches)
        except BaseException as error:  # noqa: BLE001 (an object of the user's own may raise anything)
            return self._note("unreadable_answer", _in_words(error))

    def raise_interrupt(self) -> None:
        """Of a call of its own, where nobody else watches for Ctrl-C."""
        if self.interrupt is not None:
            raise self.interrupt

    def warn(self, label: str) -> None:
        """A warning of each kind of thing that went wrong, with the words of the first."""
        kinds = {"library_error": "raised an exception", "unreadable_answer": "returned what is no answer"}
        for status, words in kinds.items():
            if self.counts[status]:
                warnings.warn(f"estimators[{label!r}] {words} in {self.counts[status]} of {self.num_calls} calls ({status}); "
                              f"first: {self.first[status]}", RuntimeWarning, stacklevel=4)

    def _note(self, status: str, message: str) -> dict[str, Any]:
        self.counts[status] += 1
        self.first.setdefault(status, message)
        return {"status": status, "message": message}


Functions = dict[str, tuple[FunctionEstimator, str]]


def named_function(name: str, function: Callable[..., Any]) -> tuple[FunctionEstimator, str]:
    """The function as an estimator, with the hash of its source; ValueError where it cannot take the arguments."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # some functions of C have none
        return FunctionEstimator(function), code_of(function)
    try:
        signature.bind(*(None,) * 5)
    except TypeError as error:
        raise ValueError(f"{name}: its parameters are {signature} ({error}); expected a function of (x1, x2, camera1, camera2, "
                         "options)") from None
    return FunctionEstimator(function), code_of(function)


def warn_of(functions: Functions) -> None:
    for label, (function, _) in functions.items():
        function.warn(label)


def code_of(function: Callable[..., Any]) -> str:
    """A hash of the function's source: a result file is not continued by a function that has changed. What the function
    calls, and values that it holds, are not seen."""
    inner = getattr(function, "func", function)
    name = getattr(inner, "__qualname__", type(inner).__qualname__)
    compiled = getattr(inner, "__code__", None)  # where there is no source, and of lambdas, which may share a line
    text = f"{name} {compiled.co_code!r} {compiled.co_consts!r} {compiled.co_names!r}" if compiled else name
    for candidate in (inner, type(inner)) if not compiled or "<lambda>" not in name else ():
        try:
            text = inspect.getsource(candidate)
            break
        except (TypeError, OSError):
            pass
    return hashlib.sha256(text.encode("utf-8", "replace")).hexdigest()[:16]


def fields_of(result: Any, num_matches: int) -> dict[str, Any]:
    """The fields of an answer; Unreadable where it is none."""
    pose, info = _split(result)
    _refuse_unknown("info", info, KEYS, PASSED_ON)
    status = info.get("status", "no_candidate" if pose is None else "ok")
    if not isinstance(status, str):
        raise Unreadable(f"info['status'] is a {type(status).__name__}; expected a text")
    fields: dict[str, Any] = {"status": status, "message": _encodable(str(info.get("message", "")))[:MAX_MESSAGE]}
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
            if not math.isfinite(fields[key]):  # NaN would count as not stated
                raise Unreadable(f"info[{key!r}] is {fields[key]}; expected a finite number, or None where it is not known")
    return fields


def _in_words(error: BaseException) -> str:
    try:
        text = str(error)
    except Exception:  # noqa: BLE001
        text = "(its message cannot be shown)"
    name = "" if isinstance(error, Unreadable) else type(error).__name__ + ": "
    return _encodable(name + text)[:MAX_MESSAGE]


def _encodable(text: str) -> str:
    return text.encode("utf-8", "replace").decode()


def _place_of(error: BaseException, function: Callable[..., Any]) -> str:
    """ in mine.py:12: the last line in the function's own file, or where there is none the last of all."""
    try:
        frames = traceback.extract_tb(error.__traceback__)[1:]  # the first is this module's
        code = getattr(inspect.unwrap(getattr(function, "func", function)), "__code__", None)
        frame = ([frame for frame in frames if code and frame.filename == code.co_filename] or frames)[-1]
    except Exception:  # noqa: BLE001 (no frames; attributes of the user's own)
        return ""
    return f" in {os.path.basename(frame.filename)}:{frame.lineno}"


def _refuse_unknown(what: str, given: Mapping[str, Any], allowed: tuple[str, ...], passed_on: Iterable[str] = ()) -> None:
    unknown = [key for key in given if key not in allowed and key not in passed_on]
    if unknown:
        near = difflib.get_close_matches(str(unknown[0]), allowed, 1)
        hint = f" (did you mean {near[0]!r}?)" if near else ""
        raise Unreadable(f"{what}[{str(unknown[0])[:40]!r}] is not known{hint}; expected keys among: {', '.join(allowed)}")


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
        _refuse_unknown("pose", pose, ("R", "t"))
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
                         "truth values (convert with .astype(bool)), or indices")
    if array.dtype in (np.bool_, np.uint8):
        if len(array) != num_matches:
            raise Unreadable(f"info['inliers'] is a mask of {len(array)}; expected one of {num_matches}")
        return np.flatnonzero(array).tolist()
    if (array < 0).any() or (array >= num_matches).any():
        raise Unreadable(f"info['inliers'] has indices outside 0 to {num_matches - 1}")
    if len(np.unique(array)) < len(array):
        if len(array) == num_matches and (array <= 1).all():
            raise Unreadable("info['inliers'] is a mask of integers, which would be read as indices; convert with .astype(bool)")
        raise Unreadable("info['inliers'] has an index twice; expected a mask (convert with .astype(bool)), or each index once")
    return array.tolist()
