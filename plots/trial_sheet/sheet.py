"""A figure put together from blocks, from the top down, each of a height that is known beforehand; all lengths in
inches. A block is (height, paint); `paint(sheet, top)` draws it."""

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

MARGIN = 0.12
WIDTH = 8.2  # between the margins


class Sheet:
    """Places things by their left and upper edge."""

    def __init__(self, height):
        self.width, self.height = WIDTH + 2 * MARGIN, height + 2 * MARGIN
        self.figure = Figure(figsize=(self.width, self.height))
        FigureCanvasAgg(self.figure)

    def place(self, left, top):
        """In fractions of the figure, y upwards."""
        return (MARGIN + left) / self.width, 1 - (MARGIN + top) / self.height

    def axes(self, left, top, width, height):
        corner = self.place(left, top + height)
        return self.figure.add_axes((*corner, width / self.width, height / self.height))

    def text(self, left, top, text, **look):
        self.figure.text(*self.place(left, top), text, va="top", **look)

    def legend(self, top, handles, columns):
        """`handles`: {name: handle}."""
        self.figure.legend(handles.values(), handles.keys(), ncols=columns, loc="upper left",
                           bbox_to_anchor=self.place(0, top), borderaxespad=0, borderpad=0, fontsize=7.5,
                           labelspacing=0.35, handlelength=2.2)


def sheet_of(blocks):
    """The figure of all blocks, one below the other."""
    sheet = Sheet(sum(height for height, _ in blocks))
    top = 0
    for height, paint in blocks:
        paint(sheet, top)
        top += height
    return sheet.figure
