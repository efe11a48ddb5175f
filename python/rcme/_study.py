"""Studies: their conditions, single trials, whole runs with functions of Python among the estimators, tuning."""

from __future__ import annotations

import atexit
import contextlib
import itertools
import json
import os
import shutil
import tempfile
import threading
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Optional, Union

import numpy as np
import pandas

from rcme import _check, _rcme
from rcme._function import Functions, named_function, warn_of

Study = Union[str, "os.PathLike[str]", Mapping[str, Any]]
Estimator = Union[Callable[..., Any], Mapping[str, Any], str, "os.PathLike[str]"]

_one_at_a_time = threading.Lock()
_run_numbers = itertools.count()
_own_folder: Optional[str] = None  # of runs without `out`; gone with the interpreter
_folder_owner = 0  # the process that made it
_making_folder = threading.Lock()


def conditions(study: Study, *, overrides: Optional[Mapping[str, Any]] = None) -> pandas.DataFrame:
    """The conditions of a study, a row each: its number, its level of each factor (text), and its trials.

    `study` is the path of a study file (YAML), the name of one that comes with the program ("paper_table"), or a dict with
    the same keys; `overrides` as for `run`. ValueError: no such file, or a study that is wrong (the message names the key
    and what is allowed).
    """
    return pandas.DataFrame(_rcme.conditions(source_of(study, overrides)))


def simulate(study: Study, condition: int = 0, trial: int = 0, *, overrides: Optional[Mapping[str, Any]] = None,
             seed: Optional[int] = None) -> dict[str, Any]:
    """The matches of one trial and their truth: what the estimators of a run get, number for number.

    Parameters
    ----------
    study : path of a study file (YAML), or a dict with the same keys
    condition, trial : int
        From 0; `conditions(study)` numbers the conditions. Any trial number is allowed: a trial is a pure function of (seed,
        condition, trial).
    overrides, seed : as for `run`

    Returns
    -------
    dict with x1, x2 (N, 2; px), camera1, camera2 (dicts as `estimate_relative_pose` takes them), sigma_px (what estimators
    assume), noise_scale (N, how noisy each match is said to be beside the others; None: nothing is said), prior (as
    `estimate_relative_pose` takes it; None: no sensor measures the motion), levels (of the
    factors, as text), severity (how hard the problem is, by name), origin, weight, condition, trial,
    and truth: R (3, 3), t (3; None where nobody knows it), inliers (bool, N; None for real pairs) and undetectable (bool, N:
    wrong matches on their true epipolar line; None where there are none known).

    Raises
    ------
    ValueError : an argument that is wrong, or a study that is.
    """
    index = _check.whole("condition", condition, 0, 2**32 - 1)
    number = _check.whole("trial", trial, 0, 2**32 - 2)
    return _rcme.simulate(source_of(study, overrides, seed=seed), index, number)


def run(study: Study, estimators: Optional[Mapping[str, Estimator]] = None, *, out: Optional[str] = None,
        trials: Optional[int] = None, threads: int = 0, seed: Optional[int] = None,
        overrides: Optional[Mapping[str, Any]] = None, allow_process: bool = False) -> str:
    """Runs a study and keeps every trial in a result file; estimators of yours run on the same trials as the study's own.

    Parameters
    ----------
    study : path of a study file (YAML), the name of one that comes with the program ("paper_table"), or a dict with the
        same keys
    estimators : dict {label: estimator}, added to those of the study. An estimator is
        - a function (x1, x2, camera1, camera2, options) -> (pose, info), as `estimate_relative_pose` itself: x1, x2 (N, 2;
          px), cameras as dicts, options {"sigma_px": float, "seed": int}, and "noise_scale" (N, 1 in
          the median) where the data state how noisy each match is. The truth is not among them. It returns a pose ((R,
          t), a dict, an object with R and t, or a 3 x 4 matrix; t of any length) alone or with a dict: pose_cov (6, 6) of
          [w, dt], inliers (mask or indices), p_failure, sigma, inlier_probabilities, status, message, each of which may be
          left out; or None where it finds no motion. Without pose_cov it is given the first-order covariance of its inliers;
          without inliers, those are the matches that agree with its motion. Nothing that it does ends the run: an exception
          is the status library_error, an answer of a wrong type or shape or with an unknown key unreadable_answer, a matrix that
          is no rotation invalid_motion; the summary counts them, and a RuntimeWarning at the end says what the first one was. It
          should depend on its arguments alone: the seed is the trial's.
        - a dict {"name": ..., "options": {...}} of a registered estimator, or the path of an estimator file.
    out : path of the result file; a run that was cut off is resumed, a file of another study (or of a function whose source
        has changed) is refused. Default: a file that is gone when the interpreter ends.
    trials, seed : int, in place of the study's own
    threads : int; 0: one per core. The results do not depend on it. Functions of Python take turns (the interpreter has one
        lock, which the rest of a trial does not need): more threads speed up what is not Python.
    overrides : dict of settings as `rcme run --set` takes them: a data key, a failure bound, an option of all estimators that
        have it ("mu") or of one ("rcme.mu")
    allow_process : bool; whether the commands that the study or an estimator file names (estimators `process`) may run. Whoever
        wrote the file wrote the command: without permission such a file is refused (docs/threat_model.md)

    Returns
    -------
    str : the path of the result file, for `summarize`, `compare` and `reliability`.

    Raises
    ------
    ValueError : an argument, a study or a result file that is wrong, a function that cannot take the five arguments.
    KeyboardInterrupt: Ctrl-C; the trials so far are kept.
    RuntimeError: another run or audit of this process has not ended.
    """
    source = source_of(study, overrides, seed=seed, trials=trials, allow_process=allow_process)
    functions = add_estimators(source, estimators)
    num_threads = _check.whole("threads", threads, 0, 1024)
    path = _own_path() if out is None else _check.path("out", out, "a result file")
    with alone("run"):
        _rcme.run(source, functions, num_threads, path)
    warn_of(functions)
    return path


