"""One look for every figure of this project.

    figure, axes = style.new_figure(rows=1, columns=2)
    looks = style.looks_of(["standard", "rcme"])       # colour, marker, dashes: those of an estimator in every figure
    axes[0, 0].plot(x, y, **looks["rcme"].line())
    style.add_legend_and_caption(figure, handles, "study demo, n = 400 per point")
    style.save(figure, "failure_rate")                 # failure_rate.png and failure_rate.pdf

Colours can be told apart with every common colour-vision deficiency; the first seven are those of Okabe and Ito. Colour is
never the only carrier: each estimator also has its own marker and dash pattern, so a grey print says the same.
"""

import hashlib
import itertools
import math
import textwrap
from dataclasses import dataclass, replace

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: E402  (after the choice of backend)
from matplotlib.backends.backend_pdf import FigureCanvasPdf  # noqa: E402
from matplotlib.backends.backend_svg import FigureCanvasSVG  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.path import Path  # noqa: E402

from common import sheet  # noqa: E402
from common.text_size import fill  # noqa: E402
from common.whole_file import write_whole  # noqa: E402

BLACK, ORANGE, SKY_BLUE, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILLION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"  # Okabe-Ito's yellow is too pale for a line on white

SOLID, DASHED, DOTTED, DASH_DOT, LONG_DASHED = "-", (0, (4, 1.6)), (0, (1, 1.4)), (0, (5, 1.4, 1, 1.4)), (0, (8, 2))

FOUR_POINTS = (4, 1, 0)  # a star

# An arrow that hangs from its point: "at most this", for a value that has no place on a logarithmic axis.
ARROW_DOWN = Path([(0, 0), (0, -2), (-0.4, -1.5), (0, -2), (0.4, -1.5)],
                  [Path.MOVETO, Path.LINETO, Path.MOVETO, Path.LINETO, Path.LINETO])

RC = {
    "font.family": "DejaVu Sans",  # ships with matplotlib: the same glyphs on every machine
    "font.size": 8, "axes.titlesize": 8.5, "axes.labelsize": 8.5,
    "xtick.labelsize": 8, "ytick.labelsize": 8, "legend.fontsize": 8,
    "axes.titlelocation": "left", "axes.spines.top": False, "axes.spines.right": False,
    "axes.linewidth": 0.7, "xtick.major.width": 0.7, "ytick.major.width": 0.7, "ytick.minor.width": 0.5,
    "axes.grid": True, "axes.axisbelow": True, "grid.color": "0.9", "grid.linewidth": 0.6,
    "legend.frameon": False, "legend.handlelength": 2.8, "legend.columnspacing": 1.2, "legend.handletextpad": 0.5,
    "text.parse_math": False,  # names come from files; a "$" in one is only a "$"
    "pdf.fonttype": 42,  # real fonts, so that the text in the PDF can be searched and edited
    "savefig.dpi": 200,
}
matplotlib.rcdefaults()  # a personal matplotlibrc must not change a figure of the paper
matplotlib.rcParams.update(RC)


@dataclass(frozen=True)
class Look:
    """How one estimator is drawn."""

    label: str
    color: str
    marker: str
    dashes: object = SOLID
    line_width: float = 1.4
    marker_size: float = 5.0
    is_rest: bool = False  # grey, behind the others
    is_highlighted: bool = False

    @property
    def zorder(self):
        return 2.5 if self.is_rest else 3

    @property
    def text_color(self):
        """For its name beside its line: a grey that can be read."""
        return "0.4" if self.is_rest else self.color

    def line(self):
        """Keyword arguments for `Axes.plot`."""
        return dict(label=self.label, color=self.color, marker=self.marker, linestyle=self.dashes,
                    linewidth=self.line_width, markersize=self.marker_size,
                    markeredgecolor="white", markeredgewidth=0.5)

    def upper_limit(self):
        """Keyword arguments of two calls of `Axes.plot`: an arrow down, and on its end the estimator's open marker."""
        arrow = dict(linestyle="none", color=self.color, marker=ARROW_DOWN, markersize=11, markerfacecolor="none",
                     markeredgewidth=0.8, label="_arrow")
        marker = dict(linestyle="none", color=self.color, marker=self.marker, markersize=3.2 * size_of(self.marker),
                      markerfacecolor="white", markeredgewidth=0.8, label="_marker")
        return arrow, marker


