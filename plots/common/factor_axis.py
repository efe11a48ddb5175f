"""A factor along an axis: at its numbers or, where a level is a word, side by side in the order of the study; and a row
of panels for each combination of levels of the factors that are not on the axis."""

import math

from matplotlib.ticker import FuncFormatter, NullFormatter
from matplotlib.transforms import ScaledTranslation

from common import sheet, style
from common.command_line import PlotError
from common.number_text import is_number
from common.text_size import height_of, width_of

MAX_PANEL_ROWS = 6
FAR = 50  # times the least level: levels farther than that from each other stand on a logarithmic axis
TICK_SIZE, NAME_GAP = 8, 0.08  # points; inches between names below an axis, or they stand upright


class FactorAxis:
    """Where each level of one factor stands."""

    def __init__(self, name, levels):
        self.name, self.levels = name, list(dict.fromkeys(levels))
        self.is_numeric = all(map(is_number, self.levels))
        self.place = {level: float(level) if self.is_numeric else float(position)
                      for position, level in enumerate(self.levels)}

        self.is_logarithmic = self.is_numeric and 0 < FAR * min(self.place.values()) <= max(self.place.values())

    def positions(self, levels):
        return [self.place[level] for level in levels]

    def limits(self):
        """The ends of the axis, with a margin."""
        left, right = self.ends()
        return (10 ** left, 10 ** right) if self.is_logarithmic else (left, right)

    def ends(self):
        """The same; on a logarithmic axis their logarithms."""
        left, right = min(self.steps()), max(self.steps())
        margin = (0.06 * (right - left) or 0.5) if self.is_numeric else 0.5
        return left - margin, right + margin

    def steps(self):
        """Places along the axis, evenly on paper."""
        return [math.log10(place) if self.is_logarithmic else place for place in self.place.values()]

    def room(self, panels_abreast):
        """Points of paper that the marks of one level may take without meeting those of the next."""
        left, right = self.ends()
        places = sorted(set(self.steps()))
        gap = min((b - a for a, b in zip(places, places[1:])), default=right - left)
        return min(26, 0.7 * 72 * self.width(panels_abreast) * gap / (right - left))

    def width(self, panels_abreast):
        """Inches of the axis, about."""
        if sheet.current().width is None:
            return {1: 4.0, 2: 3.0}.get(panels_abreast, 2.1)
        return style.room_of_panel(panels_abreast) - 0.6

    def height_of_names(self, panels_abreast):
        """Inches below a panel that upright names take on a sheet with a width, whose panels have a height of their own."""
        if self.is_numeric or sheet.current().width is None:
            return 0
        names, is_upright = self.names(panels_abreast)
        return max(width_of(name, TICK_SIZE) for name in names) if is_upright else 0

    def names(self, panels_abreast):
        """(the levels in words, whether they stand upright); upright ones are broken at their first space where two lines
        fit beside each other."""
        names = list(map(style.level_text, self.levels))
        is_upright = self.is_crowded(names, panels_abreast)
        if is_upright and self.width(panels_abreast) / len(names) > height_of(2, TICK_SIZE) + NAME_GAP / 2:
            names = [name.replace(" ", "\n", 1) for name in names]
        return names, is_upright

    def is_crowded(self, names, panels_abreast):
        """Whether names of words, one beside the other, would touch."""
        widths = [width_of(name, TICK_SIZE) for name in names]
        step = self.width(panels_abreast) / len(names)
        return any((a + b) / 2 + NAME_GAP > step for a, b in zip(widths, widths[1:])) or max(widths) > 1.6 * step

    def prepare(self, axes, panels_abreast):
        """Limits with a margin and, for words, ticks; conditions without a value keep their place."""
        if self.is_logarithmic:
            axes.set_xscale("log")
            axes.xaxis.set_major_formatter(FuncFormatter(lambda level, _: f"{level:g}"))
            axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_xlim(*self.limits())
        axes.set_xlabel(style.in_words(self.name))
        if not self.is_numeric:
            names, is_upright = self.names(panels_abreast)
            axes.set_xticks(range(len(names)), names, rotation=90 if is_upright else 0)
            axes.tick_params(axis="x", length=0)
            axes.grid(axis="x", visible=False)


def abreast(axes, position, count, width):
    """The shift of mark `position` of `count` that share a place on the x axis, all within `width` points."""
    step = min(4.3, width / count)
    return ScaledTranslation(step * (position - (count - 1) / 2) / 72, 0, axes.figure.dpi_scale_trans)


def rows_that_vary(rows, other_factors):
    """The rows with those levels of the other factors at which column `x` takes more than one place, or all if there are
    none: of a study that varies one factor at a time, the part that is about this one."""
    if not other_factors or rows.empty:
        return rows
    num_places = rows.groupby(other_factors)["x"].transform("nunique")
    return rows[num_places > 1] if (num_places > 1).any() else rows


def split_into_panel_rows(path, rows, other_factors, in_words=style.level_in_words):
    """[(title, rows)]: one row of panels per combination of levels of the factors that are on no axis."""
    varying = [factor for factor in other_factors if rows[factor].nunique() > 1]
    combinations = rows[varying].drop_duplicates()
    parts = [(", ".join(map(in_words, varying, levels)), rows[(rows[varying] == levels).all(axis=1)])
             for levels in combinations.itertuples(index=False, name=None)] if varying else [("", rows)]
    if len(parts) > MAX_PANEL_ROWS:
        raise PlotError(f"{path}: {len(parts)} combinations of {', '.join(varying)} need more than {MAX_PANEL_ROWS} "
                        "rows of panels; fix some with --where " +
                        " --where ".join(f"{factor}={rows[factor].iloc[0]}" for factor in varying) + ".")
    return parts
