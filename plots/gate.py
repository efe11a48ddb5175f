#!/usr/bin/python3
"""Draws what `rcme gate` found: a row for each quantity with the change, its interval and the verdict, all in units of the row's
margin, and the values in their own units above.

It draws what the file says and computes nothing but that ratio: changes, intervals and verdicts are those of `rcme gate`.
"""

import sys

from common.command_line import FigureParser, draw_figure
from gate_figure.gate_file import read_gate
from gate_figure.panel import draw

EXAMPLE = """
example:
  rcme gate regression_gate --old standard --new rcme_calibrated --out gate
  rcme plot gate gate/gate.json --out gate/figure
"""


def parse(arguments):
    parser = FigureParser(prog="rcme plot gate", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("gate", metavar="GATE.json", help="gate.json of 'rcme gate --out DIR'")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    return parser.parse_args(arguments)


def main(arguments=None):
    return draw_figure("gate.py", parse, lambda options: draw(read_gate(options.gate)), arguments)


if __name__ == "__main__":
    sys.exit(main())
