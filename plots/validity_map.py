#!/usr/bin/python3
"""Draws where first-order covariances hold: coverage of the 95 % regions over noise, number of points and baseline, or a
study's conditions.

Up to three figures, each as PNG and PDF, from the tables of `rcme map`; of a study there is no reference:
  validity_map           a coloured cell per noise level and number of points, a row of panels per quantity
  validity_conditioning  the same for the least number of points, by thirds of the sample's conditioning
  validity_reference     the same draws of noise covered by first-order, unscented and Monte-Carlo covariances
It draws what the files say and computes nothing: coverages, intervals and counts are those of the program.
"""

import itertools
import math
import os
import sys

from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from common import sheet, style
from common.command_line import FigureParser, PlotError, draw_figures, numbered
from common.summary_csv import numbers, read_table
from common.text_size import wrap

NOMINAL = 0.95
QUANTITIES = {  # name in the files: name in words
    "f": "Linear model f", "pose": "Motion p from f", "fresh_point": "Inlier test, fresh match",
    "ml_pose": "Motion p, max. likelihood",
}
DEGREES_OF_FREEDOM = {"f": 8, "pose": 5, "fresh_point": 1, "ml_pose": 5}
# Upper bound of a shade, its colour, its name (per cent). Light is right; red is too sure, blue too modest.
SHADES = ((0.50, "#7f1d06", "< 50"), (0.70, "#c2410c", "50\u201370"), (0.80, "#ea7a2c", "70\u201380"),
          (0.90, "#f8b26a", "80\u201390"), (0.94, "#fde0b5", "90\u201394"), (0.96, "#f7f7f4", "94\u201396"),
          (1.01, "#a9cfe8", "\u2265 96"))
CONTOURS = {0.94: dict(color="black", linewidth=1.6, linestyle="-"),
            0.90: dict(color="black", linewidth=1.1, linestyle=style.DASHED)}
THIRDS = {  # conditioning group: look
    "exact_lower": style.Look("without noise: worst third", style.VERMILLION, "v"),
    "exact_middle": style.Look("without noise: middle third", style.ORANGE, "s", marker_size=4.5),
    "exact_upper": style.Look("without noise: best third", style.BLUE, "^"),
    "observed_lower": style.Look("as observed: worst third", style.VERMILLION, "<", style.DOTTED),
    "observed_middle": style.Look("as observed: middle third", style.ORANGE, "d", style.DOTTED),
    "observed_upper": style.Look("as observed: best third", style.BLUE, ">", style.DOTTED),
}
COVARIANCES = {  # covariance of the second reference: look
    "first_order_at_estimate": style.Look("first order, at the estimate", style.VERMILLION, "o"),
    "first_order_at_truth": style.Look("first order, at the truth", style.ORANGE, "s"),
    "unscented_at_truth": style.Look("unscented, at the truth", style.GREEN, "^"),
    "monte_carlo_at_truth": style.Look("Monte Carlo, at the truth", style.BLUE, "D"),
}
CELL = ["sigma_px", "num_points"]
MAX_COLUMNS = 4  # conditions side by side in one figure
COUNTS = ["n", "num_covered", "coverage", "lower", "upper"]
MAP_KEYS, REFERENCE_KEYS = ["conditioning", "quantity"], ["covariance", "quantity"]

EXAMPLE = """
example:
  rcme map --out map
  rcme plot validity_map map --out figures
draws figures/validity_map.png, .pdf and the other figures; without --out beside the tables. More than four conditions of a
study go to validity_map_2 and so on.
"""


def read_coverages(path, keys, more=()):
    """The rows of one table with numbers in place of text and the condition in words; one row per cell and keys. Rows
    of cells without any sample (n = 0, no coverage) are left out."""
    table = read_table(path, [*CELL, *keys, *COUNTS, *more], "rcme map --out DIR")
    if "condition" not in table.rows:
        table = read_table(path, ["baseline_m"], "rcme map --out DIR")
        table.rows["condition"] = [f"baseline {baseline:g} m" for baseline in numbers(table, "baseline_m")]
    table.rows = table.rows[(table.rows.n != "0") | (table.rows.coverage != "")]
    if not len(table.rows):
        raise PlotError(f"{path}: no cell has a sample, so there is nothing to draw.")
    rows = table.rows.assign(**{column: numbers(table, column) for column in [*CELL, *COUNTS, *more]})
    for row in rows.itertuples():
        if not (0 <= row.lower <= row.coverage <= row.upper <= 1 and 0 <= row.num_covered <= row.n and row.n > 0):
            raise PlotError(f"{path}: line {row.line}: a coverage must lie in its interval and both in 0..1, "
                            "and n must be positive.")
        if row.sigma_px <= 0:
            raise PlotError(f"{path}: line {row.line}: sigma_px has no place on a logarithmic axis; "
                            "it must be positive.")
    repeated = rows[rows.duplicated([*CELL, "condition", *keys])]
    if len(repeated):
        row = repeated.iloc[0]
        raise PlotError(f"{path}: line {row.line}: this cell's {row.quantity} is there twice.")
    return rows


