"""Where a rate crosses a value, against one factor: a line per estimator with both intervals of `rcme solve`."""

import math
from dataclasses import dataclass

import pandas
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from common import style
from common.command_line import PlotError
from common.factor_axis import FactorAxis, abreast, rows_that_vary, split_into_panel_rows
from common.json_file import is_finite, read_object
from common.number_text import number_text
from common.summary_csv import rows_where
from rates.selection import check_factor, fixed_levels, n_in_words

CROSSINGS = ("rcme solve", "rcme crossings 1")  # command, format
INTERVALS = {"interval": ("lower", "upper"), "logistic_interval": ("logistic_lower", "logistic_upper")}


@dataclass(frozen=True)
class Crossings:
    """`rows`: a column per factor, estimator, estimate, lower, upper, logistic_lower, logistic_upper, n. An end beyond the
    range that was searched is infinite; an estimate is NaN where no trial could be simulated."""

    path: str
    study: str
    setting: str
    range: tuple
    is_logarithmic: bool
    quantity: str
    rate: float
    factors: tuple
    rows: pandas.DataFrame


def read_crossings(path):
    """The Crossings in the file `path`; a cut-off or foreign file is an error."""
    file = read_object(path, *CROSSINGS)
    rows = [row_of(node) for node in file.nodes("crossings", "crossing")]
    if not rows:
        raise PlotError(f"{path}: holds no crossings.")
    factors = tuple(rows[0][0])
    return Crossings(path, file.text("study"), file.text("setting"),
                     (file.get("from", is_finite, "a number"), file.get("to", is_finite, "a number")),
                     file.boolean("logarithmic"), file.text("quantity"), file.fraction("rate"), factors,
                     pandas.DataFrame([{**levels, **numbers} for levels, numbers in rows]))


def row_of(node):
    """(levels by factor, the other columns)."""
    levels = node.node("levels").value
    numbers = {"estimator": node.text("estimator"), "estimate": node.number_or("estimate", math.nan), "n": node.count("trials")}
    for key, names in INTERVALS.items():
        ends = node.get(key, lambda value: isinstance(value, list) and len(value) == 2 and
                        all(end is None or is_finite(end) for end in value), "two numbers or nulls")
        numbers.update(zip(names, (-math.inf if ends[0] is None else ends[0], math.inf if ends[1] is None else ends[1])))
    return levels, numbers


def draw_open_ends(axes, points, look, ends, place):
    """Arrows at the ends of the range where an interval goes beyond it."""
    for column, beyond, end, marker in (("lower", -math.inf, ends[0], "v"), ("upper", math.inf, ends[1], "^")):
        at = points.x[points[column] == beyond]
        if at.empty:  # an empty line would confuse the layout
            continue
        axes.plot(at, [end] * len(at), linestyle="none", marker=marker, markersize=4, color=look.color, transform=place,
                  clip_on=False, zorder=4, label="_beyond")


def draw_estimator(axes, points, look, aside, is_numeric, ends):
    """One estimator's levels: both intervals end at the range that was searched."""
    place = axes.transData + aside
    within = points.assign(**{name: points[name].clip(*ends) for names in INTERVALS.values() for name in names})
    if is_numeric:
        axes.fill_between(within.x, within.logistic_lower, within.logistic_upper, color=look.color, alpha=0.13, linewidth=0)
    else:
        axes.vlines(within.x, within.logistic_lower, within.logistic_upper, color=look.color, linewidth=4, alpha=0.25,
                    transform=place)
    axes.vlines(within.x, within.lower, within.upper, color=look.color, linewidth=1, alpha=0.6, zorder=2, transform=place)
    axes.plot(points.x, points.estimate, **{**look.line(), **({} if is_numeric else {"linestyle": "none"})}, clip_on=False,
              zorder=3, transform=place)
    draw_open_ends(axes, points, look, ends, place)


def draw_panel(axes, points, looks, axis, ends):
    points = points[points.estimate.notna()].sort_values("x", kind="stable")
    for position, (estimator, look) in enumerate(looks.items()):
        if (points.estimator != estimator).all():
            continue
        draw_estimator(axes, points[points.estimator == estimator], look, abreast(axes, position, len(looks), axis.room(1)),
                       axis.is_numeric, ends)


def check_no_repetition(path, part):
    repeated = part[part.duplicated(["x", "estimator"])]
    if len(repeated):
        raise PlotError(f"{path}: {repeated.estimator.iloc[0]} has a second crossing at one place of the x axis; choose with "
                        "--where FACTOR=LEVEL.")


def draw(crossings, x, conditions=()):
    """The whole figure: a row of panels per combination of the other factors."""
    check_factor(crossings, "--x", x)
    rows = rows_where(crossings.path, crossings.rows, [*crossings.factors, "estimator"], conditions)
    if rows.estimate.isna().all():
        raise PlotError(f"{crossings.path}: no crossing has a trial that could be simulated.")
    axis, looks = FactorAxis(x, rows[x]), style.equal_looks_of(list(dict.fromkeys(rows.estimator)))
    others = [factor for factor in crossings.factors if factor != x]
    rows = rows_that_vary(rows.assign(x=axis.positions(rows[x])), others)
    parts = split_into_panel_rows(crossings.path, rows, others)
    figure, panels = style.new_figure(len(parts), 1, axis.height_of_names(1), may_fold=True)
    letters = style.letters(panels.size)
    for axes, (levels, part) in zip(panels[:, 0], parts):
        check_no_repetition(crossings.path, part)
        if crossings.is_logarithmic:
            axes.set_yscale("log")
            axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axes.yaxis.set_major_formatter(FuncFormatter(lambda level, _: number_text(level)))
            axes.yaxis.set_minor_formatter(NullFormatter())
        axes.set_ylim(*crossings.range)
        draw_panel(axes, part, looks, axis, crossings.range)
        axes.set_title(style.title_lines(next(letters) + levels, 1))
    for axes in style.left_panels(panels):
        axes.set_ylabel(style.in_words(crossings.setting))
    for axes in style.bottom_panels(panels):
        axis.prepare(axes, 1)  # the x axis is shared by all panels
    handles = {handle.get_label(): handle for axes in panels.flat for handle in axes.get_legend_handles_labels()[0]}
    style.add_legend_and_caption(figure, list(handles.values()), caption_of(crossings, rows, others, axis))
    return figure


def caption_of(crossings, rows, others, axis):
    is_open = any(math.isinf(end) for names in INTERVALS.values() for name in names for end in rows[name])
    return "; ".join(
        [f"Study {crossings.study}", *fixed_levels(rows, others),
         f"level of {crossings.setting} at which the rate of {crossings.quantity} crosses {number_text(crossings.rate)}",
         n_in_words(rows, "point"), f"bars: 95 % intervals that suppose a monotone rate; {'bands' if axis.is_numeric else 'broad bars'}: "
         "that suppose a logistic one"] + (["arrows: the level may lie beyond the range that was searched"] if is_open else [])) + "."
