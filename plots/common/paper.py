"""Placing things on a figure in inches from its upper left corner."""

from matplotlib.lines import Line2D

HEAD_SIZE, SMALL_SIZE = 8.5, 6.5


def add_axes(figure, left, top, width, height):
    paper_width, paper_height = figure.get_size_inches()
    return figure.add_axes((left / paper_width, 1 - (top + height) / paper_height,
                            width / paper_width, height / paper_height))


def add_text(figure, left, top, text, **look):
    """The upper left corner of the text (or what `ha` and `va` say) stands there."""
    paper_width, paper_height = figure.get_size_inches()
    look = {"ha": "left", "va": "top", "linespacing": 1.2, **look}
    return figure.text(left / paper_width, 1 - top / paper_height, text, **look)


def add_rule(figure, left, top, width, **look):
    paper_width, paper_height = figure.get_size_inches()
    y = 1 - top / paper_height
    return figure.add_artist(Line2D([left / paper_width, (left + width) / paper_width], [y, y], **look))


def keep_right_of(axes, left):
    """Moves the left end of the axes, not the right one, until its labels begin at `left` inches."""
    figure = axes.figure
    for _ in range(2):  # fewer inches may mean other ticks
        box = axes.get_position()
        labels_left = axes.get_tightbbox(figure.canvas.get_renderer()).x0 / figure.dpi
        x0 = box.x0 + (left - labels_left) / figure.get_size_inches()[0]
        axes.set_position((x0, box.y0, box.x1 - x0, box.height))
