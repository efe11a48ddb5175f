"""A figure as a picture inside a page, on a narrow screen another one than on a wide."""

import base64
import io

from common import sheet, style
from common.command_line import PlotError
from page.html import element

PIXELS_PER_INCH = 115
WIDE, NARROW, NARROW_SCREEN = 6.8, 3.4, "(max-width: 40rem)"  # inches of the figures, the second for such a screen


def settle(figure):
    """Leaves the panels where the layout puts them, to a millionth of the figure: the last bits of its solver are not the same
    each time, and names within the file are hashes of them."""
    style.lay_out(figure, figure.get_dpi())
    for axes in figure.axes:
        axes.set_position([round(number, 6) for number in axes.get_position().bounds])


def data_uri(figure):
    """The figure as SVG; the same figure gives the same bytes."""
    picture = io.BytesIO()
    settle(figure)
    style.print_as("svg", figure, picture, {"Date": None, "Creator": None})
    return "data:image/svg+xml;base64," + base64.b64encode(picture.getvalue()).decode()


def picture_of(draw, alt):
    """The figure as it would be printed over a page; on a narrow screen the one for a column, whose texts are as large there.
    What has no room in either is as it is, and scrolls. Throws PlotError."""
    try:
        with sheet.use(sheet.Sheet(width=WIDE)):
            figure = draw()
    except PlotError:
        figure = draw()
    width, height = (round(PIXELS_PER_INCH * inches) for inches in figure.get_size_inches())
    image = element("img", src=data_uri(figure), alt=alt, width=width, height=height)
    try:
        with sheet.use(sheet.Sheet(width=NARROW)):
            narrow = element("source", media=NARROW_SCREEN, srcset=data_uri(draw()))
    except PlotError:
        return element("div", image, class_="scroll wide", role="region", tabindex="0", aria_label="figure")
    return element("picture", narrow, image)
