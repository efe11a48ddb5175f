"""Reliability diagrams with their histograms, and risk-coverage curves."""

import math

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from common import sheet, style
from common.command_line import PlotError
from rates.rate_bands import per_cent
from rates.selection import listed
from reliability_figure.reliability_file import STATED
from reliability_figure.risk_band import risk_band

MAX_DIAGRAMS = 3
TICKS = (0, 0.01, 0.05, 0.1, 0.25, 0.5, 0.75, 1)
BAND = dict(color="0.5", alpha=0.25, linewidth=0)
RISK_BAND = dict(alpha=0.15, linewidth=0)
RIGHT = dict(color="0.5", linewidth=0.8, linestyle=style.DOTTED)
BARS = dict(color="0.6", linewidth=0)


def root(value):
    return abs(value) ** 0.5


def square(value):
    return value ** 2


def of_group(file, group):
    """The entries of a group; default: of the first."""
    groups = list(dict.fromkeys(entry.group for entry in file.entries))
    if group is None:
        group = groups[0]
    elif group not in groups:
        raise PlotError(f"{file.path}: has no group '{group}'; expected one of {', '.join(map(repr, groups))}.")
    return [entry for entry in file.entries if entry.group == group]


def with_diagram(file, entries, names):
    """Those named; default: those that state probabilities, or else the first."""
    if names is None:
        return ([entry for entry in entries if entry.source == STATED] or entries)[:MAX_DIAGRAMS]
    known = {entry.estimator: entry for entry in entries}
    for name in names:
        if name not in known:
            raise PlotError(f"{file.path}: has no probabilities of '{name}'; expected one of {', '.join(known)}.")
    if len(names) > MAX_DIAGRAMS:
        raise PlotError(f"--estimators: at most {MAX_DIAGRAMS} diagrams fit beside each other.")
    return [known[name] for name in names]


def number(measured, digits):
    if math.isnan(measured.value):
        return "not defined"
    if math.isnan(measured.lower + measured.upper):
        return f"{measured.value:.{digits}f}"
    return f"{measured.value:.{digits}f} [{measured.lower:.{digits}f}, {measured.upper:.{digits}f}]"


def scores_in_words(entry):
    return (f"{title_of(entry)}: n = {entry.n}, refused {entry.refused}, Brier {number(entry.brier, 4)}, "
            f"ECE {entry.calibration_error:.4f} (if right {entry.error_if_calibrated:.4f}), "
            f"slope {number(entry.slope, 2)}, AUC {number(entry.auc, 3)}")


def title_of(entry):
    return style.label_of(entry.estimator) + ("" if entry.source == STATED else ", P from inlier share")


def root_axis(axes, direction):
    """From 0 to 1, with room for small probabilities."""
    getattr(axes, f"set_{direction}scale")("function", functions=(root, square))
    getattr(axes, f"set_{direction}lim")(0, 1)
    axis = getattr(axes, f"{direction}axis")
    axis.set_ticks(TICKS)
    axis.set_major_formatter(per_cent)


def draw_diagram(axes, entry, look):
    for direction in ("x", "y"):
        root_axis(axes, direction)
    axes.plot([0, 1], [0, 1], **RIGHT, label="_right")
    if entry.band:
        axes.fill_between(*zip(*entry.band), **BAND, label="_band")
    axes.plot(*zip(*entry.curve), color=look.color, linewidth=1.4, label="_curve")
    for one in entry.bins:
        share = one.failure
        axes.errorbar(one.mean_probability, share.value, [[share.value - share.lower], [share.upper - share.value]],
                      fmt="o", markersize=3.4, color=look.color, markeredgecolor="white", markeredgewidth=0.5,
                      elinewidth=0.8, clip_on=False, label="_bin")
    axes.set_ylabel("Failed (%)")
    axes.tick_params(labelbottom=False)


def draw_histogram(axes, entry, edges):
    """Logarithmic: most trials are sure, and the few others count."""
    root_axis(axes, "x")
    axes.stairs(entry.histogram, edges, fill=True, **BARS)
    axes.set_yscale("symlog", linthresh=1, linscale=0.4)
    axes.set_ylim(0, 1.6 * max(entry.histogram))
    powers = range(0, 9, 1 if max(entry.histogram) < 1000 else 2)
    axes.yaxis.set_ticks([10 ** power for power in powers if 10 ** power <= max(entry.histogram)])
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda count, _: f"{count:g}"))
    axes.set(xlabel="Stated P (%)", ylabel="Trials")
    axes.tick_params(axis="x", labelsize=7)


def curve_of(entry):
    """(coverage, risk) where there is a risk."""
    return [point for point in entry.risk_coverage if point[1] > 0]


