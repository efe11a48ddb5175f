"""Rates over two factors: a heat map per estimator and quantity, each cell with its rate and interval."""

import itertools

from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from common import style
from common.command_line import PlotError
from common.factor_axis import FactorAxis
from rates.selection import (check_factor, check_no_repetition, fixed_levels, interval_in_words, kind_in_words,
                             n_in_words, select_rates, title_of)

COLORS = colormaps["cividis_r"]  # even steps to the eye, with every colour vision and in grey; dark is much
LEAST_TOP = 0.05  # a scale that ended lower would paint rates that hardly differ from zero as dark as a failure
CELL_WIDTH, CELL_HEIGHT = 0.62, 0.36  # inches: room for "[10.1, 14.8]"
LONGEST_LEVEL_NAME = 11  # letters that fit below a cell
WIDEST = 9.5  # inches; more panels go into a further row
MAX_PANELS = 60


def select(summary, x, y, quantities):
    """(rows, x axis, y axis); one row per cell, estimator and quantity."""
    check_factor(summary, "--x", x)
    check_factor(summary, "--y", y)
    if x == y:
        raise PlotError(f"--y {y}: is --x too; a heat map needs two factors.")
    rows = select_rates(summary, quantities)
    others = [factor for factor in summary.factors if factor not in (x, y)]
    varying = [factor for factor in others if rows[factor].nunique() > 1]
    if varying:
        raise PlotError(f"{summary.path}: {', '.join(varying)} varies too; fix it with --where " +
                        " --where ".join(f"{factor}={rows[factor].iloc[0]}" for factor in varying) + ".")
    check_no_repetition(summary.path, rows, [x, y, "estimator", "quantity"], lambda row: f"{x} = {row[x]}, {y} = {row[y]}")
    return rows, *(FactorAxis(factor, rows[factor]) for factor in (x, y))


def chosen_estimators(summary, rows, wanted):
    """The wanted estimators, or all, in the order of the study."""
    present = list(dict.fromkeys(rows.estimator))
    for name in wanted:
        if name not in present:
            raise PlotError(f"--estimators {name}: {summary.path} has no such estimator; allowed: {', '.join(present)}.")
    return [name for name in present if not wanted or name in wanted]


