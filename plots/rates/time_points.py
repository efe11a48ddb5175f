"""Success rates against the median time of a call."""

import math

from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from common import sheet, style
from common.command_line import PlotError
from common.summary_csv import numbers

COLUMNS = ("value", "lower", "upper")


def points_of(summary):
    """{estimator: (time, success)}, each a triple of value, lower and upper bound; times in ms."""
    rows = summary.rows.assign(**{column: numbers(summary, column, may_be_empty=True) for column in COLUMNS})
    found = {}
    for quantity in ("time_ms", "success"):
        part = rows[rows.quantity == quantity]
        if not len(part):
            raise PlotError(f"{summary.path}: has no '{quantity}'; write it with rcme summarize --pooled --times.")
        if part.estimator.duplicated().any():
            raise PlotError(f"{summary.path}: has several conditions; write it with rcme summarize --pooled --times.")
        for row in part.itertuples():
            found.setdefault(row.estimator, {})[quantity] = tuple(getattr(row, column) for column in COLUMNS)
    return {name: (point["time_ms"], point["success"]) for name, point in found.items() if len(point) == 2}


def front_of(points):
    """Of (time, success) those that no other beats in both, by time."""
    front = []
    for time, success in sorted(points, key=lambda point: (point[0], -point[1])):
        if not front or success > front[-1][1]:
            front.append((time, success))
    return front


def draw_point(axes, look, point):
    (time, time_lower, time_upper), (success, lower, upper) = point
    axes.errorbar(time, success, [[success - lower], [upper - success]], [[time - time_lower], [time_upper - time]],
                  fmt="none", ecolor=look.color, elinewidth=0.8, zorder=look.zorder)
    axes.plot(time, success, **{**look.line(), "linestyle": "none"}, zorder=look.zorder)


def points_by_estimator(summaries):
    """{estimator: [(time, success), ...] by time} of one study's summaries."""
    by_estimator = {}
    for summary in summaries:
        for name, point in points_of(summary).items():
            by_estimator.setdefault(name, []).append(point)
    return {name: sorted(points) for name, points in by_estimator.items()}


def draw_panel(axes, looks, by_estimator):
    for name, points in by_estimator.items():
        axes.plot([time[0] for time, _ in points], [success[0] for _, success in points], color=looks[name].color,
                  linestyle=looks[name].dashes, linewidth=0.9, zorder=looks[name].zorder)
        for point in points:
            draw_point(axes, looks[name], point)
    front = front_of([(time[0], success[0]) for points in by_estimator.values() for time, success in points])
    axes.step(*zip(*front), where="post", color="0.75", linewidth=4.5, alpha=0.45, zorder=0)
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter(FuncFormatter(lambda ms, _: f"{ms:g}"))
    if sheet.current().width is not None:  # a narrow panel may hold no power of ten
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5), numticks=7))
        axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda share, _: f"{100 * share:g}"))


def panels_for(count):
    """A figure and as many panels of it, row by row, two beside each other."""
    columns = min(count, style.panels_abreast(2))
    figure, axes = style.new_figure(math.ceil(count / columns), columns)
    for blank in axes.flat[count:]:
        blank.set_axis_off()
    if count == 1 and sheet.current().width is None:
        figure.set_size_inches(5.2, 3.9)
    for bottom in axes[-1]:
        bottom.set_xlabel("Time of a call (ms)")
    for left in axes[:, 0]:
        left.set_ylabel("Success (%)")
    return figure, list(axes.flat[:count])


def draw(summaries):
    """The whole figure, a panel per study."""
    by_study = {}
    for summary in summaries:
        by_study.setdefault(summary.rows.study.iloc[0], []).append(summary)
    panels = {study: points_by_estimator(files) for study, files in by_study.items()}
    looks = style.equal_looks_of(list(dict.fromkeys(name for points in panels.values() for name in points)))
    figure, axes = panels_for(len(panels))
    for panel, letter, (study, by_estimator) in zip(axes, style.letters(len(panels)), panels.items()):
        draw_panel(panel, looks, by_estimator)
        if len(panels) > 1:
            panel.set_title(style.title_lines(letter + style.in_words(study), min(len(panels), 2)))
    has_lines = any(len(points) > 1 for by_estimator in panels.values() for points in by_estimator.values())
    width = {"linewidth": 0.9} if has_lines else {"linestyle": "none"}
    handles = [axes[0].plot([], [], **{**look.line(), **width})[0] for look in looks.values()]
    trials = sorted(int(n) for summary in summaries for n in summary.rows[summary.rows.quantity == "success"].n)
    number = f"n = {trials[0]:,}" + (f" to {trials[-1]:,}" if trials[-1] > trials[0] else "")
    which = "A panel per study" if len(panels) > 1 else f"Study {next(iter(panels))}"
    style.add_legend_and_caption(figure, handles, f"{which}; success: neither failed nor refused, over all conditions, "
                                 f"with its 95 % interval ({number} for a point); time: median with its 95 % interval; " +
                                 ("a line joins one estimator's budgets, a file each; " if has_lines else "") +
                                 "broad grey: the points that no other beats in both.")
    return figure
