"""Success rates against the median time of a call."""

from matplotlib.ticker import FuncFormatter

from common import style
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
                  fmt="none", ecolor=look.color, elinewidth=0.8)
    axes.plot(time, success, **{**look.line(), "linestyle": "none"})


def draw(summaries):
    """The whole figure."""
    by_estimator = {}
    for summary in summaries:
        for name, point in points_of(summary).items():
            by_estimator.setdefault(name, []).append(point)
    looks = style.equal_looks_of(list(by_estimator))
    figure, panels = style.new_figure(1, 1)
    axes = panels[0, 0]
    for name, points in by_estimator.items():
        points.sort()
        axes.plot([time[0] for time, _ in points], [success[0] for _, success in points], color=looks[name].color,
                  linestyle=looks[name].dashes, linewidth=0.9)
        for point in points:
            draw_point(axes, looks[name], point)
    front = front_of([(time[0], success[0]) for points in by_estimator.values() for time, success in points])
    axes.step(*zip(*front), where="post", color="0.75", linewidth=4, alpha=0.5, zorder=0)
    axes.set(xscale="log", xlabel="Time of a call (ms)", ylabel="Success (%)")
    axes.xaxis.set_major_formatter(FuncFormatter(lambda ms, _: f"{ms:g}"))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda share, _: f"{100 * share:g}"))
    figure.set_size_inches(5.2, 3.9)
    handles = [axes.plot([], [], **looks[name].line())[0] for name in by_estimator]
    studies = ", ".join(dict.fromkeys(summary.rows.study.iloc[0] for summary in summaries))
    style.add_legend_and_caption(figure, handles, f"Study {studies}; success: neither failed nor refused, over all conditions, "
                                 "with its 95 % interval; time: median with its 95 % interval; a line joins one estimator's "
                                 "budgets; grey: the points that no other beats in both.")
    return figure
