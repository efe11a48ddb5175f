#!/usr/bin/python3
"""Draws whether two-view covariances predict how rotations close around longer and longer loops of images: the share of loops
within the 95 % region, and the root mean square of the closure over its stated standard deviation, each against the number of
images in a loop, with what is right as a grey line.

It draws what the files say and computes nothing: shares, ratios and intervals are those of `rcme validate --loops`.
"""

import sys
from dataclasses import replace

import pandas
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from common import style
from common.command_line import FigureParser, PlotError, draw_figure
from common.number_text import number_text
from common.summary_csv import numbers, read_table, rows_where

EXAMPLE = """
examples:
  rcme validate PAIRS --loops 6 --out validation
  rcme plot closure validation/closure.csv --out closure
  rcme plot closure own/closure.csv robust/closure.csv --where "shared_errors=allowed for" --out closure
draws closure.png and closure.pdf. Lines are of pairs; --where of=twins draws those of their simulated twins.
"""
KEYS = ("set", "estimator", "shared_errors", "of")
PANELS = {"covered": "Loops within the 95 % region (%)", "rms_over_sd": "RMS closure / stated sd"}
NUMBERS = tuple(name + end for name in PANELS for end in ("", "_lower", "_upper"))
COLUMNS = (*KEYS, "images", "loops", "apart", *NUMBERS)
RIGHT = {"covered": 95, "rms_over_sd": 1}


def read_closures(path):
    """The rows of one file, its numbers as floats: shares in percent, unbounded ends NaN."""
    table = read_table(path, COLUMNS, "rcme validate PAIRS --loops 6 --out DIR")
    rows = table.rows.assign(**{column: numbers(table, column, may_be_empty=column in NUMBERS)
                                for column in ("images", "loops", "apart", *NUMBERS)})
    shares = [name for name in NUMBERS if name.startswith("covered")]
    return rows.assign(**{name: 100 * rows[name] for name in shares})


def read_lines(options):
    """{name of a line: its rows}: of the pairs, or what --where names; a name says what differs between lines."""
    rows = pandas.concat(map(read_closures, options.closures), ignore_index=True)
    conditions = options.where if any(one.startswith("of=") for one in options.where) else [*options.where, "of=pairs"]
    rows = rows_where(", ".join(options.closures), rows, KEYS, conditions)
    if rows.duplicated([*KEYS, "images"]).any():
        raise PlotError(f"{', '.join(options.closures)}: two rows are of the same set, estimator and number of images.")
    differing = [key for key in KEYS if rows[key].nunique() > 1]

    def name_line(row):
        words = {"shared_errors": f"shared errors {row.shared_errors}", "estimator": style.label_of(row.estimator)}
        return "; ".join(words.get(key, row[key]) for key in differing) or style.label_of(row.estimator)

    return {name: part.sort_values("images") for name, part in rows.groupby(rows.apply(name_line, axis=1), sort=False)}


def looks_of(lines):
    """{name of a line: (Look, what its marks have beside it)}. An estimator has its own colour; of its two lines the second has
    open marks and dashes. Where it has more, as of many sets, each line has a colour."""
    estimators = {name: rows.estimator.iloc[0] for name, rows in lines.items()}
    of_each = {one: [name for name in lines if estimators[name] == one] for one in estimators.values()}
    if max(map(len, of_each.values())) > 2:
        return {name: (look, {}) for name, look in style.equal_looks_of(list(lines)).items()}
    looks = {}
    for name, look in ((name, style.equal_looks_of(list(of_each))[one]) for name, one in estimators.items()):
        is_second = name != of_each[estimators[name]][0]
        hollow = dict(markerfacecolor="white", markeredgecolor=look.color, markeredgewidth=0.9, linewidth=1)
        looks[name] = (replace(look, label=name, dashes=style.DOTTED if is_second else style.SOLID), hollow if is_second else {})
    return looks


def draw_line(axes, points, quantity, look, aside):
    look, more = look
    known = points[points[quantity].notna()]
    x, ends = known.images + aside, (0, 100) if quantity == "covered" else axes.far
    axes.vlines(x, known[quantity + "_lower"].fillna(ends[0]).clip(*ends), known[quantity + "_upper"].fillna(ends[1]).clip(*ends),
                color=look.color, linewidth=1, alpha=0.6)
    return axes.plot(x, known[quantity].clip(*ends), **{**look.line(), **more})[0]


def find_ends(lines):
    """A range of ratios that holds all of them, and 1, with room for their intervals."""
    ratios = pandas.concat([rows.rms_over_sd for rows in lines.values()])
    ratios = ratios[ratios > 0]
    return min([0.4, *(0.7 * ratios)]), max([2.5, *(1.5 * ratios)])


def draw(options):
    lines = read_lines(options)
    looks = looks_of(lines)
    figure, panels = style.new_figure(1, len(PANELS))
    handles = []
    for letter, axes, (quantity, label) in zip(style.letters(len(PANELS)), panels[0], PANELS.items()):
        axes.far = find_ends(lines)
        axes.axhline(RIGHT[quantity], color="0.6", linewidth=0.8, zorder=0)
        handles = [draw_line(axes, rows, quantity, looks[name], 0.08 * (number - (len(lines) - 1) / 2))
                   for number, (name, rows) in enumerate(lines.items())]
        axes.set_title(letter + label)
        axes.set_xlabel("Images in a loop")
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    panels[0, 0].set_ylim(-3, 103)
    ratio = panels[0, 1]
    ratio.set_yscale("log")
    ratio.set_ylim(*ratio.far)
    ratio.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    ratio.yaxis.set_major_formatter(FuncFormatter(lambda value, _: number_text(value)))
    ratio.yaxis.set_minor_formatter(NullFormatter())
    style.add_legend_and_caption(figure, handles, caption_of(lines))
    return figure


def caption_of(lines):
    loops, apart = (sorted({int(n) for rows in lines.values() for n in rows[column]}) for column in ("loops", "apart"))

    def range_of(counts):
        return str(counts[0]) if counts[0] == counts[-1] else f"{counts[0]} to {counts[-1]}"

    return (f"Closure of rotations around loops of images, {range_of(loops)} loops a point, of which {range_of(apart)} share no image; "
            "grey: what covariances give that hold; bars: 95 % intervals.")


def parse(arguments):
    parser = FigureParser(prog="rcme plot closure", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("closures", metavar="CLOSURE.csv", nargs="+", help="of `rcme validate --loops N --out DIR`")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    parser.add_argument("--where", action="append", default=[], metavar="KEY=VALUE",
                        help=f"draw only these rows; KEY is one of {', '.join(KEYS)}; repeatable")
    return parser.parse_args(arguments)


def main(arguments=None):
    return draw_figure("closure.py", parse, draw, arguments)


if __name__ == "__main__":
    sys.exit(main())