def line_of(curve, look):
    """How it is drawn; a curve that begins at its end is a dot."""
    shape = dict(marker="o", markersize=3.4, linestyle="none") if len(curve) == 1 else dict(linestyle=look.dashes, linewidth=1.3)
    return dict(color=look.color, **shape)


def draw_risk_coverage(axes, entries, looks):
    """Logarithmic, from the first failure among the surest answers on."""
    curves = {entry.estimator: curve_of(entry) for entry in entries if curve_of(entry)}
    for entry in entries:
        look, curve = looks[entry.estimator], curves.get(entry.estimator)
        if not curve:
            continue
        if band := risk_band(entry, curve):
            axes.fill_between(*zip(*band), **RISK_BAND, color=look.color, zorder=look.zorder - 1, label="_risk_band")
        axes.plot(*zip(*curve), **line_of(curve, look), label="_risk", zorder=look.zorder, clip_on=len(curve) > 1)
    risks = [risk for curve in curves.values() for _, risk in curve]
    first = min((curve[0][0] for curve in curves.values()), default=0)
    axes.set_xlim(max(0, min(first - 0.03 * (1 - first), 0.98)), 1)
    axes.set_yscale("log")
    axes.set_ylim(0.7 * min(risks, default=0.001), min(1.0, 1.5 * max(risks, default=1)))
    axes.yaxis.set_major_locator(LogLocator(numticks=9) if max(risks, default=1) > 9 * min(risks, default=0) else LogLocator(subs=(1, 2, 5)))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.xaxis.set_major_formatter(per_cent)
    axes.yaxis.set_major_formatter(per_cent)
    if not risks:
        axes.text(0.5, 0.5, "no failure", transform=axes.transAxes, ha="center", va="center", color="0.4")
    axes.set(xlabel="Answered, surest first (%)", ylabel="Failed among them (%)")


def handles_of(entries, diagrams, looks):
    """Of what is drawn: an estimator without a failure has no curve."""
    handles = [Line2D([], [], **line_of(curve_of(entry), looks[entry.estimator]),
                      label=f"{style.label_of(entry.estimator)}: AURC {number(entry.risk_coverage_area, 4)}") for entry in entries if curve_of(entry)]
    return handles + [Patch(**BAND, label="if P were right (95 %)")] * any(entry.band for entry in diagrams)


def caption_of(file, group, entries, diagrams, has_band):
    safe, others = ([style.label_of(entry.estimator) for entry in entries if is_in(entry)]
                    for is_in in (lambda entry: not curve_of(entry), lambda entry: entry.source != STATED))
    parts = [f"Study {file.study}"] + ([style.level_in_words(file.by, group)] if file.by else [])
    return "; ".join(parts + list(map(scores_in_words, diagrams)) + [
        "lines: isotonic regression of failures on P; dots: ten bins of equal width with exact 95 % intervals",
        "the band is pointwise", "axes of P in proportion to the square root", "risk and coverage: from the first failure "
        "on, a refusal is the least sure and counts as a failure" + (", band pointwise 95 % (Wilson)" if has_band else ""),
        "AURC: area under the curve"] + [f"{words}: {listed(names)}" for words, names in (
            ("P from inlier share", others), ("without a failure, so without a curve", safe)) if names]) + "."


def draw(file, names=None, group=None):
    """The whole figure."""
    entries = of_group(file, group)
    diagrams = with_diagram(file, entries, names)
    looks = style.looks_of(list(dict.fromkeys(entry.estimator for entry in entries)))
    count, width = len(diagrams) + 1, sheet.current().width
    abreast = style.panels_abreast(count)
    lines = math.ceil(count / abreast)
    figure = Figure(figsize=(2.7 * count, 4.2) if width is None else (width, 3.7 * lines), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(2 * lines, abreast, height_ratios=(3.2, 1) * lines)
    letters = style.letters(count)
    for position, entry in enumerate(diagrams):
        line, column = divmod(position, abreast)
        axes = figure.add_subplot(grid[2 * line, column])
        draw_diagram(axes, entry, looks[entry.estimator])
        axes.set_title(style.title_lines(next(letters) + title_of(entry), count))
        draw_histogram(figure.add_subplot(grid[2 * line + 1, column]), entry, file.edges)
    line, column = divmod(count - 1, abreast)
    axes = figure.add_subplot(grid[2 * line:2 * line + 2, column])
    draw_risk_coverage(axes, entries, looks)
    axes.set_title(next(letters) + "Risk and coverage")
    style.add_legend_and_caption(figure, handles_of(entries, diagrams, looks), caption_of(
        file, entries[0].group, entries, diagrams, any(not entry.is_of_population for entry in entries)))
    return figure
