"""The ROC curve of a threshold mu: good models accepted over contaminated ones, with the default mu marked."""

import math

from audit_figures import groups, look
from audit_figures.panel import Panel
from common.command_line import PlotError
from common.number_text import number_text
from common.paper import add_axes, keep_right_of

DEFAULT_MUS = (-3.53, 6.0)  # of the reading as printed, and of the rank-aware one
GOOD, CONTAMINATED = "good", "contaminated"
AXES_HEIGHT, AXES_BELOW, LEFT_MARGIN, RIGHT_MARGIN = 2.5, 0.48, 0.62, 0.1  # inches
LEGEND_LINE = 0.15


def is_roc(claim):
    return claim.family == "mu" and claim.id.endswith(".roc")


class RocPanel(Panel):
    """One claim; one curve per combination of the conditions other than `models`."""

    span = 1

    def __init__(self, claim, rows, path):
        self.curves = curves_of(claim, rows, path)

    def height(self, width):
        return AXES_HEIGHT + AXES_BELOW + LEGEND_LINE * (len(self.curves) if len(self.curves) > 1 else 0)

    def draw(self, figure, left, top, width):
        axes = add_axes(figure, left + LEFT_MARGIN, top, width - LEFT_MARGIN - RIGHT_MARGIN, AXES_HEIGHT)
        axes.plot([0, 1], [0, 1], color="0.7", linewidth=0.7, linestyle=(0, (2, 2)), zorder=1, label="_chance")
        for position, (label, points) in enumerate(self.curves.items()):
            draw_curve(axes, points, label, position)
        for direction, name in (("x", "Contaminated models accepted (%)"), ("y", "Good models accepted (%)")):
            getattr(axes, f"set_{direction}lim")(-0.02, 1.02)
            getattr(axes, f"{direction}axis").set_major_formatter(lambda rate, _: number_text(100 * rate))
            getattr(axes, f"set_{direction}label")(name)
        keep_right_of(axes, left)
        if len(self.curves) > 1:
            paper_width, paper_height = figure.get_size_inches()
            figure.legend(handles=[line for line in axes.lines if not line.get_label().startswith("_")], loc="upper left",
                          bbox_to_anchor=(left / paper_width, 1 - (top + AXES_HEIGHT + AXES_BELOW) / paper_height),
                          borderaxespad=0, borderpad=0, fontsize=7, labelspacing=0.35)
        return axes


def curves_of(claim, rows, path):
    """{conditions in words: [(mu, contaminated target, good target)] in order of mu}."""
    names = [name for name in groups.varying(rows) if name != "models"]
    found = {}
    for row in rows:
        models = row.conditions.get("models")
        if models not in (GOOD, CONTAMINATED) or math.isnan(row.target.threshold):
            raise PlotError(f"{path}: claim '{claim.id}' is a ROC curve: each evidence needs the condition 'models' "
                            f"'{GOOD}' or '{CONTAMINATED}' and each target a 'threshold'.")
        found.setdefault(groups.in_words(row.conditions, names), {GOOD: {}, CONTAMINATED: {}})[models][
            row.target.threshold] = row.target
    for pair in found.values():
        if pair[GOOD].keys() != pair[CONTAMINATED].keys():
            raise PlotError(f"{path}: claim '{claim.id}' has 'threshold' values for good models that differ from those "
                            "for contaminated ones; a ROC curve needs the same for both.")
    return {label: [(mu, pair[CONTAMINATED][mu], pair[GOOD][mu]) for mu in sorted(pair[GOOD])]
            for label, pair in found.items()}


def draw_curve(axes, points, label, position):
    """The curve with the interval of each rate as a pale bar, and a ring with its value at the default mu."""
    color, dashes = look.series_look(position)
    for _, x, y in points:
        ends = dict(color=color, alpha=0.35, linewidth=0.9, zorder=2)
        axes.hlines([y.measured], [max(x.lower, 0)], [min(x.upper, 1)], **ends)
        axes.vlines([x.measured], [max(y.lower, 0)], [min(y.upper, 1)], **ends)
    axes.plot([x.measured for _, x, _ in points], [y.measured for _, _, y in points], color=color, linestyle=dashes,
              linewidth=1.3, marker=".", markersize=3.5, zorder=3, label=label or "_roc", clip_on=False)
    known = [point for point in points if not (math.isnan(point[1].measured) or math.isnan(point[2].measured))]
    if known:
        default = next((mu for mu in DEFAULT_MUS if any(mu == point[0] for point in known)), DEFAULT_MUS[0])
        mu, x, y = min(known, key=lambda point: abs(point[0] - default))
        axes.plot([x.measured], [y.measured], marker="o", markersize=8, markerfacecolor="none", markeredgecolor=color,
                  markeredgewidth=1.5, linestyle="none", zorder=5, clip_on=False, label="_default mu")
        to_left = x.measured > 0.7
        axes.annotate(f"mu = {number_text(mu)}", (x.measured, y.measured), textcoords="offset points",
                      xytext=(-7, 5) if to_left else (6, -6), ha="right" if to_left else "left",
                      va="bottom" if to_left else "top", fontsize=7.5, color=color, zorder=4)
