"""What a run says, as data frames."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

import pandas

from rcme import _check, _rcme
from rcme._function import warn_of
from rcme._study import Estimator, Study, add_estimators, alone, source_of

_MARKED = re.compile("^'(?=[' ]*[=+\\-@\t\r\uff1d\uff0b\uff0d\uff20])")
_NUMBER = re.compile(r"-?(0|[1-9][0-9]*)(\.[0-9]+)?(e[+-]?[0-9]+)?")
AUDIT_COLUMNS = ["claim", "family", "reading", "claim_verdict", "conditions", "quantity", "kind", "nominal", "low", "high",
                 "value", "lower", "upper", "n", "verdict", "side"]


def summarize(run: str, *, times: bool = False, pooled: bool = False) -> pandas.DataFrame:
    """Every quantity of every estimator in every condition, with its interval and its n: `rcme summarize --format csv`.

    Parameters
    ----------
    run : path of a result file
    times : bool; with the rows time_ms and mean_time_ms (ms a call), which no two runs share
    pooled : bool; all conditions as one

    Returns
    -------
    DataFrame with the columns study, condition, one per factor, estimator, quantity, kind (rate, score, area, mean, median,
    share), value, lower, upper (95 %), standard_error (of means), n, interval (its kind), verdict and trials_to_decide.
    Rates and scores are in [0, 1]; `rcme list quantities` explains each quantity. Unknown numbers are NaN.

    Raises
    ------
    ValueError : no such file, or no sound result file.
    """
    path = _check.existing("run", run, "a result file")
    return _frame(_rcme.summary_csv(path, _check.yes_or_no("times", times), _check.yes_or_no("pooled", pooled)))


def trials(run: str, *, times: bool = False) -> pandas.DataFrame:
    """Every trial of every estimator, a row each, nothing summarized: `rcme summarize --raw csv`.

    Parameters
    ----------
    run : path of a result file
    times : bool; with the column seconds, which no two runs share

    Returns
    -------
    DataFrame with the columns study, condition, one per factor, trial, estimator (its label), outcome (success, failure, refusal,
    not_scored), status, and the numbers of the tables trials and problems of the file (docs/result_file.md). Unknown
    numbers are NaN.

    Raises
    ------
    ValueError : no such file, no sound result file, or one that keeps counts instead of trials.
    """
    path = _check.existing("run", run, "a result file")
    return _frame(_rcme.trials_csv(path, _check.yes_or_no("times", times)))


def compare(run: str, against: Optional[str] = None, *, of: Union[str, Sequence[str]] = "events",
            anytime: bool = False, pooled: bool = False) -> pandas.DataFrame:
    """Each estimator against one of them, the reference, on the same trials: `rcme compare --format csv`.

    Parameters
    ----------
    run : path of a result file of at least two estimators
    against : label of the reference; default: the study's first estimator
    of : "events" (failure, refusal, failure_or_refusal), "scores", "errors", or names of some, or a list of these
    anytime : bool; intervals and p-values that hold however often somebody has looked
    pooled : bool; all conditions as one

    Returns
    -------
    DataFrame: a row per condition, estimator and thing compared, with the paired counts, risk_difference (estimator minus
    reference; of errors the median difference in degrees), lower, upper (95 %), p_value and p_holm (adjusted for all rows).

    Raises
    ------
    ValueError : no such file, label or name; one estimator alone.
    """
    path = _check.existing("run", run, "a result file")
    reference = "" if against is None else _check.plain("against", against)
    return _frame(_rcme.comparison_csv(path, reference, _check.texts("of", of, "events, scores, errors or a name of one"),
                                       _check.yes_or_no("anytime", anytime), _check.yes_or_no("pooled", pooled)))


def reliability(run: str, *, by: Optional[str] = None) -> dict[str, Any]:
    """Do motions fail as often as their stated probabilities say? `rcme reliability --format json`, as a dict: its entries,
    one per estimator (and level of the factor `by`), hold scores with intervals, the reliability curve with its band, bins,
    and the risk-coverage curve (docs/output_formats.md). An estimator that states no probability is given its share of
    inliers, recalibrated on the other half of the scenes. ValueError: no such file or factor.
    """
    path = _check.existing("run", run, "a result file")
    return json.loads(_rcme.reliability_json(path, "" if by is None else _check.plain("by", by)))


def audit(study: Optional[Study] = None, estimators: Optional[Mapping[str, Estimator]] = None, *,
          only: Union[str, Sequence[str], None] = None, budget: str = "quick", seed: Optional[int] = None,
          overrides: Optional[Mapping[str, Any]] = None, threads: int = 0, allow_process: bool = False) -> pandas.DataFrame:
    """Checks claims: without a study every claim of the paper on built-in scenes (minutes), with one the claims about
    calibration on its scene, cameras, noise, outliers and estimators, in each of its conditions; `rcme audit`.

    Parameters
    ----------
    study : path of a study file, or a dict; None: the built-in scenes
    estimators : as for `run`; with a study only. Do the covariances of a function of yours hold?
    only : ids of claims or of families, such as "estimator"; default: all
    budget : "quick" or "full"
    seed, overrides, threads, allow_process : as for `run`; overrides with a study only

    Returns
    -------
    DataFrame: a row per claimed or measured number with claim, family, reading, claim_verdict (of the whole claim),
    conditions (text), quantity, kind, nominal, low and high (what counts as nominal), value, lower and upper (its interval;
    the whole audit has at most 5 % of false verdicts), n, verdict ("holds", "does not hold", "undecided", ...; "measured":
    nothing is claimed), and side (of a confidence region that does not hold: "too narrow" or "too wide"; else "").

    Raises
    ------
    ValueError, KeyboardInterrupt, RuntimeError : as for `run`; ValueError also for a study of real pairs.
    """
    if study is None and (estimators or overrides):
        raise ValueError("study: None is not allowed with estimators or overrides; expected a study file or a dict")
    source = source_of(study, overrides, seed=seed, allow_process=allow_process)
    functions = add_estimators(source, estimators)
    wanted = [] if only is None else _check.texts("only", only, "the id of a claim or of a family")
    is_full = _check.one_of("budget", budget, ("quick", "full")) == "full"
    num_threads = _check.whole("threads", threads, 0, 1024)
    with alone("audit"):
        text = _rcme.audit_json(source, functions, wanted, is_full, num_threads)
    warn_of(functions)
    return pandas.DataFrame(_audit_rows(json.loads(text)), columns=AUDIT_COLUMNS)


def _frame(text: str) -> pandas.DataFrame:
    names = next(csv.reader(io.StringIO(text)))
    factors = names[names.index("condition") + 1:min(names.index(name) for name in ("trial", "estimator") if name in names)]
    frame = pandas.read_csv(io.StringIO(text), dtype=dict.fromkeys(["study", "estimator", "reference", *factors], str),
                            keep_default_na=False, na_values=[""])
    for factor in factors:
        if frame[factor].dropna().map(_is_number).all():
            frame[factor] = pandas.to_numeric(frame[factor])
    return frame.apply(lambda column: column.map(_text_of_cell) if column.dtype == object else column)


def _is_number(level: str) -> bool:
    """As numbers are usually written: "01" is a name."""
    return bool(_NUMBER.fullmatch(level))


def _text_of_cell(cell: Any) -> Any:
    """Without the apostrophe that keeps spreadsheets from taking a text for a formula."""
    return _MARKED.sub("", cell) if isinstance(cell, str) else cell


def _audit_rows(file: dict[str, Any]) -> list[dict[str, Any]]:
    rows = []
    for claim in file["claims"]:
        head = {"claim": claim["id"], "family": claim["family"], "reading": claim["reading"],
                "claim_verdict": claim["verdict"]}
        for evidence in claim["evidence"]:
            place = {"conditions": "; ".join(f"{name} {level}" for name, level in evidence["conditions"].items())}
            for target in evidence["targets"]:
                lower, upper = target.get("interval") or (None, None)
                rows.append({**head, **place, **{key: target.get(key) for key in AUDIT_COLUMNS}, **head, **place,
                             "value": target["measured"], "lower": lower, "upper": upper})
    return rows
