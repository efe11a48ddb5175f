#!/usr/bin/python3
"""Draws success against the time of a call, a panel per study in the files and a point per estimator and file, for comparisons
at several budgets; a line joins the points of one estimator, and a step the points that no other beats in both.

It draws what the files say: values and interval bounds are those of `rcme summarize --pooled --times`.
"""

import sys

from common.command_line import FigureParser, draw_figure
from common.summary_csv import read_summary
from rates.time_points import draw

EXAMPLE = """
example:
  rcme summarize own_rule.sqlite --pooled --times --format csv --out own_rule.csv
  rcme summarize at_10_ms.sqlite --pooled --times --format csv --out at_10_ms.csv
  rcme plot time_against_success own_rule.csv at_10_ms.csv --out success
"""


def parse(arguments):
    parser = FigureParser(prog="rcme plot time_against_success", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("summaries", metavar="SUMMARY.csv", nargs="+",
                        help="output of 'rcme summarize RUN.sqlite --pooled --times --format csv'")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    return parser.parse_args(arguments)


def draw_for(options):
    return draw([read_summary(path) for path in options.summaries])


def main(arguments=None):
    return draw_figure("time_against_success.py", parse, draw_for, arguments)


if __name__ == "__main__":
    sys.exit(main())
