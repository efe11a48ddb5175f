"""What the figures of `rcme tune` share: the look of the tuned setting, of other estimators and of the target, and
where the levels of an option stand."""

import math
from dataclasses import replace

import numpy as np
from matplotlib.lines import Line2D

from common import sheet, style
from common.factor_axis import FactorAxis
from common.number_text import number_text
from common.text_size import fill, height_of
from rates.rate_bands import TARGET, per_cent
from rates.selection import INTERVALS

CERTIFIED = dict(linestyle="none", marker="o", markersize=3.6, color=style.BLACK, markeredgecolor="white",
                 markeredgewidth=0.6)
TUNED = dict(linestyle="none", marker="*", markersize=12, color=TARGET, markeredgecolor="white", markeredgewidth=0.7)
TARGET_LINE = dict(color=TARGET, linewidth=1.5, linestyle=style.LONG_DASHED)
SHORT = {"failure": "failure", "refusal": "refusal", "false_refusal": "false refusal"}
LEGEND_SIZE = 7  # points, of a legend beside the panel
MAX_LABELS = {"x": 8, "y": 10}  # of levels along an axis
MAX_TICKS = 300  # of levels along an axis; more would touch
FAR_SPREAD = 8  # the widest gap between levels over the narrowest; beyond, levels stand evenly


def looks_of(others):
    """A look for each of the other estimators; one label may be there in several versions, of which the first has its colour."""
    labels = [other.label for other in others]
    keys = [label if label not in labels[:place] else f"{label}, {other.words}"
            for place, (label, other) in enumerate(zip(labels, others))]
    looks = style.equal_looks_of(keys)
    return [replace(looks[key], label=other.name(), marker_size=1.35 * looks[key].marker_size)
            for key, other in zip(keys, others)]


def marks_of(look):
    """Keyword arguments of `Axes.plot` for a mark without a line."""
    return {**look.line(), "linestyle": "none", "markeredgewidth": 0.7}


def plot_points(axes, x, y, **look):
    """`Axes.plot` with marks that may reach over the edge; an empty line would confuse the layout."""
    if len(x):
        axes.plot(x, y, clip_on=False, **look)


def handle(label, /, **look):
    return Line2D([], [], **{**look, "label": label})


def in_words(options, levels):
    return ", ".join(option.level_in_words(level) for option, level in zip(options, levels))


def tuned_handle(tune):
    """The star of the legend, or none."""
    return [handle(f"tuned: {in_words(tune.options, tune.tuned.levels)}", **TUNED)] if tune.tuned else []


def target_handle(target, quantities):
    """The target's line of the legend, if it bounds one of these rates."""
    bounds = [f"{SHORT[quantity]} \u2264 {per_cent(target.level(quantity))} %" for quantity in quantities
              if not math.isnan(target.level(quantity))]
    return [handle("target: " + ", ".join(bounds), **TARGET_LINE)] if bounds else []


def study_in_words(file):
    return f"Study {file.study}, {style.label_of(file.estimator)}, seed {file.seed}"


def head_in_words(file):
    """The caption's beginning: which study, estimator and target."""
    return f"{study_in_words(file)}; target: {file.target.words}"


def tuned_in_words(tune):
    return [] if tune.tuned else ["no setting met it"]


EXACT = f"{INTERVALS['exact']} intervals"


def figure_with_legend_beside(handles, width, height):
    """(figure, axes, handles): one panel, and at its right the legend with texts of at most `width` inches; the figure is
    at least `height` inches high. On a sheet too narrow for both the handles are left, for a legend above."""
    paper_width = sheet.current().width
    if paper_width is not None and paper_width < 5.2:
        figure, ((axes,),) = style.new_figure(1, 1)
        figure.set_size_inches(paper_width, 0.85 * paper_width)
        return figure, axes, handles
    lines = 0
    for one in handles:
        label = [part for line in one.get_label().split("\n") for part in fill(line, width, LEGEND_SIZE)]
        one.set_label("\n".join(label))
        lines += len(label)
    figure, ((axes, beside),) = style.new_figure(1, 2)
    whole = paper_width or 7.0
    figure.set_size_inches(whole, max(height, 0.8 + height_of(lines + 0.6 * len(handles), LEGEND_SIZE)))
    axes.get_gridspec().set_width_ratios([whole - 0.9 - width, width + 0.5])
    beside.set_axis_off()
    style.draw_legend(beside, handles, loc="upper left", bbox_to_anchor=(0, 1), borderaxespad=0, fontsize=LEGEND_SIZE,
                      labelspacing=0.6)
    return figure, axes, []


def add_legend_and_caption(figure, handles, caption):
    """As every figure has them, measured at the size at which they are saved: a legend of many rows is higher there."""
    figure.set_dpi(style.RC["savefig.dpi"])
    style.add_legend_and_caption(figure, handles, caption)


class LevelAxis(FactorAxis):
    """Where each level of an option stands: at its number or, where numbers are far apart, one beside the other."""

    def __init__(self, option):
        super().__init__(option.name, option.levels)
        self.option = option
        gaps = np.diff(sorted(self.place.values()))
        self.is_even = not self.is_numeric or len(gaps) > 1 and max(gaps) > FAR_SPREAD * min(gaps)
        self.levels = sorted(self.levels, key=self.place.get)
        if self.is_even:
            self.place = {level: float(rank) for rank, level in enumerate(self.levels)}

    def places(self):
        return self.positions(self.levels)

    def ticks(self):
        """The places, one of those that lie too close for ticks of their own."""
        places = np.array(self.places())
        _, first = np.unique(np.round(MAX_TICKS * (places - places[0]) / (np.ptp(places) or 1)), return_index=True)
        return places[first]

    def locate(self, level):
        """(place, side): side -1 or 1 where the level lies beyond that end, which then is its place; None for a word
        that is not among the levels."""
        if not self.is_numeric:
            return (self.place[level], 0) if level in self.place else None
        numbers, number = list(map(float, self.levels)), float(level)
        side = int(number > numbers[-1]) - int(number < numbers[0])
        return float(np.interp(number, numbers, self.places())), side

    def prepare(self, axes, direction, panels_abreast, margin=0.0):
        """Limits, name and ticks of the axis 'x' or, for numbers, 'y'; small ticks at levels without a label."""
        if self.is_numeric:
            axis, places = getattr(axes, f"{direction}axis"), self.places()
            margin *= places[-1] - places[0]
            getattr(axes, f"set_{direction}lim")(places[0] - margin, places[-1] + margin)
            if self.is_even:
                step = -(-len(places) // MAX_LABELS[direction])
                axis.set_ticks(places[::step], [number_text(float(level)) for level in self.levels[::step]])
            axis.set_ticks(self.ticks(), minor=True)
        else:
            super().prepare(axes, panels_abreast)
        getattr(axes, f"set_{direction}label")(self.option.label())
