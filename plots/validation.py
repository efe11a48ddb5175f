#!/usr/bin/python3
"""Draws what `rcme validate` found, as PNG and PDF: for each scene by what its covariances are too small, test by test,
with the range that is nominal; beside it how alike residuals are at each distance, and what is wrong with the camera, in units of
what is nominal.
It draws what the file says and computes nothing: ratios, intervals and verdicts are those of the program.
"""

import json
import math
import sys

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from common import sheet, style
from common.command_line import FigureParser, PlotError, check_figure_path, draw_figure

EXAMPLE = """
example:
  rcme plot validation validation/validation.json --out validation
draws validation.png and validation.pdf.
"""
FORMAT = "rcme validation 2"
CAPTION = ("In brackets: pairs of the scene; bars: intervals; grey: what counts as nominal; correlation of neighbouring residuals "
           "minus that of the simulated twin; camera faults over what is nominal (below 1), linear up to there.")
TESTS = {"spatial_halves": "halves of the image", "random_halves": "random halves", "closure": "rotations around loops",
         "directions": "directions around three"}
FAULTS = {"focal_length": ("focal length", "o", "tab:blue"), "principal_point_x": ("principal point, x", "s", "tab:orange"),
          "principal_point_y": ("principal point, y", "D", "tab:olive"), "distortion": ("distortion", "^", "tab:purple"),
          "readout_time": ("readout time", "v", "tab:brown")}
FARTHEST_FAULT = 300  # of what is nominal: farther says nothing
COLORS = {"holds": "tab:green", "too small": "tab:red", "too large": "tab:purple", "undecided": "0.45"}
MARKERS = {"spatial_halves": "o", "random_halves": "s", "closure": "^", "directions": "v"}


def drawn_tests(one_set):
    """The tests of a scene that have a ratio."""
    return [test for test in one_set["tests"] if test["ratio"] is not None]


def number_log_axis(axes):
    """A logarithmic axis whose ticks are plain numbers."""
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5), numticks=6))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def draw_ratios(axes, sets):
    nominal = axes.nominal
    axes.axvspan(1 / nominal, nominal, color="0.92", zorder=0)
    axes.axvline(1, color="0.6", linewidth=0.8, zorder=1)
    for row, one_set in enumerate(sets):
        for number, test in enumerate(drawn_tests(one_set)):
            y = row + 0.2 * (number - 1)
            lower, upper = (x if x is not None and x > 0 else test["ratio"] for x in test["interval"])
            color = COLORS.get(test["verdict"], "0.45")
            axes.plot([lower, upper], [y, y], color=color, linewidth=1.6)
            axes.plot([test["ratio"]], [y], MARKERS[test["test"]], color=color, markersize=5)
    number_log_axis(axes)
    axes.set_yticks(range(len(sets)), [f"{style.label_of(s['name'])} ({s['pairs']})" for s in sets])
    axes.set_ylim(len(sets) - 0.5, -0.5)
    axes.set_xlabel("covariances too small by, in variance")
    handles = [Line2D([], [], linestyle="none", marker=MARKERS[test], color="0.45", label=words) for test, words in TESTS.items()]
    if sheet.current().width is None:
        axes.legend(handles=handles, loc="upper right", fontsize=7, frameon=False)
    return handles


