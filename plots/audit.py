#!/usr/bin/python3
"""Draws the audit of the paper's claims: one figure per family of claims, one panel per claim.

It draws what audit.json says and computes nothing: values, intervals, allowed ranges and verdicts are those of
`rcme audit`.
"""

import math
import os
import sys

from audit_figures import groups, look
from audit_figures.audit_file import read_audit
from audit_figures.curve import panels_of
from audit_figures.forest import ForestPanel
from audit_figures.html_page import audit_page
from audit_figures.page import Titled, draw_page
from audit_figures.panel import EmptyPanel
from audit_figures.roc import RocPanel, is_roc
from common.command_line import FigureParser, PlotError, run, written_figures
from common.number_text import power_text
from common.whole_file import write_text

EXAMPLE = """
example:
  rcme audit --out audit
  rcme plot audit audit
draws audit/audit_<family>.png and .pdf for every family of claims in audit/audit.json.

A claim with a condition along x is drawn over that condition, any other as a list of its targets; the acceptance of models
by mu as a ROC curve.
"""


def panels_of_claim(claim, path):
    """The panels of one claim: curves if its x has at least two levels, else one forest."""
    rows = groups.rows_of(claim)
    if not rows:
        return [Titled(claim, "", EmptyPanel())]
    if is_roc(claim):
        return [Titled(claim, ", ".join(groups.fixed(rows)), RocPanel(claim, rows, path))]
    if claim.figure_x and len({row.conditions[claim.figure_x] for row in rows}) > 1:
        shared = groups.fixed(rows, but=(claim.figure_x,))
        return [Titled(claim, ", ".join(filter(None, (words, *shared))), body)
                for words, body in panels_of(claim, rows, path)]
    return [Titled(claim, ", ".join(groups.fixed(rows)), ForestPanel(rows))]


def confidence_text(confidence):
    """'1 − 8·10⁻⁵', or '0.95'."""
    return f"{confidence:g}" if confidence <= 0.99 else f"1 \u2212 {power_text(1 - confidence)}"


def caption_of(audit, family, claims, panels):
    """What a reader needs beyond the marks: seed, budget, n, what the intervals promise."""
    rows = [row for claim in claims for row in groups.rows_of(claim)]
    counts = [row.target.n for row in rows]
    parts = [f"Audit of family {family}" + (f" on study {audit.study}" if audit.study else ""), f"seed {audit.seed}", f"budget {audit.budget}"]
    if counts:
        low, high = min(counts), max(counts)
        parts.append(f"n = {low} per target" if low == high else f"n = {low}\u2013{high} per target")
    parts.append("intervals hold at all sample sizes at once, confidence "
                 f"{confidence_text(audit.confidence_per_target)} each")
    if any(panel.body.has_pale_series() for panel in panels):
        parts.append("pale: the other significance levels, each around its own nominal value")
    if any(panel.body.cuts_intervals() for panel in panels):
        parts.append("arrow at a frame: the interval goes on")
    if any(panel.body.shows_limit() for panel in panels):
        parts.append("dashed upright line: the noise up to which the claim holds")
    if any(map(is_roc, claims)):
        parts.append("ring: the mu nearest to the default of its reading")
    if any(math.isnan(row.target.measured) for row in rows):
        parts.append("cross at a frame or 'no value': no finite value measured")
    if unmeasured := [claim.id for claim in claims if not groups.rows_of(claim)]:
        parts.append(f"nothing measured for {', '.join(unmeasured)}")
    return "; ".join(parts) + "."


def draw_family(audit, family, claims):
    """The figure of one family."""
    with_values = [claim for claim in claims if groups.rows_of(claim)]
    panels = [panel for claim in with_values or claims for panel in panels_of_claim(claim, audit.path)]
    marked = [row.target for claim in claims if not is_roc(claim) for row in groups.rows_of(claim)]
    handles = look.legend_handles({target.verdict for target in marked}, any(target.is_claim for target in marked),
                                  any(not math.isnan(target.nominal) for target in marked))
    return draw_page(panels, handles, caption_of(audit, family, claims, panels))


def parse(arguments):
    parser = FigureParser(out_is_folder=True, prog="rcme plot audit", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("folder", metavar="DIR", help="the folder that 'rcme audit --out DIR' wrote; it holds audit.json")
    parser.add_argument("--out", metavar="OUTDIR", help="the folder to write to (default: DIR)")
    parser.add_argument("--page", action="store_true",
                        help="also write audit.html: verdicts, figures and every number on one page that needs nothing else")
    options = parser.parse_args(arguments)
    options.out = os.path.join(options.folder if options.out is None else options.out, "")
    return options


def draw_for(options):
    audit = read_audit(os.path.join(options.folder, "audit.json"))
    if not os.path.isdir(options.out):
        raise PlotError(f"--out {options.out}: there is no such folder.")
    return {f"audit_{family}": draw_family(audit, family, claims) for family, claims in audit.families().items()}


def make(arguments):
    options = parse(arguments)
    written = written_figures(options, draw_for)
    if options.page:
        audit = read_audit(os.path.join(options.folder, "audit.json"))
        written.append(options.out + "audit.html")
        write_text(written[-1], audit_page(audit, draw_family))
    return written


def main(arguments=None):
    return run("audit.py", make, arguments)


if __name__ == "__main__":
    sys.exit(main())
