"""Motions from pairs of images: one, or many at a time."""

from __future__ import annotations

import difflib
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple, Optional

import numpy as np

from rcme import _check, _rcme
from rcme._function import Functions, named_function


MAX_PAIRS = 1_000_000
MAX_DRAWS = 1_000_000
OPTIONS_OF_CALLS = ("estimator", "estimator_file", "allow_process", "sigma_px", "noise_scale", "integrity_risk", "seed")


class Pose(NamedTuple):
    """A motion: X2 = R X1 + t."""

    R: np.ndarray  # 3 x 3
    t: np.ndarray  # 3, |t| = 1; NaN where the direction cannot be observed


class Poses(NamedTuple):
    """The motions of n pairs; row i of each is of pair i. NaN where there is no motion, or nothing is stated."""

    status: np.ndarray  # n texts: "ok", or why there is no motion
    R: np.ndarray  # n x 3 x 3
    t: np.ndarray  # n x 3
    pose_cov: np.ndarray  # n x 6 x 6, of [w, dt]
    p_failure: np.ndarray  # n
    p_failure_domain: np.ndarray  # n texts: "verified", "extrapolated", "not_stated"
    p_failure_for_bounds: np.ndarray  # n x number of `bounds`
    sigma: np.ndarray  # n, px
    sigma_sd: np.ndarray  # n, px
    num_inliers: np.ndarray  # n
    inliers: list  # n arrays of bool, one for each match


