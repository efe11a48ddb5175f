#!/usr/bin/python3
"""Draws how much more often each estimator fails than the reference on the same trials, or how much higher it scores,
against one factor.

It draws what the file says and computes nothing: differences, their intervals and Holm's p-values are those of `rcme
compare`. A mark is filled where the Holm-adjusted p-value is below 0.05.
"""

import sys

from common.command_line import FigureParser, draw_figure, names_of
from common.summary_csv import of_estimators, read_comparison, where
from rates.differences import draw

EXAMPLE = """
example:
  rcme compare run.sqlite --format csv > comparison.csv
  rcme plot paired_difference comparison.csv --x outlier_ratio --out difference
draws difference.png and difference.pdf: the failure rate of each estimator minus that of the study's first.

  rcme plot paired_difference comparison.csv --x outlier_ratio --out difference --event failure,failure_or_refusal \\
      --where sigma_px=1 --estimators rcme
draws two events, one estimator, at one noise level.

  rcme compare run.sqlite --of scores --format csv > scores.csv
  rcme plot paired_difference scores.csv --x outlier_ratio --out difference --event auc_5_deg,auc_10_deg
draws scores.
"""


def parse(arguments):
    parser = FigureParser(prog="rcme plot paired_difference", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("comparison", metavar="COMPARISON.csv", help="output of 'rcme compare RUN.sqlite --format csv'")
    parser.add_argument("--x", required=True, metavar="FACTOR", help="the factor on the x axis; words stand side by side")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    parser.add_argument("--event", default="failure", metavar="A,B",
                        help="events or scores of the table, one panel each (default: %(default)s)")
    parser.add_argument("--estimators", metavar="A,B", help="labels of the estimators to draw (default: all)")
    parser.add_argument("--where", action="append", default=[], metavar="KEY=VALUE",
                        help="draw only these rows; KEY is a factor, study, condition or estimator; repeatable")
    options = parser.parse_args(arguments)
    options.event = names_of("--event", options.event, "failure")
    options.estimators = [] if options.estimators is None else names_of("--estimators", options.estimators, "rcme")
    return options


def draw_for(options):
    comparison = of_estimators(where(read_comparison(options.comparison), options.where), options.estimators)
    return draw(comparison, options.x, options.event)


def main(arguments=None):
    return draw_figure("paired_difference.py", parse, draw_for, arguments)


if __name__ == "__main__":
    sys.exit(main())