def size_of(marker):
    """Squares and diamonds look larger than a circle of the same nominal size, stars smaller; in print, thin marks are lost."""
    in_print = {} if sheet.current().width is None else {"d": 1.15, "p": 1.1}
    return {"s": 0.86, "D": 0.8, "*": 1.4, FOUR_POINTS: 1.4, **in_print}.get(marker, 1)


# (colour, marker, dashes) of one estimator: no two share a colour or a marker. Any two colours are at least 12 apart
# (CIEDE2000) to the eye and in simulated protanopia and deuteranopia, and at least 10 in tritanopia; where two are alike in
# grey their dashes differ. The first seven are those of Okabe and Ito.
SLOTS = (
    (BLACK, "o", SOLID), (BLUE, "D", SOLID), (VERMILLION, "^", DASHED), (GREEN, "H", DOTTED), (ORANGE, "P", SOLID),
    (SKY_BLUE, "X", DASH_DOT), (PURPLE, "v", LONG_DASHED), ("#A50F4B", "s", SOLID), ("#003C96", "<", DOTTED),
    ("#005A4B", ">", DASHED), ("#1E00F0", "d", DASH_DOT), ("#694B00", "p", LONG_DASHED), ("#7878FF", "8", SOLID),
    ("#5A0F00", "h", DASHED), ("#965A78", "*", DASH_DOT), ("#4B0F4B", FOUR_POINTS, DOTTED))
REST = "0.66"  # the grey of estimators that are not highlighted, and of those beyond the last slot

# An estimator's label in a study: (in words, its slot). Labels with one slot are one estimator with other names or options, or
# estimators that no committed study has together; of those in one figure, the one further up has it.
KNOWN = {
    "standard_five_point": ("Standard, five points", 0), "rcme_calibrated": ("RCME, calibrated", 1), "poselib": ("PoseLib", 2),
    "opencv_magsac": ("OpenCV MAGSAC", 4), "rcme": ("RCME", 5), "rcme_as_printed": ("RCME, as printed", 5),
    "prcme": ("pRCME", 6), "prcme_as_printed": ("pRCME, as printed", 6),
    "standard": ("Standard", 7), "standard_eight_point": ("Standard, eight points", 7),
    "rcme_rank_aware": ("RCME, rank-aware", 8), "rcme_eight_point": ("RCME, eight points", 8),
    "prcme_rank_aware": ("pRCME, rank-aware", 11), "prcme_eight_point": ("pRCME, eight points", 11),
    "rcme_predictive_tuned": ("RCME, predictive, tuned", 3), "rcme_predictive": ("RCME, predictive likelihood", 9),
    "opencv_graph_cut": ("OpenCV graph cut", 14), "opencv_ransac": ("OpenCV RANSAC", 12), "opengv_ransac": ("OpenGV RANSAC", 10),
    "opencv_lmeds": ("OpenCV LMedS", 15), "opencv_usac": ("OpenCV USAC", 13),
    "rcme_five_point": ("RCME, five points", 13), "prcme_five_point": ("pRCME, five points", 15),
    "msac": ("MSAC", 13), "msac_five_point": ("MSAC, five points", 13), "mlesac": ("MLESAC", 10), "lo_ransac": ("LO-RANSAC", 12),
    "cov_ransac": ("Cov-RANSAC", 14), "m_estimator": ("M-estimator", 9),
}
OWNED = {KNOWN[name][1] for name in ("standard_five_point", "rcme_calibrated", "poselib", "opencv_magsac", "rcme", "prcme")}


