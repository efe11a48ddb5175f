"""The sheet a figure is drawn for: how wide it is printed, what its names are, whether it has a caption, in which formats it is
written. Every kind of figure asks the sheet in use, so that all have the same options:

    with sheet.use(Sheet(width=3.48, labels={"rcme": "Ours"}, has_caption=False, formats=("pdf",))):
        style.save(draw(...), "figure")
"""

import contextlib
from dataclasses import dataclass, field

FORMATS = ("png", "pdf", "svg", "tikz")
NARROWEST, WIDEST = 2.5, 14.0  # inches
SMALLEST_FONT, LARGEST_FONT = 7.0, 9.0  # points, of every text of a figure with a stated width


@dataclass
class Sheet:
    width: float = None  # inches; None: as each figure needs it, for a screen and a page of its own
    labels: dict = field(default_factory=dict)  # name of an estimator, factor, level or quantity: what to print
    has_caption: bool = True
    formats: tuple = ("png", "pdf")
    highlight: tuple = ()  # estimators in colour, the others grey; none: all in colour
    colors: dict = field(default_factory=dict)  # name of an estimator: its colour
    asked: tuple = ()  # (option, name) of the command line: what the figure has to show
    met: dict = field(default_factory=dict)  # the names that the figure asked for, in order

    def text_of(self, name, otherwise):
        """What the figure prints for a name."""
        self.met[name] = None
        return self.labels.get(name, otherwise)

    def font_size(self, points):
        """The size of a text: as it is, or, where the width is stated, within what can be read in print."""
        return points if self.width is None else min(max(points, SMALLEST_FONT), LARGEST_FONT)


_in_use = [Sheet()]


def current():
    return _in_use[-1]


@contextlib.contextmanager
def use(sheet):
    _in_use.append(sheet)
    try:
        yield sheet
    finally:
        _in_use.pop()