def grid_of(num_estimators, num_quantities, x_levels, y_levels):
    """(figure, panels, colour bars): a row of panels per quantity, or several where one would be too wide. `panels` has
    one list per quantity, estimators in order; `colour bars` the axes at the right of each of its rows."""
    width, height = max(1.5, CELL_WIDTH * x_levels), CELL_HEIGHT * y_levels
    columns = max(1, min(num_estimators, int((WIDEST - 1.6) // (width + 0.1))))
    lines = -(-num_estimators // columns)
    rows = num_quantities * lines
    figure = Figure(figsize=(1.4 + columns * (width + 0.1), 0.9 + rows * (height + 0.6)), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, columns + 1, squeeze=False, gridspec_kw={"width_ratios": [width] * columns + [0.13]})
    panels = [list(axes[q * lines:(q + 1) * lines, :-1].flat) for q in range(num_quantities)]
    for unused in itertools.chain(*(of_quantity[num_estimators:] for of_quantity in panels)):
        unused.set_visible(False)
    return figure, panels, [list(axes[q * lines:(q + 1) * lines, -1]) for q in range(num_quantities)]


def luminance(color):
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]


def text_color(color):
    """Readable on that colour."""
    return "white" if luminance(color) < 0.5 else "black"


def in_per_cent(fraction):
    return f"{100 * fraction:.1f}"


def draw_cell(axes, left, bottom, row, scale):
    """A coloured cell with its rate (%) and, in small print, its interval; hatched where there are no trials."""
    box = dict(linewidth=0.8, edgecolor="white")
    if row.value != row.value:
        axes.fill_between([left, left + 1], bottom, bottom + 1, facecolor="0.93", hatch="///", **{**box, "edgecolor": "0.7"})
        axes.text(left + 0.5, bottom + 0.5, "n = 0", ha="center", va="center", fontsize=5.6, color="0.3")
        return
    color = COLORS(scale(row.value))
    text = dict(ha="center", va="center", color=text_color(color))
    axes.fill_between([left, left + 1], bottom, bottom + 1, facecolor=color, **box)
    axes.text(left + 0.5, bottom + 0.64, in_per_cent(row.value), fontsize=7.5, **text)
    axes.text(left + 0.5, bottom + 0.25, f"[{in_per_cent(row.lower)}, {in_per_cent(row.upper)}]", fontsize=5.2, **text)


def draw_panel(axes, rows, x_axis, y_axis, scale):
    """One estimator's cells; both factors in the order of the study, from the lower left."""
    for row in rows.itertuples():
        draw_cell(axes, x_axis.levels.index(row.x), y_axis.levels.index(row.y), row, scale)
    axes.set(xlim=(0, len(x_axis.levels)), ylim=(0, len(y_axis.levels)))
    is_long = max(len(level) for level in x_axis.levels) > LONGEST_LEVEL_NAME
    axes.set_xticks([0.5 + i for i in range(len(x_axis.levels))], x_axis.levels, rotation=25 if is_long else 0,
                    ha="right" if is_long else "center")
    axes.set_yticks([0.5 + i for i in range(len(y_axis.levels))], y_axis.levels)
    axes.tick_params(length=0, labelsize=7)
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set_visible(False)


def draw_color_bars(figure, bars, scale, label):
    for bar in bars:
        figure.colorbar(ScalarMappable(scale, COLORS), cax=bar, format=FuncFormatter(lambda f, _: f"{100 * f:g}"))
        bar.set_ylabel(label, fontsize=7)
        bar.tick_params(labelsize=7)
        bar.grid(False)
        bar.spines[:].set_visible(False)


def scale_of(rows):
    """The colours of one quantity, the same in all its panels: from zero to its greatest rate."""
    return Normalize(0, max(LEAST_TOP, rows.value.max() if rows.value.notna().any() else 0))


def draw(summary, x, y, quantities, estimators=()):
    """The whole figure: a row of panels per quantity, a column per estimator."""
    rows, x_axis, y_axis = select(summary, x, y, quantities)
    names = chosen_estimators(summary, rows, estimators)
    rows = rows[rows.estimator.isin(names)].assign(x=rows[x], y=rows[y])
    if len(names) * len(quantities) > MAX_PANELS:
        raise PlotError(f"{len(names)} estimators and {len(quantities)} quantities need more than {MAX_PANELS} panels; "
                        "choose some with --estimators or --quantities.")
    looks, letters = style.looks_of(names), style.letters(len(names) * len(quantities))
    figure, panels, bars = grid_of(len(names), len(quantities), len(x_axis.levels), len(y_axis.levels))
    for quantity, of_quantity, bars_of_quantity in zip(quantities, panels, bars):
        drawn = rows[rows.quantity == quantity]
        scale = scale_of(drawn)
        for axes, name in zip(of_quantity, names):
            draw_panel(axes, drawn[drawn.estimator == name], x_axis, y_axis, scale)
            axes.set_title(f"{next(letters)}{title_of(quantity)}, {looks[name].label}", fontsize=7.5)
        draw_color_bars(figure, bars_of_quantity, scale, f"{kind_in_words(drawn)} (%)")
        name_axes(of_quantity, len(of_quantity) // len(bars_of_quantity), x, y)
    others = [factor for factor in summary.factors if factor not in (x, y)]
    style.add_legend_and_caption(figure, [], "; ".join(
        [f"Study {rows.study.iloc[0]}", *fixed_levels(rows, others), n_in_words(rows, "cell"),
         f"in each cell the {kind_in_words(rows).lower()} in %, below it its {interval_in_words(rows)} interval"]) + ".")
    return figure


def name_axes(of_quantity, columns, x, y):
    """The factors' names at the left of the first column and below the panels that have none beneath them."""
    shown = [axes for axes in of_quantity if axes.get_visible()]
    for axes in shown[::columns]:
        axes.set_ylabel(style.in_words(y))
    for axes in shown[-columns:]:
        axes.set_xlabel(style.in_words(x))
