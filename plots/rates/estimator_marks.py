"""Rates and scores of one condition: a panel per quantity, and in it a mark with its interval for each estimator."""

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from common import sheet, style
from common.command_line import PlotError
from common.text_size import fill
from rates.lines import (LEAST, STATED, STATED_LEVELS, are_numbers, caption_of, draw_zeros, ends_in_words, has_log_axis, in_panels,
                         is_all_zero, set_log_ticks, with_content)
from rates.selection import check_no_repetition, refusals_in_words, select_rates, title_of, with_sharpness

ROW, AROUND = 0.24, 0.95  # inches of an estimator; of title, axis and its numbers
NAME_WIDTH, NAMES_WIDTH, PANEL_WIDTH = 1.7, 2.2, 1.9  # inches: of a name; beside the panels; of the narrowest panel, on a screen
MOST_ABREAST = 4  # panels, on a screen; more stand in two lines


def check_one_condition(summary, rows):
    conditions = list(dict.fromkeys(rows.condition))
    if len(conditions) > 1:
        raise PlotError(f"{summary.path}: has {len(conditions)} conditions; give the factor on the x axis with --x, one of "
                        f"{', '.join(summary.factors) or 'none'}, or choose a condition, such as --where condition={conditions[0]}.")


def draw_marks(axes, points, looks):
    """Downward in the order of the study; the values of rates are fractions, their tick labels per cent."""
    for row, (name, look) in enumerate(looks.items()):
        for point in points[(points.estimator == name) & points.value.notna()].itertuples():
            axes.plot([point.lower, point.upper], [row, row], color=look.color, linewidth=1.2, zorder=2, label="_interval")
            axes.plot([point.value], [row], **{**look.line(), "linestyle": "none"}, zorder=3, clip_on=False)
    for quantity in set(points.quantity) & {*STATED_LEVELS, *LEAST}:
        axes.axvline((STATED_LEVELS | LEAST)[quantity], **STATED)
    axes.margins(x=0.08)
    is_of_numbers, low = are_numbers(points), min(points.lower.min(), points.value.min())
    if not is_of_numbers and not low > 0.5:  # of what is near one, the part that differs
        axes.set_xlim(left=0)
    if is_of_numbers and points.is_open.any():
        axes.set_xlim(right=points.upper.max())
    if has_log_axis(points, None) and is_of_numbers:
        axes.set_xscale("log")
        set_log_ticks(axes.xaxis)
    else:
        axes.xaxis.set_major_locator(MaxNLocator(4))
    if not is_of_numbers:
        axes.xaxis.set_major_formatter(FuncFormatter(lambda fraction, _: f"{100 * fraction:g}"))
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("" if is_of_numbers else f"{points.kind.iloc[0].capitalize()} (%)")


def new_figure(count, rows):
    """(figure, axes of each panel)."""
    width = sheet.current().width
    abreast = count if count <= MOST_ABREAST else -(-count // 2)
    if width is not None:
        abreast = max(1, min(count, int((width - NAMES_WIDTH + 0.6) / (0.75 * PANEL_WIDTH))))
    lines = -(-count // abreast)
    figure = Figure(figsize=(width or NAMES_WIDTH + PANEL_WIDTH * abreast, lines * (AROUND + ROW * rows)), layout="constrained")
    FigureCanvasAgg(figure)
    return figure, list(figure.subplots(lines, abreast, sharey=True, squeeze=False).flat)


def draw(summary, quantities):
    """The whole figure of a table of one condition."""
    quantities = with_sharpness(summary, quantities)
    rows = select_rates(summary, quantities, or_numbers=True)
    check_one_condition(summary, rows)
    check_no_repetition(summary.path, rows, ["estimator", "quantity"], lambda row: f"condition {row.condition}")
    rows = in_panels(rows)
    asked, (quantities, left_out) = quantities, with_content(rows, quantities)
    looks = style.equal_looks_of(list(dict.fromkeys(rows.estimator)))
    notes = ends_in_words(rows) + refusals_in_words(summary, rows, asked)
    if is_all_zero(rows):
        return draw_zeros(summary, asked, caption_of(rows, summary.factors, False, notes, asked, per="estimator"))
    figure, panels = new_figure(len(quantities), len(looks))
    letters = style.letters(len(quantities))
    for axes, quantity in zip(panels, quantities):
        draw_marks(axes, rows[rows.quantity == quantity], looks)
        axes.set_title("\n".join(fill(next(letters) + title_of(quantity), PANEL_WIDTH - 0.2, style.RC["axes.titlesize"])))
    for axes in panels[len(quantities):]:
        axes.set_axis_off()
    size = style.font_size(style.RC["ytick.labelsize"])
    panels[0].set_yticks(range(len(looks)), ["\n".join(fill(look.label, NAME_WIDTH, size)) for look in looks.values()])
    panels[0].set_ylim(len(looks) - 0.4, -0.6)
    style.add_legend_and_caption(figure, [], caption_of(rows, summary.factors, False, notes, left_out, per="estimator"))
    return figure
