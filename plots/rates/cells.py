"""Rates over two factors: a heat map per estimator and quantity, each cell with its rate and interval."""

import itertools

from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from common import sheet, style
from common.command_line import PlotError
from common.factor_axis import FactorAxis
from common.text_size import wrap, width_of
from rates.selection import (check_factor, check_no_repetition, fixed_levels, interval_in_words, kind_in_words,
                             listed, n_in_words, select_rates, sharpness_in_words, title_of)

COLORS = colormaps["cividis_r"]  # even steps to the eye, with every colour vision and in grey; dark is much
LEAST_TOP = 0.05  # a scale that ended lower would paint rates that hardly differ from zero as dark as a failure
CELL_WIDTH, CELL_HEIGHT = 0.62, 0.36  # inches: room for "[10.1, 14.8]"
LONGEST_LEVEL_NAME = 11  # letters that fit below a cell
WIDEST = 9.5  # inches; more panels go into a further row
LABELS_WIDTH, BAR_WIDTH = 0.85, 0.65  # inches beside the panels: names of levels and of the factor; the colour bar
STACKED_HEIGHT, SMALLEST_CELL = 0.42, 0.34  # inches, on a sheet with a width: of three lines of text, and of "100.0"
LARGE, SMALL = 7.5, 5.2  # points: the rate in a cell, its interval
TITLE_HEIGHT = 0.6  # inches of a panel's title and names of levels
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


def with_content(rows, names, quantities):
    """({quantity: names of the estimators with a panel}, [(quantity, those without)]): all cells of a panel that is left out
    are exactly zero. Where no panel had content the first keeps its own."""
    shown, left_out = {}, {}
    for quantity in quantities:
        values = {name: rows.value[(rows.quantity == quantity) & (rows.estimator == name)] for name in names}
        left_out[quantity] = [name for name in names if (values[name] == 0).all()]
        shown[quantity] = [name for name in names if name not in left_out[quantity]]
    if not any(shown.values()):
        shown[quantities[0]], left_out[quantities[0]] = names[:1], names[1:]
    return ({quantity: with_panel for quantity, with_panel in shown.items() if with_panel},
            [(quantity, without) for quantity, without in left_out.items() if without])


def without_content_in_words(rows, quantity, names, labels):
    """'No-candidate rate of Standard and pRCME: 0 in every cell, at most 0.9 %'."""
    upper = rows.upper[(rows.quantity == quantity) & rows.estimator.isin(names)].max()
    return f"{title_of(quantity)} of {listed([labels[name] for name in names])}: 0 in every cell, at most {100 * upper:.2g} %"


