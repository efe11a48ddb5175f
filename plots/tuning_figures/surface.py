"""Rates over the options that `rcme tune` varied: a map of coloured bands over the first two numeric ones, or a curve
over the only one; a row of panels per combination of the others."""

import math
from dataclasses import dataclass, replace

import numpy as np
import pandas
from matplotlib.markers import CARETDOWN, CARETLEFT, CARETRIGHT, CARETUP
from matplotlib.patheffects import withStroke
from matplotlib.transforms import ScaledTranslation

from common import sheet, style
from common.command_line import PlotError
from common.factor_axis import abreast, split_into_panel_rows
from common.summary_csv import rows_where, same_level
from common.text_size import fill
from rates.cells import COLORS, text_color
from rates.lines import draw_abreast, draw_line
from rates.rate_bands import BORDERS, QUANTITIES, SCALE, TARGET, add_color_bar, color_of, per_cent
from rates.selection import n_in_words
from tuning_figures.marks import (CERTIFIED, EXACT, TARGET_LINE, TUNED, LevelAxis, add_legend_and_caption, handle, head_in_words,
                        in_words, looks_of, marks_of, plot_points, target_handle, tuned_handle, tuned_in_words)
from tuning_figures.tune_file import FALSE_REFUSAL

INSET, STEP = 10, 7  # points: from the edge to a mark that belongs beyond it, and between marks of one place
SHORT_LINE, LABEL_ROOM, LABEL_INSET = 0.12, 0.035, 0.07  # of the panel: what has no label; about INSET
TITLE_SIZE = 8.5  # points
MANY = 200  # settings on a panel; beyond, their marks are smaller
PANEL_WIDTH = {2: 2.5, 3: 1.9}  # inches that a title may take
CARETS = {(0, -1): CARETLEFT, (0, 1): CARETRIGHT, (1, -1): CARETDOWN, (1, 1): CARETUP}
WHITE_RIM = [withStroke(linewidth=3, foreground="white")]
CURVE = style.Look("fresh trials", style.BLUE, "")


@dataclass(frozen=True)
class Spot:
    """A setting to mark, on the panels of its further levels."""

    name: str
    look: dict
    levels: tuple
    rates: dict
    color: str


class Surface:
    """The settings, those that `conditions` ask for, and which options are axes, rows of panels or fixed."""

    def __init__(self, tune, conditions):
        names = [option.name for option in tune.options]
        rows = pandas.DataFrame([setting.levels for setting in tune.settings], columns=names, dtype=str)
        self.tune, self.rows = tune, rows_where(tune.path, rows, names, conditions)
        self.options = [replace(option, levels=tuple(dict.fromkeys(self.rows[option.name]))) for option in tune.options]
        varying = [option for option in self.options if len(option.levels) > 1]
        numeric = [option for option in varying if option.is_numeric]
        if not varying:
            raise PlotError(f"{tune.path}: no option varies, so there is no surface; give one of "
                            f"{', '.join(names)} two or more levels.")
        self.on_axes = numeric[:2] or varying[:1]
        self.axes = [LevelAxis(option) for option in self.on_axes]
        self.others = [option for option in self.options if option not in self.on_axes]
        self.quantities = ["failure", "refusal"] + ["false_refusal"] * (tune.target.kind == FALSE_REFUSAL)

    def is_map(self):
        return len(self.on_axes) == 2

    def parts(self):
        """[(title, rows)]; a row's index is the number of its setting."""
        words = {option.name: option.level_in_words for option in self.others}
        return split_into_panel_rows(self.tune.path, self.rows, list(words), lambda name, level: words[name](level))

    def level(self, levels, option):
        return levels[[known.name for known in self.options].index(option.name)]

    def is_on(self, spot, part):
        """Whether the panels of these rows hold the spot: its levels of the further options are theirs."""
        has_their_levels = all(same_level(self.level(spot.levels, option), part[option.name].iloc[0])
                               for option in self.others)
        return has_their_levels and None not in self.locate(spot)

    def locate(self, spot):
        """[(place, side)] along the axes."""
        return [axis.locate(self.level(spot.levels, axis.option)) for axis in self.axes]

    def beyond(self, spot):
        """In words, where beyond the edge the spot lies; nothing where it does not."""
        options = [axis.option for axis, (_, side) in zip(self.axes, self.locate(spot)) if side]
        return in_words(options, [self.level(spot.levels, option) for option in options])


