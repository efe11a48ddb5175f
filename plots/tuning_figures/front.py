"""Failure against refusal: every setting that `rcme tune` tried with their Pareto front, those it tested, the tuned one
and the other estimators."""

import math

import numpy as np
import pandas

from common import sheet, style
from rates.rate_bands import BORDERS, per_cent
from rates.selection import n_in_words
from tuning_figures.marks import (CERTIFIED, EXACT, TARGET_LINE, TUNED, add_legend_and_caption, figure_with_legend_beside, handle,
                        head_in_words, looks_of, marks_of, plot_points, target_handle, tuned_handle, tuned_in_words)

SETTING = dict(linestyle="none", marker=".", markersize=3.2, color="0.72", markeredgewidth=0)
FRONT = dict(color="0.35", linewidth=0.9)
TESTED = {**CERTIFIED, "color": FRONT["color"], "markeredgecolor": FRONT["color"]}
UNCERTIFIED = {**TESTED, "markerfacecolor": "white"}
MARGIN = 0.025  # of an axis, before its zero
SUMS = (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1)  # of failure and refusal
SUM_LINE = dict(color="0.82", linewidth=0.6, linestyle=style.DOTTED)
QUANTITIES = ("refusal", "failure")  # along x and y


def known(settings):
    """Those with a place: both rates have a value."""
    return [one for one in settings if not any(math.isnan(one.rates[quantity].value) for quantity in QUANTITIES)]


def places_of(settings):
    return [[one.rates[quantity].value for one in settings] for quantity in QUANTITIES]


def draw_bars(axes, settings, **look):
    """The intervals of both rates of each."""
    x, y = (pandas.DataFrame([one.rates[quantity] for one in settings]) for quantity in QUANTITIES)
    axes.hlines(y.value, x.lower, x.upper, **look)
    axes.vlines(x.value, y.lower, y.upper, **look)


def draw_tested(axes, settings):
    """The Pareto front of all settings as a line from the least refusal on, and those that were tested as points."""
    front = sorted(zip(*places_of([one for one in settings if one.is_on_front])))
    axes.plot(*zip(*front), **FRONT, zorder=2.5, label="_front")
    tested = [one for one in settings if one.is_on_path]
    if tested:
        draw_bars(axes, tested, color="0.72", linewidth=0.5, zorder=2)
    for is_certified, look, label in ((False, UNCERTIFIED, "_tested"), (True, TESTED, "_certified")):
        plot_points(axes, *places_of([one for one in tested if one.is_certified == is_certified]), **look, zorder=3,
                    label=label)


def draw_mark(axes, one, look):
    draw_bars(axes, [one], color=look["color"], linewidth=1, zorder=4)
    plot_points(axes, *places_of([one]), **look, zorder=5)


def draw_target(axes, target):
    for line, quantity in ((axes.axvline, "refusal"), (axes.axhline, "failure")):
        if not math.isnan(target.level(quantity)):
            line(target.level(quantity), **TARGET_LINE, zorder=1, label="_target")


def draw_sums(axes, right, top):
    """Lines of equal failure + refusal, each with its value in the middle of its visible part."""
    for total in (total for total in SUMS if total < right + top):
        x = np.linspace(max(0, total - top), min(total, right), 100)
        axes.plot(x, total - x, **SUM_LINE, zorder=0, label="_sum")
        middle = ((math.sqrt(x[0]) + math.sqrt(x[-1])) / 2) ** 2
        axes.text(middle, total - middle, per_cent(total), fontsize=style.font_size(5.5), color="0.6", ha="center", va="center",
                  zorder=0.5, bbox=dict(facecolor="white", edgecolor="none", pad=0.6))


def root(value):
    """With the sign of the value, so that an axis can begin a little before zero."""
    return np.sign(value) * np.sqrt(np.abs(value))


def square(value):
    return np.sign(value) * np.square(value)


def prepare(axes, tops):
    """Square-root axes from zero: a rate of zero has its place, and small rates have room."""
    for direction, top, name in zip("xy", tops, ("Refusal rate (%)", "Failure rate (%)")):
        getattr(axes, f"set_{direction}scale")("function", functions=(root, square))
        getattr(axes, f"set_{direction}lim")(square(-MARGIN) * top, top)
        axis = getattr(axes, f"{direction}axis")
        axis.set_ticks(ticks_apart(top))
        axis.set_major_formatter(per_cent)
        axis.set_label_text(name)
    axes.grid(False)


def ticks_apart(top):
    """The borders of the colours, on a sheet with a width those whose numbers do not touch, the greatest first."""
    borders, width = [border for border in BORDERS if border <= top], sheet.current().width
    if width is None:
        return borders
    kept = borders[-1:]
    for border in reversed(borders[:-1]):
        if (root(kept[-1]) - root(border)) / root(top) * (min(width, 4.5) - 0.9) > 0.3:
            kept.append(border)
    return kept


def tops_of(marks, target):
    """The ends of both axes: beyond every interval and what the target allows."""
    bounds = [[*(one.rates[quantity].upper for one in marks), target.level(quantity)] for quantity in QUANTITIES]
    return [min(1.0, 1.06 * max((bound for bound in of_axis if not math.isnan(bound)), default=1) or 1)
            for of_axis in bounds]


def legend_of(tune, settings, others):
    is_tested = {setting.is_certified for setting in settings if setting.is_on_path}
    handles = tuned_handle(tune)
    handles += [handle("tested, certified", **TESTED)] * (True in is_tested)
    handles += [handle("tested, not certified", **UNCERTIFIED)] * (False in is_tested)
    handles += [handle("other setting", **{**SETTING, "markersize": 6})]
    handles += [handle("Pareto front", **FRONT)]
    handles += target_handle(tune.target, ("failure", "refusal"))
    handles += [handle("failure + refusal (%)", **{**SUM_LINE, "color": "0.6"})]
    return handles + [handle(other.name(), **marks_of(look)) for other, look in others]


def draw_front(tune):
    settings = known(tune.settings)
    others = [pair for pair in zip(tune.others, looks_of(tune.others)) if known([pair[0]])]
    tuned = known([tune.tuned]) if tune.tuned else []
    figure, axes, handles = figure_with_legend_beside(legend_of(tune, settings, others), width=1.8, height=4.2)
    tops = tops_of([*settings, *tuned, *(other for other, _ in others)], tune.target)
    prepare(axes, tops)
    draw_sums(axes, *tops)
    draw_target(axes, tune.target)
    plot_points(axes, *places_of([one for one in settings if not one.is_on_path]), **SETTING, zorder=1.5,
                label="_settings")
    draw_tested(axes, settings)
    for other, look in others:
        draw_mark(axes, other, {**marks_of(look), "label": f"_{other.name()}"})
    for one in tuned:
        draw_mark(axes, one, {**TUNED, "label": "_tuned"})
    counts = pandas.DataFrame({"n": [one.rates[quantity].n for one in tune.settings for quantity in QUANTITIES]})
    add_legend_and_caption(figure, handles, "; ".join(
        [head_in_words(tune), *tuned_in_words(tune), "rates on fresh trials", n_in_words(counts, "setting"),
         f"bars: {EXACT}", "axes in proportion to the square root of the rate"]) + ".")
    return figure