def slots_of(estimators, other_colors=()):
    """{name: index of SLOTS, or None where all are taken}.

    Those in KNOWN have theirs; each other has the first free slot of an order that depends on its label alone, so that it
    changes only where another has that slot. The slots of OWNED are the last to be lent. Colours that --style gives to an
    estimator are no other's, nor are `other_colors`, which mean something else in the figure.
    """
    given = {color.lower() for name, color in sheet.current().colors.items() if name in estimators}
    given |= {color.lower() for color in other_colors}
    free, slots = {slot for slot, (color, *_) in enumerate(SLOTS) if color.lower() not in given}, {}
    wanted = [(name, [slot]) for name, (_, slot) in KNOWN.items()]
    wanted += [(name, slots_in_order_for(name)) for name in sorted(set(estimators))]
    for name, order in wanted:
        slot = next((slot for slot in order if slot in free), None)
        if name in estimators and name not in slots and slot is not None:
            slots[name] = slot
            free.remove(slot)
    return {name: slots.get(name) for name in estimators}


def slots_in_order_for(label):
    """All slots, in an order of this label's own: those of OWNED last."""
    def key(slot):
        return slot in OWNED, hashlib.sha256(f"{slot} {label}".encode("utf-8", "surrogateescape")).digest()
    return sorted(range(len(SLOTS)), key=key)


def looks_of(estimators, other_colors=()):
    """{name: Look}, in the given order, in none of `other_colors`. With --highlight only those named have colours.

    Where estimators tie (many are at exactly 0 %), their lines coincide. So the first is drawn widest and each later
    one, on top of it, narrower: what lies below stays visible as a rim.
    """
    looks, last, in_use, slots = {}, len(estimators) - 1, sheet.current(), slots_of(estimators, other_colors)
    for position, name in enumerate(estimators):
        slot = slots[name]
        color, marker, dashes = (REST, ".", SOLID) if slot is None else SLOTS[slot]
        is_rest = slot is None or (in_use.highlight and name not in in_use.highlight)
        color = REST if is_rest else in_use.colors.get(name, color)
        rim = 0.5 + (last / 2 - position) / max(last, 4)  # from 1 to 0; two estimators differ only a little
        rim = rim if not in_use.highlight else 0 if is_rest else 0.6
        looks[name] = Look(label_of(name), color, marker, dashes, line_width=1.1 + 1.0 * rim,
                           marker_size=(3.6 + 4.0 * rim) * size_of(marker), is_rest=is_rest,
                           is_highlighted=name in in_use.highlight)
    return looks


def equal_looks_of(estimators):
    """The same with marks of one size, for figures in which they stand side by side and none covers another."""
    return {name: replace(look, marker_size=4.6 * size_of(look.marker)) for name, look in looks_of(estimators).items()}


def label_of(estimator):
    """An estimator's label in words, as every legend has it."""
    return sheet.current().text_of(estimator, KNOWN.get(estimator, (estimator,))[0])


def split_unit(name):
    """'sigma_px' -> ('sigma', 'px'), 'outlier_ratio' -> ('outlier ratio', '')."""
    stem, _, last = name.rpartition("_")
    stem, unit = (stem, last) if stem and last in ("px", "deg", "rad", "m", "ms", "s") else (name, "")
    return stem.replace("_", " ").strip(), unit


def in_words(name):
    """For an axis or a title: 'outlier_ratio' -> 'Outlier ratio', 'sigma_px' -> 'Sigma (px)'."""
    words, unit = split_unit(name)
    return sheet.current().text_of(name, words[:1].upper() + words[1:] + (f" ({unit})" if unit else ""))


def level_text(level):
    """A level of a factor as the figure prints it: 'moving_object' -> 'moving object'."""
    return sheet.current().text_of(level, level.replace("_", " "))


def level_in_words(name, level):
    """One level of a factor: ('sigma_px', '1') -> 'sigma = 1 px'; of a factor with a label 'the label: 1'. A word has no unit."""
    words, unit = split_unit(name)
    unit = unit if any(map(str.isdigit, level)) else ""
    label = sheet.current().text_of(name, "")
    return f"{label}: {level_text(level)}" if label else f"{words} = {level_text(level)} {unit}".rstrip()


def font_size(points):
    return sheet.current().font_size(points)


def letters(count):
    """'(a) ', '(b) ', ... for the titles of so many panels; nothing for one."""
    return (f"({letter}) " if count > 1 else "" for letter in "abcdefghijklmnopqrstuvwxyz" * 9)


