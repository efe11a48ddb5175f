"""A panel without an axis of conditions: one line per target, its measured value and interval against its allowed range.

On the left the quantity and the conditions that vary, on the right the same values as numbers. Quantities of different
kind or size have axes of their own, one below the other.
"""

import math
from dataclasses import dataclass

from audit_figures import groups, look
from audit_figures.panel import Panel
from audit_figures.scale import scale_of
from common.paper import add_axes, add_rule, add_text
from common import sheet
from common.style import font_size
from common.text_size import height_of, width_of, wrap

LABEL_SIZE, VALUE_SIZE = 7.2, 6.8  # points; of a sheet with a width at least 7
MAX_LABEL_SHARE = 0.5  # of the width
LEAST_AXIS = 0.75  # inches, of an axis on a sheet with a width
INDENT, GAP, ROW_GAP = 0.1, 0.1, 0.055  # inches
TICKS_HEIGHT, NAME_HEIGHT, GROUP_GAP = 0.22, 0.16, 0.12  # inches


@dataclass(frozen=True)
class Line:
    """One line of the forest: a heading (no target) or a target."""

    text: str
    target: object = None
    indent: float = 0

    def broken(self, width):
        return wrap(self.text, width - self.indent, LABEL_SIZE, bold=self.is_heading)

    def height(self, width):
        return height_of(len(self.broken(width)), LABEL_SIZE) + ROW_GAP

    @property
    def is_heading(self):
        return self.target is None


def axis_height(group):
    """Rates need their unit named; other values have it in their label."""
    return TICKS_HEIGHT + (NAME_HEIGHT if group.is_rate else 0)


def lines_of(group, names):
    """A heading for each quantity measured under several conditions, and below it a line per combination of them."""
    lines = []
    for quantity in group.quantities:
        rows = [row for row in group.rows if row.target.quantity == quantity]
        words = [groups.in_words(row.conditions, names) for row in rows]
        if len(rows) == 1:
            lines.append(Line(", ".join(filter(None, (quantity, words[0]))), rows[0].target))
        else:
            lines.append(Line(quantity))
            lines += [Line(text or "all", row.target, INDENT) for text, row in zip(words, rows)]
    return lines


