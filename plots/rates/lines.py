"""Rates and scores against one factor: a line with an interval band per estimator, or marks with bars where levels are words."""

import itertools
import math
from dataclasses import dataclass, replace

from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from common import direct_labels, sheet, style
from common.command_line import PlotError
from common.factor_axis import FactorAxis, abreast, rows_that_vary, split_into_panel_rows
from common.text_size import fill, height_of
from rates import coinciding
from rates.selection import (DRAWN_KINDS, ERROR_MEDIANS, NUMBER_KINDS, check_factor, check_no_repetition, fixed_levels,
                             interval_in_words, is_error, kind_in_words, n_in_words, number_intervals_in_words,
                             refusals_in_words, select_rates, title_of, titles_in_words, with_sharpness)

SHARED = "0.35"  # a band that several estimators have
STATED_LEVELS = {"nees_coverage": 0.95}  # what a quantity is where the covariance holds
LEAST = {"sd_over_crb": 1}  # below it no covariance is right
SMALL = 0.02  # a linear axis that ends at the worst rates shows those below it as nothing
STATED = dict(color="0.35", linewidth=0.9, linestyle=style.DASHED, zorder=1, label="_stated")
HEADROOM = 1.3  # times what is drawn: where the interval of a number ends that has no upper end
WANTED = ("success",)  # rates that are near one where all is well
COUNTS = "no one two three four five six seven eight nine ten eleven twelve".split()


@dataclass(frozen=True)
class Choices:
    """`floor`: where a logarithmic axis ends, and rates of zero stand; None: below the least rate that is not zero. `names`:
    the estimators that are named; None: all."""

    floor: float = None
    names: tuple = None


def draw_band(axes, x, lower, upper, color, zorder):
    axes.fill_between(x, lower, upper, color=color, alpha=0.13, linewidth=0, zorder=zorder - 1)


def with_interval(points):
    """Those that have one; an end that is missing would leave the axes without limits."""
    return points[points.lower.notna() & points.upper.notna()]


def draw_line(axes, points, look):
    """One estimator's line with its interval band; both break where a value is missing."""
    draw_band(axes, points.x, points.lower, points.upper, look.color, look.zorder)
    line, = axes.plot(points.x, points.value, **look.line(), clip_on=False, zorder=look.zorder)
    finish_line(axes, points, look, line)


def finish_line(axes, points, look, line):
    """The intervals of points that have no neighbours."""
    line.set_in_layout(line.get_xydata().size > 0 and points.value.notna().any())  # an empty one would confuse the layout
    gap = points.value.isna()
    alone = with_interval(points[~gap & gap.shift(1, fill_value=True) & gap.shift(-1, fill_value=True)])  # too narrow for a band
    axes.vlines(alone.x, alone.lower, alone.upper, color=look.color, alpha=0.5, linewidth=1, zorder=2)


def draw_lines(axes, points, looks):
    """All estimators' lines. Where some coincide their dashes and marks take turns; a band that several have is grey. Returns
    whether the mark of an estimator at x is drawn."""
    lines, bands = (coinciding.groups_of(points, looks, columns) for columns in (["value"], ["lower", "upper"]))
    taken, shared = coinciding.turns_of(points, lines)
    for name, look in looks.items():
        own = points[points.estimator == name]
        steps = [step for step in coinciding.steps_of(own, ["lower", "upper"]) if name not in bands.get(step, ())]
        draw_band(axes, *(coinciding.joined(steps) or ([], [], [])), look.color, look.zorder)
        steps = coinciding.steps_of(own, ["value"])
        apart = [step for step in steps if name not in lines.get(step, ())]
        if len(apart) == len(steps):
            line, = axes.plot(own.x, own.value, **look.line(), clip_on=False, zorder=look.zorder)
        else:
            line, = axes.plot(*(coinciding.joined(apart) or ([], [])), **look.line(), markevery=[], clip_on=False, zorder=look.zorder)
            marked = own[[(x, name) not in shared or (x, name) in taken for x in own.x]]
            marks, = axes.plot(marked.x, marked.value, **{**look.line(), "linestyle": "none", "label": "_marks"}, clip_on=False,
                               zorder=look.zorder + 0.2)
            marks.set_in_layout(marked.value.notna().any())
        finish_line(axes, own, look, line)
    coinciding.draw_in_turns(axes, lines, looks)
    if bands:
        draw_band(axes, *coinciding.joined(sorted(bands)), SHARED, 3)
    return lambda x, name: (x, name) not in shared or (x, name) in taken