TALLEST = 7.6  # inches that panels take of a page of paper; legend and caption come to them
BESIDE_NAME = {RC["legend.fontsize"]: 0.6, sheet.SMALLEST_FONT: 0.45}  # inches of a legend's mark and margins
ONE_PANEL_WIDTH = 4.6  # inches: of a figure of one panel on a sheet without a width
PANEL_WIDTH, PANEL_HEIGHT = 2.2, 1.9  # inches: of the narrowest panel on a sheet with a width, and of all there


def panels_abreast(columns):
    """How many of so many panels stand beside each other."""
    width = sheet.current().width
    return columns if width is None else max(1, min(columns, int(width / PANEL_WIDTH)))


def room_of_panel(columns):
    """Inches of paper for one of so many panels, its labels included."""
    width = sheet.current().width
    return {1: ONE_PANEL_WIDTH, 2: 3.5}.get(columns, 2.6) if width is None else width / panels_abreast(columns)


def new_figure(rows, columns, names_height=0, may_fold=False):
    """A figure of paper size (two panels: 7 x 3.2 inches) and its axes as a rows x columns array. On a sheet of a stated
    width the panels of a row stand below each other where they do not fit; legend and caption add to its height, and
    so does what the names below the last row take, `names_height` inches. A long column may fold: its panels then stand two
    abreast, so that the figure is not taller than a page."""
    width, folded = sheet.current().width, may_fold and columns == 1 and rows > 2 and panels_abreast(2) == 2
    abreast = 2 if folded else panels_abreast(columns)
    lines = math.ceil(rows * columns / abreast) if folded else math.ceil(columns / abreast) * rows  # of paper
    if width is None:
        size = ({1: ONE_PANEL_WIDTH, 2: 7.0}.get(abreast, 2.6 * abreast), 1.0 + 2.2 * lines)
    else:
        size = (width, PANEL_HEIGHT * lines + names_height * (lines if folded else lines // rows))
    figure = Figure(figsize=size, layout="constrained")
    FigureCanvasAgg(figure)
    grid, axes = figure.add_gridspec(lines, abreast), numpy.empty((rows, columns), dtype=object)
    for r, c in itertools.product(range(rows), range(columns)):
        line, place = divmod(r, 2) if folded else (r * (lines // rows) + c // abreast, c % abreast)
        axes[r, c] = figure.add_subplot(grid[line, place], sharex=axes[0, 0], sharey=axes[0, c])
    for panel in set(axes.flat) - set(bottom_panels(axes)):
        panel.tick_params(labelbottom=False)
    return figure, axes


def bottom_panels(panels):
    """Those that have the x axis: the last row, or of a folded column the last panel of each half."""
    is_folded = panels.shape[1] == 1 and panels[0, 0].get_subplotspec().get_gridspec().ncols == 2
    return list(panels[-2:, 0] if is_folded else panels[-1])


def left_panels(panels):
    """Those with nothing at their left."""
    return [axes for axes in panels.flat if axes.get_subplotspec().is_first_col()]


def title_lines(text, columns, size=RC["axes.titlesize"]):
    """The title of one of so many panels, in lines that fit above it."""
    return "\n".join(fill(text, room_of_panel(columns) - 0.5, size))


def add_legend_and_caption(figure, handles, caption):
    """Legend, if there are handles, above the panels, caption below them in small print; a long legend makes the figure
    taller."""
    width, height = figure.get_size_inches()
    has_width, small = sheet.current().width is not None, font_size(6.5)
    if has_width:
        figure.set_dpi(RC["savefig.dpi"])  # measured as it is saved
    lines = fill(caption, width - 0.12, small) if has_width else textwrap.wrap(caption, int(20 * width))
    below = figure.text(0.006, 0.012, "\n".join(lines), fontsize=small, color="0.3", ha="left", va="bottom",
                        linespacing=1.3) if sheet.current().has_caption else None
    above = add_legend(figure, handles) if handles else None
    heights = [text.get_window_extent().height / figure.dpi if text else 0.0 for text in (above, below)]
    height += sum(heights) + 0.06 if has_width else max(0, heights[0] - 0.3)  # a legend of more than one row
    figure.set_size_inches(width, height)
    if below and has_width:
        below.set_position((0.05 / width, 0.03 / height))
    top = above.get_window_extent().y0 / figure.bbox.height if above else 1
    bottom = below.get_window_extent().y1 / figure.bbox.height + 0.03 / height if below else 0
    figure.get_layout_engine().set(rect=(0, bottom, 1, top - bottom), w_pad=0.05, h_pad=0.04, wspace=0.03)


def draw_legend(where, handles, **options):
    """`where.legend(...)`, which leaves out what is labelled '_...': so may an estimator or a scene be called."""
    legend = where.legend(handles, ["label"] * len(handles), **options)
    for text, handle in zip(legend.get_texts(), handles):
        text.set_text(handle.get_label())
    return legend


def in_few_rows(figure, handles, size=RC["legend.fontsize"]):
    """(legend, its columns): at the upper edge, in as few rows as fit the width."""
    for legend_rows in range(1, len(handles) + 1):
        columns = math.ceil(len(handles) / legend_rows)
        legend = draw_legend(figure, handles, loc="upper center", ncols=columns, borderaxespad=0.2, fontsize=size)
        if columns == 1 or legend.get_window_extent().width <= figure.bbox.width:
            return legend, columns
        legend.remove()


def add_legend(figure, handles):
    """In few rows; on a sheet with a width, names that are wider are broken, and those of one column stand in two in small print
    where that is much lower."""
    if sheet.current().width is None:
        return in_few_rows(figure, handles)[0]
    names = [handle.get_label() for handle in handles]

    def legend_for(columns, size):
        room = figure.get_figwidth() / columns - BESIDE_NAME[size]
        for handle, name in zip(handles, names):
            handle.set_label("\n".join(line for part in name.split("\n") for line in fill(part, room, size)))
        return in_few_rows(figure, handles, size)
    one, columns = legend_for(1, RC["legend.fontsize"])
    if columns > 1:
        return one
    two, _ = legend_for(2, sheet.SMALLEST_FONT)
    is_much_lower = two.get_window_extent().height < 0.8 * one.get_window_extent().height
    (one if is_much_lower else two).remove()
    return two if is_much_lower else one


def lay_out(figure, dpi):
    """Leaves the panels where the layout puts them."""
    FigureCanvasAgg(figure)  # measures the texts
    figure.set_dpi(dpi)
    if layout := figure.get_layout_engine():
        layout.execute(figure)
    figure.set_layout_engine("none")
    for axes in figure.axes:
        axes.apply_aspect()


def print_as(kind, figure, file, metadata):
    """`savefig` of a figure that is laid out, without the pass before it, which draws nothing and takes a third of the time."""
    canvas = {"png": FigureCanvasAgg, "pdf": FigureCanvasPdf, "svg": FigureCanvasSVG}[kind](figure)
    with matplotlib.rc_context({"svg.hashsalt": "rcme", "svg.fonttype": "path"}):
        getattr(canvas, f"print_{kind}")(file, metadata=metadata)


def written_as(figure, kind, path, dpi):
    """Writes one format; no dates or versions go in: the same input gives the same bytes."""
    if kind == "tikz":
        from common.tikz import tikz_of  # which needs the command line, and that this file
        with open(path, "w", encoding="utf-8") as file:
            file.write(tikz_of(figure))
        return
    no_stamp = {"png": {"Software": None}, "pdf": {"Creator": None, "Producer": None, "CreationDate": None},
                "svg": {"Date": None, "Creator": None}}
    figure.set_dpi(dpi)  # which the other formats change
    print_as(kind, figure, path, no_stamp[kind])


def save(figure, path_without_suffix, dpi=RC["savefig.dpi"]):
    """Writes PATH.png, PATH.pdf or what else the sheet asks for, and returns the paths.

    All are written before the first takes its place, so a reader never meets half a file and a failure leaves what was
    there.
    """
    lay_out(figure, dpi)

    def write(kind):
        return lambda part: written_as(figure, kind, part, dpi)
    files = {f"{path_without_suffix}.{kind}": write(kind) for kind in sheet.current().formats}
    write_whole(files)
    return list(files)
