"""Stanford diagrams: protection level over error, both logarithmic, with the number of answers as colour."""

import math

import numpy
from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from common import sheet, style

COLORS = colormaps["cividis_r"]  # even steps to the eye, with every colour vision and in grey; dark is much
DIAGONAL = dict(color="0.2", linewidth=0.9)
LIMIT = dict(color=style.VERMILLION, linewidth=1.1, linestyle=style.DASHED)
ROOM_BELOW, ROOM_ABOVE = 150, 30  # times the alert limit that an axis reaches at least, for the names of the regions
HEIGHT = 3.0  # inches of a panel on a sheet with a width
MARGIN = 1.12  # factor between a name and the edges of its region
SIZE = 6.5  # points of a region's name
IN_WORDS = {"available": "available", "misleading": "misleading", "hazardous": "hazardously\nmisleading",
            "unavailable": "unavailable", "unavailable_misleading": "unavailable,\nmisleading"}


def ends_of(file, diagram):
    """(least, greatest) angle of both axes, deg."""
    least = min([file.edges[min(error, level)] for error, level, _ in diagram.cells], default=diagram.limit_deg)
    return min(least, diagram.limit_deg / ROOM_BELOW), max(file.edges[-1], diagram.limit_deg * ROOM_ABOVE)


def place_of(region, limit, least, greatest):
    """(x, y, alignment) of the name of a region, where few answers are and names do not meet."""
    return {"available": (least * MARGIN, limit / MARGIN, "left", "top"),
            "misleading": (limit / MARGIN, least * MARGIN, "right", "bottom"),
            "hazardous": (greatest / MARGIN, math.sqrt(least * limit), "right", "center"),
            "unavailable": (least * MARGIN, greatest / MARGIN ** 3, "left", "top"),
            "unavailable_misleading": (greatest / MARGIN, limit * MARGIN, "right", "bottom")}[region]


def share_in_words(count, trials):
    return f"{100 * count / trials:.3g} %\nn = {count}"


def draw_cells(axes, file, diagram, scale):
    counts = numpy.full((len(file.edges) - 1, len(file.edges) - 1), numpy.nan)
    for error, level, count in diagram.cells:
        counts[level, error] = count
    mesh = axes.pcolormesh(file.edges, file.edges, numpy.ma.masked_invalid(counts), cmap=COLORS, norm=scale, linewidth=0)
    mesh.set_label("_cells")


def draw_regions(axes, diagram, least, greatest):
    axes.plot([least, greatest], [least, greatest], label="_diagonal", **DIAGONAL)
    axes.plot([least, greatest], [diagram.limit_deg] * 2, label="_limit", **LIMIT)
    axes.plot([diagram.limit_deg] * 2, [least, diagram.limit_deg], label="_limit", **LIMIT)
    for region, count in diagram.regions.items():
        x, y, across, along = place_of(region, diagram.limit_deg, least, greatest)
        axes.text(x, y, f"{IN_WORDS[region]}\n{share_in_words(count, diagram.trials)}", ha=across, va=along,
                  fontsize=style.font_size(SIZE), linespacing=1.15,
                  bbox=dict(facecolor="white", alpha=0.7, linewidth=0, pad=0.8))


def draw_panel(axes, file, diagram, scale):
    least, greatest = ends_of(file, diagram)
    axes.set(xscale="log", yscale="log", xlim=(least, greatest), ylim=(least, greatest))
    draw_cells(axes, file, diagram, scale)
    draw_regions(axes, diagram, least, greatest)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(base=10, numticks=6))
        axis.set_major_formatter(FuncFormatter(lambda angle, _: f"{angle:g}"))
        axis.set_minor_locator(NullLocator())
    axes.tick_params(labelsize=7)
    axes.set(xlabel="Error (deg)", ylabel="Protection level (deg)")


def misleading_in_words(diagram):
    if not diagram.misleading:
        return f"{diagram.error}: no answers"
    value, lower, upper = (f"{100 * number:.3g}" for number in diagram.misleading)
    return f"{diagram.error}: {value} % [{lower}, {upper}] of the answers have an error beyond their level"


# As the Stanford-ESA diagram of aviation names them, of the error, the protection level and the alert limit.
DEFINITIONS = ("available: error \u2264 level \u2264 alert limit", "misleading: level < error \u2264 limit",
               "hazardously misleading: level \u2264 limit < error, no warning",
               "unavailable: limit < level, a warning, misleading if error > level; a trial without a motion has no level")


def caption_of(file):
    first = file.diagrams[0]
    parts = [f"{style.label_of(file.estimator)} on study {file.study}, {first.trials} trials, {first.without_motion} of them "
             "without a motion", f"protection levels for a risk of {100 * file.risk:g} % an answer",
             *map(misleading_in_words, file.diagrams), *DEFINITIONS, "percentages in the figure are of all trials; intervals 95 %"]
    return "; ".join(parts) + "."


def grid_of(count):
    """(figure, panels): side by side, or below each other where the sheet is narrow. Each has a range of its own."""
    width, abreast = sheet.current().width, style.panels_abreast(count)
    lines = math.ceil(count / abreast)
    figure = Figure(figsize=(3.7 * count, 4.0) if width is None else (width, HEIGHT * lines), layout="constrained")
    FigureCanvasAgg(figure)
    return figure, list(figure.subplots(lines, abreast, squeeze=False).flat)[:count]


def draw(file):
    """The whole figure: a panel for each kind of error."""
    figure, panels = grid_of(len(file.diagrams))
    greatest = max(n for diagram in file.diagrams for *_, n in diagram.cells)
    scale, letters = LogNorm(1, max(greatest, 2)), style.letters(len(file.diagrams))
    for panel, diagram in zip(panels, file.diagrams):
        draw_panel(panel, file, diagram, scale)
        panel.set_title(next(letters) + diagram.error.capitalize())
    bar = figure.colorbar(ScalarMappable(scale, COLORS), ax=panels, format=FuncFormatter(lambda n, _: f"{n:g}"), pad=0.02,
                          fraction=0.05)
    bar.set_label("Answers", fontsize=7)
    bar.ax.tick_params(labelsize=7)
    handles = [Line2D([], [], label="error = protection level", **DIAGONAL), Line2D([], [], label="alert limit", **LIMIT)]
    style.add_legend_and_caption(figure, handles, caption_of(file))
    return figure
