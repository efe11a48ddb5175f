#!/usr/bin/python3
"""Draws rates against one factor: a panel per quantity, a line and an exact interval band per estimator.

It draws what the file says and computes nothing: values and interval bounds are those of `rcme summarize`.
"""

import argparse
import itertools
import math
import os
import sys

from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from matplotlib.transforms import ScaledTranslation

import style
from command_line import Parser, PlotError
from summary_csv import numbers, read_summary, where

MAX_PANEL_ROWS = 6

TITLES = {  # other quantities: their name in words
    "failure": "Failure rate", "success": "Success rate",
    "no_candidate": "Detect-fail rate",  # the paper's word
    "other_refusal": "Other refusals",
    "kappa_flag": "Kappa-flag rate", "nees_coverage": "NEES coverage",
}

EXAMPLE = """
example:
  rcme summarize run.sqlite --format csv > summary.csv
  plots/failure_rate.py summary.csv --x outlier_ratio --out failure_rate
draws failure_rate.png and failure_rate.pdf: the failure rate and the detect-fail rate of each estimator.

  plots/failure_rate.py summary.csv --x outlier_ratio --out failure_rate_1px \\
      --where sigma_px=1 --where estimator=standard --where estimator=rcme --quantities failure --log-y
draws only the failure rate of two estimators at one noise level, on a logarithmic axis; there a rate of exactly zero,
which has no place, becomes an arrow that points down from its upper bound.
"""


def select(summary, x, quantities):
    """The rows of the asked rates, with `x`, `value`, `lower`, `upper` and `n` as numbers."""
    path = summary.path
    if x not in summary.factors:
        raise PlotError(f"{path}: --x {x} is not a factor of this study; "
                        f"allowed: {', '.join(summary.factors) or 'none, the study varies nothing'}.")
    rates = list(dict.fromkeys(summary.rows.quantity[summary.rows.kind == "rate"]))
    for quantity in quantities:
        if quantity not in rates:
            raise PlotError(f"{path}: has no rate called '{quantity}'; allowed: {', '.join(rates) or 'none'}.")
    studies = list(dict.fromkeys(summary.rows.study))
    if len(studies) > 1:
        raise PlotError(f"{path}: holds several studies; choose one: --where study={' or study='.join(studies)}.")
    summary = summary.with_rows(summary.rows[(summary.rows.kind == "rate") & summary.rows.quantity.isin(quantities)])
    selected = summary.rows.assign(
        x=numbers(summary, x), n=numbers(summary, "n"),
        **{column: numbers(summary, column, may_be_empty=True) for column in ("value", "lower", "upper")})
    for row in selected.itertuples():
        if not (0 <= row.lower <= row.value <= row.upper <= 1 or (row.n == 0 and math.isnan(row.value))):
            raise PlotError(f"{path}: line {row.line}: a rate must lie in its interval and both in 0..1, "
                            "and may be empty only where n is 0.")
    selected.loc[selected.value.isna(), ["lower", "upper"]] = math.nan  # the interval 0..1 of no trials says nothing
    return selected


def split_into_panel_rows(path, rows, other_factors):
    """[(title, rows)]: one row of panels per combination of levels of the factors that are not on the x axis."""
    varying = [factor for factor in other_factors if rows[factor].nunique() > 1]
    combinations = rows[varying].drop_duplicates()
    parts = [(", ".join(map(style.level_in_words, varying, levels)), rows[(rows[varying] == levels).all(axis=1)])
             for levels in combinations.itertuples(index=False, name=None)] if varying else [("", rows)]
    if len(parts) > MAX_PANEL_ROWS:
        raise PlotError(f"{path}: {len(parts)} combinations of {', '.join(varying)} need more than {MAX_PANEL_ROWS} "
                        "rows of panels; fix some with --where " +
                        " --where ".join(f"{factor}={rows[factor].iloc[0]}" for factor in varying) + ".")
    for _, part in parts:
        repeated = part[part.duplicated(["x", "estimator", "quantity"])]
        if len(repeated):
            row = repeated.iloc[0]
            raise PlotError(f"{path}: line {row.line}: {row.estimator} has a second {row.quantity} at x = {row.x:g}; "
                            "choose one condition with --where condition=NAME.")
    return parts


def draw_line(axes, points, look):
    """One estimator's line with its interval band; both break where a value is missing."""
    axes.fill_between(points.x, points.lower, points.upper, color=look.color, alpha=0.13, linewidth=0)
    axes.plot(points.x, points.value, **look.line(), clip_on=False, zorder=3)
    gap = points.value.isna()
    alone = points[~gap & gap.shift(1, fill_value=True) & gap.shift(-1, fill_value=True)]  # too narrow for a band
    axes.vlines(alone.x, alone.lower, alone.upper, color=look.color, alpha=0.5, linewidth=1, zorder=2)


def draw_upper_limits(axes, zeros, looks):
    """Arrows down from the upper bounds of rates that are zero; those at one x share a bound, so they stand abreast."""
    for _, abreast in zeros.groupby("x"):
        step = min(4.3, 24 / len(abreast))  # points
        for position, row in enumerate(abreast.itertuples()):
            aside = ScaledTranslation(step * (position - (len(abreast) - 1) / 2) / 72, 0, axes.figure.dpi_scale_trans)
            for mark in looks[row.estimator].upper_limit():
                axes.plot([row.x], [row.upper], **mark, transform=axes.transData + aside, clip_on=False, zorder=4)


