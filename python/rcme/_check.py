"""What the arguments of all calls must be: a ValueError names the argument, what it was and what is expected."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from rcme import _rcme

MAX_COORDINATE_PX = 1e6
MAX_MATCHES = 1_000_000
MAX_NOISE_SCALE = 1e6
# COLMAP's models: how many parameters each has, with the places of fx, fy, cx and cy among them.
ONE_FOCAL_LENGTH, TWO_FOCAL_LENGTHS = (0, 0, 1, 2), (0, 1, 2, 3)
CAMERA_MODELS = {"PINHOLE": (4, TWO_FOCAL_LENGTHS), "SIMPLE_PINHOLE": (3, ONE_FOCAL_LENGTH), "SIMPLE_RADIAL": (4, ONE_FOCAL_LENGTH),
                 "RADIAL": (5, ONE_FOCAL_LENGTH), "OPENCV": (8, TWO_FOCAL_LENGTHS), "FULL_OPENCV": (12, TWO_FOCAL_LENGTHS),
                 "OPENCV_FISHEYE": (8, TWO_FOCAL_LENGTHS), "SIMPLE_RADIAL_FISHEYE": (4, ONE_FOCAL_LENGTH),
                 "RADIAL_FISHEYE": (5, ONE_FOCAL_LENGTH)}


def words(value: Any) -> str:
    """A value in a message: short, whatever it is."""
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape} and type {value.dtype}"
    try:
        text = repr(value)
    except Exception:  # noqa: BLE001 (a repr of the user's own)
        text = f"an object of type {type(value).__name__}"
    return text if len(text) <= 80 else f"{text[:77]}..."


def numbers(name: str, value: Any, expected: str) -> np.ndarray:
    """An array of real numbers, of any shape."""
    if np.ma.is_masked(value):
        raise ValueError(f"{name}: some of its numbers are masked; leave these rows out")
    try:
        if value is None:  # which NumPy takes for NaN
            raise TypeError
        array = np.asarray(value)
        if array.dtype.kind not in "fiub" and not (array.dtype.kind == "O" and array.size > 0):
            raise TypeError
        if array.dtype.kind == "O" and any(isinstance(each, (str, bytes)) for each in array.flat):
            raise TypeError
        return np.array(array, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name}: {words(value)} is not allowed; expected {expected}") from None


def shaped(name: str, value: Any, shape: tuple[int, ...], what: str) -> np.ndarray:
    """A finite array of that shape."""
    expected = f"{what}, an array of shape {shape}"
    array = numbers(name, value, expected)
    if array.shape != shape:
        raise ValueError(f"{name}: its shape is {array.shape}; expected {expected}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name}: holds a number that is not finite; expected {expected}")
    return array


def rotation(name: str, matrix: np.ndarray) -> np.ndarray:
    if not np.linalg.norm(matrix @ matrix.T - np.eye(3)) < 1e-4 or np.linalg.det(matrix) < 0:
        raise ValueError(f"{name}: {matrix.tolist()} is not a rotation matrix")
    return matrix


def covariance(name: str, matrix: np.ndarray) -> np.ndarray:
    """Symmetric, with standard deviations in [1e-6, 1e6]. Of a ratio above 3e6 rounding leaves nothing of the least."""
    is_symmetric = np.allclose(matrix, matrix.T, rtol=0.0, atol=1e-10 * np.abs(matrix).max())
    least, greatest = np.linalg.eigvalsh(matrix)[[0, -1]]
    if not is_symmetric or not 1e-12 <= least <= greatest <= 1e12 or not least >= 1e-13 * greatest:
        raise ValueError(f"{name}: {matrix.tolist()} is not allowed; expected a symmetric matrix with standard deviations in "
                         "[1e-6, 1e6], the greatest at most 3e6 times the least")
    return matrix


def direction(name: str, vector: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vector)
    if not 1e-9 < length < 1e9:
        raise ValueError(f"{name}: its length is {length:g}; expected one in (1e-9, 1e9)")
    return vector / length


def points(name: str, value: Any) -> np.ndarray:
    """N x 2 finite pixel coordinates."""
    expected = "an N x 2 array of pixel coordinates"
    array = numbers(name, value, expected)
    if array.ndim != 2 or array.shape[1] != 2:
        hint = "; convert with .reshape(-1, 2)" if array.ndim == 3 and array.shape[2] == 2 and 1 in array.shape[:2] else ""
        raise ValueError(f"{name}: its shape is {array.shape}; expected {expected}{hint}")
    if len(array) > MAX_MATCHES:
        raise ValueError(f"{name}: its shape is {array.shape}; expected {expected}, N at most {MAX_MATCHES}")
    with np.errstate(invalid="ignore"):
        bad = np.flatnonzero(~(np.abs(array) <= MAX_COORDINATE_PX).all(axis=1))
    if len(bad):
        raise ValueError(f"{name}: row {bad[0]} is {array[bad[0]].tolist()}, of shape {array.shape}; expected {expected}, "
                         f"each a finite number in [-{MAX_COORDINATE_PX:g}, {MAX_COORDINATE_PX:g}]")
    return array


def scales(name: str, value: Any, count: int) -> list[float]:
    """One positive number per match, or none at all."""
    if value is None:
        return []
    array = shaped(name, value, (count,), "a number for each match")
    if not ((array >= 1.0 / MAX_NOISE_SCALE) & (array <= MAX_NOISE_SCALE)).all():
        raise ValueError(f"{name}: holds {array.min():g} to {array.max():g}; expected numbers in "
                         f"[{1.0 / MAX_NOISE_SCALE:g}, {MAX_NOISE_SCALE:g}]")
    return array.tolist()


def whole(name: str, value: Any, least: int, most: int) -> int:
    is_whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not is_whole or not least <= value <= most:
        raise ValueError(f"{name}: {words(value)} is not allowed; expected a whole number in [{least}, {most}]")
    return int(value)


def number(name: str, value: Any, least: float, most: float) -> float:
    is_number = isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)
    if not is_number or not least <= value <= most:
        raise ValueError(f"{name}: {words(value)} is not allowed; expected a number in [{least:g}, {most:g}]")
    return float(value)


def yes_or_no(name: str, value: Any) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name}: {words(value)} is not allowed; expected True or False")
    return bool(value)


def plain(name: str, value: Any) -> str:
    """Text for tables: one line, at most 200 bytes."""
    is_plain = isinstance(value, str) and value.isprintable() and 0 < len(value.encode("utf-8", "replace")) <= 200
    if not is_plain or value != value.strip():
        raise ValueError(f"{name}: {words(value)} is not allowed; expected a text of one line, at most 200 bytes, without blanks "
                         "at its ends")
    return value


def label(name: str, value: Any) -> str:
    """Text that lists of labels, separated by commas, can hold."""
    if "," in plain(name, value):
        raise ValueError(f"{name}: {words(value)} is not allowed; expected a text without a comma")
    return value


def iterable(name: str, value: Any, expected: str) -> Iterator[Any]:
    """Its elements; what it raises while they are made is its own."""
    try:
        return iter(value)
    except TypeError:
        raise ValueError(f"{name}: {words(value)} is not allowed; expected {expected}") from None


def one_of(name: str, value: Any, allowed: Sequence[str]) -> str:
    if not isinstance(value, str) or value not in allowed:
        raise ValueError(f"{name}: {words(value)} is not allowed; expected one of: {', '.join(allowed)}")
    return value


def path(name: str, value: Any, what: str) -> str:
    if not isinstance(value, (str, os.PathLike)) or not os.fspath(value) or "\0" in str(os.fspath(value)):
        raise ValueError(f"{name}: {words(value)} is not allowed; expected the path of {what}")
    text = os.fspath(value)
    return text if isinstance(text, str) else os.fsdecode(text)


def existing(name: str, value: Any, what: str) -> str:
    text = path(name, value, what)
    if not os.path.isfile(text):
        raise ValueError(f"{name}: {words(text)} is no file, seen from {os.getcwd()}; expected the path of {what}")
    return text


def existing_or_shared(name: str, value: Any, what: str) -> str:
    """The path of a file, or the name of one that comes with the program ("paper_table"), which the program looks up."""
    if isinstance(value, str) and re.fullmatch(r"\w+(/\w+)*", value) and not os.path.isfile(value):
        return plain(name, value)
    return existing(name, value, what)


def texts(name: str, value: Any, what: str) -> list[str]:
    """A text or several."""
    given = [value] if isinstance(value, str) else value
    if isinstance(given, (bytes, Mapping)) or not isinstance(given, Sequence) or not given:
        raise ValueError(f"{name}: {words(value)} is not allowed; expected {what}, or a list of such")
    return [plain(name, text) for text in given]


def setting(name: str, value: Any) -> str:
    """A value as study files have it."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)) and math.isfinite(value):
        return repr(float(value))
    if isinstance(value, str) and value.isprintable() and value:
        return value
    raise ValueError(f"{name}: {words(value)} is not allowed; expected a finite number, a truth value or a text of one line")


