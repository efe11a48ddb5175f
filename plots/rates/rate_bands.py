"""Rates in bands of colour whose borders stand closer where rates are low: the same colour for the same rate in every
figure of tuning, equal steps to the eye, dark is much."""

from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm
from matplotlib.ticker import FuncFormatter

from common import style
from rates.cells import COLORS

BORDERS = (0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1)
SCALE = BoundaryNorm(BORDERS, COLORS.N, clip=True)
TARGET = style.VERMILLION  # of what the target allows, and of the setting that meets it
QUANTITIES = {"failure": "Failure rate", "refusal": "Refusal rate", "false_refusal": "False-refusal rate",
              "accepted_failure": "Failure rate of accepted trials", "risk": "Risk"}


def color_of(rate):
    return COLORS(SCALE(rate))


def per_cent(fraction, _=None):
    """'0.5', '12': for ticks and for what the target allows."""
    return f"{100 * fraction:.4g}"


def add_color_bar(figure, target_level, **where):
    """With a line where the target is; NaN: none."""
    bar = figure.colorbar(ScalarMappable(SCALE, COLORS), spacing="uniform", ticks=BORDERS,
                          format=FuncFormatter(per_cent), **where)
    bar.set_label("Rate (%)", fontsize=7)
    bar.ax.tick_params(labelsize=7, length=0)
    bar.ax.grid(False)
    bar.outline.set_visible(False)
    if target_level == target_level:
        bar.ax.axhline(target_level, color=TARGET, linewidth=2)
    return bar