def estimate_relative_pose(x1: Any, x2: Any, camera1: Any, camera2: Any,
                           options: Optional[Mapping[str, Any]] = None,
                           bounds: Iterable[tuple[float, float]] = (),
                           prior: Optional[Mapping[str, Any]] = None,
                           estimators: Optional[Mapping[str, Callable[..., Any]]] = None, draws: int = 0) -> tuple[Optional[Pose], dict[str, Any]]:
    """Estimates the motion between two images, with its uncertainty.

    Parameters
    ----------
    x1, x2 : array (N, 2)
        Matches: row i of both is the same point, seen in image 1 and in image 2 (px).
    camera1, camera2 : dict {model, width, height, params}, or array (3, 3)
        A camera model of COLMAP with its params, sizes in px: PINHOLE (fx, fy, cx, cy), SIMPLE_PINHOLE (f, cx, cy), OPENCV (fx,
        fy, cx, cy, k1, k2, p1, p2), OPENCV_FISHEYE (fx, fy, cx, cy, k1, k2, k3, k4), SIMPLE_RADIAL, RADIAL, FULL_OPENCV,
        SIMPLE_RADIAL_FISHEYE, RADIAL_FISHEYE; or K of a pinhole, whose image is taken to have its principal point in its centre
        and to hold all points. Behind a lens, matches are undistorted and weighed by how much of their noise that magnifies; one
        with a point for which the lens has no ray within 84.3 deg of its axis is left out, and no inlier.
    options : dict
        estimator (its name; default rcme_calibrated) or estimator_file (a path); allow_process (bool; default False), whether
        the command of an estimator file may run (docs/threat_model.md); sigma_px, the standard deviation of the
        noise of a coordinate in each image (default 0.5); noise_scale, N positive numbers: how many times as great each match's
        noise is (OpenCV's and OpenGV's estimators ignore it; default: all alike); integrity_risk of the protection levels
        (1e-12 to 0.999; default 1e-3); seed of the random samples (default 1); and any option of the
        estimator: `rcme.estimators()` lists them.
    bounds : iterable of (rotation, direction)
        Angles in degrees, above 0 and up to 180: the probability of failure for each, from the same fit. Only rcme_calibrated.
    prior : dict
        What is known of the motion beside the matches; only rcme_calibrated uses it. Each measurement with its standard deviation:
        rotation (3, 3) with rotation_sd_deg (a number) or rotation_cov (3, 3; rad^2, the true one is Exp([w]x) rotation);
        gravity1 and gravity2 (3), its direction in both cameras, with gravity_sd_deg; direction (3), of t, with
        direction_sd_deg. Lengths of vectors do not matter.
    estimators : dict {name: function}
        Functions as `run` takes them, for the option estimator and for a file of `conform` that is of one of them. A file of a
        function whose source has changed since is refused.
    draws : int
        So many random motions (at most 1,000,000) of the distribution that the probabilities are computed from. Only
        rcme_calibrated.

    Returns
    -------
    pose : Pose or None
        R (3, 3) and t (3), X2 = R X1 + t; None where no motion is returned. For info["status"] "direction_not_observable" t
        is NaN.
    info : dict
        status ("ok", or why there is no motion), message (a sentence); estimator (its label);
        inliers (bool, N), num_inliers, inlier_probabilities (N, or None);
        pose_cov (6, 6) of [w, dt], or None: the true motion is Exp([w]x) R, t + dt, with w in rad and dt without unit (|t| = 1),
        both along the axes of camera 2; rank 5 (nothing along t);
        p_failure, the probability that the motion is wrong by more than the estimator's bounds (its options max_rotation_error_deg
        and max_direction_error_deg, 3 and 15 degrees unless given; None if it states none); p_failure_domain, "verified" or
        "extrapolated": whether the matches are like those that it was verified on ("not_stated"); p_failure_for_bounds, for each
        of `bounds` {rotation_deg, direction_deg, p_failure, domain} (empty where there is no motion); draws, {R (draws, 3, 3),
        t (draws, 3)}, NaN in the share that "none of these motions" has (None if none were asked for, or without a motion);
        protection_levels {risk, rotation, direction}: the angles (rad) that the error of R and that of t exceed with a probability
        of at most integrity_risk each, by p_failure and by the covariances with and without errors of the calibration (pi: every
        angle; None without a motion); sigma and sigma_sd (px), the noise level that it found (None likewise);
        calibration_error_probability, that the calibration has errors that no option states, which pose_cov counts (None from most
        estimators);
        prior, "used", "contradicted" (the matches speak against it: the answer is of these alone) or "none"; prior_p_value, the
        probability that a right prior is as far from the matches (None without one);
        other_motions: a list of further explanations {R, t, pose_cov, weight, explained_share}, the most likely first.

    Raises
    ------
    ValueError
        An argument of a wrong shape, type or value, an unknown estimator or option. Matches that determine no motion are no
        error: they are a status.
    """
    x1, x2, *cameras = _pair("", x1, x2, camera1, camera2)
    chosen = _options(options, len(x1))
    pairs = _bounds(bounds)
    num_draws = _check.whole("draws", draws, 0, MAX_DRAWS)
    known = motion_prior(prior)
    functions = _functions(estimators)
    try:
        answer = _rcme.estimate(x1, x2, *cameras, chosen["sigma_px"], chosen["noise_scale"], chosen["estimator"],
                                chosen["estimator_file"], chosen["options"], chosen["seed"], chosen["allow_process"], pairs, num_draws,
                                chosen["integrity_risk"], known, functions)
    except ValueError as error:
        raise ValueError(_in_words(error, chosen["options"])) from None
    for function, _ in functions.values():
        function.raise_interrupt()
    return _pose_and_info(answer, len(x1))