def settings(name: str, value: Any) -> list[tuple[str, str]]:
    """A dict of settings as (key, text)."""
    if value is None:
        return []
    if not isinstance(value, Mapping):
        raise ValueError(f"{name}: {words(value)} is not allowed; expected a dict of names and values")
    return [(plain(f"{name}: a key", key), setting(f"{name}[{key!r}]", item)) for key, item in value.items()]


def camera(name: str, value: Any) -> _rcme.Camera:
    """A dict {model, width, height, params}, or K (3 x 3)."""
    if isinstance(value, Mapping):
        return _camera_of_dict(name, value)
    expected = ("a dict {'model': 'PINHOLE', 'width': w, 'height': h, 'params': [fx, fy, cx, cy]} or K, an array of "
                "shape (3, 3)")
    array = numbers(name, value, expected)
    if array.shape != (3, 3):
        raise ValueError(f"{name}: its shape is {array.shape}; expected {expected}")
    K = array / array[2, 2] if array[2, 2] != 0 else array
    is_pinhole = np.isfinite(K).all() and (K[[0, 1, 2, 2], [1, 0, 0, 1]] == 0).all() and K[2, 2] == 1
    if not is_pinhole:
        raise ValueError(f"{name}: {array.tolist()} is not allowed; expected K = [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], "
                         "without skew")
    width, height = (_size_about(c) for c in (K[0, 2], K[1, 2]))
    return _camera_of_model(name, "PINHOLE", np.array([K[0, 0], K[1, 1], K[0, 2], K[1, 2]]), width, height)


