#!/usr/bin/python3
"""Draws one quantity of every estimator, with its interval, one below the other.

It draws what the file says and computes nothing: values and intervals are those of `rcme summarize`.
"""

import sys

from common import style
from common.command_line import FigureParser, PlotError, check_figure_path, draw_figure
from common.summary_csv import read_summary, where

EXAMPLE = """
example:
  rcme summarize run.sqlite --pooled --format csv --out summary.csv
  rcme plot forest summary.csv --quantity success --out success
"""


def rows_of(summary, quantity):
    """One row per estimator, in the order of the file."""
    rows = summary.rows[summary.rows.quantity == quantity]
    if rows.empty:
        raise PlotError(f"--quantity {quantity}: {summary.path} has no such quantity.")
    if rows.estimator.duplicated().any():
        raise PlotError(f"{summary.path}: has several rows of an estimator; choose one condition with --where.")
    return rows


def draw_for(options):
    rows = rows_of(where(read_summary(options.summary), options.where), options.quantity)
    figure, axes = style.new_figure(1, 1)
    figure.set_size_inches(figure.get_figwidth(), 0.7 + 0.2 * len(rows))
    panel, looks = axes[0, 0], style.equal_looks_of(list(rows.estimator))
    for place, row in enumerate(rows.itertuples()):
        look = looks[row.estimator]
        panel.hlines(place, float(row.lower), float(row.upper), color=look.color, linewidth=1.2)
        panel.plot(float(row.value), place, **look.line())
    panel.set_yticks(range(len(rows)), [looks[name].label for name in rows.estimator])
    panel.set_ylim(len(rows) - 0.5, -0.5)
    panel.set_xlabel(style.in_words(options.quantity))
    counts = sorted(set(rows.n))
    style.add_legend_and_caption(figure, [], f"95 % intervals, n = {' to '.join(counts[:1] + counts[1:][-1:])}.")
    return figure


def parse(arguments):
    parser = FigureParser(prog="rcme plot forest", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("summary", metavar="SUMMARY.csv", help="output of 'rcme summarize RUN.sqlite --format csv'")
    parser.add_argument("--quantity", default="success", help="a quantity of the table (default: %(default)s)")
    parser.add_argument("--where", action="append", default=[], metavar="KEY=VALUE",
                        help="draw only these rows; KEY is a factor, study, condition or estimator; repeatable")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    options = parser.parse_args(arguments)
    check_figure_path(options.out)
    return options


def main(arguments=None):
    return draw_figure("forest.py", parse, draw_for, arguments)


if __name__ == "__main__":
    sys.exit(main())
