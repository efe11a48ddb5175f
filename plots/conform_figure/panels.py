"""Two panels with a row for each kind of region: its coverage, and its size; each of all answers and of the hardest quarter."""

import math

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from common import sheet, style

PARTS = (("all answers", style.BLUE, "o"), ("hardest quarter", style.VERMILLION, "s"))
APART = 0.16  # rows, of the two marks of a region from its middle
LEVEL = dict(color="0.2", linewidth=0.9, linestyle=style.DASHED)
GREATEST_DEG = 180
ROW_HEIGHT, AXIS_HEIGHT = 0.34, 0.75  # inches, of a region and of what is around a panel


def marks(color, marker):
    return dict(color=color, marker=marker, markersize=4.5, linestyle="none")


def draw_coverage(axes, report):
    for row, region in enumerate(report.regions):
        for sign, (value, lower, upper), (_, color, marker) in zip((-1, 1), region.shares, PARTS):
            y = row + sign * APART
            axes.plot([100 * lower, 100 * upper], [y, y], color=color, linewidth=1.4, solid_capstyle="butt", label="_interval")
            axes.plot([100 * value], [y], label="_coverage", clip_on=False, **marks(color, marker))
    axes.axvline(100 * report.level, zorder=1, **{**LEVEL, "label": "_level"})
    axes.set_xlim(0, 100)
    axes.set_xlabel("Coverage (%)")


def draw_sizes(axes, report):
    for row, region in enumerate(report.regions):
        for sign, size, (_, color, marker) in zip((-1, 1), region.sizes, PARTS):
            if size > 0 and math.isfinite(size):
                axes.plot([size], [row + sign * APART], label="_size", **marks(color, marker))
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(base=10, numticks=6))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda angle, _: f"{angle:g}"))
    axes.xaxis.set_minor_locator(NullLocator())
    sizes = [size for region in report.regions for size in region.sizes if size > 0 and math.isfinite(size)]
    axes.set_xlim(10 ** math.floor(math.log10(min(sizes, default=0.1) / 1.2)), max(GREATEST_DEG, 1.3 * max(sizes, default=1)))
    axes.set_xlabel("Size of the region (deg)")


def caption_of(report):
    parts = [f"{style.label_of(report.estimator)}, {report.origin}, {report.answers} answers",
             f"promised: {100 * report.level:g} %, also for the answers that look hardest", "bars: 95 % intervals",
             "sizes: median of the geometric mean of the semi-axes"]
    parts += [f"{region.name}: {100 * region.all_motions:.3g} % of the regions are all motions" for region in report.regions
              if region.all_motions > 0]
    return "; ".join(parts) + "."


def two_panels(rows):
    """(figure, panels): side by side, or below each other where the sheet is narrow. Each has a range of its own."""
    width, abreast, height = sheet.current().width, style.panels_abreast(2), ROW_HEIGHT * rows + AXIS_HEIGHT
    figure = Figure(figsize=(7, height + 0.8) if width is None else (width, height * (2 // abreast)), layout="constrained")
    FigureCanvasAgg(figure)
    return figure, figure.subplots(2 // abreast, abreast, squeeze=False).flat


def draw(report):
    """The whole figure."""
    figure, (coverage, sizes) = two_panels(len(report.regions))
    draw_coverage(coverage, report)
    draw_sizes(sizes, report)
    names = [sheet.current().text_of(region.name, region.name) for region in report.regions]
    for letter, panel, title in zip(style.letters(2), (coverage, sizes), ("Coverage", "Size")):
        panel.tick_params(labelsize=7)
        panel.set_yticks(range(len(names)), names)
        panel.set_ylim(len(names) - 0.5, -0.5)
        panel.set_title(letter + title)
    handles = [Line2D([], [], label=label, **marks(color, marker)) for label, color, marker in PARTS]
    style.add_legend_and_caption(figure, [*handles, Line2D([], [], label="promised", **LEVEL)], caption_of(report))
    return figure