def _size_about(centre: float) -> int:
    """The width or height of an image of unknown size whose principal point is in its centre."""
    return max(1, min(1_000_000, round(2 * centre + 1)))


def within_image(points: np.ndarray, camera: Any) -> tuple[np.ndarray, Any]:
    """Points and camera as given, but for K where more than a tenth of the points are outside of the image that it stands for,
    such as pixels that count from the principal point: then both with the origin in the corner of an image that holds all points
    about its centre."""
    if isinstance(camera, Mapping) or len(points) == 0:
        return points, camera
    K = np.array(camera, dtype=np.float64)
    centre = K[:2, 2] / K[2, 2]
    size = np.array([_size_about(c) for c in centre])
    is_outside = ((points < -0.5) | (points > size - 0.5)).any(axis=1)
    if is_outside.mean() <= 0.1:
        return points, camera
    moved = np.clip(np.abs(points - centre).max(axis=0), 0.0, 499_999.0)
    K[:2, 2] += K[2, 2] * (moved - centre)
    return points + (moved - centre), K


CAMERA_KEYS = ("model", "width", "height", "params")


def _camera_of_dict(name: str, value: Mapping[str, Any]) -> _rcme.Camera:
    unknown = [key for key in value if key not in (*CAMERA_KEYS, "camera_id", "id")]
    if unknown:
        raise ValueError(f"{name}: key {words(unknown[0])} is not allowed; expected {', '.join(CAMERA_KEYS)}")
    missing = [key for key in CAMERA_KEYS if key not in value]
    if missing:
        raise ValueError(f"{name}: a dict without {', '.join(map(repr, missing))}; expected model, width, height and params")
    model = value["model"]
    if not isinstance(model, str) or model not in CAMERA_MODELS:
        raise ValueError(f"{name}: model {words(model)} is not allowed; expected one of: {', '.join(CAMERA_MODELS)} "
                         "(undistort the points of others first)")
    params = shaped(f"{name}: params", value["params"], (CAMERA_MODELS[model][0],), f"the parameters of {model}")
    width, height = (whole(f"{name}: {key}", value[key], 1, 1_000_000) for key in ("width", "height"))
    return _camera_of_model(name, model, params, width, height)


def _camera_of_model(name: str, model: str, params: np.ndarray, width: int, height: int) -> _rcme.Camera:
    k = [params[place] for place in CAMERA_MODELS[model][1]]
    if not (k[0] > 0 and k[1] > 0 and max(map(abs, k)) <= 1e9 and min(k[:2]) >= 1e-9):
        raise ValueError(f"{name}: fx = {k[0]:g}, fy = {k[1]:g}, cx = {k[2]:g}, cy = {k[3]:g} are not allowed; expected "
                         "focal lengths > 0 px, and none beyond 1e9 px")
    return _rcme.Camera(model, params.tolist(), width, height)


