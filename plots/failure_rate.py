#!/usr/bin/python3
"""Draws rates, scores, errors and other estimates against one factor: a panel per quantity, a line with its interval band per
estimator; where levels are words, marks and bars side by side. Of one condition, without --x, a mark with its interval for each estimator.

It draws what the file says and computes nothing: values and interval bounds are those of `rcme summarize`.
"""

import sys

from common.command_line import FigureParser, draw_figure, names_of
from common.summary_csv import of_estimators, read_summary, where
from rates import estimator_marks
from rates.lines import Choices, draw
from rates.selection import usual_quantities

EXAMPLE = """
example:
  rcme summarize run.sqlite --format csv > summary.csv
  rcme plot failure_rate summary.csv --x outlier_ratio --out failure_rate
draws failure_rate.png and failure_rate.pdf: the rate of failures, and of failures or refusals, of each estimator.

  rcme plot failure_rate summary.csv --x outlier_ratio --out errors \\
      --quantities rotation_error_median_deg,direction_error_median_deg
draws the median errors on logarithmic axes.

  rcme plot failure_rate summary.csv --x outlier_ratio --out failure_rate_1px \\
      --where sigma_px=1 --estimators standard,rcme --quantities failure --log-y
draws only the failure rate of two estimators at one noise level, on a logarithmic axis; there a rate of exactly zero,
which has no place, stands on the floor of the axis, or where levels are words is an arrow down from its upper bound.

  rcme plot failure_rate summary.csv --x outlier_ratio --out failure_rate --width 3.17 --format pdf,tikz \\
      --no-caption --labels rcme_rank_aware=Ours --labels failure="Wrong motions"
draws it for a column of a paper, with names of your own (every kind of figure has these options).

  rcme plot failure_rate summary.csv --where condition=3 --quantities failure,nees_coverage --out one_condition
draws one condition.
"""


def parse(arguments):
    parser = FigureParser(prog="rcme plot failure_rate", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("summary", metavar="SUMMARY.csv", help="output of 'rcme summarize RUN.sqlite --format csv'")
    parser.add_argument("--x", metavar="FACTOR",
                        help="the factor on the x axis; words stand side by side (default: of one condition, none)")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    parser.add_argument("--quantities", metavar="A,B",
                        help="quantities of the table to draw, one panel each (default: failure,failure_or_refusal)")
    parser.add_argument("--estimators", metavar="A,B", help="labels of the estimators to draw (default: all)")
    parser.add_argument("--where", action="append", default=[], metavar="KEY=VALUE",
                        help="draw only these rows; KEY is a factor, study, condition or estimator; repeatable")
    parser.add_argument("--log-y", action="store_true", default=None,
                        help="logarithmic y axis (default: of errors, and of a quantity of which the best estimator has small rates)")
    parser.add_argument("--linear-y", action="store_false", dest="log_y", help="linear y axis")
    parser.add_argument("--floor", type=float, metavar="RATE",
                        help="where a logarithmic y axis of rates ends, and rates of exactly zero stand (default: below the least rate)")
    parser.add_argument("--names", metavar="A,B", help="write the names of these estimators alone (default: of all); grey ones are counted")
    options = parser.parse_args(arguments)
    if options.floor is not None and not 0 < options.floor < 1:
        parser.error(f"--floor {options.floor:g}: give a rate above 0 and below 1, such as 0.0002.")
    options.names = None if options.names is None else names_of("--names", options.names, "rcme")
    options.quantities = None if options.quantities is None else names_of("--quantities", options.quantities, "failure")
    options.estimators = [] if options.estimators is None else names_of("--estimators", options.estimators, "rcme")
    return options


def draw_for(options):
    summary = of_estimators(where(read_summary(options.summary), options.where), options.estimators)
    quantities = options.quantities or usual_quantities(summary)
    if options.x is None:
        return estimator_marks.draw(summary, quantities)
    return draw(summary, options.x, quantities, options.log_y, Choices(options.floor, options.names))


def main(arguments=None):
    return draw_figure("failure_rate.py", parse, draw_for, arguments)


if __name__ == "__main__":
    sys.exit(main())