def estimate_relative_poses(pairs: Iterable[tuple[Any, ...]], options: Optional[Mapping[str, Any]] = None,
                            bounds: Iterable[tuple[float, float]] = (), threads: int = 0,
                            estimators: Optional[Mapping[str, Callable[..., Any]]] = None) -> Poses:
    """Estimates the motions of many pairs of images on several threads.

    Parameters
    ----------
    pairs : iterable of (x1, x2, camera1, camera2) or (x1, x2, camera1, camera2, noise_scale)
        Each as `estimate_relative_pose` takes them; noise_scale as its option.
    options, bounds, estimators
        As there, but for the options noise_scale and integrity_risk.
    threads : int
        0 (default): one per core. The result does not depend on it: each pair has the answer of a call of its own.

    Returns
    -------
    Poses
        Arrays with a row for each pair. `info` of `estimate_relative_pose` has more of a single one.

    Raises
    ------
    ValueError
        As there; the message begins with the pair's number: "pairs[3].x1".
    """
    given = list(_check.iterable("pairs", pairs, "tuples (x1, x2, camera1, camera2)"))
    if len(given) > MAX_PAIRS:
        raise ValueError(f"pairs: there are {len(given)}; expected at most {MAX_PAIRS}")
    problems = [_numbered_pair(place, pair) for place, pair in enumerate(given)]
    for key in ("noise_scale", "integrity_risk"):
        if isinstance(options, Mapping) and key in options:
            hint = "; give it as the fifth element of a pair" if key == "noise_scale" else ""
            raise ValueError(f"options: {key} is not allowed here{hint}")
    chosen = _options(options, 0)
    limits = _bounds(bounds)
    threads = _check.whole("threads", threads, 0, 1024)
    functions = _functions(estimators)
    try:
        answer = _rcme.estimate_many(problems, chosen["sigma_px"], chosen["estimator"], chosen["estimator_file"],
                                     chosen["options"], chosen["seed"], chosen["allow_process"], limits, threads,
                                     functions)
    except ValueError as error:
        raise ValueError(_in_words(error, chosen["options"])) from None
    inliers = [np.zeros(len(problem[0]), dtype=bool) for problem in problems]
    for mask, numbers in zip(inliers, answer["inliers"]):
        mask[numbers] = True
    return Poses(np.array(answer["status"], dtype=str), *(answer[key] for key in ("R", "t", "pose_cov", "p_failure")),
                 np.array(answer["p_failure_domain"], dtype=str),
                 *(answer[key] for key in ("p_failure_for_bounds", "sigma", "sigma_sd")),
                 np.array([mask.sum() for mask in inliers], dtype=int), inliers)


def estimators() -> dict[str, dict[str, Any]]:
    """The estimators there are: {name: {"doc": a sentence, "options": {name: {"default", "unit", "allowed", "doc"}}}}."""
    return {name: {"doc": doc, "options": {option: dict(zip(("default", "unit", "allowed", "doc"), parts))
                                           for option, parts in options.items()}}
            for name, doc, options in _rcme.estimators() if name != "python"}


def intrinsics(camera: Any) -> np.ndarray:
    """K (3, 3) = [[fx, 0, cx], [0, fy, cy], [0, 0, 1]] (px) of a camera as `estimate_relative_pose` takes it, such as a function
    of `run` is given. What a lens distorts is not in it. ValueError: no such camera."""
    _check.camera("camera", camera)
    if not isinstance(camera, Mapping):
        K = np.array(camera, dtype=np.float64)
        return K / K[2, 2]
    fx, fy, cx, cy = (float(camera["params"][place]) for place in _check.CAMERA_MODELS[camera["model"]][1])
    return np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])


def _in_words(error: ValueError, options: list[tuple[str, str]]) -> str:
    """What is wrong with the options; one that no estimator has may be misspelt of the call itself."""
    text = str(error)
    if text.startswith(("bounds: ", "draws: ")):
        return text
    near = [match for key, _ in options if key in text for match in difflib.get_close_matches(key, OPTIONS_OF_CALLS, 1, 0.7)]
    return f"options: {text}" + (f" (did you mean '{near[0]}'?)" if near else "")


def _functions(estimators: Any) -> Functions:
    expected = "a dict {name: function}"
    if estimators is None:
        return {}
    if not isinstance(estimators, Mapping):
        raise ValueError(f"estimators: {_check.words(estimators)} is not allowed; expected {expected}")
    functions: Functions = {}
    for name, function in estimators.items():
        place = f"estimators[{_check.plain('estimators: a name', name)!r}]"
        if not callable(function):
            raise ValueError(f"{place}: {_check.words(function)} is not allowed; expected {expected} (others are named by the "
                             "options estimator and estimator_file)")
        functions[name] = named_function(place, function)
    return functions


