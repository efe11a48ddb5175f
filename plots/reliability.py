#!/usr/bin/python3
"""Draws how stated probabilities of failure agree with what happened: per estimator the reliability curve in the band of
right probabilities, with a histogram of the probabilities below, and beside them all risk-coverage curves.

It draws what the file says: curves, bands, intervals and scores are those of `rcme reliability`. Only the intervals along the
risk-coverage curves are computed here, from the counts.
"""

import sys

from common.command_line import FigureParser, draw_figure, names_of
from reliability_figure.panels import draw
from reliability_figure.reliability_file import read_reliability

EXAMPLE = """
example:
  rcme reliability run.sqlite --format json --out reliability.json
  rcme plot reliability reliability.json --out reliability

  rcme plot reliability reliability.json --estimators rcme_calibrated,poselib --out two
"""


def parse(arguments):
    parser = FigureParser(prog="rcme plot reliability", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("reliability", metavar="RELIABILITY.json", help="output of 'rcme reliability --format json'")
    parser.add_argument("--estimators", metavar="LABEL,...",
                        help="the estimators with a reliability diagram; default: those that state probabilities, or else "
                        "the first; all are in the risk-coverage curves")
    parser.add_argument("--group", metavar="LEVEL", help="of a file with --by: the level to draw; default: the first")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    return parser.parse_args(arguments)


def draw_for(options):
    names = None if options.estimators is None else names_of("--estimators", options.estimators, "rcme_calibrated")
    return draw(read_reliability(options.reliability), names, options.group)


def main(arguments=None):
    return draw_figure("reliability.py", parse, draw_for, arguments)


if __name__ == "__main__":
    sys.exit(main())
