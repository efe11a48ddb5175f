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
from matplotlib.transforms import ScaledTranslation

from common import direct_labels, sheet, style
from common.command_line import FigureParser, PlotError, draw_figure
from common.regular_file import read_bytes

EXAMPLE = """
example:
  rcme plot validation validation/validation.json --out validation
draws validation.png and validation.pdf.
"""
FORMAT = "rcme validation 3"
PARTS = ("tests", "correlations", "camera_faults")  # tables with a column `set`
CAPTION = ("In brackets: pairs of the scene; bars: intervals; grey: what counts as nominal; correlation of neighbouring residuals "
           "minus that of the simulated twin; camera faults over what is nominal (below 1), linear up to there; farther than "
           "{farthest} at the edge.")
SETS = {"kitti00": "KITTI 00", "kitti01": "KITTI 01", "kittiraw0928_stereo": "KITTI raw 09-28, stereo",
        "middlebury_temple": "Middlebury Temple", "strecha_castle": "Strecha Castle", "strecha_fountain": "Strecha Fountain",
        "tum_fr1_rpy": "TUM fr1 rpy", "tum_fr1_xyz": "TUM fr1 xyz"}  # others: their name in words
TESTS = {"spatial_halves": "halves of the image", "random_halves": "random halves", "closure": "rotations around loops",
         "directions": "directions around three", "simulation": "simulated twins"}
FAULTS = {"focal_length": "focal length", "principal_point_x": "principal point, x", "principal_point_y": "principal point, y",
          "image2_shift_x": "second image shifted, x", "image2_shift_y": "second image shifted, y"}  # others: their name in words
FARTHEST_FAULT, EDGE = 300, 500  # of what is nominal: farther says nothing, and stands between it and the edge
FAULT_COLOR = "0.3"
LEGEND_SIZE, LEGEND_GAP = 7.5, 0.48  # points; inches below a panel, for its axis
TWO_COLUMNS = 4.5  # inches of a figure whose legends have room for two
COLORS = {"holds": style.GREEN, "too small": style.VERMILLION, "too large": style.BLUE, "undecided": "0.45"}
SIDE_BY_SIDE = 10  # inches that the three panels need beside each other


MARKERS = ("o", "D", "^", "H", "P", "X", "v", "s", "<", ">", "d", "p", "8", "h")


def mark(label, marker, color, **look):
    return Line2D([], [], linestyle="none", marker=marker, color=color, label=label, **look)


def name_of_set(name):
    return sheet.current().text_of(name, SETS.get(name, name.replace("_", " ")))


def markers_by_name(sets, key, name):
    """{name: marker} of the tests or faults of all sets."""
    names = list(dict.fromkeys(entry[name] for one_set in sets for entry in one_set[key]))
    return {name: MARKERS[place % len(MARKERS)] for place, name in enumerate(names)}


def row_height(markers):
    """Of one test or fault of a set, whose rows are 1 apart."""
    return 0.8 / max(len(markers), 4)


def add_legend_below(axes, handles):
    """A panel's own, below the name of its axis."""
    columns = 2 if axes.figure.get_figwidth() >= TWO_COLUMNS else 1
    place = axes.transAxes + ScaledTranslation(0, -LEGEND_GAP, axes.figure.dpi_scale_trans)
    style.draw_legend(axes, handles, loc="upper left", bbox_to_anchor=(0, 0), bbox_transform=place, ncols=columns, borderaxespad=0,
                      fontsize=style.font_size(LEGEND_SIZE), handlelength=1.2, borderpad=0)


def drawn_tests(one_set):
    """The tests of a scene that have a ratio."""
    return [test for test in one_set["tests"] if test["ratio"] is not None]


def number_log_axis(axes):
    """A logarithmic axis whose ticks are plain numbers, over many decades the powers of ten."""
    axes.set_xscale("log")
    low, high = axes.get_xlim()
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 50 * low else (1,), numticks=9))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def draw_ratios(axes, sets):
    nominal = axes.nominal
    axes.axvspan(1 / nominal, nominal, color="0.92", zorder=0)
    axes.axvline(1, color="0.6", linewidth=0.8, zorder=1)
    markers = markers_by_name(sets, "tests", "test")
    for row, one_set in enumerate(sets):
        for number, test in enumerate(drawn_tests(one_set)):
            y = row + row_height(markers) * (number - (len(markers) - 1) / 2)
            lower, upper = (x if x is not None and x > 0 else test["ratio"] for x in test["ratio_interval"])
            color = COLORS.get(test["verdict"], "0.45")
            axes.plot([lower, upper], [y, y], color=color, linewidth=1.6)
            axes.plot([test["ratio"]], [y], marker=markers[test["test"]], color=color, markersize=4.5)
    number_log_axis(axes)
    axes.set_yticks(range(len(sets)), [f"{name_of_set(s['set'])} ({s['pairs']})" for s in sets])
    axes.set_ylim(len(sets) - 0.5, -0.5)
    axes.set_xlabel("covariances too small by, in variance")
    add_legend_below(axes, [mark(in_words(name, TESTS), marker, COLORS["undecided"]) for name, marker in markers.items()] + [
        mark(f"covariance {verdict}" if verdict != "undecided" else verdict, "_", color, markersize=9, markeredgewidth=1.6)
        for verdict, color in COLORS.items()])


def in_words(name, words):
    return words.get(name, name.replace("_", " "))


def beyond_at_edge(multiple):
    """Where an end of an interval is drawn."""
    return multiple if abs(multiple) <= FARTHEST_FAULT else math.copysign(EDGE, multiple)


def has_faults(one_set):
    return any(is_known(fault) for fault in one_set["camera_faults"])


