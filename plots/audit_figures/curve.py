"""A panel of measured values over one condition: a series per combination of the other conditions and per quantity.

Values carry their interval as a bar. The allowed range is a pale band, the nominal value a line. Of a quantity at several
significance levels one is drawn strong and the others thin and pale, each around its own nominal value.
"""

import math
from dataclasses import dataclass

from matplotlib.transforms import ScaledTranslation, blended_transform_factory

from audit_figures import groups, look
from audit_figures.levels import Levels
from audit_figures.panel import Panel
from audit_figures.scale import scale_of
from common.command_line import PlotError
from common.paper import add_axes, keep_right_of
from common.text_size import width_of, wrap

AXES_HEIGHT, LEFT_MARGIN, RIGHT_MARGIN = 1.75, 0.62, 0.1  # inches
LEGEND_SIZE, LEGEND_LINE, LEGEND_HANDLE, LEGEND_GAP = 7, 0.15, 0.42, 0.07
MAX_SERIES = 7  # in one panel, as long as another condition can be laid out in panels
DODGE = 3.4  # points between series at one level


@dataclass(frozen=True)
class Series:
    label: str
    position: int  # among the series of the panel
    points: tuple  # (x, target) in order of x

    @property
    def color(self):
        return look.series_look(self.position)[0]

    @property
    def dashes(self):
        return look.series_look(self.position)[1]


def panels_of(claim, rows, path):
    """[(the levels that set it apart, in words; CurvePanel)] for the rows of one claim."""
    panels = []
    for group in groups.groups_of(rows):
        panels += [(words, CurvePanel(claim, part, path)) for words, part in split(group, claim.figure_x)]
    return panels


def split(group, x):
    """A group with too many series, one part per level of its coarsest condition as long as two conditions vary."""
    names = groups.varying(group.rows, but=x)
    combinations = {tuple(row.conditions.get(name) for name in names) for row in group.rows}
    if len(combinations) <= MAX_SERIES or len(names) < 2:
        return [("", group)]
    levels = {name: list(dict.fromkeys(row.conditions.get(name) for row in group.rows)) for name in names}
    coarsest = min(names, key=lambda name: len(levels[name]))
    parts = []
    for level in levels[coarsest]:
        rows = tuple(row for row in group.rows if row.conditions.get(coarsest) == level)
        words = groups.in_words(rows[0].conditions, [coarsest])
        parts += [(", ".join(filter(None, (words, more))), part)
                  for more, part in split(groups.Group(group.name, rows, group.has_alphas), x)]
    return parts


