"""The axis of measured values: linear, logarithmic or logit, its limits and its ticks.

The limits hold every measured and nominal value and the end of the allowed range next to it. Intervals and the other end
widen them by a few widths of an interval at most, so that none can flatten the rest; what leaves the panel is cut at its
frame.
"""

import math
from dataclasses import dataclass
from statistics import median

from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullLocator

from common import sheet
from common.number_text import number_text
from common.text_size import width_of

TICK_ROOM = 0.42  # inches
WIDE_RATIO = 30  # a linear axis would hide the small values
LOGIT_TICKS = (1e-6, 1e-5, 1e-4, 0.001, 0.01, 0.05, 0.1, 0.2, 0.5, 0.8, 0.9, 0.95, 0.99, 0.999, 0.9999, 1 - 1e-5, 1 - 1e-6)


@dataclass(frozen=True)
class Scale:
    name: str  # of matplotlib: linear, log, logit
    is_rate: bool  # drawn in per cent
    low: float
    high: float
    ticks: tuple = ()  # the most important first; none if they follow from the limits

    def clip(self, value):
        return min(max(value, self.low), self.high)

    def holds(self, value):
        return self.low <= value <= self.high

    def seen(self, target):
        """The interval inside the panel: (lower, upper, is cut below, is cut above); None if nothing of it is."""
        if math.isinf(target.lower) and math.isinf(target.upper) or target.lower > self.high or target.upper < self.low:
            return None
        return self.clip(target.lower), self.clip(target.upper), target.lower < self.low, target.upper > self.high

    def cuts(self, target):
        seen = self.seen(target)
        return seen is not None and (seen[2] or seen[3])

    def tick_text(self, value):
        """A value of 0 or 1 has no place on a logit axis: the frame stands for it."""
        if self.name == "logit" and not self.low < value < self.high:
            value = round(value)
        return number_text((100 if self.is_rate else 1) * value)

    def apply(self, axes, direction):
        """To the 'x' or 'y' axis of the axes."""
        axis = getattr(axes, direction + "axis")
        getattr(axes, f"set_{direction}scale")(self.name)
        getattr(axes, f"set_{direction}lim")(self.low, self.high)
        axis.set_major_locator(FixedLocator(self.ticks_that_fit(axes, direction)) if self.ticks else
                               MaxNLocator(num_steps(axes, direction), steps=[1, 2, 2.5, 5, 10]))
        axis.set_major_formatter(FuncFormatter(lambda value, _: self.tick_text(value)))
        axis.set_minor_locator(NullLocator())


    def ticks_that_fit(self, axes, direction):
        """Those that do not touch one that is more important."""
        box, (width, height) = axes.get_position(), axes.figure.get_size_inches()
        length = box.width * width if direction == "x" else box.height * height
        inch = length / (place(self.name, self.high) - place(self.name, self.low))
        kept = []
        for tick in self.ticks:
            def room(other, tick=tick):
                if direction == "y":
                    return 0.13
                return (width_of(self.tick_text(tick), 8) + width_of(self.tick_text(other), 8)) / 2 + 0.06
            if all(inch * abs(place(self.name, tick) - place(self.name, other)) > room(other) for other in kept):
                kept.append(tick)
        return sorted(kept)


def num_steps(axes, direction):
    """Between the ticks of a linear axis: five, on a sheet with a width as many as have room for their numbers."""
    if sheet.current().width is None or direction == "y":
        return 5
    length = axes.get_position().width * axes.figure.get_figwidth()
    return max(1, min(5, int(length / TICK_ROOM)))


def place(name, value):
    """The value on the axis; NaN or infinite if it has no place there."""
    if not math.isfinite(value):
        return math.nan
    if name == "log":
        return math.log10(value) if value > 0 else math.nan
    if name == "logit":
        return math.log(value / (1 - value)) if 0 < value < 1 else math.nan
    return value


def value_at(name, position):
    if name == "log":
        return 10 ** position
    return 1 / (1 + math.exp(-position)) if name == "logit" else position


def finite(values):
    return [value for value in values if math.isfinite(value)]


def scale_name(targets, nominals_spread):
    """logit for rates around several nominal values, log for positive values of very different size."""
    if nominals_spread:
        return "logit"
    core = finite(value for target in targets for value in (target.measured, target.nominal))
    bounds = finite(value for target in targets for value in (target.low, target.high))
    if core and min(core + bounds) > 0 and max(core) > WIDE_RATIO * min(core):
        return "log"
    return "linear"


def spread_limits(name, targets):
    """(low, high) on the axis: all measured and nominal values, and the intervals and ranges near them."""
    def placed(values):
        return finite(place(name, value) for value in values)
    core = placed(value for target in targets for value in (target.measured, target.nominal, nearest_bound(target)))
    pairs = [placed(pair) for target in targets for pair in ((target.lower, target.upper), (target.low, target.high))]
    ends = [end for pair in pairs for end in pair]
    core = core or ends or placed((0.05, 0.95))
    widths = widths_of(placed((target.lower, target.upper)) for target in targets) or widths_of(pairs)
    allowance = max(2 * (max(core) - min(core)), 3 * median(widths) if widths else 0) or abs(core[0]) / 10 or 1
    low = min([min(core)] + [max(end, min(core) - allowance) for end in ends])
    high = max([max(core)] + [min(end, max(core) + allowance) for end in ends])
    margin = 0.07 * (high - low) or 0.5 * allowance
    return low - margin, high + margin


def widths_of(pairs):
    """Of those with two ends that differ."""
    return [pair[1] - pair[0] for pair in pairs if len(pair) == 2 and pair[1] > pair[0]]


def nearest_bound(target):
    """The end of the allowed range that decides: the one next to the measured value."""
    bounds = finite((target.low, target.high))
    if not bounds or math.isnan(target.measured):
        return math.nan
    return min(bounds, key=lambda bound: abs(bound - target.measured))


def scale_of(targets, nominals_spread=False):
    """The Scale on which all these targets, all of one kind, can be read."""
    name, is_rate = scale_name(targets, nominals_spread), targets[0].kind == "rate"
    low, high = (value_at(name, position) for position in spread_limits(name, targets))
    if is_rate and name == "linear":
        edge = 0.02 * (high - low)
        low, high = max(low, -edge), min(high, 1 + edge)
    return Scale(name, is_rate, low, high, ticks_of(name, low, high, targets))


def ticks_of(name, low, high, targets):
    if name == "linear":
        return ()
    if name == "logit":
        nominals = {target.nominal for target in targets if low < target.nominal < high}
        edges = {low for target in targets if target.measured == 0} | {high for target in targets if target.measured == 1}
        return (*sorted(edges), *sorted(nominals, key=lambda nominal: abs(nominal - 0.95)),
                *(tick for tick in LOGIT_TICKS if low < tick < high and tick not in nominals))
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    ticks = [digit * 10.0 ** decade for digit in (1, 5, 2) for decade in decades if digit == 1 or len(decades) <= 4]
    return tuple(tick for tick in ticks if low <= tick <= high)
