#!/usr/bin/python3
"""Draws what `rcme transfer` found: whether a setting tuned on one family of trials serves another, each figure as PNG
and PDF:
  PREFIX_matrix   the targeted rate, a row per family tuned on, a column per family verified on
  PREFIX_refusal  the refusal rate in the same places: a setting may meet its target by refusing everything
It draws what the file says and computes nothing: rates, intervals and verdicts are those of the program.
"""

import sys

import pandas
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke

from common import sheet, style
from common.command_line import FigureParser, PlotError, draw_figures
from common.number_text import number_text
from common.paper import HEAD_SIZE, SMALL_SIZE, add_axes, add_text
from common.text_size import fill, height_of, width_of
from rates.cells import CELL_HEIGHT, CELL_WIDTH, draw_cell, in_per_cent, text_color
from rates.rate_bands import QUANTITIES, SCALE, TARGET, add_color_bar, color_of
from rates.selection import n_in_words
from tuning_figures.marks import EXACT, head_in_words
from tuning_figures.tune_file import UNDECIDED, VIOLATED, is_real, read_transfer

MATRIX_WIDTH = 4.4  # inches, as all lengths here: cells narrow until so many families fit
NARROWEST_CELL, LOWEST_CELL, LEAST_CELL_IN_PRINT = 0.155, 0.15, 0.26
MARGIN, GAP, BAR_WIDTH, BAR_ROOM, LONGEST_BAR = 0.1, 0.08, 0.12, 0.5, 2.6
LONGEST_NAME, LONGEST_HEADER, LEAST_WIDTH = 1.9, 0.75, 4.6
EMPTY = dict(facecolor="0.95", hatch="////", edgecolor="0.8", linewidth=0)

EXAMPLE = """
example:
  rcme plot transfer transfer.json --out transfer
draws transfer_matrix.png, transfer_refusal.png and the same as PDF.
"""


def shortened(text, width, size):
    """The text, or as much of its beginning as fits before an ellipsis."""
    if width_of(text, size) <= width:
        return text
    while text and width_of(text + "\u2026", size) > width:
        text = text[:-1].rstrip()
    return text + "\u2026"


class Layout:
    """Sizes and places of one matrix: cells shrink with the number of families, and so do names and numbers."""

    def __init__(self, transfer):
        self.transfer, self.count = transfer, len(transfer.families)
        paper_width = sheet.current().width
        self.cell = max(NARROWEST_CELL, min(CELL_WIDTH, MATRIX_WIDTH / self.count))
        if paper_width is not None:
            self.cell = CELL_WIDTH
            self.place()
            self.cell -= max(0, self.needed_width - paper_width) / self.count
            if self.cell < LEAST_CELL_IN_PRINT:
                raise PlotError(f"--width {paper_width:g}: {self.count} families need "
                                f"{paper_width + self.count * (LEAST_CELL_IN_PRINT - self.cell) + 0.05:.1f} inches.")
        self.place()
        self.width = paper_width or max(LEAST_WIDTH, self.needed_width)

    def place(self):
        """All that follows from the cells' width."""
        transfer = self.transfer
        self.has_intervals = self.cell == CELL_WIDTH and sheet.current().width is None
        self.cell_height = max(LOWEST_CELL, min(CELL_HEIGHT, 0.7 * self.cell))
        self.name_size = style.font_size(max(5.8, min(7.5, 36 * self.cell)))
        self.number_size = style.font_size(min(7, 28 * self.cell))
        self.outline = min(1.3, 5.2 * self.cell)
        self.names = [shortened(family.words, LONGEST_NAME, self.name_size) for family in transfer.families]
        self.names_width = max(map(self.width_of, self.names + ["Tuned on"]))
        self.headers = [fill(option.label(), LONGEST_HEADER, self.name_size) for option in transfer.options]
        self.columns = [max(map(self.width_of, header + self.values(number))) + 1.5 * GAP
                        for number, header in enumerate(self.headers)]
        self.are_names_level = max(map(self.width_of, self.names)) <= self.cell - 0.04
        self.top = MARGIN + 0.42 + self.header_height()
        self.left = MARGIN + self.names_width + GAP
        self.matrix_width, self.matrix_height = self.count * self.cell, self.count * self.cell_height
        self.right = self.left + self.matrix_width
        self.needed_width = self.right + sum(self.columns) + GAP
        self.has_bar = (sheet.current().width or LEAST_WIDTH) >= LEAST_WIDTH  # the number of a cell says it all
        if self.has_bar:
            self.needed_width += BAR_WIDTH + BAR_ROOM

    def width_of(self, text):
        return width_of(text, self.name_size)

    def values(self, number):
        """The tuned levels of one option, a text per family."""
        return ["" if family.levels is None else number_text(float(family.levels[number]))
                if is_real(family.levels[number]) else family.levels[number] for family in self.transfer.families]

    def header_height(self):
        """Room for the columns' names and for the options'."""
        lines = 1 if self.are_names_level else 0
        upright = 0 if self.are_names_level else max(map(self.width_of, self.names)) + GAP / 2
        return max(height_of(max(lines, *map(len, self.headers)), self.name_size) + GAP / 2, upright)

    def row_middle(self, number):
        """Inches from the upper edge."""
        return self.top + (number + 0.5) * self.cell_height