def spots_of(tune):
    """The other estimators and, on top, the tuned setting; those that have a place among the levels."""
    spots = [Spot(other.name(), marks_of(look), other.levels, other.rates, look.color)
             for other, look in zip(tune.others, looks_of(tune.others)) if other.levels is not None]
    if tune.tuned:
        spots.append(Spot("the tuned setting", TUNED, tune.tuned.levels, tune.tuned.rates, TARGET))
    return spots


def grid_of(surface, part, quantity):
    """The rates, [y, x] in order of place; masked where there were no trials."""
    x, y = surface.axes
    row_of, column_of = ({level: place for place, level in enumerate(axis.levels)} for axis in (y, x))
    grid = np.full((len(row_of), len(column_of)), math.nan)
    for number, levels in zip(part.index, part[[x.name, y.name]].itertuples(index=False, name=None)):
        rate = surface.tune.settings[number].rates[quantity]
        grid[row_of[levels[1]], column_of[levels[0]]] = rate.value
    return np.ma.masked_invalid(grid)


def free_place(lines, taken, axes):
    """The point of these lines of one level that is farthest from what is taken and from the edges, in fractions of the
    panel; None where they are too short for a label or lie too close."""
    to_panel = axes.transLimits.transform
    points = [point for line in map(to_panel, filter(len, lines)) if max(np.ptp(line, axis=0)) > SHORT_LINE
              for start, end in zip(line, line[1:]) for point in np.linspace(start, end, 8)]
    if not points:
        return None
    points = np.array(points)
    room = np.min([points, 1 - points], axis=(0, 2))
    for place in taken:
        room = np.minimum(room, np.hypot(*(points - place).T))
    return points[np.argmax(room)] if max(room) > LABEL_ROOM else None


def label_lines(axes, lines, taken, bold):
    """A label on each line where most room is; its place is taken then."""
    labels = []
    for number, of_level in enumerate(lines.allsegs):
        place = free_place(of_level, taken, axes)
        if place is None:
            continue
        taken.append(place)
        labels.append(tuple(axes.transLimits.inverted().transform(place)))
    if labels:
        return axes.clabel(lines, fmt=lambda level: per_cent(level) + " %" * bold, fontsize=style.font_size(7 if bold else 6.5),
                           inline_spacing=2, manual=labels)
    return []


def draw_lines(axes, x, y, grid, levels, taken, bold=False):
    """Labelled lines of equal rate; those levels that the rates do not cross have none."""
    levels = [level for level in levels if grid.min() < level < grid.max()]
    if not levels:
        return
    look = dict(colors=[text_color(color_of(level)) for level in levels], linewidths=0.6)
    if bold:
        look = dict(colors=[TARGET], linewidths=TARGET_LINE["linewidth"], linestyles=[TARGET_LINE["linestyle"]])
    lines = axes.contour(x, y, grid, levels=levels, **look)
    labels = label_lines(axes, lines, taken, bold)
    for part in [*getattr(lines, "collections", [lines]), *labels] if bold else []:
        part.set_path_effects(WHITE_RIM)