def present(path, known, column):
    """The known names that the column holds, in the order they are drawn; none is an error."""
    names = [name for name in known if name in set(column)]
    if not names:
        raise PlotError(f"{path}: column {column.name} holds none of {', '.join(known)}.")
    return names


def range_of(counts):
    low, high = int(counts.min()), int(counts.max())
    return f"{low:,}" if low == high else f"{low:,}\u2013{high:,}"


def title_of(quantity):
    return f"{QUANTITIES[quantity]}, {DEGREES_OF_FREEDOM[quantity]} dof"


def lettered_titles(axes, titles):
    for letter, panel, title in zip("abcdefghijklmnopqrstuvwxyz", axes, titles):
        panel.set_title(f"({letter}) {title}")


def shade_of(coverage):
    return next(color for bound, color, _ in SHADES if coverage < bound)


def draw_cells(axes, grid):
    """One panel: shaded cells with their coverage in per cent. `grid` holds points by rows, sigma by columns."""
    for (y, row), x in itertools.product(enumerate(grid.to_numpy()), range(grid.shape[1])):
        if row[x] == row[x]:
            axes.fill_between([x, x + 1], y, y + 1, color=shade_of(row[x]), linewidth=0)
            axes.text(x + 0.5, y + 0.47, f"{100 * row[x]:.1f}", ha="center", va="center", fontsize=style.font_size(5.8),
                      color="white" if row[x] < 0.70 else "black")
    axes.set(xlim=(0, grid.shape[1]), ylim=(0, grid.shape[0]))
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set_visible(False)
    axes.tick_params(length=0)


def draw_contour(axes, grid, level, line):
    """The borders between cells on different sides of a level: no interpolation, nothing between what was measured."""
    inside = (grid >= level).to_numpy()
    for y, x in itertools.product(range(grid.shape[0]), range(grid.shape[1])):
        if x > 0 and inside[y, x] != inside[y, x - 1]:
            axes.plot([x, x], [y, y + 1], **line, zorder=3, solid_capstyle="projecting")
        if y > 0 and inside[y, x] != inside[y - 1, x]:
            axes.plot([x, x + 1], [y, y], **line, zorder=3, solid_capstyle="projecting")