def _options(options: Optional[Mapping[str, Any]], num_matches: int) -> dict[str, Any]:
    """Those of the call apart from those of the estimator."""
    if options is None:
        options = {}
    if not isinstance(options, Mapping):
        raise ValueError(f"options: {_check.words(options)} is not allowed; expected a dict of names and values")
    rest = dict(options)
    name, file = rest.pop("estimator", None), rest.pop("estimator_file", None)
    if name is not None and file is not None:
        raise ValueError("options: estimator and estimator_file are both there; expected one of them")
    return {"sigma_px": _check.number("options['sigma_px']", rest.pop("sigma_px", 0.5), 1e-9, 1000.0),
            "noise_scale": _check.scales("options['noise_scale']", rest.pop("noise_scale", None), num_matches),
            "integrity_risk": _check.number("options['integrity_risk']", rest.pop("integrity_risk", 1e-3), 1e-12, 0.999),
            "seed": _check.whole("options['seed']", rest.pop("seed", 1), 0, 2**63 - 1),
            "estimator": _check.plain("options['estimator']", "rcme_calibrated" if name is None else name),
            "estimator_file": "" if file is None else _check.existing("options['estimator_file']", file, "an estimator file"),
            "allow_process": _check.yes_or_no("options['allow_process']", rest.pop("allow_process", False)),
            "options": _check.settings("options", rest)}


def _pair(place: str, x1: Any, x2: Any, camera1: Any, camera2: Any) -> tuple[Any, ...]:
    """The checked parts of a pair; `place` stands before their names in messages."""
    x1, x2 = _check.points(f"{place}x1", x1), _check.points(f"{place}x2", x2)
    if len(x1) != len(x2):
        raise ValueError(f"{place}x2: its shape is {x2.shape}; expected that of x1, {x1.shape}: row i of both is one match")
    cameras = [(f"{place}{name}", camera) for name, camera in (("camera1", camera1), ("camera2", camera2))]
    lenses = [_check.camera(name, camera) for name, camera in cameras]
    (moved1, near1), (moved2, near2) = _check.within_image(x1, camera1), _check.within_image(x2, camera2)
    if moved1 is x1 and moved2 is x2:
        for doubt in _rcme.camera_doubts(x1, x2, *lenses, [name for name, _ in cameras],
                                         [isinstance(camera, Mapping) for _, camera in cameras]):
            warnings.warn(doubt, stacklevel=3)
        return x1, x2, *lenses
    return moved1, moved2, _check.camera(cameras[0][0], near1), _check.camera(cameras[1][0], near2)


def _numbered_pair(place: int, pair: Any) -> tuple[Any, ...]:
    if not isinstance(pair, (tuple, list)) or len(pair) not in (4, 5):
        given = f"a {type(pair).__name__} of {len(pair)}" if isinstance(pair, (tuple, list)) else _check.words(pair)
        raise ValueError(f"pairs[{place}]: {given} is not allowed; expected (x1, x2, camera1, camera2), or noise_scale as a fifth")
    checked = _pair(f"pairs[{place}].", *pair[:4])
    return *checked, _check.scales(f"pairs[{place}].noise_scale", pair[4] if len(pair) == 5 else None, len(checked[0]))


def _bounds(bounds: Any) -> list[tuple[float, float]]:
    """Pairs of angles, checked one by one."""
    expected = "pairs of angles, [(1, 5), (3, 15)]"
    pairs = [tuple(_check.iterable("bounds", pair, expected)) for pair in _check.iterable("bounds", bounds, expected)]
    for place, pair in enumerate(pairs):
        if len(pair) != 2:
            raise ValueError(f"bounds[{place}]: {_check.words(pair)} is not allowed; expected two angles (rotation, direction)")
    return [(_check.number(f"bounds[{place}][0]", pair[0], 1e-6, 180.0), _check.number(f"bounds[{place}][1]", pair[1], 1e-6, 180.0))
            for place, pair in enumerate(pairs)]


