"""Names beside the ends of lines, in place of a legend."""

from dataclasses import dataclass

from common import sheet, style
from common.text_size import fill, height_of

SIZE, WIDEST_SHARE = 7.2, 0.3  # points; of the figure's width that names may take
GAP, FREE, TALLEST = 0.16, 0.75, 2.6  # inches between a panel and the names; of a panel's height not beside them; of all names


@dataclass(frozen=True)
class End:
    """Where a line ends, in data, and what stands beside it."""

    x: float
    y: float
    text: str
    color: str
    is_bold: bool


def in_lines(name):
    width = sheet.current().width or style.ONE_PANEL_WIDTH
    return "\n".join(fill(name, WIDEST_SHARE * width - GAP, style.font_size(SIZE), bold=True))


def inches_of(name):
    return height_of(1 + in_lines(name).count("\n"), style.font_size(SIZE))


def make_room(figure, panel_rows, names):
    """Whether the names have room beside each of so many panels, one above the other; a figure that is too low grows."""
    needed = sum(map(inches_of, names))
    missing = needed + FREE - (style.PANEL_HEIGHT if sheet.current().width else 2.4)
    if needed > TALLEST:
        return False
    figure.set_figheight(figure.get_figheight() + max(0, missing) * panel_rows)
    return True


def spread(places, sizes, low, high):
    """Rising places for things of these sizes, none over another, at the least squared distance from those wanted (pool
    adjacent violators) and then moved into [low, high]."""
    below = [sum(sizes[:i]) + sizes[i] / 2 for i in range(len(sizes))]
    blocks = []  # (mean, how many) of things that touch
    for place, offset in zip(places, below):
        blocks.append((place - offset, 1))
        while len(blocks) > 1 and blocks[-2][0] > blocks[-1][0]:
            (a, m), (b, n) = blocks[-2:]
            blocks[-2:] = [((m * a + n * b) / (m + n), m + n)]
    highest = max(low, high - sum(sizes))
    starts = [min(max(mean, low), highest) for mean, count in blocks for _ in range(count)]
    return [start + offset for start, offset in zip(starts, below)]


def add(axes, ends):
    """Names at the right of a panel whose figure has its final height, at the heights where their lines end or, where they
    would touch, near them and joined by a thin line."""
    axes.figure.draw_without_rendering()  # the panel's place
    box, dots = axes.get_window_extent(), axes.figure.dpi
    to_share = (axes.transData + axes.transAxes.inverted()).transform
    ends = sorted(ends, key=lambda end: to_share((end.x, end.y))[1])
    at = [to_share((end.x, end.y)) for end in ends]
    sizes = [inches_of(end.text) * dots / box.height for end in ends]
    for end, (x, y), size, height in zip(ends, at, sizes, spread([y for _, y in at], sizes, -0.02, 1.05)):
        line = dict(arrowstyle="-", color=end.color, linewidth=0.5, shrinkA=2, shrinkB=0, relpos=(0, 0.5))
        axes.annotate(in_lines(end.text), (x, y), (1 + GAP * dots / box.width, height), xycoords="axes fraction", va="center",
                      annotation_clip=False, fontsize=style.font_size(SIZE), color=end.color, linespacing=1.1,
                      fontweight="bold" if end.is_bold else "normal",
                      arrowprops=line if abs(height - y) > 0.1 * size else None)
