#!/usr/bin/python3
"""Draws rates and scores over two factors: a small heat map per estimator and quantity, each cell with its rate and interval.

It draws what the file says and computes nothing: values and interval bounds are those of `rcme summarize`. Colour only
helps the eye, and is the same for equal rates of a quantity in all panels; the number is printed in every cell.
"""

import sys

from common.command_line import FigureParser, draw_figures, names_of, numbered
from common.summary_csv import read_summary, where
from rates.cells import draw_pages
from rates.selection import usual_quantities

EXAMPLE = """
example:
  rcme summarize run.sqlite --format csv > summary.csv
  rcme plot heat_map summary.csv --x outlier_ratio --y sigma_px --out heat_map
draws heat_map.png and heat_map.pdf: the rate of failures, and of failures or refusals, of each estimator over the two factors.
With --width, panels that do not fit on a page go to heat_map_2 and so on.

  rcme plot heat_map summary.csv --x outlier_ratio --y sigma_px --out failure \\
      --quantities failure --estimators standard,rcme_rank_aware --where num_matches=500
draws the failure rate of two estimators at one level of a third factor.
"""


def parse(arguments):
    parser = FigureParser(prog="rcme plot heat_map", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("summary", metavar="SUMMARY.csv", help="output of 'rcme summarize RUN.sqlite --format csv'")
    parser.add_argument("--x", required=True, metavar="FACTOR", help="the factor from left to right")
    parser.add_argument("--y", required=True, metavar="FACTOR", help="the factor from bottom to top")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    parser.add_argument("--quantities", metavar="A,B",
                        help="rates and scores to draw, one row of panels each (default: failure,failure_or_refusal)")
    parser.add_argument("--estimators", metavar="A,B", help="labels of the estimators to draw (default: all)")
    parser.add_argument("--where", action="append", default=[], metavar="KEY=VALUE",
                        help="draw only these rows; KEY is a factor, study, condition or estimator; repeatable")
    options = parser.parse_args(arguments)
    options.quantities = None if options.quantities is None else names_of("--quantities", options.quantities, "failure")
    options.estimators = [] if options.estimators is None else names_of("--estimators", options.estimators, "rcme")
    return options


def draw_for(options):
    summary = where(read_summary(options.summary), options.where)
    return numbered("", draw_pages(summary, options.x, options.y, options.quantities or usual_quantities(summary),
                                   options.estimators))


def main(arguments=None):
    return draw_figures("heat_map.py", parse, draw_for, arguments)


if __name__ == "__main__":
    sys.exit(main())
