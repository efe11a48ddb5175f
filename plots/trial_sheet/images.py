"""The two images of a trial: every match by what it is and what an estimator took it for, and epipolar lines."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

from common import style

GREY = "0.55"  # no estimator has it
TRUE_LINE = dict(color="0.8", linewidth=3.2, linestyle="-", solid_capstyle="butt")
# Dark edges, so that a pale colour too is seen on the true line and in a grey print.
ESTIMATED_LINE = dict(linewidth=0.9, linestyle=style.DASHED, path_effects=[withStroke(linewidth=1.6, foreground="0.15")])

# What a match is, and whether the estimator took it for an inlier (None: it refused): name, how it is drawn.
# The order is that of drawing; later ones lie on top.
RING = dict(marker="o", markersize=5.2, markerfacecolor="none", markeredgecolor="0.15", markeredgewidth=0.5)
RINGED = (("inlier", True), ("unknown", True))
LOOKS = {
    ("outlier", None): ("wrong match", dict(marker="x", markersize=3.3, color=GREY, markeredgewidth=0.8)),
    ("outlier", False): ("wrong match, rejected",
                         dict(marker="x", markersize=3.3, color=GREY, markeredgewidth=0.8)),
    ("undetectable", None): ("wrong match on its true line",
                             dict(marker="D", markersize=3.2, color=style.PURPLE, markerfacecolor="none",
                                  markeredgewidth=0.8)),
    ("undetectable", False): ("wrong match on its true line, rejected",
                              dict(marker="D", markersize=3.2, color=style.PURPLE, markerfacecolor="none",
                                   markeredgewidth=0.8)),
    ("unknown", None): ("match", dict(marker=".", markersize=3.4, color="0.45", markeredgewidth=0)),
    ("unknown", False): ("match, rejected", dict(marker="x", markersize=3, color=GREY, markeredgewidth=0.6)),
    ("inlier", None): ("true match", dict(marker="o", markersize=2.4, color=style.BLUE, markeredgewidth=0)),
    ("inlier", False): ("true match, missed",
                        dict(marker="o", markersize=2.4, color=style.SKY_BLUE, alpha=0.75, markeredgewidth=0)),
    ("unknown", True): ("match, accepted", dict(marker="o", markersize=2.4, color=style.BLUE, markeredgewidth=0)),
    ("inlier", True): ("true match, accepted", dict(marker="o", markersize=2.4, color=style.BLUE, markeredgewidth=0)),
    ("undetectable", True): ("wrong match on its true line, accepted",
                             dict(marker="D", markersize=3.6, color=style.PURPLE, markeredgewidth=0.4,
                                  markeredgecolor="black")),
    ("outlier", True): ("wrong match, accepted",
                        dict(marker="X", markersize=5.4, color=style.VERMILLION, markeredgewidth=0.5,
                             markeredgecolor="black")),
}


def groups_of(trial, estimate):
    """{(kind, accepted): indices of the matches}, in the order of drawing, without empty ones."""
    kinds = np.full(len(trial.matches), "unknown") if trial.kinds is None else trial.kinds
    accepted = np.zeros(len(trial.matches), dtype=bool)
    accepted[estimate.inliers] = True
    has_motion = estimate.status == "ok"
    groups = {}
    for kind, is_accepted in LOOKS:
        if (is_accepted is not None) == has_motion:
            members = np.flatnonzero((kinds == kind) & (not has_motion or accepted == is_accepted))
            if len(members):
                groups[kind, is_accepted] = members
    return groups


def clip(line, size):
    """The two points where the line a x + b y + c = 0 crosses the border of an image (half a pixel outside the outermost
    pixel centres), or None if it misses it."""
    a, b, c = line
    (left, right), (top, bottom) = ((-0.5, extent - 0.5) for extent in size)
    crossings = [(x, -(a * x + c) / b) for x in (left, right) if b] + [(-(b * y + c) / a, y) for y in (top, bottom) if a]
    inside = [(x, y) for x, y in crossings
              if left - 1e-6 <= x <= right + 1e-6 and top - 1e-6 <= y <= bottom + 1e-6]
    if not inside:
        return None
    ends = np.array([inside[0], max(inside, key=lambda end: np.hypot(end[0] - inside[0][0], end[1] - inside[0][1]))])
    return ends if np.hypot(*(ends[1] - ends[0])) > 0 else None


def lines_in_image2(trial, F):
    """Per selected match the ends of its epipolar line F x1 in image 2, or None."""
    return [clip(F @ np.append(trial.matches[index, :2], 1), trial.sizes[1]) for index in trial.selected]


def draw_lines(axes, trial, estimate, look):
    """In image 2: of the truth broad and pale, of the estimate dashed on top, so that equal ones look like one."""
    if trial.F_true is not None:
        for ends in filter(lambda ends: ends is not None, lines_in_image2(trial, trial.F_true)):
            axes.plot(*ends.T, **TRUE_LINE, zorder=1)
    if estimate.F is None:
        return
    exits = {}
    for number, ends in enumerate(lines_in_image2(trial, estimate.F), 1):
        if ends is not None:
            axes.plot(*ends.T, color=look.color, **ESTIMATED_LINE, zorder=2)
            point = trial.matches[trial.selected[number - 1], 2:]
            exits[number] = min(ends, key=lambda end: np.hypot(*(end - point)))  # the end nearer to the match
    name_lines(axes, exits, trial.sizes[1], look.color)


def name_lines(axes, exits, size, color):
    """The number of each match where its line leaves the image; those that would cover each other move along the
    border."""
    gap = 0.032 * max(size)
    for side, along in (((0, -0.5), 1), ((0, size[0] - 0.5), 1), ((1, -0.5), 0), ((1, size[1] - 0.5), 0)):
        here = {number: end[along] for number, end in exits.items() if abs(end[side[0]] - side[1]) < 1e-6}
        for number, place in kept_apart(here, gap).items():
            x, y = (side[1], place) if along else (place, side[1])
            axes.text(x, y, f"{number}", fontsize=6, ha="center", va="center", zorder=6,
                      bbox=dict(boxstyle="round,pad=0.12", facecolor="white", edgecolor=color, linewidth=0.8))


def kept_apart(places, gap):
    """{name: place}, moved as little as a sweep forth and back needs for neighbours to be `gap` apart."""
    names = sorted(places, key=places.get)
    moved = [places[name] for name in names]
    for i in range(1, len(moved)):
        overlap = gap - (moved[i] - moved[i - 1])
        if overlap > 0:
            moved[i] += overlap / 2
            moved[i - 1] -= overlap / 2
    for i in range(len(moved) - 1, 0, -1):
        moved[i - 1] = min(moved[i - 1], moved[i] - gap)
    return dict(zip(names, moved))


def scaled(look, factor):
    return {**look, **{key: look[key] * factor for key in ("markersize", "markeredgewidth")}}


def size_for(axes, num_matches):
    """A factor that makes marks smaller where more than 45 of them share a square inch."""
    box = axes.get_window_extent()
    area = box.width * box.height / axes.figure.dpi ** 2
    return min(1, max(0.45, (45 * area / max(num_matches, 1)) ** 0.5))


def draw_matches(axes, pixels, groups):
    size = size_for(axes, len(pixels))
    for key, members in groups.items():
        for look in (LOOKS[key][1], *([RING] if key in RINGED else [])):
            axes.plot(*pixels[members].T, linestyle="none", clip_on=False, zorder=3, **scaled(look, size))


def draw_numbers(axes, pixels, selected, size):
    """A bold ring and a number at each selected match, the number towards the middle of the image."""
    for number, index in enumerate(selected, 1):
        aside = [-1 if pixels[index, 0] > 0.93 * size[0] else 1, -1 if pixels[index, 1] < 0.07 * size[1] else 1]
        axes.plot(*pixels[index], marker="o", markersize=7, markerfacecolor="none", markeredgecolor="black",
                  markeredgewidth=1, clip_on=False, zorder=5)
        axes.annotate(f"{number}", pixels[index], xytext=(7 * aside[0], 6.5 * aside[1]), textcoords="offset points",
                      fontsize=7.5, fontweight="bold", ha="center", va="center", zorder=7, annotation_clip=False,
                      path_effects=[withStroke(linewidth=2, foreground="white")])


def draw_image_pair(panels, trial, estimate, look):
    """Both images of one row."""
    groups = groups_of(trial, estimate)
    draw_lines(panels[1], trial, estimate, look)
    for axes, pixels, (width, height) in zip(panels, (trial.matches[:, :2], trial.matches[:, 2:]), trial.sizes):
        draw_matches(axes, pixels, groups)
        draw_numbers(axes, pixels, trial.selected, (width, height))
        axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5), xticks=[], yticks=[])
        axes.grid(False)
        axes.spines[:].set_visible(True)


def legend_handles(trial, looks):
    """{name: handle} of every mark that the figure holds."""
    present = {key for estimate in trial.drawn for key in groups_of(trial, estimate)}
    handles = {}
    for key, (name, look) in reversed(LOOKS.items()):
        if key in present:
            handles[name] = (Line2D([], [], linestyle="none", **look),)
            if key in RINGED:
                handles[name] += (Line2D([], [], linestyle="none", **RING),)
    if trial.F_true is not None and trial.selected:
        handles["true epipolar line"] = Line2D([], [], **TRUE_LINE)
    colors = [looks[estimate.label].color for estimate in trial.drawn if estimate.F is not None]
    if colors and trial.selected:
        handles["estimated epipolar line"] = Line2D([], [], color=colors[0], **ESTIMATED_LINE)
    return handles
