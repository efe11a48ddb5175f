"""How the audit speaks: mark and colour of every verdict, colour and dashes of every series, numbers as text.

Colour is never the only carrier: each verdict has its own glyph in a title and its own marker on a point, each series
its own dashes.
"""

import math
from dataclasses import dataclass

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from audit_figures import audit_file as audit
from common import style
from common.number_text import number_text

GREY = "0.35"
ALLOWED = style.GREEN  # the allowed range and its nominal value
BAND_ALPHA, PALE_BAND_ALPHA = 0.16, 0.07
SERIES_COLORS = (style.BLUE, style.ORANGE, style.PURPLE, style.BLACK, style.SKY_BLUE, style.GREEN)
SERIES_DASHES = (style.SOLID, style.DASHED, style.DOTTED, style.DASH_DOT, style.LONG_DASHED)


@dataclass(frozen=True)
class VerdictLook:
    glyph: str
    color: str
    marker: str
    size: float
    filled: bool = True

    def marks(self, color):
        """Keyword arguments of `Axes.plot` for points of this verdict in a series of that colour."""
        return dict(linestyle="none", marker=self.marker, markersize=self.size,
                    markerfacecolor=color if self.filled else "white",
                    markeredgecolor="white" if self.filled else color, markeredgewidth=0.5 if self.filled else 1.1)


LOOKS = {
    audit.HOLDS: VerdictLook("\u2713", "#00785A", "o", 4.2),
    audit.HOLDS_AT_SMALL_NOISE: VerdictLook("\u25d0", "#A86F00", "o", 4.2),
    audit.DOES_NOT_HOLD: VerdictLook("\u2717", style.VERMILLION, "X", 6),
    audit.UNDECIDED: VerdictLook("?", GREY, "o", 4, filled=False),
    audit.MEASURED: VerdictLook("\u25c6", style.BLACK, "D", 3.4),
    audit.NOT_POSSIBLE: VerdictLook("\u2013", GREY, "_", 4),
}


def point_color(verdict, series_color):
    """A point that contradicts its claim stands out of its series; the others keep the series' colour."""
    return style.VERMILLION if verdict == audit.DOES_NOT_HOLD else series_color


def series_look(position):
    """(colour, dashes) of the series in that position; 6 and 5 have no common divisor: 30 different ones."""
    return SERIES_COLORS[position % 6], SERIES_DASHES[position % 5]


def with_side(verdict, side):
    """'does not hold: too narrow'."""
    return f"{verdict}: {side}" if side else verdict


def verdict_text(claim):
    """'◐ holds in the small-noise limit only: sigma ≤ 0.5 px'."""
    text = f"{LOOKS[claim.verdict].glyph} {with_side(claim.verdict, claim.side)}"
    if math.isnan(claim.holds_up_to_sigma_px):
        return text
    limit = f"sigma \u2264 {claim.holds_up_to_sigma_px:g} px"
    holds = claim.verdict in (audit.HOLDS, audit.HOLDS_AT_SMALL_NOISE)
    return f"{text}: {limit}" if holds else f"{text} (holds for {limit})"


def decimals_for(width):
    """So many that an interval of this width shows two of its own digits; None if it has no width."""
    if not 0 < width < math.inf:
        return None
    return min(6, max(0, 1 - math.floor(math.log10(width))))


def measured_text(target):
    """'94.97 [94.5, 95.4]', a rate in per cent; a bound that does not exist is infinite, a missing value a dash."""
    factor = 100 if target.kind == "rate" else 1
    decimals = decimals_for(factor * (target.upper - target.lower))
    if math.isinf(target.lower) and math.isinf(target.upper):
        interval = ""
    else:
        ends = [number_text(factor * end, decimals) for end in (target.lower, target.upper)]
        opening, closing = "(" if math.isinf(target.lower) else "[", ")" if math.isinf(target.upper) else "]"
        interval = f" {opening}{ends[0]}, {ends[1]}{closing}"
    if math.isnan(target.measured):
        return "\u2013" + interval
    return number_text(factor * target.measured, decimals if interval else None) + interval


def legend_handles(verdicts, with_range, with_nominal):
    """The marks that occur, in the fixed order of the verdicts, then the allowed range."""
    handles = [Line2D([], [], label=verdict, **LOOKS[verdict].marks(point_color(verdict, GREY)))
               for verdict in audit.TARGET_VERDICTS if verdict in verdicts]
    if with_range:
        handles.append(Patch(facecolor=ALLOWED, alpha=2 * BAND_ALPHA, label="allowed range"))
    if with_nominal:
        handles.append(Line2D([], [], color=ALLOWED, linewidth=1.2, label="nominal value"))
    return handles