def draw_abreast(axes, points, look, aside):
    """One estimator's marks with their intervals, beside those of the others: words have no line between them."""
    points = points[points.value.notna()]
    bars = with_interval(points)
    axes.vlines(bars.x, bars.lower, bars.upper, color=look.color, linewidth=1, zorder=2,
                transform=axes.transData + aside)
    line, = axes.plot(points.x, points.value, **{**look.line(), "linestyle": "none"}, transform=axes.transData + aside,
                      clip_on=False, zorder=look.zorder)
    line.set_in_layout(len(points) > 0)
    axes.update_datalim(points[["x", "value"]])  # which lines with a shift do not, and not every mark has an interval
    axes.autoscale_view()


def draw_upper_limits(axes, zeros, looks):
    """Arrows down from the upper bounds of rates that are zero; those at one x share a bound, so they stand abreast."""
    for _, at_one_x in zeros.groupby("x"):
        for position, row in enumerate(at_one_x.itertuples()):
            aside = abreast(axes, position, len(at_one_x), 24)
            for mark in looks[row.estimator].upper_limit():
                axes.plot([row.x], [row.upper], **mark, transform=axes.transData + aside, clip_on=False, zorder=4)


def draw_lines_from_floor(axes, points, looks, floor):
    """Lines on a logarithmic axis, on whose floor rates of zero stand, with open marks."""
    is_zero = points.value == 0
    is_marked = draw_lines(axes, points.assign(value=points.value.clip(lower=floor), lower=points.lower.clip(lower=floor)), looks)
    for row in points[is_zero].itertuples():
        if is_marked(row.x, row.estimator):
            _, mark = looks[row.estimator].upper_limit()
            axes.plot([row.x], [floor], **{**mark, "markersize": looks[row.estimator].marker_size}, clip_on=False, zorder=4)


def are_numbers(points):
    """Of any size, where rates are between 0 and 1."""
    return points.kind.isin(NUMBER_KINDS).any()


def has_log_axis(points, log_y):
    """`log_y` None: of errors, and of rates that are small. A number that is not positive has no place on such an axis."""
    if not are_numbers(points):
        return is_small(points) if log_y is None else log_y
    is_wanted = is_error(points.quantity.iloc[0]) if log_y is None else log_y
    return bool(is_wanted and (points.value > 0).any() and not (points.value <= 0).any())


def is_small(points):
    """Whether a logarithmic axis shows what a linear one does not: the rates of the best estimator, half of whose rates that
    are not zero are small. An estimator that is never wrong in this way needs no axis."""
    positive = points[(points.kind == "rate") & (points.value > 0) & ~points.quantity.isin((*WANTED, *STATED_LEVELS))]
    return len(positive) > 0 and positive.groupby("estimator").value.median().min() < SMALL


def draw_panel(axes, points, looks, axis, room, log_y, floor=None):
    """One quantity in one panel, all estimators; the y values of rates are fractions, their tick labels per cent."""
    points = points.sort_values("x", kind="stable")
    if log_y:
        axes.set_yscale("log", nonpositive="clip")
    if axis.is_numeric and log_y and not are_numbers(points):
        draw_lines_from_floor(axes, points, looks, floor)
    elif axis.is_numeric:
        draw_lines(axes, points, looks)
    elif log_y and not are_numbers(points):
        is_zero = points.value == 0
        draw_upper_limits(axes, points[is_zero], looks)
        points = points.assign(value=points.value.mask(is_zero), lower=points.lower.mask(is_zero))
    for position, (estimator, look) in enumerate([] if axis.is_numeric else looks.items()):
        draw_abreast(axes, points[points.estimator == estimator], look, abreast(axes, position, len(looks), room))
    for quantity in set(points.quantity) & {*STATED_LEVELS, *LEAST}:
        axes.axhline((STATED_LEVELS | LEAST)[quantity], **STATED)
    if points.value.isna().all():
        axes.text(0.5, 0.5, "no trials (n = 0)" if (points.n == 0).all() else "infinite", transform=axes.transAxes, ha="center",
                  va="center", color="0.4")
    if not are_numbers(points):
        axes.yaxis.set_major_formatter(FuncFormatter(lambda fraction, _: f"{100 * fraction:g}"))


