"""The figures of a surface: shares of variance, effects, maps of two factors, and the check of its predictions."""

import math

import numpy
from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import FuncFormatter, MaxNLocator

from common import style
from common.style import RC
from common.text_size import width_of
from surface.condition_encoder import is_there
from surface.cross_validation import BINS

COLORS = colormaps["cividis_r"]  # as of every map of rates: even to the eye; dark is much
SIGNED_COLORS = colormaps["PuOr"]  # of differences: 0 is white, below it orange
UNKNOWN = dict(facecolor="0.86", edgecolor="0.6", hatch="////", linewidth=0)
BAND = dict(color=style.SKY_BLUE, alpha=0.35, linewidth=0)
AXIS_NAME = {"failure": "Failure (%)", "coverage": "Coverage (%)", "P-y": "P \u2212 y (points)"}
MOST_CURVES, CURVES_ABREAST = 9, 3
MAP_WIDTH, TICK_GAP = 2.2, 0.05  # inches of a map's x axis, about, and between numbers below it


def grid_of_axes(rows, columns, width, height):
    """Panels that share no axis."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure, figure.subplots(rows, columns, squeeze=False)


per_cent = FuncFormatter(lambda fraction, _: f"{100 * fraction:g}".replace("-", "\u2212"))


def draw_indices(data, effects):
    """Bars of first-order and total shares, the greatest total on top."""
    rows = effects.indices.sort_values("total", ascending=False)
    rows = [*rows[rows.group != ""].itertuples(), *rows[rows.group == ""].itertuples()]
    figure, axes = grid_of_axes(1, 1, 5.2, 1.1 + 0.27 * len(rows))
    panel = axes[0, 0]
    for place, row in enumerate(rows):
        for kind, up, color, marker in (("first", -0.14, style.BLUE, "o"), ("total", 0.14, style.VERMILLION, "D")):
            if row.group == "" and kind == "first":
                continue
            value, low, high = (getattr(row, kind + end) for end in ("", "_lower", "_upper"))
            look = color if row.matters else "0.65"
            panel.plot([low, high], [place + up] * 2, color=look, linewidth=1.6, solid_capstyle="butt", zorder=2)
            panel.plot([value], [place + up], marker=marker, color=look, markersize=4.5, markeredgecolor="white",
                       markeredgewidth=0.5, zorder=3)
    panel.set_yticks(range(len(rows)))
    panel.set_yticklabels([name_of(row) for row in rows])
    panel.set(ylim=(len(rows) - 0.5, -0.5), xlim=(-0.01, min(1.0, max(row.total_upper for row in rows) * 1.08)))
    panel.grid(axis="y", visible=False)
    panel.xaxis.set_major_formatter(per_cent)
    panel.set_xlabel("Share of the variance between conditions (%)")
    handles = [Line2D([], [], color=color, marker=marker, markersize=4.5, linewidth=1.6, label=label)
               for color, marker, label in ((style.BLUE, "o", "first-order"), (style.VERMILLION, "D", "total"),
                                            ("0.65", "o", "may be none"))]
    style.add_legend_and_caption(figure, handles, f"{data.estimator}, {data.quantity}; {data.study}, {len(data.levels)} "
                                 "conditions; bars: 95 % intervals.")
    return figure


def name_of(row):
    return "no factor" if row.group == "" else style.in_words(row.group) + (" +" if row.with_keys else "")


def draw_curves(data, model, effects):
    """Partial dependence of the groups with the greatest total share; ticks below: the conditions."""
    order = effects.indices[effects.indices.group != ""].sort_values("total", ascending=False)
    groups = list(order.group[:MOST_CURVES])
    matters = dict(zip(order.group, order.matters))
    rows = math.ceil(len(groups) / CURVES_ABREAST)
    figure, axes = grid_of_axes(rows, min(CURVES_ABREAST, len(groups)), 2.45 * min(CURVES_ABREAST, len(groups)) + 0.4,
                                1.0 + 2.05 * rows)
    shown = effects.curves[effects.curves.group.isin(groups)]
    pad = 0.04 * (shown.upper.max() - shown.lower.min())
    for panel, group, letter in zip(axes.flat, groups, style.letters(len(groups))):
        draw_curve(panel, model, effects.curves[effects.curves.group == group], data.levels[group], matters[group])
        panel.set_title(letter + style.in_words(group))
        panel.set_ylim(shown.lower.min() - pad, shown.upper.max() + pad)
        panel.yaxis.set_major_formatter(per_cent)
    for panel in list(axes.flat)[len(groups):]:
        panel.set_visible(False)
    for panel in axes[:, 0]:
        panel.set_ylabel(AXIS_NAME[data.quantity])
    handles = [Line2D([], [], color=style.BLUE, label="mean over the other factors"), Patch(label="90 % band", **BAND)]
    style.add_legend_and_caption(
        figure, handles, f"{data.estimator}, {data.study}: mean of the conditions where all had one level of the factor. "
        "Ticks: levels that were run. Grey: the factor may not matter.")
    return figure


def draw_curve(panel, model, curve, levels, matters):
    column = next(column for column in model.encoder.columns if column.name == curve.group.iloc[0])
    color = style.BLUE if matters else "0.55"
    if column.words is not None:
        order = curve.sort_values("rate")
        places = numpy.arange(len(order))
        panel.vlines(places, order.lower, order.upper, color=color, linewidth=1.6)
        panel.plot(places, order.rate, "o", color=color, markersize=4.5, markeredgecolor="white", markeredgewidth=0.5)
        panel.set_xticks(places)
        panel.set_xticklabels([style.level_text(level).replace("_", " ") for level in order.level], rotation=35, ha="right",
                              rotation_mode="anchor", fontsize=6.5)
        panel.set_xlim(-0.6, len(order) - 0.4)
        return
    numbers = curve.level.astype(float)
    panel.fill_between(numbers, curve.lower, curve.upper, **(BAND if matters else dict(BAND, color="0.7")))
    panel.plot(numbers, curve.rate, color=color, linewidth=1.5)
    if column.is_log:
        log_axis(panel.xaxis, panel.set_xscale, numbers.min(), numbers.max())
    run = levels[is_there(levels)].astype(float)
    panel.plot(run, numpy.full(len(run), 0.012), "|", color="0.35", markersize=4, markeredgewidth=0.4, alpha=0.6,
               transform=panel.get_xaxis_transform(), clip_on=True)


LOG_TICKS = [m * 10.0**e for e in range(-6, 7) for m in (1, 2, 5)]


def log_axis(axis, set_scale, low, high):
    """A few round numbers."""
    set_scale("log")
    ticks = [tick for tick in LOG_TICKS if 0.99 * low <= tick <= 1.01 * high]
    axis.set_ticks(ticks if len(ticks) <= 6 else [tick for tick in ticks if f"{tick:e}"[0] == "1"])
    axis.set_major_formatter(FuncFormatter(lambda number, _: f"{number:g}"))
    axis.set_ticks([], minor=True)


def draw_maps(data, model, effects):
    pairs = [pair for pair in effects.maps.groupby(["first", "second"], sort=False) if pair[1].is_known.any()]
    columns = min(2, len(pairs))
    rows = math.ceil(len(pairs) / columns)
    figure, axes = grid_of_axes(rows, columns, 3.4 * columns + 0.8, 1.2 + 2.6 * rows)
    known = effects.maps[effects.maps.is_known]
    scale, colors = Normalize(known.rate.min(), known.rate.max()), COLORS
    if not data.is_rate:
        scale, colors = Normalize(-known.rate.abs().max(), known.rate.abs().max()), SIGNED_COLORS
    for panel, ((first, second), cells), letter in zip(axes.flat, pairs, style.letters(len(pairs))):
        draw_map(panel, model, cells, lambda rate: colors(scale(rate)), data.levels)
        panel.set_title(letter + f"{style.in_words(first)} \u00d7 {style.in_words(second)}", fontsize=7.5)
    for panel in list(axes.flat)[len(pairs):]:
        panel.set_visible(False)
    bar = figure.colorbar(ScalarMappable(scale, colors), ax=list(axes.flat), format=per_cent, shrink=0.7, pad=0.02)
    bar.set_label(AXIS_NAME[data.quantity])
    bar.outline.set_visible(False)
    handles = [Patch(label="not known", **UNKNOWN), Line2D([], [], linestyle="none", marker=".", color="black", markersize=3,
                                                         label="condition")]
    style.add_legend_and_caption(
        figure, handles, f"{data.estimator}, {data.study}: mean over the other factors; pairs with the strongest interaction. "
        "Not known: 90 % band wider than 30 points, or fewer than two conditions near.")
    return figure


def draw_map(panel, model, cells, color_of, levels):
    """Cells between the middles of their neighbours; axes in the scale of the factor."""
    (x_edges, x_of), (y_edges, y_of) = (edges_of(model, cells, side) for side in ("first", "second"))
    for row in cells.itertuples():
        i, j = x_of[row.first_level], y_of[row.second_level]
        look = dict(facecolor=color_of(row.rate), linewidth=0) if row.is_known else UNKNOWN
        panel.add_patch(Rectangle((x_edges[i], y_edges[j]), x_edges[i + 1] - x_edges[i], y_edges[j + 1] - y_edges[j], **look))
    panel.set(xlim=(x_edges[0], x_edges[-1]), ylim=(y_edges[0], y_edges[-1]))
    panel.grid(False)
    for axis, side, lookup in ((panel.xaxis, "first", x_of), (panel.yaxis, "second", y_of)):
        name_axis(axis, model, cells[side].iloc[0], lookup)
    x, y = (places_of(model, cells[side].iloc[0], lookup, levels) for side, lookup in (("first", x_of), ("second", y_of)))
    panel.plot(x, y, ".", color="black", markersize=2, alpha=0.55)


def edges_of(model, cells, side):
    """Borders of the cells along one axis, and {level: which cell}. Numbers lie at their positions 0..1, words side by side."""
    points = cells[[f"{side}_level", f"{side}_position"]].drop_duplicates().sort_values(f"{side}_position")
    positions = points[f"{side}_position"].to_numpy()
    lookup = {level: place for place, level in enumerate(points[f"{side}_level"])}
    if column_of(model, cells[side].iloc[0]).words is not None:
        return numpy.arange(len(positions) + 1.0), lookup
    if len(positions) == 1:
        return numpy.array([0.0, 1.0]), lookup
    middle = 0.5 * (positions[1:] + positions[:-1])
    return numpy.array([2 * positions[0] - middle[0], *middle, 2 * positions[-1] - middle[-1]]), lookup


def column_of(model, group):
    return next(column for column in model.encoder.columns if column.name == group)


def name_axis(axis, model, group, lookup):
    column = column_of(model, group)
    axis.set_label_text(style.in_words(group))
    if column.words is not None:
        axis.set_ticks([place + 0.5 for place in lookup.values()])
        axis.set_ticklabels([style.level_text(level).replace("_", " ") for level in lookup], fontsize=6.5)
        if axis.axis_name == "x":
            for label in axis.get_ticklabels():
                label.set(rotation=35, ha="right", rotation_mode="anchor")
        return
    low, high = (numpy.exp(column.low), numpy.exp(column.high)) if column.is_log else (column.low, column.high)
    even = [tick for tick in MaxNLocator(5, steps=[1, 2, 5, 10]).tick_values(low, high) if low <= tick <= high]
    ticks = [tick for tick in LOG_TICKS if low <= tick <= high] if column.is_log else even
    if axis.axis_name == "x":
        ticks = apart(ticks, model.encoder.positions(group, [f"{tick:.12g}" for tick in ticks]))
    axis.set_ticks(model.encoder.positions(group, [f"{tick:.12g}" for tick in ticks]))
    axis.set_ticklabels([f"{tick:.3g}" for tick in ticks])


def apart(ticks, positions):
    """Those whose numbers do not touch below a map; where some would, powers of ten come first."""
    chosen = []
    for tick, place in sorted(zip(ticks, positions), key=lambda pair: (f"{pair[0]:e}"[0] != "1", pair[0])):
        half = width_of(f"{tick:.3g}", RC["xtick.labelsize"]) / 2
        if all(abs(place - other) * MAP_WIDTH >= half + other_half + TICK_GAP for _, other, other_half in chosen):
            chosen.append((tick, place, half))
    return sorted(tick for tick, _, _ in chosen)


def places_of(model, group, lookup, levels):
    """Where the conditions lie along the axis."""
    if column_of(model, group).words is not None:
        spread = 0.15 + 0.7 * (numpy.arange(len(levels)) * 0.618034 % 1)
        return numpy.array([lookup.get(level, numpy.nan) for level in levels[group]]) + spread
    return model.encoder.positions(group, levels[group])


def draw_check(data, check):
    """Predicted against observed for held-out conditions, and the histogram of their probability integral transforms."""
    figure, axes = grid_of_axes(1, 2, 6.6, 3.1)
    left, right = axes[0]
    rows = check.rows
    low, high = min(rows.observed.min(), rows.predicted.min()), max(rows.observed.max(), rows.predicted.max())
    left.plot([low, high], [low, high], color="0.5", linewidth=0.8, linestyle=style.DOTTED, zorder=1)
    for inside, color in ((True, style.BLUE), (False, style.VERMILLION)):
        part = rows[rows.is_inside == inside]
        left.plot(part.predicted, part.observed, "o", color=color, markersize=2.8, alpha=0.6, markeredgewidth=0)
    unit = "%" if data.is_rate else "points"
    left.set(xlabel=f"Predicted ({unit})", ylabel=f"Observed ({unit})")
    for axis in (left.xaxis, left.yaxis):
        axis.set_major_formatter(per_cent)
    left.set_title("(a) Held-out conditions")
    right.bar((numpy.arange(BINS) + 0.5) / BINS, check.histogram * BINS, 0.92 / BINS, color="0.6", linewidth=0)
    right.axhline(1, color="0.3", linewidth=0.8, linestyle=style.DOTTED)
    right.set(xlabel="Probability integral transform", ylabel="Density", xlim=(0, 1))
    right.set_title("(b) Flat if calibrated")
    share, lower, upper, expected = check.inside
    gain, least, most = check.gain
    handles = [Line2D([], [], linestyle="none", marker="o", color=color, markersize=3, label=label) for color, label in
               ((style.BLUE, "inside of its 90 % predictive interval"), (style.VERMILLION, "outside"))]
    style.add_legend_and_caption(
        figure, handles, f"{data.estimator}, {data.study}; {len(rows)} conditions, ten folds. Inside: {100 * share:.0f} % "
        f"[{100 * lower:.0f}, {100 * upper:.0f}], expected {100 * expected:.0f} %. Log score against the constant, per "
        f"condition: {gain:+.3f} [{least:+.3f}, {most:+.3f}].")
    return figure
