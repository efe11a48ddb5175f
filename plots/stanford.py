#!/usr/bin/python3
"""Draws the Stanford diagram of an estimator: how often which error met which protection level, with the alert limits, for
rotation and direction.

It draws what the file says: counts and intervals are those of `rcme integrity`. Above the diagonal the level held the error;
below it the answer misled.
"""

import sys

from common.command_line import FigureParser, draw_figure
from stanford_figure.integrity_file import read_integrity
from stanford_figure.panels import draw

EXAMPLE = """
example:
  rcme integrity own_camera --estimator rcme_calibrated --out integrity
  rcme plot stanford integrity/integrity.json --out stanford
"""


def parse(arguments):
    parser = FigureParser(prog="rcme plot stanford", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("integrity", metavar="INTEGRITY.json", help="integrity.json of 'rcme integrity --out DIR'")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    return parser.parse_args(arguments)


def draw_for(options):
    return draw(read_integrity(options.integrity))


def main(arguments=None):
    return draw_figure("stanford.py", parse, draw_for, arguments)


if __name__ == "__main__":
    sys.exit(main())
