"""One row for each quantity of a gate: its values in words, and below them the change and its interval in margins."""

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullLocator

from common import sheet, style
from common.text_size import fill, height_of
from gate_figure.gate_file import NOT_MEASURED

WORDS = {"failure": "failures", "refusal": "refusals", "miscoverage": "truths outside of the region",
         "probability": "Brier score of the probability", "error": "error", "time": "time"}
LIMIT = "_at_most"  # ends the name of a rate that is compared with a limit
RATIOS = ("error", "time")  # whose change is a ratio
LOOKS = {"worse": (style.VERMILLION, "s"), "not worse": (style.BLUE, "o"), "undecided": ("0.35", "D"), NOT_MEASURED: ("0.35", "")}
MARGIN = dict(color="0.2", linewidth=0.9, linestyle=style.DASHED)
TICKS = (-100, -10, -1, 0, 1, 10, 100)
SIZE = 7.0  # points
WIDTH = 5.0  # inches, on a sheet without a width
ROW_GAP, INTERVAL_HEIGHT, AXIS_HEIGHT = 0.07, 0.17, 0.45  # inches


def signed(value):
    return f"{100 * value:+.3g}".replace("-", "\u2212")


def row_in_words(test):
    """'failures +1.2 [+0.3, +2.1] points, margin +0.5'"""
    has_limit = test.quantity.endswith(LIMIT)
    quantity = test.quantity.removesuffix(LIMIT)
    name = sheet.current().text_of(test.quantity, WORDS.get(quantity, quantity.replace("_", " ")))
    unit = "%" if has_limit or quantity in RATIOS else "points"
    margin = f"limit {100 * test.margin:.3g}" if has_limit else f"margin {signed(test.margin)}"
    if test.change is None:
        return f"{name}: {margin} {unit}"
    change, lower, upper = map((lambda value: f"{100 * value:.3g}") if has_limit else signed, (test.change, *test.interval))
    return f"{name}: {change} [{lower}, {upper}] {unit}, {margin}"


def draw_row(axes, test, middle):
    color, marker = LOOKS[test.verdict]
    axes.text(1.02, middle, test.verdict, transform=axes.get_yaxis_transform(), va="center", fontsize=style.font_size(SIZE), color=color)
    if test.change is None:
        return
    change, lower, upper = (value / test.margin for value in (test.change, *test.interval))
    axes.plot([lower, upper], [middle, middle], color=color, linewidth=1.4, solid_capstyle="butt", label="_interval")
    axes.plot([change], [middle], marker, color=color, markersize=4.5, label="_change")


def draw_rows(axes, tests, width):
    """Each row as high as its words need; y is in inches, downwards. Returns the height."""
    size, top = style.font_size(SIZE), ROW_GAP
    for test in tests:
        lines = fill(row_in_words(test), width, size)
        text = axes.text(0, top, "\n".join(lines), transform=axes.get_yaxis_transform(), va="top", fontsize=size, linespacing=1.2,
                         bbox=dict(facecolor="white", linewidth=0, pad=0.8))  # no line goes through it
        text.set_in_layout(False)  # it may reach above the verdict
        top += height_of(len(lines), size)
        draw_row(axes, test, top + INTERVAL_HEIGHT / 2)
        top += INTERVAL_HEIGHT + ROW_GAP
    return top


def is_limit(gate):
    return not gate.old


def label_axis(axes, gate):
    tests = gate.tests
    ends = [end / test.margin for test in tests if test.change is not None for end in test.interval]
    if is_limit(gate):
        axes.set_xlim(0, 1.15 * max(1, *ends))
    else:
        axes.set_xscale("symlog", linthresh=1, linscale=0.7)
        axes.set_xlim(1.3 * min(-1.2, *ends), 1.3 * max(1.5, *ends))
        axes.set_xticks([tick for tick in TICKS if axes.get_xlim()[0] <= tick <= axes.get_xlim()[1]])
        axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}".replace("-", "\u2212")))
    axes.tick_params(labelsize=7)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.set_xlabel("Rate, in limits" if is_limit(gate) else "Change, in margins (right: worse)")


def caption_of(gate):
    new, pairs = style.label_of(gate.new), sorted({test.pairs for test in gate.tests if test.change is not None})
    versions = new if is_limit(gate) else f"{new} against {style.label_of(gate.old)}"
    counts = " to ".join(f"{count}" for count in dict.fromkeys((pairs[0], pairs[-1])))
    parts = [f"{versions} on study {gate.study}, {gate.rounds} trials in each of {gate.conditions} conditions (n = {counts})",
             f"{gate.verdict}, at level {100 * gate.level:g} % for all quantities together",
             f"bars: intervals of one quantity that hold at every look, each end with {100 - 100 * gate.level:g} %"]
    if not is_limit(gate):
        parts += ["linear up to one margin, then logarithmic", "points are percentage points"]
    if any(test.quantity in RATIOS for test in gate.tests):
        parts.append("error and time are ratios of new over old, less 1")
    return "; ".join(parts) + "."


def draw(gate):
    """The whole figure."""
    width = sheet.current().width or WIDTH
    figure = Figure(figsize=(width, 1), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    height = draw_rows(axes, gate.tests, width - 0.25)
    axes.set_ylim(height, 0)
    label_axis(axes, gate)
    limit = Line2D([], [], label="limit" if is_limit(gate) else "margin", **MARGIN)
    axes.axvline(0, color="0.6", linewidth=0.8, zorder=1, label="_zero")
    axes.axvline(1, zorder=1, **{**MARGIN, "label": "_margin"})
    figure.set_size_inches(width, height + AXIS_HEIGHT + (0 if sheet.current().width else 0.9))
    style.add_legend_and_caption(figure, [limit], caption_of(gate))
    return figure