def floor_of(points, axis, choices):
    """Of a logarithmic axis: 1, 2 or 5 times a power of ten, clearly below every rate that is not zero. Marks and bars side by
    side need none: there a zero is an arrow."""
    if are_numbers(points):
        return None
    if choices.floor is not None or not axis.is_numeric:
        return choices.floor
    most = min(points.value[points.value > 0], default=0.1) / 1.5
    power = 10.0 ** math.floor(math.log10(most))
    return max(digit * power for digit in (1, 2, 5) if digit * power <= most)


def set_log_ticks(axis):
    """At 1, 2 and 5 times the powers of ten, of a long axis at the powers."""
    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 200 * low else (1,), numticks=12))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def set_number_limits(column_of_axes, points, log_y):
    """From zero where nothing is below it; on a logarithmic axis around what is drawn. Up to where an interval without an upper
    end stops."""
    if not log_y and not (points[["value", "lower"]] < 0).any(axis=None):
        column_of_axes[0].set_ylim(bottom=0)
    if points.is_open.any():
        column_of_axes[0].set_ylim(top=points.upper.max())
    for axes in column_of_axes if log_y else ():
        set_log_ticks(axes.yaxis)


def set_y_limits(column_of_axes, points, log_y, floor=None):
    """From zero; on a logarithmic axis from the floor, else from half of the least value that is drawn."""
    if are_numbers(points):
        return set_number_limits(column_of_axes, points, log_y)
    if not log_y:
        column_of_axes[0].set_ylim(bottom=0, top=None if points[["value", "upper"]].max().max() > 0 else 1)
        return
    drawn = points.value.where(points.value > 0, points.upper)
    smallest = min(drawn.dropna(), default=0.1)
    column_of_axes[0].set_ylim(floor or smallest / 2, 1)
    for axes in column_of_axes:
        axes.yaxis.set_major_locator(LogLocator(numticks=12))
        axes.yaxis.set_minor_formatter(NullFormatter())
        if floor and (points.value == 0).any():
            decades = [10.0 ** power for power in range(-12, 1) if 10.0 ** power > floor]
            axes.set_yticks([floor, *decades], ["0", *(f"{100 * decade:g}" for decade in decades)])


def has_content(points):
    """Whether a value is there that is not zero; an infinite one has no place, but is no zero."""
    return bool((points.value.notna() & (points.value != 0)).any() or points.is_infinite.any())


def with_content(rows, quantities):
    """(quantities with a panel, those without: no trial had them); of none with content the first keeps its panel."""
    shown = [quantity for quantity in quantities if has_content(rows[rows.quantity == quantity])] or list(quantities[:1])
    return shown, [quantity for quantity in quantities if quantity not in shown]


def without_content_in_words(rows, quantity):
    """'Other refusals: none, at most 0.9 % at a point'."""
    points = rows[rows.quantity == quantity]
    if points.value.isna().all():
        return f"{title_of(quantity)}: no trials"
    at_most = "" if are_numbers(points) else f", at most {100 * points.upper.max():.2g} % at a point"
    return f"{title_of(quantity)}: 0 everywhere{at_most}"


def in_panels(rows):
    """The rows with what can be drawn of numbers, which may be infinite: `is_infinite` where a value is, `is_open` where an
    interval has no upper end. Such an interval ends above all that is drawn."""
    is_number = rows.kind.isin(NUMBER_KINDS)
    is_infinite = is_number & rows.value.map(math.isinf)
    is_open = is_number & ~is_infinite & rows.value.notna() & rows.lower.notna() & rows.upper.isna()
    ends = {column: rows[column].mask(is_infinite) for column in ("value", "lower", "upper")}
    rows = rows.assign(**ends, is_infinite=is_infinite, is_open=is_open)
    tops = rows.groupby("quantity")[["value", "lower", "upper"]].max().max(axis=1)
    return rows.assign(upper=rows.upper.mask(is_open, HEADROOM * rows.quantity.map(tops)))


