#!/usr/bin/python3
"""Draws the level at which a rate crosses a value against a factor of the study: a line per estimator, with the interval that
supposes nothing but that the rate rises (or falls) as a bar, and the one that also supposes a logistic curve as a band.

It draws what the file says and computes nothing: levels and intervals are those of `rcme solve`.
"""

import sys

from common.command_line import FigureParser, draw_figure
from rates.crossing_lines import draw, read_crossings

EXAMPLE = """
example:
  rcme solve failure_vs_outliers_and_clustering --over outlier_ratio --at 0.1 --out solved
  rcme plot crossings solved/crossings.json --x clustered_share --out crossings
draws crossings.png and crossings.pdf: how many wrong matches each estimator bears, the more clustered they are. An end of
an interval that may lie beyond the range that was searched is an arrow at the end of the range.
"""


def parse(arguments):
    parser = FigureParser(prog="rcme plot crossings", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("crossings", metavar="CROSSINGS.json", help="file that 'rcme solve --out' wrote")
    parser.add_argument("--x", required=True, metavar="FACTOR", help="the factor on the x axis; words stand side by side")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    parser.add_argument("--where", action="append", default=[], metavar="KEY=VALUE",
                        help="draw only these rows; KEY is a factor or estimator; repeatable")
    return parser.parse_args(arguments)


def draw_for(options):
    return draw(read_crossings(options.crossings), options.x, options.where)


def main(arguments=None):
    return draw_figure("crossings.py", parse, draw_for, arguments)


if __name__ == "__main__":
    sys.exit(main())