def number_in_cell(rate):
    """Per cent in at most three characters."""
    if not 0 < rate < 0.995:
        return f"{100 * rate:.0f}"
    return in_per_cent(rate) if rate < 0.0995 else f"{100 * rate:.0f}"


def draw_small_cell(axes, left, bottom, rate, size):
    """A coloured cell with its number alone; what has no trials shows the hatches behind."""
    if rate.value != rate.value:
        return
    color = color_of(rate.value)
    axes.fill_between([left, left + 1], bottom, bottom + 1, facecolor=color, edgecolor="white", linewidth=0.4)
    axes.text(left + 0.5, bottom + 0.46, number_in_cell(rate.value), ha="center", va="center", fontsize=size,
              color=text_color(color))


def draw_verdict(axes, left, bottom, verdict, width, numbers):
    """An outline where the target is violated; paler, slanting numbers where the trials do not decide."""
    if verdict == VIOLATED:
        axes.add_patch(Rectangle((left + 0.06, bottom + 0.08), 0.88, 0.84, edgecolor=TARGET, facecolor="none", zorder=4,
                                 linewidth=width, path_effects=[withStroke(linewidth=2 * width, foreground="white")]))
    if verdict == UNDECIDED:
        for text in numbers:
            text.set(alpha=0.65, style="italic")


def draw_matrix(axes, layout, quantity):
    """The cells of one rate, the first family above; a hatched row for what could not be tuned."""
    transfer, count = layout.transfer, layout.count
    axes.set(xlim=(0, count), ylim=(0, count), xticks=[], yticks=[])
    axes.patch.set(**EMPTY)
    axes.spines[:].set_visible(False)
    for cell in transfer.cells:
        rate, place, before = getattr(cell, quantity), (cell.verified_on, count - 1 - cell.tuned_on), len(axes.texts)
        if layout.has_intervals:
            draw_cell(axes, *place, rate, SCALE)
        else:
            draw_small_cell(axes, *place, rate, layout.number_size)
        draw_verdict(axes, *place, cell.verdict, layout.outline, axes.texts[before:])
    for number, family in enumerate(transfer.families):
        if family.levels is None:
            why = shortened(family.why, layout.matrix_width - 0.15, layout.name_size)
            axes.text(count / 2, count - 0.5 - number, why, fontsize=layout.name_size, ha="center",
                      va="center", color="0.2", bbox=dict(facecolor="white", edgecolor="none", pad=0.8))