def ends_in_words(rows):
    """Of what in_panels changed."""
    return (["no mark: infinite"] * bool(rows.is_infinite.any()) +
            ["intervals that reach the end of a panel have no upper end"] * bool(rows.is_open.any()))


def is_all_zero(rows):
    """Whether there is nothing to compare: every rate is zero."""
    return rows.kind.isin(DRAWN_KINDS).all() and rows.value.notna().any() and not has_content(rows)


def draw_zeros(summary, quantities, caption, names=()):
    """In place of panels a sentence, and what differs where nothing fails. `names`: what panels would show, so that --labels may
    name it."""
    figure, panels = style.new_figure(1, 1)
    known = [quantity for quantity in ERROR_MEDIANS if ((summary.rows.quantity == quantity) & (summary.rows.n != "0")).any()]
    advice = f"; to draw errors, give --quantities {','.join(known)}" if known else ""
    text = fill(f"{titles_in_words(quantities)}: 0 at every point{advice}.", figure.get_figwidth() - 0.5, style.font_size(9))
    for name in names:
        style.level_text(name)
    panels[0, 0].set_axis_off()
    panels[0, 0].text(0.5, 0.5, "\n".join(text), transform=panels[0, 0].transAxes, ha="center", va="center",
                      fontsize=style.font_size(9))
    figure.set_figheight(1.0 + height_of(len(text), 9))
    style.add_legend_and_caption(figure, [], caption)
    return figure


def rates_of(rows):
    return rows[rows.kind.isin(DRAWN_KINDS)]


def looks_of(estimators, is_numeric):
    """Lines of one width, but for those that --highlight chooses."""
    if is_numeric and sheet.current().highlight:
        return style.looks_of(estimators)
    return {name: replace(look, line_width=1.3) for name, look in style.equal_looks_of(estimators).items()}


def coincide(parts, looks, quantities):
    """Whether lines of two estimators lie on each other in a panel."""
    return any(coinciding.groups_of(part[part.quantity == quantity].sort_values("x", kind="stable"), looks, ["value"])
               for _, part in parts for quantity in quantities)


def caption_of(rows, other_factors, is_numeric, notes, left_out, per="point"):
    rates = rates_of(rows)
    kinds = ([interval_in_words(rates)] if len(rates) else []) + number_intervals_in_words(rows)
    return "; ".join([f"Study {rows.study.iloc[0]}", *fixed_levels(rows, other_factors), n_in_words(rows, per),
                      f"{'bands' if is_numeric else 'bars'}: {', '.join(kinds)} intervals"] +
                     notes +
                     [f"dashed: the stated level, {100 * level:g} %" for quantity, level in STATED_LEVELS.items()
                      if quantity in set(rows.quantity)] +
                     [f"dashed: {least}, below which no covariance is right" for quantity, least in LEAST.items()
                      if quantity in set(rows.quantity)] +
                     [without_content_in_words(rows, quantity) for quantity in left_out]) + "."


def ends_of(points, looks, floor):
    """Where each estimator's line ends, for its name."""
    ends = []
    for estimator, look in looks.items():
        known = points[(points.estimator == estimator) & points.value.notna()].sort_values("x")
        if len(known):
            last = known.iloc[-1]
            ends.append(direct_labels.End(last.x, max(last.value, floor) if floor else last.value, look.label, look.text_color,
                                          look.is_highlighted))
    return ends