def replay(run: str, condition: int, trial: int, estimators: Optional[Mapping[str, Callable[..., Any]]] = None, *,
           allow_process: bool = False) -> pandas.DataFrame:
    """Runs one trial of a result file again, as `rcme replay` does, your functions too.

    Parameters
    ----------
    run : path of a result file
    condition, trial : int, from 0
    estimators : dict {label: function}; the functions of the run, with the same source as then
    allow_process : as for `run`

    Returns
    -------
    DataFrame with a row per estimator: estimator (its label), outcome, message (why it refused), status, the numbers of the
    file's table trials, R (3, 3) and t (3) of its answer (of a refusal: identity and (1, 0, 0)), and same: whether the record in the file is equal but for the time
    (None: the trial is not in the file).

    Raises
    ------
    ValueError : no such file or condition, a function that is not given or has changed.
    """
    path = _check.existing("run", run, "a result file")
    numbers = (_check.whole("condition", condition, 0, 2**32 - 1), _check.whole("trial", trial, 0, 2**32 - 2))
    functions: Functions = {}
    for label, function in (estimators or {}).items():
        if not callable(function):
            raise ValueError(f"estimators[{label!r}]: {_check.words(function)} is not allowed; expected a function of the run")
        functions[label] = named_function(f"estimators[{label!r}]", function)
    with alone("replay"):
        rows = _rcme.replay(path, *numbers, functions, _check.yes_or_no("allow_process", allow_process))
    return pandas.DataFrame(rows)


def tune(study: Study, *, out: Optional[str] = None, threads: int = 0, seed: Optional[int] = None,
         overrides: Optional[Mapping[str, Any]] = None, allow_process: bool = False) -> dict[str, Any]:
    """Finds options that meet the target of the study's block `tune`, with a guarantee, as `rcme tune` does.

    Returns a dict: `tuned` (levels, rates with intervals on fresh trials; None where no setting is certified), `why` (then the
    reason), `settings` (every setting with its rates) and what else `rcme tune` writes (docs/output_formats.md). `out`: where
    to write the estimator file of the tuned one, for `run(..., estimators={"tuned": out})` with another seed. Other arguments
    and errors as for `run`.
    """
    source = source_of(study, overrides, seed=seed, allow_process=allow_process)
    num_threads = _check.whole("threads", threads, 0, 1024)
    path = None if out is None else _check.path("out", out, "an estimator file to write")
    with alone("tune"):
        answer = _rcme.tune(source, num_threads)
    if path is not None and answer["file"]:
        _rcme.write_file(path, answer["file"])
    return {**json.loads(answer["json"]), "why": answer["why"] or None}


def conform(study: Study, *, estimator: Optional[str] = None, out: Optional[str] = None, check: Optional[str] = None,
            estimators: Optional[Mapping[str, Estimator]] = None, level: float = 0.95, wrong_and_accepted: float = 0.02,
            risk: float = 0.05, new: str = "usual", models: Optional[str] = None, trials: Optional[int] = None, threads: int = 0,
            seed: Optional[int] = None, overrides: Optional[Mapping[str, Any]] = None, allow_process: bool = False) -> dict[str, Any]:
    """Makes an estimator keep its word by the problems of a study, as `rcme conform` does (docs/conform.md).

    `estimator`: a label of the study or of `estimators`, which are those of `run`, functions too. `out`: the file to write; it is the
    estimator `conform` with the option `file`, for `estimate_relative_pose` and `run`, which are given the same `estimators` where
    it is of a function. `check`: a file of before, to be tested on the study's
    problems instead. `level`, `wrong_and_accepted`, `risk`, `new` ("usual", "trial", "condition") and `models` as the command's options.
    Returns its report as a dict: `regions`, `accept`, `probabilities`, `promises`, of a check `shift`. Other arguments and errors as
    for `run`.
    """
    if (out is None) == (check is None):
        raise ValueError("out, check: expected one of them, the file to write or the file to test")
    if (estimator is None) == (check is None):
        raise ValueError("estimator: expected with `out`, and not with `check`, whose file names it")
    if new not in ("usual", "trial", "condition"):
        raise ValueError(f"new: {_check.words(new)} is not allowed; expected 'usual', 'trial' or 'condition'")
    source = source_of(study, overrides, seed=seed, trials=trials, allow_process=allow_process)
    functions = add_estimators(source, estimators)
    numbers = (_check.number("level", level, 0.51, 0.999), _check.number("wrong_and_accepted", wrong_and_accepted, 1e-4, 0.5),
               _check.number("risk", risk, 1e-4, 0.5))
    path = None if out is None else _check.path("out", out, "a file to write")
    files = ["" if file is None else _check.existing(name, file, "a file of rcme.conform") for name, file in (("models", models), ("check", check))]
    label = "" if estimator is None else _check.plain("estimator", estimator)
    num_threads = _check.whole("threads", threads, 0, 1024)
    with alone("conform"):
        answer = _rcme.conform(source, functions, label, *numbers, new, *files, num_threads)
    warn_of(functions)
    if path is not None:
        _rcme.write_file(path, answer["file"])
    return json.loads(answer["json"])


