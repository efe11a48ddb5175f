"""How wide a text is on paper, in inches, and where to break it; nothing here is drawn."""

import functools
import re

from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextToPath

LINE_HEIGHT = 1.25 / 72  # inches per point of size
BREAKS = (r"(?<=[,;] )", r"(?<= )", r"(?<=[._/-])(?=[A-Za-z])", r"(?<=.)")  # the best place first


@functools.lru_cache(maxsize=None)
def width_of(text, size, bold=False):
    """Inches; the widest line of the text."""
    font = FontProperties(family="DejaVu Sans", weight="bold" if bold else "normal", size=size)
    lines = text.split("\n")
    return max(TextToPath().get_text_width_height_descent(line, font, False)[0] for line in lines) / 72


def wrap(text, width, size, bold=False):
    """The lines of the text, each at most `width` inches.

    Broken after a comma; a phrase that fills more than a line after a space, a word after '_', '.', '/' or '-', and what
    is still too long anywhere.
    """
    def fits(line):
        return width_of(line.rstrip(), size, bold) <= width

    def add(lines, piece, level):
        if fits(lines[-1] + piece):
            lines[-1] += piece
        elif level == len(BREAKS) or fits(piece):
            lines.append(piece)
        else:
            for part in filter(None, re.split(BREAKS[level], piece)):
                add(lines, part, level + 1)

    lines = [""]
    add(lines, text, 0)
    return [line.rstrip() for line in lines if line.strip()] or [""]


def fill(text, width, size, bold=False):
    """The lines of a running text: broken between words, and within one only where it fills a line alone."""
    lines = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".strip()
        if width_of(longer, size, bold) <= width:
            lines[-1] = longer
        else:
            lines += wrap(word, width, size, bold)
    return list(filter(None, lines)) or [""]


def height_of(lines, size):
    """Inches of so many lines of a size."""
    return lines * size * LINE_HEIGHT
