#!/usr/bin/python3
"""Draws how sharp the audit is against a wrong sigma: the share of seeds with each verdict over the error.

It draws what sigma.csv says and computes nothing but shares.
"""

import sys

from common import style
from common.command_line import FigureParser, draw_figure
from common.summary_csv import read_table

COLUMNS = ("claim", "statistic", "budget", "sigma_error", "seeds", "does_not_hold", "does_not_hold_lower",
           "does_not_hold_upper", "holds", "holds_lower", "holds_upper")
LOOKS = {"quick": dict(color=style.BLUE, marker="o"), "full": dict(color=style.VERMILLION, marker="s")}
DASHES = {"does_not_hold": style.SOLID, "holds": style.DASHED}
EXAMPLE = """
example:
  rcme_audit_power sigma > sigma.csv
  rcme plot audit_power sigma.csv --out power
"""


def draw_curve(axes, rows, verdict, look):
    """The share of seeds with the verdict over the error of sigma, with exact intervals; drawn trials as a line, simulated
    cases as open marks."""
    handle = None
    for statistic in ("drawn", "run"):
        points = sorted((100 * float(row["sigma_error"]), float(row[verdict]) / float(row["seeds"]),
                         float(row[verdict + "_lower"]), float(row[verdict + "_upper"]))
                        for row in rows if row["statistic"] == statistic)
        if not points:
            continue
        errors, shares, lowers, uppers = zip(*points)
        axes.vlines(errors, [100 * x for x in lowers], [100 * x for x in uppers], color=look["color"], linewidth=0.7,
                    alpha=0.6)
        is_drawn = statistic == "drawn"
        line, = axes.plot(errors, [100 * share for share in shares], markersize=3.6 if is_drawn else 7, **look,
                          linestyle=DASHES[verdict] if is_drawn else "none",
                          markerfacecolor=look["color"] if is_drawn else "none")
        handle = handle or line
    return handle


def draw(options):
    table = read_table(options.table, COLUMNS, "rcme_audit_power sigma")
    rows = [row for _, row in table.rows.iterrows()]
    claims = list(dict.fromkeys(row["claim"] for row in rows))
    figure, axes = style.new_figure(rows=1, columns=len(claims))
    handles = {}
    for letter, panel, claim in zip(style.letters(len(claims)), axes[0], claims):
        panel.set_title(f"{letter}{style.in_words(claim)}")
        panel.set_xlabel("Error of the assumed sigma (%)")
        panel.set_ylabel("Share of seeds (%)")
        panel.set_ylim(-3, 103)
        for budget, look in LOOKS.items():
            for verdict in DASHES:
                chosen = [row for row in rows if row["claim"] == claim and row["budget"] == budget]
                words = f"{budget}: {verdict.replace('_', ' ')}"
                handles.setdefault(words, draw_curve(panel, chosen, verdict, look))
                if handles[words] is not None:
                    handles[words].set_label(words)
    counts = sorted({int(row["seeds"]) for row in rows if row["statistic"] == "drawn"})
    style.add_legend_and_caption(
        figure, [handle for handle in handles.values() if handle is not None],
        f"Verdicts of the audit where sigma is wrong; n = {counts[-1]} seeds per point (statistics drawn from their law), exact "
        "95 % intervals; open marks: simulated cases.")
    return figure


def parse(arguments):
    parser = FigureParser(prog="rcme plot audit_power", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("table", metavar="TABLE.csv", help="what 'rcme_audit_power sigma' printed")
    parser.add_argument("--out", metavar="PATH", default="audit_power", help="writes PATH.png and PATH.pdf")
    return parser.parse_args(arguments)


def main(arguments=None):
    return draw_figure("audit_power.py", parse, draw, arguments)


if __name__ == "__main__":
    sys.exit(main())