class ForestPanel(Panel):
    """All targets of one claim."""

    span = 2  # columns of the page

    def __init__(self, rows):
        names = groups.varying(rows)
        self.groups = groups.groups_of(rows)
        self.lines = [lines_of(group, names) for group in self.groups]
        labels = [line for lines in self.lines for line in lines if not line.is_heading]
        self.widest_label = max(width_of(line.text, LABEL_SIZE) + line.indent for line in labels) + 0.02
        self.value_width = max(width_of(look.measured_text(row.target), font_size(VALUE_SIZE)) for row in rows) + 0.22

    def label_width(self, width):
        share = MAX_LABEL_SHARE if sheet.current().width is None else min(MAX_LABEL_SHARE, 0.9 - (self.value_width + LEAST_AXIS) / width)
        return min(self.widest_label, share * width)

    def line_width(self, line, width):
        """A heading may run across the axes, where it has no data to hide."""
        return width - self.value_width if line.is_heading else self.label_width(width)

    def lines_height(self, lines, width):
        return sum(line.height(self.line_width(line, width)) for line in lines) + ROW_GAP

    def height(self, width):
        return sum(self.lines_height(lines, width) + axis_height(group) + GROUP_GAP
                   for group, lines in zip(self.groups, self.lines)) - GROUP_GAP

    def cuts_intervals(self):
        return any(scale_of(group.targets, group.has_alphas).cuts(target)
                   for group in self.groups for target in group.targets)

    def draw(self, figure, left, top, width):
        for group, lines in zip(self.groups, self.lines):
            self.draw_group(figure, group, lines, left, top, width)
            top += self.lines_height(lines, width) + axis_height(group) + GROUP_GAP

    def draw_group(self, figure, group, lines, left, top, width):
        """One axis; its y runs in inches downwards from its top."""
        scale = scale_of(group.targets, group.has_alphas)
        label_width, height = self.label_width(width), self.lines_height(lines, width)
        axes_left = left + label_width + GAP
        axes = add_axes(figure, axes_left, top, left + width - self.value_width - GAP - axes_left, height)
        axes.set_ylim(height, 0)
        scale.apply(axes, "x")
        axes.yaxis.set_visible(False)
        axes.spines["left"].set_visible(False)
        axes.patch.set_visible(False)  # the rules between the lines go through
        axes.set_xlabel("Rate (%)" if group.is_rate else "", labelpad=1.5)
        y = ROW_GAP
        for line in lines:
            broken = line.broken(self.line_width(line, width))
            line_height = line.height(self.line_width(line, width))
            middle = y + (line_height - ROW_GAP) / 2
            self.write_label(figure, left + line.indent, top + middle, line, broken)
            if not line.is_heading:
                draw_row(axes, middle, line.target, scale)
                self.write_values(figure, left + width, top + middle, line.target)
            y += line_height
            if line is not lines[-1]:
                add_rule(figure, left, top + y - ROW_GAP / 2, width, color="0.92", linewidth=0.5, zorder=0)

    def write_label(self, figure, left, middle, line, broken):
        heading = dict(fontweight="bold", color=look.GREY, bbox=dict(facecolor="white", edgecolor="none", pad=0.6))
        add_text(figure, left, middle, "\n".join(broken), va="center", fontsize=LABEL_SIZE,
                 **(heading if line.is_heading else {}))

    def write_values(self, figure, right, middle, target):
        verdict = look.LOOKS[target.verdict]
        add_text(figure, right - 0.2, middle, look.measured_text(target), ha="right", va="center",
                 fontsize=font_size(VALUE_SIZE))
        add_text(figure, right, middle, verdict.glyph, ha="right", va="center", fontsize=8.5, color=verdict.color)


def draw_row(axes, y, target, scale):
    """Allowed range, nominal value, interval and the mark of the verdict."""
    half = 0.06  # inches
    verdict = look.LOOKS[target.verdict]
    if target.is_claim:
        low, high = scale.clip(target.low), scale.clip(target.high)
        axes.fill_between([low, high], y - half, y + half, color=look.ALLOWED, alpha=look.BAND_ALPHA * 1.5, linewidth=0,
                          zorder=1)
        for bound in filter(scale.holds, (target.low, target.high)):
            axes.vlines([bound], y - half, y + half, color=look.ALLOWED, linewidth=0.7, zorder=1.2, label="_bound")
    if not math.isnan(target.nominal) and scale.holds(target.nominal):
        axes.vlines([target.nominal], y - half, y + half, color=look.ALLOWED, linewidth=1.5, zorder=1.4, label="_nominal")
    draw_interval(axes, y, target, scale, verdict.color)
    if math.isnan(target.measured):
        axes.text(0.5, y, "no value", transform=axes.get_yaxis_transform(), fontsize=font_size(6.5), color=look.GREY, ha="center",
                  va="center", style="italic")
    else:
        axes.plot([scale.clip(target.measured)], [y], **verdict.marks(verdict.color), zorder=4, clip_on=False,
                  label="_" + target.verdict)


def draw_interval(axes, y, target, scale, color):
    """The interval as a bar; an end that does not exist or lies outside the panel is an arrow at the frame."""
    seen = scale.seen(target)
    if seen is None:
        return
    lower, upper, is_cut_below, is_cut_above = seen
    axes.hlines([y], [lower], [upper], color=color, linewidth=1.2, zorder=3, label="_interval")
    for end, is_cut, marker in ((lower, is_cut_below, "<"), (upper, is_cut_above, ">")):
        if is_cut:
            axes.plot([end], [y], marker=marker, color=color, markersize=3.6, markeredgewidth=0, linestyle="none",
                      clip_on=False, zorder=3, label="_cut")
