"""How much more often each estimator fails than the reference, or how much higher it scores, with intervals, against one factor."""

import itertools
import math

from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter

from common import sheet, style
from common.command_line import PlotError
from common.factor_axis import FactorAxis, abreast, rows_that_vary, split_into_panel_rows
from common.summary_csv import numbers
from rates.selection import (check_factor, check_no_repetition, check_one_study, difference_interval_in_words,
                             fixed_levels, n_in_words, test_in_words, title_of)

SIGNIFICANCE_LEVEL = 0.05
TITLES = {  # other events: their name in words
    "failure": "Failures", "refusal": "Refusals", "failure_or_refusal": "Failures and refusals",
}


def name_of(event):
    return sheet.current().text_of(event, TITLES[event]) if event in TITLES else title_of(event)


def compared_in_words(rows):
    """'rate', 'score', or both; a table from before there were scores has rates."""
    return " or ".join(dict.fromkeys("score" if kind == "score" else "rate" for kind in rows.get("kind", ["event"])))


def select(comparison, events):
    """The rows of the asked events, with numbers in place of text; NaN where n is 0."""
    kinds = comparison.rows.get("kind")  # errors are in degrees: no part of this figure
    path = comparison.path
    present = list(dict.fromkeys(comparison.rows.event if kinds is None else comparison.rows.event[kinds != "error"]))
    for event in events:
        if event not in present:
            raise PlotError(f"{path}: has no event or score called '{event}'; allowed: {', '.join(present)}.")
    check_one_study(comparison)
    comparison = comparison.with_rows(comparison.rows[comparison.rows.event.isin(events)])
    if comparison.rows.reference.nunique() > 1:
        raise PlotError(f"{path}: holds comparisons with several references: "
                        f"{', '.join(dict.fromkeys(comparison.rows.reference))}.")
    columns = {name: numbers(comparison, name, may_be_empty=True)
               for name in ("risk_difference", "lower", "upper", "p_holm")}
    rows = comparison.rows.assign(n=numbers(comparison, "n"), **columns)
    for row in rows.itertuples():
        is_whole = -1 <= row.lower <= row.risk_difference <= row.upper <= 1 and 0 <= row.p_holm <= 1
        if not is_whole and not (row.n == 0 and math.isnan(row.risk_difference)):
            raise PlotError(f"{path}: line {row.line}: a difference must lie in its interval and both in -1..1, p_holm in "
                            "0..1, and they may be empty only where n is 0.")
    rows.loc[rows.risk_difference.isna(), ["lower", "upper"]] = math.nan
    return rows


def draw_estimator(axes, points, look, aside, is_numeric):
    """One estimator's differences with their intervals, a little aside of the others'."""
    place = axes.transData + aside
    if is_numeric:
        axes.plot(points.x, points.risk_difference, color=look.color, linestyle=look.dashes, linewidth=0.7, alpha=0.6,
                  transform=place, zorder=2, label="_line")
    axes.vlines(points.x, points.lower, points.upper, color=look.color, linewidth=1, transform=place, zorder=3)
    for is_filled, part in points.groupby(points.p_holm < SIGNIFICANCE_LEVEL):
        axes.plot(part.x, part.risk_difference, linestyle="none", marker=look.marker, markersize=look.marker_size,
                  markeredgecolor=look.color, markerfacecolor=look.color if is_filled else "white",
                  markeredgewidth=0.9, transform=place, clip_on=False, zorder=4,
                  label=f"{'_filled' if is_filled else '_open'} {look.label}")


def draw_panel(axes, points, looks, is_numeric, room):
    """One event in one panel, all estimators; the y values are fractions, the tick labels percentage points."""
    points = points.sort_values("x", kind="stable")
    axes.axhline(0, color="0.25", linewidth=0.9, zorder=1, label="_zero")
    for position, (estimator, look) in enumerate(looks.items()):
        draw_estimator(axes, points[points.estimator == estimator], look, abreast(axes, position, len(looks), room),
                       is_numeric)
    if points.risk_difference.isna().all():
        axes.text(0.5, 0.5, "no trials (n = 0)", transform=axes.transAxes, ha="center", va="center", color="0.4")
    axes.yaxis.set_major_formatter(FuncFormatter(lambda fraction, _: f"{100 * fraction:+g}" if fraction else "0"))


def legend_of(looks, test):
    """The estimators, then what filled and open marks mean."""
    def mark(label, color, marker, is_filled):
        return Line2D([], [], linestyle="none", marker=marker, markersize=5, markeredgecolor=color,
                      markerfacecolor=color if is_filled else "white", markeredgewidth=0.9, label=label)
    return [mark(look.label, look.color, look.marker, True) for look in looks.values()] + [
        mark(f"filled: Holm-adjusted {test} p < {SIGNIFICANCE_LEVEL:g}", "0.35", "o", True),
        mark(f"open: p \u2265 {SIGNIFICANCE_LEVEL:g}", "0.35", "o", False)]


def draw(comparison, x, events):
    """The whole figure: events side by side, one row of panels per combination of the other factors."""
    check_factor(comparison, "--x", x)
    rows = select(comparison, events)
    axis, looks = FactorAxis(x, rows[x]), style.equal_looks_of(list(dict.fromkeys(rows.estimator)))
    other_factors = [factor for factor in comparison.factors if factor != x]
    rows = rows_that_vary(rows.assign(x=axis.positions(rows[x])), other_factors)
    parts = split_into_panel_rows(comparison.path, rows, other_factors)
    for _, part in parts:
        check_no_repetition(comparison.path, part, ["x", "estimator", "event"], lambda row: f"x = {row[x]}")
    reference = style.label_of(rows.reference.iloc[0])
    figure, panels = style.new_figure(len(parts), len(events), axis.height_of_names(len(events)), may_fold=True)
    letters = style.letters(panels.size)
    for (r, (levels, part)), (c, event) in itertools.product(enumerate(parts), enumerate(events)):
        draw_panel(panels[r, c], part[part.event == event], looks, axis.is_numeric,
                   axis.room(len(events)))
        title = next(letters) + name_of(event) + (f", {levels}" if levels else "")
        panels[r, c].set_title(style.title_lines(title, len(events)))
    for axes in style.bottom_panels(panels):
        axis.prepare(axes, len(events))  # the x axis is shared by all panels
    for axes in style.left_panels(panels):
        axes.set_ylabel("Difference (% points)")
    style.add_legend_and_caption(figure, legend_of(looks, test_in_words(rows)), "; ".join(
        [f"Study {rows.study.iloc[0]}", *fixed_levels(rows, other_factors),
         f"{compared_in_words(rows)} of each estimator minus that of {reference}, on the same trials",
         n_in_words(rows, "point"), f"bars: {difference_interval_in_words(rows)} intervals; p-values adjusted by Holm for all tests of the comparison"]) + ".")
    return figure