class CurvePanel(Panel):
    """One group of quantities over one condition."""

    span = 1

    def __init__(self, claim, group, path):
        self.claim, self.group, self.path = claim, group, path
        self.names = groups.varying(group.rows, but=claim.figure_x)
        self.strong = groups.strong_alpha(group.targets) if group.has_alphas else None
        self.scale = scale_of(group.targets, group.has_alphas)

    def levels(self, width):
        return Levels(self.claim.figure_x, [row.conditions[self.claim.figure_x] for row in self.group.rows],
                      width - LEFT_MARGIN - RIGHT_MARGIN)

    def has_several_quantities(self):
        return self.strong is None and len(self.group.quantities) > 1

    def is_strong(self, row):
        return self.strong is None or groups.split_alpha(row.target.quantity)[1] == self.strong

    def series_of(self, rows, levels):
        """One Series per combination of the other conditions and, where several quantities share the axes, of those."""
        several = self.has_several_quantities()
        members = {}
        for row in rows:
            label = ", ".join(filter(None, (row.target.quantity if several else "",
                                            groups.in_words(row.conditions, self.names))))
            members.setdefault(label, []).append((levels.place(row.conditions[self.claim.figure_x]), row.target))
        for label, points in members.items():
            if len({x for x, _ in points}) < len(points):
                raise PlotError(f"{self.path}: claim '{self.claim.id}' has '{points[0][1].quantity}' more than once at one "
                                f"level of {self.claim.figure_x}" + (f" ({label})" if label else "") +
                                "; its 'conditions' must tell its evidence apart.")
        return [Series(label, position, tuple(sorted(points, key=lambda point: point[0])))
                for position, (label, points) in enumerate(members.items())]

    def pale_series(self, levels):
        """The series at the other significance levels, each level on its own."""
        alphas = dict.fromkeys(groups.split_alpha(row.target.quantity)[1]
                               for row in self.group.rows if not self.is_strong(row))
        return [self.series_of([row for row in self.group.rows if groups.split_alpha(row.target.quantity)[1] == alpha],
                               levels) for alpha in alphas]

    def strong_series(self, levels):
        return self.series_of([row for row in self.group.rows if self.is_strong(row)], levels)

    def legend_layout(self, labels, width):
        """(columns, wrapped labels, lines): as many columns as fit."""
        if len(labels) < 2:
            return 1, [], 0
        if len(self.names) == 1 and all(label.count(" = ") == 1 for label in labels) and not self.has_several_quantities():
            labels = [labels[0]] + [label.partition(" = ")[2] for label in labels[1:]]  # 'num points = 8', '20', '100'
        broken = ["\n".join(wrap(label, width - LEGEND_HANDLE, LEGEND_SIZE)) for label in labels]
        for columns in range(len(broken), 0, -1):
            parts = columns_of(broken, columns)
            if columns == 1 or width >= sum(max(width_of(label, LEGEND_SIZE) for label in part) + LEGEND_HANDLE + 0.08
                                            for part in parts):
                return columns, broken, max(sum(label.count("\n") + 1 for label in part) for part in parts)

    def height(self, width):
        levels = self.levels(width)
        labels = [series.label for series in self.strong_series(levels)]
        lines = self.legend_layout(labels, width)[2]
        return AXES_HEIGHT + levels.height() + (LEGEND_GAP + LEGEND_LINE * lines if lines else 0)

    def cuts_intervals(self):
        return any(self.scale.cuts(row.target) for row in self.group.rows if self.is_strong(row))

    def has_pale_series(self):
        return not all(map(self.is_strong, self.group.rows))

    def shows_limit(self):
        return self.claim.figure_x == "sigma_px" and not math.isnan(self.claim.holds_up_to_sigma_px)

    def draw(self, figure, left, top, width):
        axes = add_axes(figure, left + LEFT_MARGIN, top, width - LEFT_MARGIN - RIGHT_MARGIN, AXES_HEIGHT)
        levels = self.levels(width)
        levels.apply(axes)
        self.scale.apply(axes, "y")
        for series in self.pale_series(levels):
            draw_ranges(axes, series, self.scale, strong=False)
            for one in series:
                draw_pale(axes, one, self.scale, joined=levels.are_numbers or len(series) > 1)
        series = self.strong_series(levels)
        draw_ranges(axes, series, self.scale, strong=True)
        for one in series:
            draw_strong(axes, one, self.scale, aside(axes, one.position, len(series)),
                        joined=levels.are_numbers or len(series) > 1)
        self.draw_limit(axes)
        axes.set_ylabel(self.y_name())
        keep_right_of(axes, left)
        self.draw_legend(axes, figure, left, top + AXES_HEIGHT + levels.height() + LEGEND_GAP, width)
        return axes

    def y_name(self):
        name = self.group.axis_name()
        if self.strong is not None:
            return f"{name}\nstrong: alpha {self.strong:g}"
        return "\n".join(wrap(name, AXES_HEIGHT, 8.5))

    def draw_limit(self, axes):
        """The noise up to which the claim holds."""
        limit = self.claim.holds_up_to_sigma_px
        if self.shows_limit() and axes.get_xlim()[0] <= limit <= axes.get_xlim()[1]:
            axes.axvline(limit, color=look.GREY, linewidth=0.8, linestyle=(0, (2, 2)), zorder=1.5, label="_limit")

    def draw_legend(self, axes, figure, left, top, width):
        handles = [line for line in axes.lines if line.get_label()[:1] not in ("_", "")]
        columns, labels, lines = self.legend_layout([line.get_label() for line in handles], width)
        if lines:
            paper_width, paper_height = figure.get_size_inches()
            figure.legend(handles, labels, loc="upper left", ncols=columns, fontsize=LEGEND_SIZE, handlelength=2.4,
                          bbox_to_anchor=(left / paper_width, 1 - top / paper_height), borderaxespad=0, borderpad=0,
                          labelspacing=0.35, columnspacing=0.8, handletextpad=0.4)


def columns_of(labels, columns):
    """As a legend fills its columns: from top to bottom, the first ones one longer."""
    each, longer = divmod(len(labels), columns)
    ends = [column * each + min(column, longer) for column in range(columns + 1)]
    return [labels[first:last] for first, last in zip(ends, ends[1:])]


def aside(axes, position, count):
    """The data's place, a little to the side, so that the bars of several series stand abreast."""
    step = min(DODGE, 16 / count)
    shift = ScaledTranslation(step * (position - (count - 1) / 2) / 72, 0, axes.figure.dpi_scale_trans)
    return axes.transData + shift