def draw_map(axes, surface, part, quantity, spots):
    """Bands between the settings' rates, lines at their borders, and certified settings."""
    x, y = surface.axes
    grid, target = grid_of(surface, part, quantity), surface.tune.target.level(quantity)
    certified = part[[surface.tune.settings[number].is_certified for number in part.index]]
    certified = x.positions(certified[x.name]), y.positions(certified[y.name])
    axes.set(xlim=(x.places()[0], x.places()[-1]), ylim=(y.places()[0], y.places()[-1]))
    axes.patch.set(facecolor="0.93", hatch="///", edgecolor="0.7")
    if grid.count():
        axes.contourf(x.places(), y.places(), grid, levels=BORDERS, cmap=COLORS, norm=SCALE)
        taken = [axes.transLimits.transform(place) for place in zip(*certified)]
        for spot in spots:
            place, side = zip(*surface.locate(spot))
            taken += [axes.transLimits.transform(place) - inset * np.array(side) for inset in (0, LABEL_INSET)]
        draw_lines(axes, x.places(), y.places(), grid, [target], taken, bold=True)
        draw_lines(axes, x.places(), y.places(), grid, [border for border in BORDERS if border != target], taken)
    size = CERTIFIED["markersize"] * (0.75 if len(part) > MANY else 1)
    plot_points(axes, *certified, **{**CERTIFIED, "markersize": size}, zorder=4, label="_certified")
    axes.grid(False)


def points_of(surface, part, quantity):
    """The settings along the only axis, as the lines of other figures have them."""
    axis, settings = surface.axes[0], [surface.tune.settings[number] for number in part.index]
    rates = [setting.rates[quantity] for setting in settings]
    return pandas.DataFrame({"x": axis.positions(part[axis.name]), "is_certified": [s.is_certified for s in settings],
                             **{key: [getattr(rate, key) for rate in rates] for key in ("value", "lower", "upper")}}
                            ).sort_values("x")


def draw_curve(axes, surface, part, quantity):
    """A line with its band, or marks where levels are words; and certified settings."""
    points, axis, target = points_of(surface, part, quantity), surface.axes[0], surface.tune.target.level(quantity)
    if axis.is_numeric:
        draw_line(axes, points, CURVE)
    else:
        draw_abreast(axes, points, replace(CURVE, marker="o"), abreast(axes, 0, 1, STEP))
    if not math.isnan(target):
        axes.axhline(target, **TARGET_LINE, zorder=1, label="_target")
    certified = points[points.is_certified]
    plot_points(axes, certified.x, certified.value, **CERTIFIED, zorder=4, label="_certified")


def draw_spots(axes, surface, spots, quantity):
    """Each at its place; those of one place side by side, those beyond the edge within it with an arrow."""
    placed = {}
    for spot in spots:
        located = surface.locate(spot)
        if not surface.is_map():
            rate = spot.rates.get(quantity)
            if rate is None or math.isnan(rate.value):
                continue
            located.append((rate.value, 0))
        placed.setdefault(tuple(place for place, _ in located), []).append((spot, [side for _, side in located]))
    for place, members in placed.items():
        for position, (spot, sides) in enumerate(members):
            draw_spot(axes, place, sides, STEP * (position - (len(members) - 1) / 2), spot,
                      None if surface.is_map() else spot.rates[quantity])


def draw_spot(axes, place, sides, aside, spot, rate):
    def shifted(points):
        return axes.transData + ScaledTranslation(points[0] / 72, points[1] / 72, axes.figure.dpi_scale_trans)

    at = [[value] for value in place]
    shift = [-INSET * side for side in sides]
    shift[1 if sides[0] and not rate else 0] += aside
    if rate:
        axes.vlines(at[0], rate.lower, rate.upper, color=spot.color, linewidth=1, transform=shifted(shift), zorder=5)
    axes.plot(*at, **{**spot.look, "label": f"_{spot.name}"}, transform=shifted(shift), clip_on=False, zorder=6)
    for direction, side in enumerate(sides):
        if side:  # its tip is on the edge
            axes.plot(*at, linestyle="none", marker=CARETS[direction, side], color=spot.color, markeredgecolor="white",
                      markeredgewidth=0.5, transform=shifted([0 if k == direction else shift[k] for k in (0, 1)]),
                      clip_on=False, zorder=6, label="_beyond")


