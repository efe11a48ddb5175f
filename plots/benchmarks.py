#!/usr/bin/python3
"""Draws what `rcme_ratios` measured: time of each stage and estimator, and cost against n, N and the number of trials.

It draws what the file says: medians over interleaved rounds with their intervals, and the fitted slopes.
"""

import json
import sys

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullFormatter

from common import sheet, style
from common.command_line import FigureParser, PlotError, draw_figure
from common.regular_file import read_bytes
from common.text_size import fill

LOOKS = {  # the second part of a case's name, or its group
    "fast": dict(color=style.BLACK, marker="o"),
    "reference": dict(color="0.6", marker="s"),
    "peer": dict(color="0.35", marker="D"),
    "only": dict(color=style.BLACK, marker="o"),
}  # grey: a colour is an estimator's
HANDLES = {"fast": "rcme", "reference": "its simple reference", "peer": "other libraries"}
LABELS = {"opencv_ransac_200": "OpenCV RANSAC, 200", "opencv_usac_magsac": "OpenCV USAC_MAGSAC",
          "opencv_usac_accurate": "OpenCV USAC_ACCURATE", "poselib_relative_pose": "PoseLib relative pose",
          "rcme_calibrated_half_wrong": "RCME, calibrated, half of the matches wrong",
          "linearize_sampson_squared": "Linearize squared Sampson error",
          "linearize_sampson_cauchy": "Linearize Sampson error, Cauchy",
          **{name: label for name, (label, _) in style.KNOWN.items()}}
NAME_WIDTH = 1.5  # inches
SERIES = {  # panel: x label, and its series with labels
    "n": ("Matches n", {"n": "pRCME, whole call", "n_scoring": "its scoring"}),
    "iterations": ("Hypotheses N", {"iterations": "pRCME, whole call"}),
    "trials": ("Trials of a study", {"trials": "rcme, all cores"}),
}
PRCME = style.looks_of(["prcme"])["prcme"].color
SERIES_LOOKS = {"n": dict(color=PRCME, marker="o"), "n_scoring": dict(color="0.6", marker="s"),
                "iterations": dict(color=PRCME, marker="o"), "trials": dict(color=style.BLACK, marker="o")}

EXAMPLE = """
example:
  build/release/bin/rcme_ratios --out build/benchmarks.json
  rcme plot benchmarks build/benchmarks.json --out build/benchmarks
draws build/benchmarks.png and build/benchmarks.pdf. scripts/benchmark does both.
"""


def read(path):
    try:
        content = json.loads(read_bytes(path).decode())
    except (ValueError, RecursionError) as error:
        raise PlotError(f"{path}: cannot be read as JSON ({error}).") from error
    missing = [key for key in ("run", "ratios", "cases", "series") if key not in content]
    if missing:
        raise PlotError(f"{path}: has no {', '.join(missing)}; expected the output of rcme_ratios.")
    return content


def rows_of(cases, groups):
    """{label: {variant: microseconds}} of the cases in the groups, in the file's order."""
    rows = {}
    for case in cases:
        if case["group"] in groups:
            stage, _, variant = case["name"].partition("/")
            variant = variant or ("peer" if case["group"] == "peer" else "only")
            label = LABELS.get(stage) or style.in_words(stage)
            rows.setdefault(label, {})[variant] = case["microseconds"]
    return rows


def draw_times(axes, rows):
    """One line per stage, top down; fast and reference on the same line."""
    for y, variants in enumerate(rows.values()):
        for variant, time in variants.items():
            axes.hlines(y, time["lower"], time["upper"], color=LOOKS[variant]["color"], linewidth=1.2)
            axes.plot(time["median"], y, linestyle="none", markersize=4, markeredgecolor="white", markeredgewidth=0.4,
                      **LOOKS[variant])
    axes.set_xscale("log")
    size = style.font_size(6.5)
    axes.set_yticks(range(len(rows)), ["\n".join(fill(label, NAME_WIDTH, size)) for label in rows])
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.tick_params(axis="y", labelsize=size, length=0)
    axes.xaxis.set_major_formatter(FuncFormatter(in_time))
    axes.xaxis.set_minor_formatter(NullFormatter())