def size_of_panels(num_panels, x_levels, y_levels):
    """(width of a panel, its height, how many stand side by side)."""
    paper_width = sheet.current().width
    if paper_width is None:
        width = max(1.5, CELL_WIDTH * x_levels)
        return width, CELL_HEIGHT * y_levels, max(1, min(num_panels, int((WIDEST - 1.6) // (width + 0.1))))
    width, columns = fitted(paper_width, num_panels, x_levels)
    return width, (CELL_HEIGHT if has_room_for_interval(width / x_levels) else STACKED_HEIGHT) * y_levels, columns


def pages_of(shown, columns, height):
    """`shown` in parts whose panels, with so many columns and of that height, fit on a page; on a sheet without a width all of
    it. A quantity that fits on a page is not split."""
    most = MAX_PANELS if sheet.current().width is None else max(1, int(style.TALLEST / (height + TITLE_HEIGHT)))
    pages, lines = [{}], 0
    for quantity, names in shown.items():
        for first in range(0, len(names), most * columns):
            part = names[first:first + most * columns]
            added = -(-len(part) // columns)
            if lines and lines + added > most:
                pages.append({})
                lines = 0
            pages[-1][quantity] = part
            lines += added
    return pages


def grid_of(counts, width, height, columns):
    """(figure, panels, colour bars): a row of panels per quantity, or several where one would be too wide. `counts` has the
    number of estimators of each quantity, `panels` one list per quantity, estimators in order; `colour bars` the axes at the
    right of each of its rows."""
    paper_width = sheet.current().width
    lines = [-(-count // columns) for count in counts]
    rows, firsts = sum(lines), [sum(lines[:q]) for q in range(len(lines))]
    figure = Figure(figsize=(paper_width or 1.4 + columns * (width + 0.1),
                             (0.9 if paper_width is None else 0.25) + rows * (height + TITLE_HEIGHT)), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, columns + 1, squeeze=False, gridspec_kw={"width_ratios": [width] * columns + [0.13]})
    panels = [list(axes[first:first + count, :-1].flat) for first, count in zip(firsts, lines)]
    for unused in itertools.chain(*(of_quantity[count:] for of_quantity, count in zip(panels, counts))):
        unused.set_visible(False)
    return figure, panels, [list(axes[first:first + count, -1]) for first, count in zip(firsts, lines)]


def has_room_for_interval(cell_width):
    """Whether "[10.1, 14.8]" fits on one line of a cell."""
    return cell_width > width_of("[10.1, 14.8]", style.font_size(SMALL))


def fitted(paper_width, num_panels, x_levels):
    """(width of a panel, how many stand side by side) on a sheet of that width."""
    room = paper_width - LABELS_WIDTH - BAR_WIDTH
    if room < SMALLEST_CELL * x_levels:
        raise PlotError(f"--width {paper_width:g}: {x_levels} levels side by side need "
                        f"{LABELS_WIDTH + BAR_WIDTH + SMALLEST_CELL * x_levels:.1f} inches; put the factor with fewer levels "
                        "on --x, or draw some levels with --where.")
    columns = max(1, min(num_panels, int(room // max(1.5, CELL_WIDTH * x_levels))))
    return room / columns, columns


def luminance(color):
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]


def text_color(color):
    """Readable on that colour."""
    return "white" if luminance(color) < 0.5 else "black"


def in_per_cent(fraction):
    return f"{100 * fraction:.1f}"


def draw_cell(axes, left, bottom, row, scale, has_room_for_interval=True):
    """A coloured cell with its rate (%) and, in small print, its interval; hatched where there are no trials."""
    box = dict(linewidth=0.8, edgecolor="white")
    if row.value != row.value:
        axes.fill_between([left, left + 1], bottom, bottom + 1, facecolor="0.93", hatch="///", **{**box, "edgecolor": "0.7"})
        axes.text(left + 0.5, bottom + 0.5, "n = 0", ha="center", va="center", fontsize=style.font_size(5.6), color="0.3")
        return
    color = COLORS(scale(row.value))
    text = dict(ha="center", va="center", color=text_color(color))
    axes.fill_between([left, left + 1], bottom, bottom + 1, facecolor=color, **box)
    value, lower, upper = map(in_per_cent, (row.value, row.lower, row.upper))
    large, small = style.font_size(LARGE), style.font_size(SMALL)
    if has_room_for_interval:
        axes.text(left + 0.5, bottom + 0.64, value, fontsize=large, **text)
        axes.text(left + 0.5, bottom + 0.25, f"[{lower}, {upper}]", fontsize=small, **text)
    else:  # its ends above and below the rate
        axes.text(left + 0.5, bottom + 0.5, value, fontsize=large, fontweight="bold", **text)
        axes.text(left + 0.5, bottom + 0.82, upper, fontsize=small, **text)
        axes.text(left + 0.5, bottom + 0.18, lower, fontsize=small, **text)


def draw_panel(axes, rows, x_axis, y_axis, scale, cell_width=None):
    """One estimator's cells; both factors in the order of the study, from the lower left. `cell_width`: inches, on a sheet
    with a width."""
    is_roomy = cell_width is None or has_room_for_interval(cell_width)
    for row in rows.itertuples():
        draw_cell(axes, x_axis.levels.index(row.x), y_axis.levels.index(row.y), row, scale, is_roomy)
    axes.set(xlim=(0, len(x_axis.levels)), ylim=(0, len(y_axis.levels)))
    x_names, y_names = (list(map(style.level_text, each.levels)) for each in (x_axis, y_axis))
    is_long = (max(map(len, x_names)) > LONGEST_LEVEL_NAME if cell_width is None else
               max(width_of(name, 7) for name in x_names) > cell_width - 0.04)
    axes.set_xticks([0.5 + i for i in range(len(x_names))], x_names, rotation=25 if is_long else 0,
                    ha="right" if is_long else "center")
    axes.set_yticks([0.5 + i for i in range(len(y_names))], y_names)
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


def draw_pages(summary, x, y, quantities, estimators=()):
    """The figures: a row of panels per quantity, a panel per estimator that has it anywhere."""
    rows, x_axis, y_axis = select(summary, x, y, quantities)
    names = chosen_estimators(summary, rows, estimators)
    rows = rows[rows.estimator.isin(names)].assign(x=rows[x], y=rows[y])
    if len(names) * len(quantities) > MAX_PANELS:
        raise PlotError(f"{len(names)} estimators and {len(quantities)} quantities need more than {MAX_PANELS} panels; "
                        "choose some with --estimators or --quantities.")
    shown, left_out = with_content(rows, names, quantities)
    labels = {name: style.label_of(name) for name in names}
    width, height, columns = size_of_panels(max(map(len, shown.values())), len(x_axis.levels), len(y_axis.levels))
    cell_width = None if sheet.current().width is None else width / len(x_axis.levels)
    others = [factor for factor in summary.factors if factor not in (x, y)]
    caption = "; ".join(
        [f"Study {rows.study.iloc[0]}", *fixed_levels(rows, others), n_in_words(rows, "cell"),
         f"in each cell the {kind_in_words(rows).lower()} in %, " + (
             "below it" if cell_width is None or has_room_for_interval(cell_width) else "above and below it the ends of") +
         f" its {interval_in_words(rows)} interval", *sharpness_in_words(summary, quantities),
         *(without_content_in_words(rows, quantity, without, labels) for quantity, without in left_out)]) + "."
    figures = []
    for page in pages_of(shown, columns, height):
        counts = list(map(len, page.values()))
        letters = style.letters(sum(counts))
        figure, panels, bars = grid_of(counts, width, height, columns)
        for (quantity, with_panel), of_quantity, bars_of_quantity in zip(page.items(), panels, bars):
            drawn = rows[rows.quantity == quantity]
            scale = scale_of(drawn)
            for axes, name in zip(of_quantity, with_panel):
                draw_panel(axes, drawn[drawn.estimator == name], x_axis, y_axis, scale, cell_width)
                title = f"{next(letters)}{title_of(quantity)}, {labels[name]}"
                axes.set_title("\n".join(wrap(title, width, 7.5)), fontsize=7.5)
            draw_color_bars(figure, bars_of_quantity, scale, f"{kind_in_words(drawn)} (%)")
            name_axes(of_quantity, len(of_quantity) // len(bars_of_quantity), x, y)
        style.add_legend_and_caption(figure, [], caption)
        figures.append(figure)
    return figures


def name_axes(of_quantity, columns, x, y):
    """The factors' names at the left of the first column and below the panels that have none beneath them."""
    shown = [axes for axes in of_quantity if axes.get_visible()]
    for axes in shown[::columns]:
        axes.set_ylabel(style.in_words(y))
    for axes in shown[-columns:]:
        axes.set_xlabel(style.in_words(x))