def legend_of(surface, spots):
    """Handles of what stands somewhere."""
    handles = tuned_handle(surface.tune) if any(spot.look is TUNED for spot in spots) else []
    if any(surface.tune.settings[number].is_certified for number in surface.rows.index):
        handles.append(handle("certified setting", **CERTIFIED))
    handles += target_handle(surface.tune.target, surface.quantities)
    for spot in spots:
        if spot.look is not TUNED:
            beyond = surface.beyond(spot)
            handles.append(handle(spot.name + (f"; arrow: at {beyond}" if beyond else ""), **spot.look))
    return handles


def caption_of(surface, missing):
    """`missing`: names of what has no place on the surface."""
    tune, fixed = surface.tune, [option for option in surface.others if len(option.levels) == 1]
    settings = [tune.settings[number] for number in surface.rows.index]
    counts = pandas.DataFrame({"n": [setting.rates[quantity].n for setting in settings
                                     for quantity in surface.quantities]})
    sentences = [[head_in_words(tune), *tuned_in_words(tune)],
                 [in_words(fixed, [option.levels[0] for option in fixed])] if fixed else [],
                 ["rates on fresh trials", n_in_words(counts, "setting"),
                  "between settings interpolated" if surface.is_map() else
                  f"{'band' if surface.axes[0].is_numeric else 'bars'}: {EXACT}"],
                 ["hatched: no trials (n = 0)"] if surface.is_map() and counts.n.min() == 0 else [],
                 [f"levels of {axis.option.symbol()} stand evenly" for axis in surface.axes
                  if axis.is_numeric and axis.is_even],
                 [f"without a place among these levels: {', '.join(missing)}"] if missing else []]
    return " ".join(sentence[:1].upper() + sentence[1:] + "." for sentence in map("; ".join, sentences) if sentence)


def draw_panel(axes, surface, part, quantity, spots):
    spots = [spot for spot in spots if surface.is_on(spot, part)]
    if surface.is_map():
        draw_map(axes, surface, part, quantity, spots)
    else:
        draw_curve(axes, surface, part, quantity)
    draw_spots(axes, surface, spots, quantity)


def name_axes(panels, surface):
    for axes in panels[-1]:
        surface.axes[0].prepare(axes, "x", len(panels[0]), margin=0 if surface.is_map() else 0.04)
    left = style.left_panels(panels)
    for axes in panels.flat:
        if surface.is_map():
            surface.axes[1].prepare(axes, "y", len(panels[0]))
        else:
            axes.set_ylim(bottom=0)
            axes.yaxis.set_major_formatter(per_cent)
            axes.set_ylabel("Rate (%)")
        if axes not in left:
            axes.set_ylabel("")


def title_of(rate, levels, width):
    """In one line where that fits, else the levels below the rate."""
    whole = f"{rate}, {levels}" if levels else rate
    lines = fill(whole, width, TITLE_SIZE)
    return whole if len(lines) == 1 else "\n".join([rate, *fill(levels, width, TITLE_SIZE)])


def draw_surface(tune, conditions=()):
    """The whole figure: failure, refusal and, if the target is about them, false refusals side by side."""
    surface = Surface(tune, conditions)
    parts = surface.parts()
    spots = [spot for spot in spots_of(tune) if any(surface.is_on(spot, part) for _, part in parts)]
    shown = {spot.name for spot in spots}
    missing = [other.name() for other in tune.others if other.name() not in shown]
    missing += ["the tuned setting"] * bool(tune.tuned and "the tuned setting" not in shown)
    figure, panels = style.new_figure(len(parts), len(surface.quantities))
    letters = style.letters(panels.size)
    for row, (levels, part) in zip(panels, parts):
        for axes, quantity in zip(row, surface.quantities):
            draw_panel(axes, surface, part, quantity, spots)
            axes.set_title(title_of(next(letters) + QUANTITIES[quantity], levels, PANEL_WIDTH[len(row)] if sheet.current().width is None else
                                    style.room_of_panel(len(row)) - 0.6), pad=9)
    name_axes(panels, surface)
    if surface.is_map():
        add_color_bar(figure, math.nan, ax=list(panels.flat), fraction=0.05, pad=0.015, aspect=25 * len(parts))
    add_legend_and_caption(figure, legend_of(surface, spots), caption_of(surface, missing))
    return figure
