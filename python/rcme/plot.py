"""Figures on matplotlib axes of yours: each function draws on `ax` and returns it. Colours and marks are those of the axes' own
cycle; nothing is computed, values and intervals are those of the tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Optional

import numpy as np
import pandas

from rcme import _check

__all__ = ["audit", "matches", "paired_difference", "rate", "reliability"]


def rate(ax: Any, summary: pandas.DataFrame, x: str, quantity: str = "failure", *,
         estimators: Optional[Sequence[str]] = None, where: Optional[Mapping[str, Any]] = None,
         labels: Optional[Mapping[str, str]] = None) -> Any:
    """A rate or score (%) against a factor: a line with its 95 % interval per estimator; where levels are words, marks.

    ax : matplotlib axes; summary : what `summarize` gave; x : a factor (a column of it); quantity : a rate (failure,
    failure_or_refusal, ...), a score or a mean;
    estimators : labels to draw, in order (default: all); where : levels of other factors, {factor: level}; labels : names for
    the legend, {label: name}. ValueError: no such column, quantity, estimator or level; another factor varies.
    """
    _axes(ax)
    rows = _rows(summary, "summary", ("estimator", "quantity", "value", "lower", "upper", "kind"), x, where)
    rows = _chosen(rows, "quantity", quantity, "quantity")
    scale = 100.0 if rows.kind.isin(["rate", "score"]).all() else 1.0
    series, ticks = _series(rows, x, estimators, labels)
    for label, at, aside, points in series:
        value, lower, upper = (scale * points[column].to_numpy(float) for column in ("value", "lower", "upper"))
        if ticks is None:
            # The first is drawn widest: where estimators tie, it stays visible as a rim.
            (line,) = ax.plot(at, value, marker="o", markersize=4 - 2 * aside, linewidth=1.6 - 1.4 * aside, label=label)
            ax.fill_between(at, lower, upper, color=line.get_color(), alpha=0.15, linewidth=0)
        else:
            ax.errorbar(at + 0.5 * aside, value, yerr=_arms(value, lower, upper), fmt="o", markersize=3, label=label)
    _name_axes(ax, x, quantity + (" (%)" if scale == 100.0 else ""), ticks)
    return ax


def paired_difference(ax: Any, comparison: pandas.DataFrame, x: str, event: str = "failure", *,
                      estimators: Optional[Sequence[str]] = None, where: Optional[Mapping[str, Any]] = None,
                      labels: Optional[Mapping[str, str]] = None) -> Any:
    """How much more often (% points) each estimator fails than the reference, on the same trials, with 95 % intervals.

    comparison : what `compare` gave; event : an event or a score of it. A mark is filled where p_holm < 0.05. Other arguments
    and errors as for `rate`.
    """
    _axes(ax)
    rows = _rows(comparison, "comparison", ("estimator", "event", "risk_difference", "lower", "upper", "p_holm"), x, where)
    rows = _chosen(rows, "event", event, "event")
    series, ticks = _series(rows, x, estimators, labels)
    for label, at, aside, points in series:
        value, lower, upper, p = (points[column].to_numpy(float) for column in ("risk_difference", "lower", "upper", "p_holm"))
        at = at + 0.3 * (np.diff(np.unique(at)).min() if len(np.unique(at)) > 1 else 1.0) * aside
        bars = ax.errorbar(at, 100 * value, yerr=100 * _arms(value, lower, upper), fmt="o", markersize=3.5,
                           markerfacecolor="white", label=label)
        is_sure = p < 0.05
        ax.plot(at[is_sure], 100 * value[is_sure], "o", markersize=3.5, color=bars[0].get_color())
    ax.axhline(0, color="0.25", linewidth=0.8, zorder=0)
    _name_axes(ax, x, f"{event}: difference (% points)", ticks)
    return ax


def reliability(ax: Any, measured: Mapping[str, Any], estimator: str, *, group: Optional[str] = None) -> Any:
    """How often an estimator's motions fail (%) against the probability of failure that it stated, in the band in which right
    probabilities stay.

    measured : what `rcme.reliability` gave; estimator : a label in it; group : with `by` a level. ValueError: none of that.
    """
    _axes(ax)
    if not isinstance(measured, Mapping) or "entries" not in measured:
        raise ValueError(f"measured: {_check.words(measured)} is not allowed; expected what rcme.reliability gave")
    entries = [entry for entry in measured["entries"] if entry["estimator"] == estimator
               and (group is None or entry["group"] == str(group)) and entry["n"] > 0]
    if not entries:
        known = sorted({entry["estimator"] for entry in measured["entries"] if entry["n"] > 0})
        raise ValueError(f"estimator: {_check.words(estimator)} has no answers there; expected one of: {', '.join(known)}")
    entry = entries[0]
    band = np.array([[point[key] for key in ("probability", "lower", "upper")] for point in entry["band"]], dtype=float)
    if len(band):
        ax.fill_between(100 * band[:, 0], 100 * band[:, 1], 100 * band[:, 2], color="0.85", linewidth=0)
    ax.plot([0, 100], [0, 100], color="0.5", linewidth=0.8, linestyle="--")
    steps = np.array([[step[key] for key in ("first", "last", "recalibrated")] for step in entry["curve"]], dtype=float)
    if len(steps):  # the failure rate is constant from the first to the last probability of a step
        ax.plot(100 * steps[:, :2].ravel(), 100 * np.repeat(steps[:, 2], 2), marker=".", label=estimator)
    ax.set(xlabel="stated probability of failure (%)", ylabel="failures (%)", xlim=(0, 100), ylim=(0, 100))
    return ax


def audit(ax: Any, audited: pandas.DataFrame, *, claim: Optional[str] = None) -> Any:
    """Claimed rates with their intervals beside what counts as nominal (grey): a line per number, red where it does not hold.

    audited : what `rcme.audit` gave; claim : the beginning of the ids to draw (default: all rates). ValueError: no such rows.
    """
    _axes(ax)
    _table(audited, "audited", ("claim", "kind", "low", "high", "value", "lower", "upper", "verdict", "quantity", "conditions"))
    rows = audited[(audited.kind == "rate") & audited.verdict.notna()]
    if claim is not None:
        rows = rows[rows.claim.str.startswith(_check.plain("claim", claim))]
    if rows.empty:
        known = sorted(set(audited.claim[(audited.kind == "rate") & audited.verdict.notna()]))
        raise ValueError(f"claim: {_check.words(claim)} has no claimed rates; expected the beginning of one of: "
                         f"{', '.join(known)}")
    for y, row in enumerate(rows.itertuples()):
        color = {"holds": "tab:blue", "does not hold": "tab:red"}.get(row.verdict, "0.4")
        ax.barh(y, row.high - row.low, left=row.low, height=0.8, color="0.88")
        ax.plot([row.lower, row.upper], [y, y], color=color)
        ax.plot(row.value, y, "o", markersize=3, color=color)
    ax.set_yticks(range(len(rows)), [f"{row.claim}, {row.quantity}" for row in rows.itertuples()])
    ax.invert_yaxis()
    ax.set_xlabel("rate")
    return ax


def matches(ax: Any, trial: Mapping[str, Any], inliers: Optional[Any] = None) -> Any:
    """The matches of a trial in image 1 (px): a line from x1 to x2, true ones blue, wrong ones red, unknown ones grey.

    trial : what `simulate` gave; inliers : a mask (N) to colour by, such as info["inliers"] (default: the truth's).
    """
    _axes(ax)
    if not isinstance(trial, Mapping) or not {"x1", "x2", "camera1", "truth"} <= set(trial):
        raise ValueError(f"trial: {_check.words(trial)} is not allowed; expected what rcme.simulate gave")
    x1, x2 = trial["x1"], trial["x2"]
    is_inlier = trial["truth"]["inliers"] if inliers is None else inliers
    if is_inlier is not None and np.shape(is_inlier) != (len(x1),):
        raise ValueError(f"inliers: its shape is {np.shape(is_inlier)}; expected a mask of shape ({len(x1)},)")
    groups = ([(np.ones(len(x1), dtype=bool), "0.4", "matches")] if is_inlier is None else
              [(~np.asarray(is_inlier, dtype=bool), "tab:red", "outliers"),
               (np.asarray(is_inlier, dtype=bool), "tab:blue", "inliers")])
    for chosen, color, label in groups:
        ax.plot(np.vstack([x1[chosen, 0], x2[chosen, 0]]), np.vstack([x1[chosen, 1], x2[chosen, 1]]), color=color,
                linewidth=0.6, alpha=0.7)
        ax.plot(x1[chosen, 0], x1[chosen, 1], "o", markersize=2, color=color, label=label)
    camera = trial["camera1"]
    ax.set(xlim=(-0.5, camera["width"] - 0.5), ylim=(camera["height"] - 0.5, -0.5), xlabel="x (px)", ylabel="y (px)",
           aspect="equal")
    return ax


def _axes(ax: Any) -> None:
    if not all(hasattr(ax, name) for name in ("plot", "errorbar", "fill_between", "set_xlabel")):
        raise ValueError(f"ax: {_check.words(ax)} is not allowed; expected matplotlib axes, as of plt.subplots()")


def _table(table: Any, name: str, columns: Sequence[str]) -> None:
    if not isinstance(table, pandas.DataFrame):
        raise ValueError(f"{name}: {_check.words(table)} is not allowed; expected a data frame")
    missing = [column for column in columns if column not in table.columns]
    if missing:
        raise ValueError(f"{name}: its shape is {table.shape}, without the columns {', '.join(missing)}; expected what "
                         "rcme's function of that name gave")


def _rows(table: Any, name: str, columns: Sequence[str], x: str, where: Optional[Mapping[str, Any]]) -> pandas.DataFrame:
    _table(table, name, columns)
    if not isinstance(x, str) or x not in table.columns:
        raise ValueError(f"x: {_check.words(x)} is no column; expected one of: {', '.join(map(str, table.columns))}")
    if where is not None and not isinstance(where, Mapping):
        raise ValueError(f"where: {_check.words(where)} is not allowed; expected a dict {{factor: level}}")
    for key, level in (where or {}).items():
        if key not in table.columns:
            raise ValueError(f"where: {_check.words(key)} is no column; expected one of: {', '.join(map(str, table.columns))}")
        table = table[table[key].map(lambda cell: _is_level(cell, level))]
        if table.empty:
            raise ValueError(f"where: no row has {key} = {level}")
    return table


def _is_level(cell: Any, level: Any) -> bool:
    """Equal as text or as a number: 1, 1.0 and "1" are one level."""
    if str(cell) == str(level):
        return True
    try:
        return float(cell) == float(level)
    except (TypeError, ValueError):
        return False


def _chosen(rows: pandas.DataFrame, column: str, value: str, name: str) -> pandas.DataFrame:
    chosen = rows[rows[column] == value]
    if not isinstance(value, str) or chosen.empty:
        raise ValueError(f"{name}: {_check.words(value)} is not there; expected one of: "
                         f"{', '.join(dict.fromkeys(rows[column].astype(str)))}")
    return chosen


def _estimators(rows: pandas.DataFrame, wanted: Optional[Sequence[str]]) -> list[str]:
    present = list(dict.fromkeys(rows.estimator))
    names = present if wanted is None else _check.texts("estimators", wanted, "a label")
    for name in names:
        if name not in present:
            raise ValueError(f"estimators: {name!r} is not there; expected some of: {', '.join(present)}")
    return names


def _places(rows: pandas.DataFrame, x: str) -> tuple[dict[Any, float], Optional[list[str]]]:
    """Where each level stands, and names for the ticks where levels are words."""
    levels = list(dict.fromkeys(rows[x]))
    try:
        return {level: float(level) for level in levels}, None
    except (TypeError, ValueError):
        return {level: float(i) for i, level in enumerate(levels)}, [str(level) for level in levels]


def _series(rows: pandas.DataFrame, x: str, estimators: Optional[Sequence[str]], labels: Optional[Mapping[str, str]]
            ) -> tuple[list[tuple[str, np.ndarray, float, pandas.DataFrame]], Optional[list[str]]]:
    """Of each estimator its label, the places of its levels, what share of the room between levels it stands aside (-0.5..0.5)
    and its rows in the order of the places; and the names of the ticks where levels are words."""
    if labels is not None and not isinstance(labels, Mapping):
        raise ValueError(f"labels: {_check.words(labels)} is not allowed; expected a dict {{label: name for the legend}}")
    names = _estimators(rows, estimators)
    places, ticks = _places(rows, x)
    series = []
    for number, name in enumerate(names):
        points = rows[rows.estimator == name]
        _check_one_per_level(points, x)
        at = np.array([places[level] for level in points[x]])
        order = np.argsort(at, kind="stable")
        series.append(((labels or {}).get(name, name), at[order], (number + 0.5) / len(names) - 0.5, points.iloc[order]))
    return series, ticks


def _check_one_per_level(points: pandas.DataFrame, x: str) -> None:
    if points[x].duplicated().any():
        raise ValueError(f"x: {len(points)} rows of {points.estimator.iloc[0]} share {points[x].nunique()} levels of {x!r}; "
                         "expected one row per level: fix the other factors with where={factor: level}")


def _arms(value: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """The lengths of the bars; 0 where there is no interval."""
    return np.nan_to_num(np.maximum(0.0, np.vstack([value - lower, upper - value])))


def _name_axes(ax: Any, x: str, y: str, ticks: Optional[list[str]]) -> None:
    ax.set_xlabel(x.replace("_", " "))
    ax.set_ylabel(y.replace("_", " "))
    if ticks is not None:
        ax.set_xticks(range(len(ticks)), ticks)