def draw_panel(axes, points, looks, log_y):
    """One quantity in one panel, all estimators; the y values are fractions, the tick labels per cent."""
    points = points.sort_values("x", kind="stable")
    if log_y:
        axes.set_yscale("log", nonpositive="clip")
        is_zero = points.value == 0
        draw_upper_limits(axes, points[is_zero], looks)
        points = points.assign(value=points.value.mask(is_zero), lower=points.lower.mask(is_zero))
    for estimator, look in looks.items():
        draw_line(axes, points[points.estimator == estimator], look)
    if points.upper.isna().all():
        axes.text(0.5, 0.5, "no trials (n = 0)", transform=axes.transAxes, ha="center", va="center", color="0.4")
    axes.yaxis.set_major_formatter(FuncFormatter(lambda fraction, _: f"{100 * fraction:g}"))


def set_y_limits(column_of_axes, points, log_y):
    """From zero; on a logarithmic axis from the decade below everything that is drawn."""
    if not log_y:
        column_of_axes[0].set_ylim(bottom=0, top=None if points.upper.max() > 0 else 1)
        return
    drawn = points.value.where(points.value > 0, points.upper)
    smallest = min(drawn.dropna(), default=0.1)
    column_of_axes[0].set_ylim(10 ** math.floor(math.log10(smallest) - 0.3), 1)
    for axes in column_of_axes:
        axes.yaxis.set_major_locator(LogLocator(numticks=12))
        axes.yaxis.set_minor_formatter(NullFormatter())


def caption_of(rows, other_factors, log_y):
    low, high = int(rows.n.min()), int(rows.n.max())
    fixed = [style.level_in_words(factor, rows[factor].iloc[0])
             for factor in other_factors if rows[factor].nunique() == 1]
    return "; ".join([f"Study {rows.study.iloc[0]}", *fixed,
                      f"n = {low} per point" if low == high else f"n = {low}\u2013{high} per point",
                      "bands: exact 95 % (Clopper-Pearson) intervals"] +
                     (["arrows: rate zero, at its upper bound"] if log_y and (rows.value == 0).any() else [])) + "."


def draw(summary, x, quantities, log_y=False):
    """The whole figure: quantities side by side, one row of panels per combination of the other factors."""
    rows = select(summary, x, quantities)
    other_factors = [factor for factor in summary.factors if factor != x]
    parts = split_into_panel_rows(summary.path, rows, other_factors)
    looks = style.looks_of(list(dict.fromkeys(rows.estimator)))
    figure, panels = style.new_figure(len(parts), len(quantities))
    letters = (f"({letter}) " if panels.size > 1 else "" for letter in "abcdefghijklmnopqrstuvwxyz" * 9)
    for (r, (levels, part)), (c, quantity) in itertools.product(enumerate(parts), enumerate(quantities)):
        draw_panel(panels[r, c], part[part.quantity == quantity], looks, log_y)
        panels[r, c].set_title(next(letters) + TITLES.get(quantity, style.in_words(quantity)) +
                               (f", {levels}" if levels else ""))
    for c, quantity in enumerate(quantities):
        set_y_limits(panels[:, c], rows[rows.quantity == quantity], log_y)
        panels[-1, c].set_xlabel(style.in_words(x))
    left, right = rows.x.min(), rows.x.max()
    margin = 0.06 * (right - left) or 0.5
    panels[0, 0].set_xlim(left - margin, right + margin)  # shared by all panels; conditions without a rate keep a place
    for axes in panels[:, 0]:
        axes.set_ylabel("Rate (%)")
    style.add_legend_and_caption(figure, panels[0, 0].get_legend_handles_labels()[0],
                                 caption_of(rows, other_factors, log_y))
    return figure


def parse(arguments):
    parser = Parser(prog="failure_rate.py", description=__doc__, epilog=EXAMPLE,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("summary", metavar="SUMMARY.csv", help="output of 'rcme summarize RUN.sqlite --format csv'")
    parser.add_argument("--x", required=True, metavar="FACTOR", help="the factor on the x axis; its levels are numbers")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    parser.add_argument("--quantities", default="failure,no_candidate", metavar="A,B",
                        help="rates to draw, one panel each (default: %(default)s)")
    parser.add_argument("--where", action="append", default=[], metavar="KEY=VALUE",
                        help="draw only these rows; KEY is a factor, study, condition or estimator; repeatable")
    parser.add_argument("--log-y", action="store_true", help="logarithmic y axis")
    options = parser.parse_args(arguments)
    options.quantities = list(dict.fromkeys(filter(None, options.quantities.split(","))))
    if not options.quantities:
        raise PlotError("--quantities: name at least one rate, such as failure.")
    folder, name = os.path.split(options.out)
    if not name or name.endswith((".png", ".pdf")):
        raise PlotError(f"--out {options.out}: give a file path without .png or .pdf; both are written.")
    if not os.path.isdir(folder or "."):
        raise PlotError(f"--out {options.out}: there is no folder {folder}.")
    return options


def main(arguments=None):
    try:
        options = parse(arguments)
        summary = where(read_summary(options.summary), options.where)
        written = style.save(draw(summary, options.x, options.quantities, options.log_y), options.out)
    except PlotError as error:
        print(f"failure_rate.py: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"failure_rate.py: cannot write {options.out}: {error.strerror}.", file=sys.stderr)
        return 2
    print("\n".join(written))
    return 0


if __name__ == "__main__":
    sys.exit(main())