def draw_map(path, rows):
    """Quantities by rows, conditions by columns."""
    rows = rows[rows.conditioning == "all"]
    quantities, conditions = present(path, QUANTITIES, rows.quantity), conditions_of(rows)
    points, sigmas = sorted(set(rows.num_points)), sorted(set(rows.sigma_px))
    figure, panels = style.new_figure(len(quantities), len(conditions))
    width = max(4.6 / len(conditions), 1.0 + 0.2 * len(sigmas))  # of a panel, inches
    if sheet.current().width is None:
        figure.set_size_inches(width * len(conditions), 1.0 + 1.45 * len(quantities))
    for (r, quantity), (c, condition) in itertools.product(enumerate(quantities), enumerate(conditions)):
        part = rows[(rows.quantity == quantity) & (rows.condition == condition)]
        grid = part.pivot(index="num_points", columns="sigma_px", values="coverage").reindex(index=points, columns=sigmas)
        draw_cells(panels[r, c], grid)
        for level, line in CONTOURS.items():
            draw_contour(panels[r, c], grid, level, line)
        panels[r, c].xaxis.set_major_locator(FixedLocator([x + 0.5 for x in range(grid.shape[1])]))
        panels[r, c].yaxis.set_major_locator(FixedLocator([y + 0.5 for y in range(grid.shape[0])]))
        panels[r, c].set_xticklabels([f"{sigma:g}" for sigma in grid.columns])
        panels[r, c].set_yticklabels([f"{points:g}" for points in grid.index])
        panels[r, c].tick_params(labelsize=7)
        if r == 0:
            header = f"{condition}, parallax {part.median_parallax_deg.iloc[0]:.2g}\u00b0"
            panels[r, c].text(0.5, 1.2, "\n".join(wrap(header, width, 9)),
                              transform=panels[r, c].transAxes, ha="center", va="bottom")
        if panels[r, c].get_subplotspec().is_first_col():
            panels[r, c].set_ylabel("Points m")
        panels[-1, c].set_xlabel("Noise sigma (px)")
    lettered_titles(panels.flat,
                    [title_of(quantity) if c == 0 else "" for quantity in quantities for c in range(len(conditions))])
    handles = [Patch(facecolor=color, edgecolor="0.6", linewidth=0.4, label=label) for _, color, label in SHADES]
    handles += [Line2D([], [], label=f"border at {100 * level:g}", **line) for level, line in CONTOURS.items()]
    style.add_legend_and_caption(
        figure, handles,
        f"Coverage (%) of first-order {100 * NOMINAL:g} % regions, estimates from m matches by linear least squares or "
        f"maximum likelihood; n = {range_of(rows.n)} per cell; exact 95 % (Clopper-Pearson) intervals reach at most "
        f"\u00b1{half_width(rows):.1f} points from what is printed; borders are of the unrounded coverages. A sample "
        "without a model counts as not covered. Parallax: median angle at a point."
        + (" No value: too few true matches." if len(rows) < full_size(rows) else ""))
    return figure


def conditions_of(rows):
    """In the order of the file; baselines rising."""
    names = list(dict.fromkeys(rows.condition))
    return sorted(names, key=lambda name: float(name.split()[1])) if "baseline_m" in rows else names


def pages_of(rows):
    """The rows in parts of so many conditions as fit side by side and, on a sheet with a width, of so many quantities as
    fit on a page below each other."""
    names, quantities, pages = conditions_of(rows), [name for name in QUANTITIES if name in set(rows.quantity)], []
    for first in range(0, len(names), MAX_COLUMNS):
        conditions, per_page = names[first:first + MAX_COLUMNS], len(quantities)
        if sheet.current().width is not None:
            lines = math.ceil(len(conditions) / style.panels_abreast(len(conditions)))
            per_page = max(1, int(style.TALLEST / (style.PANEL_HEIGHT * lines)))
        for start in range(0, len(quantities), max(1, per_page)):
            pages.append(rows[rows.condition.isin(conditions) & rows.quantity.isin(quantities[start:start + per_page])])
    return pages


def full_size(rows):
    """How many rows there would be if every cell had a sample."""
    return len(set(rows.num_points)) * len(set(rows.sigma_px)) * len(set(rows.quantity)) * len(set(rows.condition))


def half_width(rows):
    """The farthest that an interval of the file reaches from its coverage, in percentage points."""
    return 100 * max((rows.upper - rows.coverage).max(), (rows.coverage - rows.lower).max())


def set_coverage_axis(axes):
    axes.axhline(NOMINAL, color="0.35", linewidth=0.8, zorder=1)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda fraction, _: f"{100 * fraction:g}"))