def motion_prior(prior: Any) -> Optional[_rcme.MotionPrior]:
    """The measurements, checked; None where there are none."""
    if prior is None:
        return None
    if not isinstance(prior, Mapping):
        raise ValueError(f"prior: {_check.words(prior)} is not allowed; expected a dict of measurements")
    rest = dict(prior)

    def take(key: str, shape: tuple[int, ...]) -> np.ndarray:
        if rest.get(key) is None:
            raise ValueError(f"prior: {key} is missing; expected an array of shape {shape}")
        return _check.shaped(f"prior['{key}']", rest.pop(key), shape, key)

    def sd(key: str) -> float:
        if rest.get(key) is None:
            raise ValueError(f"prior: {key} is missing; expected the standard deviation in degrees, a number in [0.0001, 180]")
        return float(np.radians(_check.number(f"prior['{key}']", rest.pop(key), 1e-4, 180.0)))

    rotation: list[float] = []
    gravity: list[float] = []
    direction: list[float] = []
    if rest.keys() & {"rotation", "rotation_sd_deg", "rotation_cov"}:
        matrix = _check.rotation("prior['rotation']", take("rotation", (3, 3)))
        cov = take("rotation_cov", (3, 3)) if "rotation_cov" in rest else sd("rotation_sd_deg") ** 2 * np.eye(3)
        rotation = [*matrix.ravel().tolist(), *_check.covariance("prior['rotation_cov']", cov).ravel().tolist()]
    if rest.keys() & {"gravity1", "gravity2", "gravity_sd_deg"}:
        vectors = [_check.direction(f"prior['{key}']", take(key, (3,))) for key in ("gravity1", "gravity2")]
        gravity = [*vectors[0].tolist(), *vectors[1].tolist(), sd("gravity_sd_deg")]
    if rest.keys() & {"direction", "direction_sd_deg"}:
        direction = [*_check.direction("prior['direction']", take("direction", (3,))).tolist(), sd("direction_sd_deg")]
    if rest:
        raise ValueError(f"prior: {_check.words(next(iter(rest)))} is not allowed; expected rotation and rotation_sd_deg or "
                         "rotation_cov, gravity1, gravity2 and gravity_sd_deg, direction and direction_sd_deg")
    return _rcme.MotionPrior(rotation, gravity, direction) if rotation or gravity or direction else None


def _known(value: float) -> Optional[float]:
    return None if np.isnan(value) else value


def _pose_and_info(answer: dict[str, Any], num_matches: int) -> tuple[Optional[Pose], dict[str, Any]]:
    motion = answer.pop("motion")
    inliers = np.zeros(num_matches, dtype=bool)
    inliers[answer["inliers"]] = True
    probabilities = np.array(answer["inlier_probabilities"])
    info = {"status": answer["status"], "message": answer["message"], "estimator": answer["estimator"],
            "inliers": inliers, "num_inliers": int(inliers.sum()),
            "inlier_probabilities": probabilities if len(probabilities) else None,
            "pose_cov": motion["pose_cov"] if motion else None,
            **{key: _known(answer[key]) for key in ("p_failure", "sigma", "sigma_sd", "prior_p_value",
                                                    "calibration_error_probability")},
            "prior": answer["prior"],
            "p_failure_domain": answer["p_failure_domain"],
            "p_failure_for_bounds": answer["p_failure_for_bounds"],
            "draws": answer["draws"],
            "protection_levels": answer["protection_levels"],
            "other_motions": answer["other_motions"]}
    return Pose(motion["R"], motion["t"]) if motion else None, info