def is_known(fault):
    return fault["beside_others"] is not None and fault["beside_others_interval"][0] is not None


def draw_faults(axes, sets):
    """Each fault with its interval, as multiples of what is nominal; hollow where it is undecided. Sets without a fault that
    could be measured are left out."""
    sets, markers = [one_set for one_set in sets if has_faults(one_set)], markers_by_name(sets, "camera_faults", "fault")
    axes.axvspan(-1, 1, color="0.92", zorder=0)
    axes.axvline(0, color="0.6", linewidth=0.8, zorder=1)
    for row, one_set in enumerate(sets):
        for number, fault in enumerate(one_set["camera_faults"]):
            if not is_known(fault):
                continue
            value, *ends = (x / fault["nominal"] for x in (fault["beside_others"], *fault["beside_others_interval"]))
            y = row + row_height(markers) * (number - (len(markers) - 1) / 2)
            axes.plot(list(map(beyond_at_edge, ends)), [y, y], color=FAULT_COLOR, linewidth=0.8)
            axes.plot([min(max(value, -FARTHEST_FAULT), FARTHEST_FAULT)], [y], marker=markers[fault["fault"]], color=FAULT_COLOR,
                      markersize=4.4, markeredgewidth=0.9, clip_on=False, linestyle="none",
                      markerfacecolor="white" if fault["verdict"] == "undecided" else FAULT_COLOR)
    axes.set_xscale("symlog", linthresh=1, linscale=0.6)
    axes.set_xlim(-EDGE, EDGE)
    axes.set_xticks([-100, -10, -1, 0, 1, 10, 100] if sheet.current().width is None else [-100, -1, 1, 100])
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_yticks(range(len(sets)), [name_of_set(s["set"]) for s in sets])
    axes.set_ylim(len(sets) - 0.5, -0.5)
    axes.set_xlabel("camera faults over nominal")
    add_legend_below(axes, [mark(in_words(name, FAULTS), marker, FAULT_COLOR) for name, marker in markers.items()] + [
        mark("hollow: undecided", "o", FAULT_COLOR, markerfacecolor="white")])


def draw_correlations(axes, sets):
    """Where the sets' lines end, for their names. Their colours are no verdict's."""
    axes.axhline(0, color="0.6", linewidth=0.8)
    looks, ends = style.looks_of([one_set["set"] for one_set in sets], (style.GREEN, style.VERMILLION, style.BLUE)), []
    for number, one_set in enumerate(sets):
        look, known = looks[one_set["set"]], [c for c in one_set["correlations"] if c["difference_interval"][0] is not None]
        if not known:
            continue
        x = [math.sqrt(max(c["from_px"], 0.25) * c["to_px"]) * 1.03 ** number for c in known]
        y = [c["correlation"] - c["twin_correlation"] for c in known]
        axes.vlines(x, *zip(*(c["difference_interval"] for c in known)), color=look.color, linewidth=0.9)
        axes.plot(x, y, **{**look.line(), "linewidth": 0.9, "markersize": 4})
        ends.append(direct_labels.End(x[-1], y[-1], name_of_set(one_set["set"]), look.text_color, look.is_highlighted))
    number_log_axis(axes)
    axes.set_xlabel("distance of key points, px")
    axes.set_ylabel("correlation of residuals")
    return ends


def sets_with_parts(validation):
    """The rows of the table of sets, each with the rows of its parts."""
    return [one_set | {part: [row for row in validation[part] if row["set"] == one_set["set"]] for part in PARTS}
            for one_set in validation["sets"]]


def draw(validation):
    sets = sets_with_parts(validation)
    width, height = sheet.current().width or 13, 2.2 + 0.45 * len(sets)
    heights = [height, 2.6, height] if any(map(has_faults, sets)) else [height, 2.6]
    if width < SIDE_BY_SIDE:
        figure = Figure(figsize=(width, sum(heights)), layout="constrained")
        ratios, correlations, *faults = figure.subplots(len(heights), 1, height_ratios=heights)
    else:
        figure = Figure(figsize=(width, height), layout="constrained")
        ratios, correlations, *faults = figure.subplots(1, len(heights))
    FigureCanvasAgg(figure)
    ratios.nominal = validation["nominal_variance"]
    draw_ratios(ratios, sets)
    ends = draw_correlations(correlations, sets)
    for axes in faults:
        draw_faults(axes, sets)
    for letter, axes, title in zip(style.letters(3), (ratios, correlations, *faults),
                                   ("Stated covariances", "Neighbouring residuals", "Camera")):
        axes.set_title(letter + title)
    style.add_legend_and_caption(figure, [], CAPTION.format(farthest=FARTHEST_FAULT))
    direct_labels.add(correlations, ends)
    return figure


def read_validation(path):
    content = read_bytes(path)
    try:
        validation = json.loads(content.decode())
    except (ValueError, RecursionError) as error:
        raise PlotError(f"{path}: is no JSON: {error}.") from error
    if not isinstance(validation, dict) or validation.get("format") != FORMAT or not validation.get("sets"):
        raise PlotError(f"{path}: is not what `rcme validate --out` writes (format '{FORMAT}', at least one set).")
    return validation


def draw_file(options):
    try:
        return draw(read_validation(options.validation))
    except (KeyError, TypeError, IndexError, AttributeError) as error:
        raise PlotError(f"{options.validation}: is not a whole file of `rcme validate --out` ({error!r}).") from error


def parse(arguments):
    parser = FigureParser(prog="rcme plot validation", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("validation", metavar="VALIDATION.json", help="of `rcme validate --out`")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    return parser.parse_args(arguments)


def main(arguments=None):
    return draw_figure("validation.py", parse, draw_file, arguments)


if __name__ == "__main__":
    sys.exit(main())