def draw_conditioning(path, rows):
    """Quantities side by side for the least number of points and the middle condition; a line per third."""
    conditions = conditions_of(rows)
    points, condition = min(rows.num_points), conditions[len(conditions) // 2]
    rows = rows[(rows.num_points == points) & (rows.condition == condition)]
    groups, quantities = present(path, THIRDS, rows.conditioning), present(path, QUANTITIES, rows.quantity)
    rows = rows[rows.conditioning.isin(groups)]
    figure, panels = style.new_figure(1, len(quantities))
    if sheet.current().width is None:
        figure.set_size_inches(max(4.6, 2.2 * len(quantities)), 3.0)
    for axes, quantity in zip(panels.flat, quantities):
        for group in groups:
            part = rows[(rows.quantity == quantity) & (rows.conditioning == group)].sort_values("sigma_px")
            axes.vlines(part.sigma_px, part.lower, part.upper, color=THIRDS[group].color, linewidth=0.8, alpha=0.6)
            axes.plot(part.sigma_px, part.coverage, **THIRDS[group].line(), zorder=3)
        set_coverage_axis(axes)
        axes.set_xscale("log")
        axes.set_xlabel("Noise sigma (px)")
        axes.xaxis.set_major_formatter(FuncFormatter(lambda sigma, _: f"{sigma:g}"))
        axes.set_ylim(min(0.9, rows.lower.min() - 0.02), 1)
    for axes in style.left_panels(panels):
        axes.set_ylabel("Coverage (%)")
    lettered_titles(panels.flat, [QUANTITIES[quantity] for quantity in quantities])
    style.add_legend_and_caption(
        figure, panels[0, 0].get_legend_handles_labels()[0],
        f"m = {points:g} points, {condition}; thirds of each cell's trials in order of the ratio of "
        "smallest to largest singular value of M A, of the sample without noise and as observed; "
        f"n = {range_of(rows.n)} per point; bars: exact 95 % (Clopper-Pearson) intervals; horizontal line: nominal.")
    return figure


def draw_reference(path, rows):
    """Quantities side by side; within each cell the covariances stand abreast."""
    quantities, covariances = present(path, QUANTITIES, rows.quantity), present(path, COVARIANCES, rows.covariance)
    cells = sorted(set(zip(rows.num_points, rows.sigma_px)))
    figure, panels = style.new_figure(1, len(quantities))
    for axes, quantity in zip(panels.flat, quantities):
        for position, covariance in enumerate(covariances):
            look, aside = COVARIANCES[covariance], 0.16 * (position - (len(covariances) - 1) / 2)
            part = rows[(rows.quantity == quantity) & (rows.covariance == covariance)]
            x = [cells.index(cell) + aside for cell in zip(part.num_points, part.sigma_px)]
            axes.vlines(x, part.lower, part.upper, color=look.color, linewidth=1.2)
            axes.plot(x, part.coverage, **{**look.line(), "linestyle": "none"}, zorder=3)
        for border in range(1, len(cells)):
            axes.axvline(border - 0.5, color="0.9", linewidth=0.6, zorder=0)
        set_coverage_axis(axes)
        axes.grid(axis="x", visible=False)
        axes.xaxis.set_minor_locator(NullLocator())
        axes.set_xticks(range(len(cells)), [f"m = {points:g}\n{sigma:g} px" for points, sigma in cells])
        axes.tick_params(axis="x", labelsize=7, length=0)
        axes.set_xlim(-0.5, len(cells) - 0.5)
        axes.set_ylim(min(0.9, rows.lower.min() - 0.03), 1)
    for axes in style.left_panels(panels):
        axes.set_ylabel("Coverage (%)")
    lettered_titles(panels.flat, [title_of(quantity) for quantity in quantities])
    style.add_legend_and_caption(
        figure, panels[0, 0].get_legend_handles_labels()[0],
        f"{', '.join(conditions_of(rows)).capitalize()}; the same fresh draws of noise for all covariances, {range_of(rows.num_samples)} fixed "
        f"samples and n = {range_of(rows.n)} draws per cell; bars: exact 95 % (Clopper-Pearson) intervals of the mean "
        "coverage over these samples; horizontal line: nominal.")
    return figure


def parse(arguments):
    parser = FigureParser(out_is_folder=True, prog="rcme plot validity_map", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("tables", metavar="DIR", help="folder that 'rcme map --out DIR' wrote")
    parser.add_argument("--out", metavar="DIR", help="folder for the figures (default: where the tables are)")
    options = parser.parse_args(arguments)
    options.out = os.path.join(options.out or options.tables, "")
    for folder in (options.tables, options.out):
        if not os.path.isdir(folder):
            raise PlotError(f"there is no folder {folder}.")
    return options


def draw_for(options):
    map_path, reference_path = (os.path.join(options.tables, name)
                                for name in ("validity_map.csv", "validity_reference.csv"))
    coverages = read_coverages(map_path, MAP_KEYS, ["median_parallax_deg"])
    figures = numbered("validity_map", [draw_map(map_path, page) for page in pages_of(coverages)])
    figures["validity_conditioning"] = draw_conditioning(map_path, coverages)
    if "baseline_m" in coverages:
        reference = read_coverages(reference_path, REFERENCE_KEYS, ["num_samples"])
        figures["validity_reference"] = draw_reference(reference_path, reference)
    return figures


def main(arguments=None):
    return draw_figures("validity_map.py", parse, draw_for, arguments, dpi=170)


if __name__ == "__main__":
    sys.exit(main())
