"""The scene of a trial from above, and its two cameras close up from two sides; all in camera 1's frame (m): x to the
right, y down, z ahead."""

import numpy as np
from matplotlib.patches import Circle
from matplotlib.patheffects import withStroke

from common import style

MARKS = {  # kind: how its scene points are drawn
    "outlier": dict(marker="x", markersize=2.4, color="0.55", alpha=0.6, markeredgewidth=0.6),
    "undetectable": dict(marker="D", markersize=2.2, color=style.PURPLE, alpha=0.6, markerfacecolor="none",
                         markeredgewidth=0.6),
    "inlier": dict(marker="o", markersize=1.9, color=style.BLUE, markeredgewidth=0),
}
TRUE_BASELINE = dict(color="0.7", linewidth=4, solid_capstyle="butt")
MIDDLE = (2, 98)  # percentiles of the points that the view shows at least
LONG_M = 2000  # a longer view has axes in km

# A side to look from: coordinates to the right and up or down the panel, and the two rays of View.edges in its plane.
FROM_ABOVE = ((0, 2), slice(0, 2))
FROM_THE_RIGHT = ((2, 1), slice(2, 4))


def limits_of_scene(trial, shape):
    """((left, right), (near, far)) in the proportions of a panel (width, height). Some far points cannot stretch it: it
    holds the cameras and the middle of the points, if any, in each coordinate."""
    shown = np.array([view.centre_m for view in trial.views])[:, [0, 2]]
    if len(trial.points_m):
        shown = np.vstack([np.percentile(trial.points_m[:, [0, 2]], MIDDLE, axis=0), shown])
    scale = 1.1 * max(np.ptp(shown, axis=0) / shape) or 1
    middle, half = (shown.min(axis=0) + shown.max(axis=0)) / 2, scale * np.array(shape) / 2
    return tuple(zip(middle - half, middle + half))


def num_outside(trial, limits):
    (left, right), (near, far) = limits
    x, z = trial.points_m[:, 0], trial.points_m[:, 2]
    return int(np.sum((x < left) | (x > right) | (z < near) | (z > far)))


def draw_camera(axes, view, side, length):
    """A camera as the wedge it sees; returns the wedge's far corners."""
    plane, edges = side
    plane = list(plane)
    rays = view.edges[edges][:, plane]
    corners = view.centre_m[plane] + length * rays / max(np.linalg.norm(rays, axis=1))
    outline = np.array([corners[0], view.centre_m[plane], corners[1], corners[0]])
    axes.fill(*outline.T, facecolor="white", alpha=0.6, edgecolor="none", zorder=4)
    axes.plot(*outline.T, color="black", linewidth=0.9, zorder=5)
    return corners


def draw_directions(axes, trial, looks, side):
    """From camera 1 the true way to camera 2, and where each drawn estimator puts it at that length."""
    right, up = side[0]
    centre = trial.views[1].centre_m
    axes.plot([0, centre[right]], [0, centre[up]], **TRUE_BASELINE, zorder=6)
    for position, estimate in enumerate(reversed(trial.drawn)):
        if estimate.centre2_m is not None:
            rim = position / max(len(trial.drawn) - 1, 2)  # of equal ones, those below stay visible as a rim
            arrow = dict(arrowstyle="-|>", color=looks[estimate.label].color, linewidth=1.2 + 2.2 * rim, shrinkA=0,
                         shrinkB=0, mutation_scale=7 + 5 * rim)
            axes.annotate("", estimate.centre2_m[[right, up]], (0, 0), arrowprops=arrow, zorder=7 - rim / 2,
                          annotation_clip=False)


def draw_scene(axes, trial, looks, limits):
    (left, right), (near, far) = limits
    for kind, mark in MARKS.items():
        points = trial.points_m[trial.kinds == kind]
        axes.plot(points[:, 0], points[:, 2], linestyle="none", **mark, zorder=3)
    for view in trial.views:
        draw_camera(axes, view, FROM_ABOVE, 0.11 * (right - left))
    if trial.baseline_m:
        draw_directions(axes, trial, looks, FROM_ABOVE)
    unit = "m"
    if far - near > LONG_M:  # numbers of five digits would leave the figure
        unit = "km"
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(lambda metres, _: f"{metres / 1000:g}".replace("-", "\N{MINUS SIGN}"))
    axes.set(xlim=(left, right), ylim=(near, far), xlabel=f"x ({unit})", ylabel=f"z ({unit})")
    axes.set_title("The scene from above")
    axes.tick_params(labelsize=7)


def draw_close_up(axes, trial, looks, side, title):
    """The cameras within the circle of the true baseline's length around camera 1, the rim of all directions."""
    reach = 1.45 * trial.baseline_m
    axes.add_patch(Circle((0, 0), trial.baseline_m, facecolor="none", edgecolor="0.75", linewidth=0.7, linestyle=":"))
    for number, view in enumerate(trial.views):
        corners = draw_camera(axes, view, side, 0.32 * trial.baseline_m)
        outwards = (corners[number] - corners[1 - number]) / np.linalg.norm(corners[1] - corners[0])
        axes.annotate(f"{number + 1}", corners[number], xytext=5 * outwards * (1, -1 if side is FROM_THE_RIGHT else 1),
                      textcoords="offset points", fontsize=7, fontweight="bold", ha="center", va="center", zorder=8,
                      path_effects=[withStroke(linewidth=2, foreground="white")])
    draw_directions(axes, trial, looks, side)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), xticks=[], yticks=[])
    if side is FROM_THE_RIGHT:
        axes.invert_yaxis()  # y points down
    axes.set_title(title, fontsize=7.5)
    axes.grid(False)
    axes.spines[:].set_visible(True)