def draw_ranges(axes, series, scale, strong):
    """Allowed ranges and nominal values; what several series share is drawn once, in the colour of 'allowed'."""
    ranges = {}
    for one in series:
        ranges.setdefault(tuple((x, target.low, target.high, target.nominal) for x, target in one.points
                                if target.is_claim or not math.isnan(target.nominal)), one)
    for places, one in ranges.items():
        if places:
            color = look.ALLOWED if len(ranges) == 1 else one.color
            draw_band(axes, places, scale, color, look.BAND_ALPHA if strong else look.PALE_BAND_ALPHA)
            draw_nominal(axes, places, scale, color, 1.0 if strong else 0.5)


def draw_band(axes, places, scale, color, alpha):
    """A band over the whole panel if the range is the same everywhere, else one that follows it."""
    bounds = [(x, low, high) for x, low, high, _ in places if low > -math.inf or high < math.inf]
    if not bounds:
        return
    look_of_band = dict(color=color, alpha=alpha, linewidth=0, zorder=0.5)
    if len({bound[1:] for bound in bounds}) == 1:
        axes.axhspan(scale.clip(bounds[0][1]), scale.clip(bounds[0][2]), **look_of_band)
        return
    xs, lows, highs = zip(*((x, scale.clip(low), scale.clip(high)) for x, low, high in bounds))
    axes.fill_between(xs, lows, highs, **look_of_band)


def draw_nominal(axes, places, scale, color, width):
    known = [(x, nominal) for x, _, _, nominal in places if not math.isnan(nominal)]
    if known and len({nominal for _, nominal in known}) == 1:
        axes.axhline(known[0][1], color=color, linewidth=width, zorder=1, label="_nominal")
    elif known:
        axes.plot(*zip(*known), color=color, linewidth=width, zorder=1, label="_nominal")


def line_of(series, scale):
    """x and y of the points; NaN where nothing finite was measured."""
    measured = [target.measured for _, target in series.points]
    return [x for x, _ in series.points], [value if math.isnan(value) else scale.clip(value) for value in measured]


def draw_strong(axes, series, scale, where, joined):
    """One series: line, interval bars, and on each point the mark of its verdict; a missing value is a gap."""
    xs, ys = line_of(series, scale)
    axes.plot(xs, ys, color=series.color, linestyle=series.dashes if joined else "none", linewidth=1.2, zorder=3,
              transform=where, label=series.label or "_series")
    for (x, target), y in zip(series.points, ys):
        draw_interval(axes, x, target, scale, series.color, where)
        if math.isnan(y):
            draw_missing(axes, x)
        else:
            marks = look.LOOKS[target.verdict].marks(look.point_color(target.verdict, series.color))
            axes.plot([x], [y], **marks, zorder=4, transform=where, clip_on=False, label="_" + target.verdict)


def draw_interval(axes, x, target, scale, color, where):
    """The interval as a bar; an end that does not exist or lies outside the panel is an arrow at the frame."""
    seen = scale.seen(target)
    if seen is None:
        return
    lower, upper, is_cut_below, is_cut_above = seen
    axes.vlines([x], [lower], [upper], color=color, linewidth=1, zorder=2.5, transform=where, label="_interval")
    for end, is_cut, marker in ((lower, is_cut_below, "v"), (upper, is_cut_above, "^")):
        if is_cut:
            axes.plot([x], [end], marker=marker, color=color, markersize=3.2, markeredgewidth=0, linestyle="none",
                      transform=where, clip_on=False, zorder=3, label="_cut")


def draw_missing(axes, x):
    """A cross on the lower frame: measured, but no finite value."""
    axes.plot([x], [0.0], marker="x", color=look.GREY, markersize=4.5, markeredgewidth=1.1, clip_on=False, zorder=5,
              transform=blended_transform_factory(axes.transData, axes.transAxes), linestyle="none", label="_missing")


def draw_pale(axes, series, scale, joined):
    """A series at another significance level: thin, pale, without marks; a point that contradicts keeps its mark."""
    xs, ys = line_of(series, scale)
    axes.plot(xs, ys, color=series.color, alpha=0.45, linewidth=0.8, zorder=2, label="_pale",
              linestyle=series.dashes if joined else "none")
    for (x, target), y in zip(series.points, ys):
        look_of_point = look.LOOKS[target.verdict]
        if not math.isnan(y):
            color = look.point_color(target.verdict, series.color)
            axes.plot([x], [y], **{**look_of_point.marks(color), "markersize": 0.6 * look_of_point.size}, alpha=0.55,
                      zorder=2.2, label="_pale " + target.verdict)
