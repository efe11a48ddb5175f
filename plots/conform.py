#!/usr/bin/python3
"""Draws what `rcme conform` reports of regions: how often each kind of region contains the truth, in total and in the hardest quarter
of the answers, beside the promised level, and how large the regions are.

It draws what the file says and computes nothing: coverages, intervals and sizes are those of `rcme conform`.
"""

import sys

from common.command_line import FigureParser, PlotError, draw_figure
from conform_figure.conform_file import read_report, read_table_of_regions
from conform_figure.panels import draw

EXAMPLE = """
example:
  rcme conform own_camera --estimator standard --out mine.conform.json --format json > report.json
  rcme conform own_camera --seed 2 --check mine.conform.json --format json --out check.json
  rcme plot conform check.json --out check

  rcme plot conform results/conform/regions.csv --level 0.9 --where estimator=rcme_calibrated --where draws=fresh --out fresh
"""


def parse(arguments):
    parser = FigureParser(prog="rcme plot conform", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("report", metavar="REPORT", help="output of 'rcme conform --format json', also with --check; or the CSV "
                        "table of its regions, with --level")
    parser.add_argument("--level", type=float, metavar="LEVEL", help="of a CSV table: the promised coverage, which it does not have")
    parser.add_argument("--where", action="append", default=[], metavar="KEY=VALUE",
                        help="of a CSV table: draw only these rows; repeatable")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    return parser.parse_args(arguments)


def draw_for(options):
    if options.level is None:
        if options.where:
            raise PlotError(f"--where {options.where[0]}: selects rows of a CSV table of regions, which also needs --level.")
        return draw(read_report(options.report))
    return draw(read_table_of_regions(options.report, options.level, options.where))


def main(arguments=None):
    return draw_figure("conform.py", parse, draw_for, arguments)


if __name__ == "__main__":
    sys.exit(main())