def draw_faults(axes, sets):
    """Each fault with its interval, as multiples of what is nominal; hollow where it is undecided."""
    axes.axvspan(-1, 1, color="0.92", zorder=0)
    axes.axvline(0, color="0.6", linewidth=0.8, zorder=1)
    for row, one_set in enumerate(sets):
        for number, fault in enumerate(one_set["camera_faults"]):
            found = fault["beside_others"]
            if found["value"] is None or found["interval"][0] is None:
                continue
            _, marker, color = FAULTS[fault["fault"]]
            value, lower, upper = (min(max(x / fault["nominal"], -FARTHEST_FAULT), FARTHEST_FAULT)
                                   for x in (found["value"], *found["interval"]))
            y = row + 0.16 * (number - 2)
            axes.plot([lower, upper], [y, y], color=color, linewidth=1.2)
            axes.plot([value], [y], marker, color=color, markersize=4, fillstyle="none" if fault["verdict"] == "undecided" else "full")
    axes.set_xscale("symlog", linthresh=1, linscale=0.6)
    axes.set_xlim(-FARTHEST_FAULT, FARTHEST_FAULT)
    axes.set_xticks([-100, -10, -1, 0, 1, 10, 100])
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_yticks(range(len(sets)), [style.label_of(s["name"]) for s in sets])
    axes.set_ylim(len(sets) - 0.5, -0.5)
    axes.set_xlabel("camera faults over nominal")
    handles = [Line2D([], [], linestyle="none", marker=marker, color=color, label=words) for words, marker, color in FAULTS.values()]
    if sheet.current().width is None:
        axes.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, fontsize=6, frameon=False)
    return handles


def draw_correlations(axes, sets):
    axes.axhline(0, color="0.6", linewidth=0.8)
    handles = []
    for number, one_set in enumerate(sets):
        known = [c for c in one_set["correlations"] if c["difference_interval"][0] is not None]
        x = [math.sqrt(max(c["from_px"], 0.25) * c["to_px"]) * 1.03 ** number for c in known]
        y = [c["correlation"] - c["twin_correlation"] for c in known]
        error = [[max(v - c["difference_interval"][0], 0) for v, c in zip(y, known)],
                 [max(c["difference_interval"][1] - v, 0) for v, c in zip(y, known)]]
        handles.append(axes.errorbar(x, y, yerr=error, fmt="o-", markersize=3, linewidth=0.9,
                                     label=style.label_of(one_set["name"])))
    number_log_axis(axes)
    axes.set_xlabel("distance of key points, px")
    axes.set_ylabel("correlation of residuals")
    style.draw_legend(axes, handles, fontsize=style.font_size(6), frameon=False)


def draw(validation):
    sets = validation["sets"]
    width, height = sheet.current().width, 1.4 + 0.45 * len(sets)
    if width is not None and style.panels_abreast(3) < 3:
        figure = Figure(figsize=(width, 2 * height + 2.6), layout="constrained")
        ratios, correlations, faults = figure.subplots(3, 1, height_ratios=[height, 2.6, height])
    else:
        figure = Figure(figsize=(width or 13, height), layout="constrained")
        ratios, correlations, faults = figure.subplots(1, 3, width_ratios=[1.3, 1, 1.2])
    FigureCanvasAgg(figure)
    ratios.nominal = validation["nominal_variance"]
    handles = draw_ratios(ratios, sets)
    draw_correlations(correlations, sets)
    handles += draw_faults(faults, sets)
    if width is not None:
        style.add_legend_and_caption(figure, handles, CAPTION)
    return figure


def read_validation(path):
    try:
        with open(path, encoding="utf-8") as file:
            validation = json.load(file)
    except OSError as error:
        raise PlotError(f"{path}: cannot be read: {error.strerror}.") from error
    except ValueError as error:
        raise PlotError(f"{path}: is no JSON: {error}.") from error
    if not isinstance(validation, dict) or validation.get("format") != FORMAT or not validation.get("sets"):
        raise PlotError(f"{path}: is not what `rcme validate --out` writes (format '{FORMAT}', at least one set).")
    return validation


def parse(arguments):
    parser = FigureParser(prog="rcme plot validation", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("validation", metavar="VALIDATION.json", help="of `rcme validate --out`")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    options = parser.parse_args(arguments)
    check_figure_path(options.out)
    return options


def main(arguments=None):
    return draw_figure("validation.py", parse, lambda options: draw(read_validation(options.validation)), arguments)


if __name__ == "__main__":
    sys.exit(main())