def draw_names(figure, layout):
    """Families at the left and above, tuned levels at the right."""
    look = dict(fontsize=layout.name_size)
    bottom = layout.top - GAP / 2
    add_text(figure, MARGIN, bottom, "Tuned on", va="bottom", fontweight="bold", **look)
    add_text(figure, layout.left, MARGIN + 0.22, "Verified on", fontweight="bold", **look)
    for number, name in enumerate(layout.names):
        add_text(figure, layout.left - GAP, layout.row_middle(number), name, ha="right", va="center", **look)
        add_text(figure, layout.left + (number + 0.5) * layout.cell, bottom, name, ha="center", va="bottom",
                 rotation=0 if layout.are_names_level else 90, **look)
    left = layout.right + GAP
    for column, (header, width) in enumerate(zip(layout.headers, layout.columns)):
        add_text(figure, left, bottom, "\n".join(header), va="bottom", **look)
        for number, value in enumerate(layout.values(column)):
            add_text(figure, left, layout.row_middle(number), value, va="center", **look)
        left += width
    return left


def caption_of(transfer, layout, quantity):
    counts = pandas.DataFrame({"n": [getattr(cell, quantity).n for cell in transfer.cells]})
    verdicts = {cell.verdict for cell in transfer.cells}
    return "; ".join(
        [head_in_words(transfer)] + ([n_in_words(counts, "cell")] if len(counts) else []) +
        (["outlined: the target is violated there"] if VIOLATED in verdicts else []) +
        (["pale and slanting: undecided whether it is"] if UNDECIDED in verdicts else []) +
        (["hatched: not tuned or no trials"] if len(counts) < layout.count ** 2 or counts.n.min() == 0 else []) +
        ([f"in brackets {EXACT}"] if layout.has_intervals else [])) + "."


def draw(transfer, quantity, title):
    """One matrix; `quantity`: the rate of a cell, by its name there."""
    layout = Layout(transfer)
    small = style.font_size(SMALL_SIZE)
    caption = fill(caption_of(transfer, layout, quantity), layout.width - 2 * MARGIN, small) if sheet.current().has_caption else []
    bar_height = max(layout.matrix_height, 1.3 if layout.has_bar else 0)
    bottom = layout.top + bar_height + GAP
    figure = Figure(figsize=(layout.width, bottom + height_of(len(caption), small) + MARGIN))
    FigureCanvasAgg(figure)
    add_text(figure, MARGIN, MARGIN, title, fontsize=HEAD_SIZE)
    draw_matrix(add_axes(figure, layout.left, layout.top, layout.matrix_width, layout.matrix_height), layout, quantity)
    left = draw_names(figure, layout) + GAP
    if layout.has_bar:
        bar = add_axes(figure, left, layout.top, BAR_WIDTH, min(bar_height, LONGEST_BAR))
        add_color_bar(figure, transfer.target.at_most if quantity == "rate" else transfer.target.max_refusal, cax=bar)
    if caption:
        add_text(figure, MARGIN, bottom, "\n".join(caption), fontsize=small, color="0.3")
    return figure


def draw_for(options):
    transfer = read_transfer(options.transfer)
    return {"_matrix": draw(transfer, "rate", f"{QUANTITIES[transfer.target.kind]} (%) of the tuned setting"),
            "_refusal": draw(transfer, "refusal", f"{QUANTITIES['refusal']} (%) of the tuned setting")}


def parse(arguments):
    parser = FigureParser(prog="rcme plot transfer", description=__doc__, epilog=EXAMPLE)
    parser.add_argument("transfer", metavar="TRANSFER.json", help="file that 'rcme transfer' wrote")
    parser.add_argument("--out", required=True, metavar="PREFIX",
                        help="where to write: the figures' names begin with it")
    return parser.parse_args(arguments)


def main(arguments=None):
    return draw_figures("transfer.py", parse, draw_for, arguments)


if __name__ == "__main__":
    sys.exit(main())