def others_end(ends):
    """One name of all grey lines, at the middle one of their ends."""
    words = COUNTS[len(ends)] if len(ends) < len(COUNTS) else str(len(ends))
    return replace(sorted(ends, key=lambda end: end.y)[len(ends) // 2], text=f"{words} other{'s' * (len(ends) > 1)}")


def named_ends(points, looks, named, floor):
    """Of the lines that have a name, and of the grey ones that have none."""
    ends = ends_of(points, named, floor)
    others = ends_of(points, {name: look for name, look in looks.items() if look.is_rest and name not in named}, floor)
    return ends + ([others_end(others)] if others else [])


def with_names(looks, choices):
    """The looks of the estimators that are named."""
    unknown = [name for name in choices.names or () if name not in looks]
    if unknown:
        raise PlotError(f"--names {unknown[0]}: no such estimator is drawn; allowed: {', '.join(looks)}.")
    return {name: look for name, look in looks.items() if choices.names is None or name in choices.names}


def axis_text(quantity):
    """The title of a quantity that is no share, beside its axis."""
    return "Error (deg)" if is_error(quantity) else title_of(quantity)


def draw(summary, x, quantities, log_y=None, choices=Choices()):
    """The whole figure: quantities side by side, one row of panels per combination of the other factors. Names stand beside
    the lines where there is one panel abreast and room, in a legend elsewhere. `log_y` None: where rates are small."""
    check_factor(summary, "--x", x)
    quantities = with_sharpness(summary, quantities)
    rows = select_rates(summary, quantities, or_numbers=True)
    axis = FactorAxis(x, rows[x])
    other_factors = [factor for factor in summary.factors if factor != x]
    rows = in_panels(rows_that_vary(rows.assign(x=axis.positions(rows[x])), other_factors))
    asked, (quantities, left_out) = quantities, with_content(rows, quantities)
    parts = split_into_panel_rows(summary.path, rows, other_factors)
    for _, part in parts:
        check_no_repetition(summary.path, part, ["x", "estimator", "quantity"], lambda row: f"x = {row[x]}")
    looks = looks_of(list(dict.fromkeys(rows.estimator)), axis.is_numeric)
    refusals = refusals_in_words(summary, rows, asked)
    if is_all_zero(rows):
        return draw_zeros(summary, asked, caption_of(rows, other_factors, axis.is_numeric, refusals, asked), [x, *axis.levels])
    figure, panels = style.new_figure(len(parts), len(quantities), axis.height_of_names(len(quantities)), may_fold=True)
    letters = style.letters(panels.size)
    drawn = {quantity: rows[rows.quantity == quantity] for quantity in quantities}
    is_log = {quantity: has_log_axis(drawn[quantity], log_y) for quantity in quantities}
    floors = {quantity: floor_of(drawn[quantity], axis, choices) if is_log[quantity] else None for quantity in quantities}
    for (r, (levels, part)), (c, quantity) in itertools.product(enumerate(parts), enumerate(quantities)):
        draw_panel(panels[r, c], part[part.quantity == quantity], looks, axis, axis.room(len(quantities)), is_log[quantity],
                   floors[quantity])
        title = next(letters) + title_of(quantity) + (f", {levels}" if levels else "")
        panels[r, c].set_title(style.title_lines(title, len(quantities)))
    for c, quantity in enumerate(quantities):
        set_y_limits(panels[:, c], drawn[quantity], is_log[quantity], floors[quantity])
    for axes in style.bottom_panels(panels):
        axis.prepare(axes, len(quantities))  # the x axis is shared by all panels
    left = style.left_panels(panels)
    for (_, c), axes in zip(itertools.product(range(len(parts)), range(len(quantities))), panels.flat):
        points = drawn[quantities[c]]
        if any(axes is one for one in left):
            axes.set_ylabel(axis_text(quantities[c]) if are_numbers(points) else f"{kind_in_words(rates_of(rows))} (%)")
    named = with_names(looks, choices)
    has_names = axis.is_numeric and len(quantities) == 1 and len(parts) <= 2 and direct_labels.make_room(
        figure, len(parts), [*(look.label for look in named.values()), *["others"] * (len(named) < len(looks))])
    has_zeros = any(is_log[quantity] and (drawn[quantity].value == 0).any() for quantity in quantities)
    handles = [handle for handle in panels[0, 0].get_legend_handles_labels()[0]
               if handle.get_label() in {look.label for look in named.values()}]
    notes = [note for note, is_needed in [
        ("open marks: rate zero" if axis.is_numeric else "arrows: rate zero, at its upper bound", has_zeros),
        ("coinciding lines alternate, their band is grey",
         axis.is_numeric and coincide(parts, looks, quantities))] if is_needed] + ends_in_words(rows) + refusals
    style.add_legend_and_caption(figure, [] if has_names else handles,
                                 caption_of(rows, other_factors, axis.is_numeric, notes, left_out))
    for axes, (_, part) in zip(panels[:, 0], parts if has_names else []):
        direct_labels.add(axes, named_ends(part[part.quantity == quantities[0]], looks, named, floors[quantities[0]]))
    return figure
