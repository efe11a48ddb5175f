"""The axis of a condition: where its levels stand and how they are labelled.

Levels are numbers (linear; logarithmic for a noise level and for positive values over more than a decade, if there is a
zero two decades, with a place for the zero beside them) or words (side by side in the order of the file).
"""

import math
import re

import numpy
from matplotlib.ticker import FixedFormatter, FixedLocator, NullLocator

from common import style
from common.number_text import parse_number
from common.text_size import height_of, width_of, wrap

TICK_SIZE = 7.5
UPRIGHT_LENGTH = 1.2  # inches at most of a label that stands upright
ZERO_GAP = 0.35  # decades from the smallest positive level to the place of zero


class Levels:
    """The levels of one condition on an axis `width` inches long."""

    def __init__(self, name, texts, width):
        self.name, self.width = name, width
        self.texts = list(dict.fromkeys(texts))
        numbers = [parse_number(text) for text in self.texts]
        self.are_numbers = all(map(math.isfinite, numbers))
        if self.are_numbers:
            self.texts.sort(key=float)
            numbers.sort()
        self.values = dict(zip(self.texts, numbers if self.are_numbers else map(float, range(len(numbers)))))
        positive = [number for number in numbers if number > 0]
        decades = math.log10(max(positive) / min(positive)) if len(positive) > 1 else 0
        self.is_log = self.are_numbers and min(numbers) >= 0 and decades > 0 and \
            (name == "sigma_px" or decades > (1 if min(numbers) > 0 else 2))
        self.smallest = min(positive, default=math.nan)
        self.has_zero = self.is_log and min(numbers) == 0
        self.lines, self.upright = self.tick_lines()

    def place(self, text):
        """The x value of a level: the number itself, or the position of a word."""
        return self.values[text]

    def slot(self):
        return self.width / max(1, len(self.texts))

    def tick_lines(self):
        """The tick labels, and whether they stand upright: words that do not fit side by side, broken between words."""
        if self.are_numbers:
            return list(self.texts), False
        widest_word = max(width_of(word, TICK_SIZE) for text in self.texts for word in re.split(r"[ ._/-]", text + "_"))
        broken = [wrap(text, self.slot() - 0.06, TICK_SIZE) for text in self.texts]
        if widest_word < self.slot() - 0.1 and max(map(len, broken)) <= 3:
            return ["\n".join(lines) for lines in broken], False
        room = max(1, int(self.slot() / height_of(1, TICK_SIZE)))
        broken = [wrap(text, UPRIGHT_LENGTH, TICK_SIZE) for text in self.texts]
        return ["\n".join(lines[:room]) + ("\u2026" if len(lines) > room else "") for lines in broken], True

    def height(self):
        """Inches below the axis: ticks, tick labels and the name of the condition."""
        if self.upright:
            labels = max(width_of(text, TICK_SIZE) for text in self.lines)
        else:
            labels = height_of(max(text.count("\n") + 1 for text in self.lines), TICK_SIZE)
        return 0.08 + labels + 0.04 + height_of(1, 8.5)

    def position(self, value):
        """The place along the axis, from which distances on paper follow."""
        if not self.is_log:
            return value
        return math.log10(value) if value > 0 else math.log10(self.smallest) - ZERO_GAP

    def apply(self, axes):
        places = [self.position(value) for value in self.values.values()]
        margin = 0.06 * (places[-1] - places[0]) or 0.5
        if not self.are_numbers:
            margin = 0.5
        if self.is_log:
            self.apply_log(axes, places, margin)
        else:
            axes.set_xlim(places[0] - margin, places[-1] + margin)
        ticks = self.ticks_that_fit(places, margin)
        axes.xaxis.set_major_locator(FixedLocator([self.values[self.texts[number]] for number in ticks]))
        axes.xaxis.set_major_formatter(FixedFormatter([self.lines[number] for number in ticks]))
        axes.xaxis.set_minor_locator(NullLocator())
        axes.tick_params(axis="x", labelsize=TICK_SIZE)
        if self.upright:
            axes.tick_params(axis="x", rotation=90)
        axes.set_xlabel(style.in_words(self.name))

    def apply_log(self, axes, places, margin):
        """With a zero, the axis is linear from zero to the smallest positive level and logarithmic from there."""
        if self.has_zero:
            axes.set_xscale("function", functions=(self.bent, self.unbent))
            axes.set_xlim(*self.unbent([places[0] - margin, places[-1] + margin]))
        else:
            axes.set_xscale("log")
            axes.set_xlim(10 ** (places[0] - margin), 10 ** (places[-1] + margin))

    def bent(self, values):
        """Values -> places; the same as `position`, for an array and between the levels too."""
        values, first = numpy.asarray(values, float), math.log10(self.smallest)
        return numpy.where(values >= self.smallest, numpy.log10(numpy.maximum(values, self.smallest)),
                           first - ZERO_GAP * (1 - values / self.smallest))

    def unbent(self, places):
        """Places -> values: the inverse of `bent`."""
        places, first = numpy.asarray(places, float), math.log10(self.smallest)
        return numpy.where(places >= first, 10 ** places, self.smallest * (1 - (first - places) / ZERO_GAP))

    def ticks_that_fit(self, places, margin):
        """Numbers of the levels whose labels do not touch: from the left, the last one always."""
        if not self.are_numbers:
            return range(len(places))
        inch = self.width / (places[-1] - places[0] + 2 * margin)
        half = [width_of(text, TICK_SIZE) / 2 for text in self.lines]

        def clear(left, right):
            return inch * (places[right] - places[left]) > half[left] + half[right] + 0.06
        last = len(places) - 1
        kept = []
        for number in range(last):
            if (not kept or clear(kept[-1], number)) and clear(number, last):
                kept.append(number)
        return kept + [last]