def in_time(microseconds, _=None):
    """0.5 -> '0.5 us', 3000 -> '3 ms'."""
    for unit, size in (("s", 1e6), ("ms", 1e3)):
        if microseconds >= size:
            return f"{microseconds / size:g} {unit}"
    return f"{microseconds:g} \u00b5s"


def draw_series(axes, content, panel):
    """Points with intervals, and the fitted slope through their middle."""
    label, series = SERIES[panel]
    for name, words in series.items():
        look = SERIES_LOOKS[name]
        points = content["series"][name]
        sizes, medians = [point["size"] for point in points], [point["median"] for point in points]
        axes.vlines(sizes, [point["lower"] for point in points], [point["upper"] for point in points],
                    color=look["color"], linewidth=0.9)
        axes.plot(sizes, medians, linestyle="none", markersize=4, markeredgecolor="white", markeredgewidth=0.4, **look)
        slope = content["ratios"][f"exponent_{name}"]
        middle_x = geometric_mean(sizes)
        line = [geometric_mean(medians) * (size / middle_x) ** slope for size in (sizes[0], sizes[-1])]
        axes.plot([sizes[0], sizes[-1]], line, color=look["color"], linewidth=0.8, label=f"{words}: slope {slope:.2f}")
    axes.set(xscale="log", yscale="log", xlabel=label)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda size, _: f"{size:,g}"))
    axes.yaxis.set_major_formatter(FuncFormatter(in_time))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.legend(loc="upper left", fontsize=style.font_size(6.5), handlelength=1.4, borderaxespad=0.1)


def geometric_mean(values):
    product = 1.0
    for value in values:
        product *= value ** (1 / len(values))
    return product


def new_figure():
    """(figure, {panel: axes}): two wide panels above the series; below each other where the sheet is narrow."""
    names, width = ("stages", "estimators", *SERIES), sheet.current().width
    if style.panels_abreast(3) < 3:
        heights = (4.4, 3.0, *(2.0,) * len(SERIES))
        figure = Figure(figsize=(width, sum(heights)), layout="constrained")
        cells = figure.add_gridspec(len(names), 1, height_ratios=heights)
        return figure, {name: figure.add_subplot(cell) for name, cell in zip(names, cells)}
    figure = Figure(figsize=(width or 7.4, 7.4), layout="constrained")
    wide, narrow = figure.add_gridspec(2, 1, height_ratios=(2.1, 1))
    cells = [*wide.subgridspec(1, 2), *narrow.subgridspec(1, len(SERIES))]
    return figure, {name: figure.add_subplot(cell) for name, cell in zip(names, cells)}


def draw(content):
    figure, axes = new_figure()
    FigureCanvasAgg(figure)
    draw_times(axes["stages"], rows_of(content["cases"], ["stage"]))
    draw_times(axes["estimators"], rows_of(content["cases"], ["estimator", "peer", "trial"]))
    for panel in SERIES:
        draw_series(axes[panel], content, panel)
    titles = {"stages": "Stages (200 hypotheses)", "estimators": "Whole calls", "n": "Cost against n",
              "iterations": "Cost against N", "trials": "Cost against trials"}
    for letter, (name, title) in zip("abcde", titles.items()):
        axes[name].set_title(f"({letter}) {title}")
    for name in ("stages", "estimators"):
        axes[name].set_xlabel("Time")
    handles = [Line2D([], [], linestyle="none", label=words, **LOOKS[variant]) for variant, words in HANDLES.items()]
    run = content["run"]
    style.add_legend_and_caption(
        figure, handles,
        f"{run['problem']}; medians of {run['rounds']} interleaved rounds with distribution-free 95 % intervals; "
        f"{run['clock']}; {run['instruction_set']}, {run['cores']} cores.")
    return figure


def parse(arguments):
    parser = FigureParser(prog="rcme plot benchmarks", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("result", help="what rcme_ratios wrote")
    parser.add_argument("--out", required=True, help="path of the figure without .png or .pdf")
    return parser.parse_args(arguments)


def main(arguments=None):
    return draw_figure("benchmarks.py", parse, lambda options: draw(read(options.result)), arguments)


if __name__ == "__main__":
    sys.exit(main())
