"""The figure of one family: its panels in a grid, each under its title and verdict, marks above, caption below.

Curves come first, in rows; forests, which are wide and of very different length, follow, each in the shorter column.
"""

import math
from dataclasses import dataclass

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from audit_figures import look
from audit_figures.panel import Panel
from common import sheet
from common.paper import HEAD_SIZE, SMALL_SIZE, add_text
from common.style import font_size
from common.text_size import height_of, width_of, wrap

COLUMN, COLUMN_GAP, MARGIN, ROW_GAP = 3.4, 0.3, 0.1, 0.26  # inches
NARROWEST_COLUMN = 3.0  # inches, of two on a sheet with a width
TALLEST = 11  # inches; beyond, the page becomes wider as long as it is taller than wide
MAX_COLUMNS = 8


@dataclass(frozen=True)
class Titled:
    """A panel with its words."""

    claim: object
    note: str  # in small print: the conditions all its rows share
    body: Panel

    def title(self):
        return f"{self.claim.id} ({self.claim.reading})" if self.claim.reading else self.claim.id

    def head(self, letter, width):
        """[(text of one or more lines, look)] from top to bottom."""
        title = wrap(f"{letter} {self.title()}".lstrip(), width, HEAD_SIZE)
        verdict = wrap(look.verdict_text(self.claim), width, 8, bold=True)
        small = font_size(SMALL_SIZE)
        note = wrap(self.note, width, small) if self.note else []
        return [("\n".join(title), dict(fontsize=HEAD_SIZE)),
                ("\n".join(verdict), dict(fontsize=8, fontweight="bold", color=look.LOOKS[self.claim.verdict].color)),
                ("\n".join(note), dict(fontsize=small, color=look.GREY))]

    def head_height(self, width):
        return sum(height_of(text.count("\n") + 1, style["fontsize"]) for text, style in self.head("(mm)", width)
                   if text) + 0.07

    def height(self, width):
        return self.head_height(width) + self.body.height(width)

    def draw(self, figure, letter, left, top, width, head_height):
        y = top
        for text, style in self.head(letter, width):
            if text:
                add_text(figure, left, y, text, **style)
                y += height_of(text.count("\n") + 1, style["fontsize"])
        self.body.draw(figure, left, top + head_height, width)


@dataclass(frozen=True)
class Place:
    panel: Titled
    left: float
    top: float
    width: float
    head_height: float


def column_width(columns):
    """Of one of so many."""
    paper_width = sheet.current().width
    return COLUMN if paper_width is None else (paper_width - 2 * MARGIN - (columns - 1) * COLUMN_GAP) / columns


def width_of_columns(columns):
    return columns * column_width(columns) + (columns - 1) * COLUMN_GAP


def arrange(panels, columns):
    """(places, height) of the panels from the top of the grid."""
    narrow = [panel for panel in panels if panel.body.span == 1]
    places, top = arrange_rows(narrow, columns)
    wide, bottom = arrange_columns([panel for panel in panels if panel.body.span > 1], columns, top)
    return places + wide, bottom


def arrange_rows(panels, columns):
    """Rows of equal columns; in one row all axes begin at one height."""
    places, top = [], 0
    for first in range(0, len(panels), columns):
        row = panels[first:first + columns]
        is_alone = len(panels) == 1 < columns  # among forests, so it is as wide as they
        width = width_of_columns(columns if sheet.current().width else 2) if is_alone else column_width(columns)
        head = max(panel.head_height(width) for panel in row)
        places += [Place(panel, column * (column_width(columns) + COLUMN_GAP), top, width, head) for column, panel in enumerate(row)]
        top += head + max(panel.body.height(width) for panel in row) + ROW_GAP
    return places, top


def arrange_columns(panels, columns, top):
    """Wide columns from `top` down; the next panel goes below the shortest."""
    count = max(1, columns // 2)
    width = width_of_columns(min(2, columns))
    bottoms, places = [top] * count, []
    for panel in panels:
        column = bottoms.index(min(bottoms))
        places.append(Place(panel, column * (width + COLUMN_GAP), bottoms[column], width, panel.head_height(width)))
        bottoms[column] += panel.height(width) + ROW_GAP
    return places, max(bottoms)


def grid(panels):
    """(columns, places, height): one column for one curve, else two, more if the page became too tall; of a stated width as
    many as fit."""
    paper_width = sheet.current().width
    if paper_width is not None:
        columns = 1 if paper_width < 2 * NARROWEST_COLUMN else 2
        return columns, *arrange(panels, columns)
    columns = 1 if len(panels) == 1 and panels[0].body.span == 1 else 2
    places, height = arrange(panels, columns)
    while height > max(TALLEST, 1.3 * width_of_columns(columns)) and 2 <= columns < MAX_COLUMNS:
        wider_places, wider_height = arrange(panels, columns + 2)
        if wider_height > 0.9 * height:
            break
        columns, places, height = columns + 2, wider_places, wider_height
    return columns, places, height


def letter_of(position):
    """(a) ... (z), (aa), (ab) ..."""
    letters = "abcdefghijklmnopqrstuvwxyz"
    return f"({letters[position // 26 - 1] if position >= 26 else ''}{letters[position % 26]})"


def legend_columns_within(handles, width):
    """At most three."""
    widest = max((width_of(handle.get_label(), 8) for handle in handles), default=0)
    return max(1, min(3, int((width - 2 * MARGIN + 0.13) / (widest + 0.4))))


def draw_page(panels, handles, caption):
    columns, places, grid_height = grid(panels)
    width = width_of_columns(columns) + 2 * MARGIN
    small = font_size(SMALL_SIZE)
    caption = wrap(caption, width - 2 * MARGIN, small) if sheet.current().has_caption else []
    legend_columns = len(handles) if columns > 1 else min(legend_columns_within(handles, width), len(handles))
    legend_height = 0.2 * math.ceil(len(handles) / max(1, legend_columns)) + 0.1 if handles else 0
    height = MARGIN + legend_height + grid_height - ROW_GAP / 2 + height_of(len(caption), small) + MARGIN
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    if handles:
        figure.legend(handles=handles, loc="upper left", ncols=legend_columns, borderaxespad=0, borderpad=0,
                      bbox_to_anchor=(MARGIN / width, 1 - MARGIN / height), handlelength=1.8)
    for position, place in enumerate(places):
        place.panel.draw(figure, letter_of(position) if len(places) > 1 else "", MARGIN + place.left,
                         MARGIN + legend_height + place.top, place.width, place.head_height)
    if caption:
        add_text(figure, MARGIN, height - MARGIN, "\n".join(caption), fontsize=small, color="0.3", va="bottom")
    return figure