def source_of(study: Optional[Study], overrides: Optional[Mapping[str, Any]] = None, *, seed: Optional[int] = None,
              trials: Optional[int] = None, allow_process: bool = False) -> _rcme.StudySource:
    """The study as the C++ half takes it; without a study, of `audit`, an empty one."""
    path, text = "", ""
    if isinstance(study, Mapping):
        text = _text_of(study)
    elif study is not None:
        path = _check.existing_or_shared("study", study, "a study file (YAML), or a dict with the same keys")
    return _rcme.StudySource(path, text, _check.settings("overrides", overrides),
                             -1 if seed is None else _check.whole("seed", seed, 0, 2**63 - 1),
                             0 if trials is None else _check.whole("trials", trials, 1, 2_000_000_000),
                             _check.yes_or_no("allow_process", allow_process))


def add_estimators(source: _rcme.StudySource,
                   estimators: Optional[Mapping[str, Estimator]]) -> Functions:
    """Those with a name or a file go into the source; returns the functions, each with the hash of its source."""
    functions: Functions = {}
    if estimators is None:
        return functions
    expected = "a dict {label: function, dict {name, options}, or path of an estimator file}"
    if not isinstance(estimators, Mapping):
        raise ValueError(f"estimators: {_check.words(estimators)} is not allowed; expected {expected}")
    for label, estimator in estimators.items():
        label = _check.label("estimators: a label", label)
        name = f"estimators[{label!r}]"
        if isinstance(estimator, Mapping):
            _add_by_name(source, name, label, estimator)
        elif isinstance(estimator, (str, os.PathLike)):
            source.add_estimator_file(label, _check.existing_or_shared(name, estimator, "an estimator file"))
        elif callable(estimator):
            functions[label] = named_function(name, estimator)
        else:
            raise ValueError(f"{name}: {_check.words(estimator)} is not allowed; expected {expected}")
    return functions


@contextlib.contextmanager
def alone(call: str) -> Iterator[None]:
    """Signals and functions are the process's own: one run at a time. A second one, such as of an estimator that begins a run
    itself, would wait for ever."""
    if not _one_at_a_time.acquire(blocking=False):
        raise RuntimeError(f"rcme.{call}: another run, tuning or audit of this process has not ended")
    try:
        yield
    finally:
        _one_at_a_time.release()


def _add_by_name(source: _rcme.StudySource, name: str, label: str, estimator: Mapping[str, Any]) -> None:
    unknown = [key for key in estimator if key not in ("name", "options")]
    if "name" not in estimator or unknown:
        raise ValueError(f"{name}: {_check.words(dict(estimator))} is not allowed; expected {{'name': ..., 'options': {{...}}}}")
    try:
        source.add_estimator(label, _check.plain(f"{name}['name']", estimator["name"]),
                             _check.settings(f"{name}['options']", estimator.get("options")))
    except ValueError as error:
        raise ValueError(str(error) if str(error).startswith(name) else f"{name}: {error}") from None


def _own_path() -> str:
    """Of a process that has been forked a folder of its own: the first that ends removes its folder."""
    global _own_folder, _folder_owner
    with _making_folder:
        if _own_folder is None or _folder_owner != os.getpid() or not os.path.isdir(_own_folder):
            _own_folder, _folder_owner = tempfile.mkdtemp(prefix="rcme-runs-"), os.getpid()
            atexit.register(_remove_own, _own_folder, _folder_owner)
        return os.path.join(_own_folder, f"run{next(_run_numbers)}.sqlite")


def _remove_own(folder: str, owner: int) -> None:
    if os.getpid() == owner:
        shutil.rmtree(folder, ignore_errors=True)


def _text_of(study: Mapping[str, Any]) -> str:
    """JSON is YAML."""
    def plain(value: Any) -> Any:
        if isinstance(value, np.generic):
            return value.item()
        if isinstance(value, np.ndarray):
            return value.tolist()
        raise ValueError(f"study: {_check.words(value)} is not allowed; expected numbers, texts, lists and dicts")
    try:
        return json.dumps(dict(study), default=plain, allow_nan=False, ensure_ascii=False)
    except (TypeError, ValueError, RecursionError) as error:
        text = str(error)
        raise ValueError(text if text.startswith("study") else f"study: {text}; expected the keys of a study file") from None
