#!/usr/bin/python3
"""Draws what `rcme tune` found, three figures, each as PNG and PDF:
  PREFIX_surface  failure and refusal over the options, with the tuned setting, certified ones and other estimators
  PREFIX_front    failure against refusal of every setting, with the Pareto front and those that were tested
  PREFIX_roc      how well the score tells good models from bad ones (if the file has such curves)
The first is left out, with a word, where there is no surface: one level of every option, or too many panels.
It draws what the file says and computes nothing: rates, intervals, areas and the tuned setting are those of the
program. Colours and lines between settings are interpolated.
"""

import sys

from common.command_line import FigureParser, PlotError, draw_figures, printable
from tuning_figures.front import draw_front
from tuning_figures.roc import draw_roc
from tuning_figures.surface import draw_surface
from tuning_figures.tune_file import read_tune

EXAMPLE = """
example:
  rcme plot tune tune.json --out tune
draws tune_surface.png, tune_front.png, tune_roc.png and the same as PDF.

  rcme plot tune tune.json --out tune_1 --where significance_level=0.05
draws of the surface only the part with one level of a further option; front and ROC curves are of all settings.
"""


def parse(arguments):
    parser = FigureParser(prog="rcme plot tune", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("tune", metavar="TUNE.json", help="file that 'rcme tune' wrote")
    parser.add_argument("--out", required=True, metavar="PREFIX",
                        help="where to write: the figures' names begin with it")
    parser.add_argument("--where", action="append", default=[], metavar="OPTION=LEVEL",
                        help="draw only this part of the surface; repeatable")
    return parser.parse_args(arguments)


def draw_surface_if_possible(tune, where):
    """{what the name adds: figure}. A surface that cannot be drawn as a whole (one level of everything, too many panels)
    is no reason to draw nothing; a part that was asked for has to be there."""
    try:
        return {"_surface": draw_surface(tune, where)}
    except PlotError as error:
        if where:
            raise
        print(f"tune.py: no surface: {printable(str(error))}", file=sys.stderr)
        return {}


def draw_for(options):
    tune = read_tune(options.tune)
    figures = {**draw_surface_if_possible(tune, options.where), "_front": draw_front(tune)}
    return {**figures, "_roc": draw_roc(tune)} if tune.rocs else figures


def main(arguments=None):
    return draw_figures("tune.py", parse, draw_for, arguments)


if __name__ == "__main__":
    sys.exit(main())
