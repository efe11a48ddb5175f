"""A figure as TikZ: every line and area where it is, every text as a node that LaTeX sets in the document's own font.

    \\usepackage{tikz}
    ...
    \\input{figure.tikz}
"""

import math

from matplotlib.backend_bases import RendererBase
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

from common.command_line import PlotError

FARTHEST = 10000  # big points; TeX knows no dimension beyond 16383 pt
HATCH_TILE = 72  # big points
ESCAPES = {"\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#", "%": r"\%", "_": r"\_",
           "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "<": r"\textless{}", ">": r"\textgreater{}",
           "|": r"\textbar{}", '"': r"\char34{}", "\u2212": "$-$", "\u00b7": r"$\cdot$", "\u00b0": r"$^\circ$",
           "\u2264": r"$\le$", "\u2265": r"$\ge$", "\u221e": r"$\infty$", "\u00b1": r"$\pm$", "\u2013": "--",
           "\u2026": r"\dots{}", "\u00b5": r"$\mu$", "\u00d7": r"$\times$", "\u2192": r"$\to$", "\u207b": "$^{-}$",
           "\u2713": r"$\surd$", "\u2717": r"$\times$", "\u25c6": r"$\diamond$", "\u25d0": r"$\sim$", "\u25a0": r"\rule{1ex}{1ex}",
           **{digit: f"$^{{{number}}}$" for number, digit in enumerate("\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079")}}


def escaped(text):
    """Characters that LaTeX would take for commands, and those that its fonts need mathematics for."""
    return "".join(ESCAPES.get(character, character if character.isprintable() else " ") for character in text)


def number(value):
    """At most two decimals: a hundredth of a point."""
    return f"{min(max(value, -FARTHEST), FARTHEST):.2f}".rstrip("0").rstrip(".").replace("-0", "0", 1 if abs(value) < 0.005 else 0)


def color(rgb):
    return "{{rgb,1:red,{:.4g};green,{:.4g};blue,{:.4g}}}".format(*rgb[:3])


def point(x, y):
    return f"({number(x)},{number(y)})"


def path_text(path, transform, clip=None):
    """The segments of a path; `clip`: (left, bottom, right, top) beyond which a line may be left out."""
    words, last = [], (0.0, 0.0)
    for vertices, code in path.iter_segments(transform, clip=clip, simplify=False):
        if code == Path.MOVETO:
            words.append(point(*vertices))
        elif code == Path.LINETO:
            words.append(f"-- {point(*vertices)}")
        elif code == Path.CURVE3:  # one control point: two thirds of the way to it, from both ends
            x, y = vertices[:2], vertices[2:]
            controls = [[a + 2 / 3 * (b - a) for a, b in zip(end, x)] for end in (last, y)]
            words.append(f".. controls {point(*controls[0])} and {point(*controls[1])} .. {point(*y)}")
        elif code == Path.CURVE4:
            words.append(f".. controls {point(*vertices[:2])} and {point(*vertices[2:4])} .. {point(*vertices[4:])}")
        elif code == Path.CLOSEPOLY:
            words.append("-- cycle")
        last = vertices[-2:]
    return " ".join(words)


class TikzRenderer(RendererBase):
    """Takes what matplotlib draws; lengths are big points (1/72 inch) from the lower left corner."""

    def __init__(self, width, height):
        super().__init__()
        self.width, self.height, self.lines = width, height, []

    def get_canvas_width_height(self):
        return self.width, self.height

    def points_to_pixels(self, points):
        return points

    def flipy(self):
        return False

    def draw_path(self, gc, path, transform, rgbFace=None):
        is_filled, line_width = rgbFace is not None, gc.get_linewidth()
        text = path_text(path, transform, None if is_filled else (0, 0, self.width, self.height))
        if not text:
            return
        styles = []
        if is_filled:
            styles += [f"fill={color(rgbFace)}", *self.opacity("fill", gc, rgbFace)]
        if line_width > 0 and gc.get_rgb()[3] > 0:
            styles += [f"draw={color(gc.get_rgb())}", f"line width={number(line_width)}bp",
                       *self.opacity("draw", gc, gc.get_rgb()), *self.dashes(gc)]
            styles += [f"line cap={ {'projecting': 'rect'}.get(gc.get_capstyle(), gc.get_capstyle())}",
                       f"line join={gc.get_joinstyle()}"]
        if styles:
            self.within_clip(gc, [f"\\path[{', '.join(styles)}] {text};"])
        if gc.get_hatch():
            self.draw_hatch(gc, text, path.get_extents(transform))

    def opacity(self, kind, gc, rgba):
        alpha = gc.get_alpha() if gc.get_forced_alpha() else (rgba[3] if len(rgba) > 3 else 1.0)
        return [f"{kind} opacity={alpha:.3g}"] if alpha < 1 else []

    def dashes(self, gc):
        offset, lengths = gc.get_dashes()
        if lengths is None:
            return []
        lengths = [max(float(length), 0.01) for length in lengths]
        pattern = " ".join(f"{'off' if place % 2 else 'on'} {number(length)}bp" for place, length in enumerate(lengths))
        return [f"dash pattern={pattern}", f"dash phase={number(offset or 0)}bp"]

    def draw_hatch(self, gc, outline, extents):
        hatch, lines = gc.get_hatch_path(), [f"\\clip {outline};"]
        for column in range(math.floor(extents.x0 / HATCH_TILE), math.ceil(extents.x1 / HATCH_TILE)):
            for row in range(math.floor(extents.y0 / HATCH_TILE), math.ceil(extents.y1 / HATCH_TILE)):
                tile = path_text(hatch, Affine2D().scale(HATCH_TILE).translate(column * HATCH_TILE, row * HATCH_TILE))
                lines.append(f"\\path[draw={color(gc.get_hatch_color())}, "
                             f"line width={number(gc.get_hatch_linewidth())}bp] {tile};")
        self.within_clip(gc, ["\\begin{scope}", *lines, "\\end{scope}"])

    def within_clip(self, gc, lines):
        clips = []
        rectangle, (clip, clip_transform) = gc.get_clip_rectangle(), gc.get_clip_path()
        if rectangle is not None:
            clips.append(f"\\clip {point(rectangle.x0, rectangle.y0)} rectangle {point(rectangle.x1, rectangle.y1)};")
        if clip is not None:
            clips.append(f"\\clip {path_text(clip, clip_transform)};")
        self.lines += ["\\begin{scope}", *clips, *lines, "\\end{scope}"] if clips else lines

    def draw_text(self, gc, x, y, s, prop, angle, ismath=False, mtext=None):
        """A font of another width keeps the end, the middle or the beginning where it was, as the text is aligned."""
        place = place_along(mtext, angle)
        width = self.get_text_width_height_descent(s, prop, ismath)[0]
        x += place * width * math.cos(math.radians(angle))
        y += place * width * math.sin(math.radians(angle))
        size = prop.get_size_in_points()
        font = f"\\fontsize{{{number(size)}}}{{{number(1.2 * size)}}}\\selectfont"
        font += "\\bfseries" if prop.get_weight() in ("bold", "semibold", 700) else ""
        font += "\\itshape" if prop.get_style() in ("italic", "oblique") else ""
        styles = [f"anchor={ {0: 'base west', 0.5: 'base', 1: 'base east'}[place]}", "inner sep=0pt", "outer sep=0pt",
                  f"text={color(gc.get_rgb())}", f"font={{{font}}}", *self.opacity("text", gc, gc.get_rgb())]
        if angle:
            styles.append(f"rotate={number(angle)}")
        self.lines.append(f"\\node[{', '.join(styles)}] at {point(x, y)} {{{escaped(s)}}};")

    def draw_image(self, gc, x, y, im, transform=None):
        raise PlotError("--format tikz: this figure holds a picture of points of colour; choose pdf, svg or png.")


def place_along(text, angle):
    """Which part of a line stays: 0 its beginning, 1 its end."""
    if text is None:
        return 0
    if angle == 90 and text.get_rotation_mode() != "anchor":
        return {"top": 1, "bottom": 0}.get(text.get_va(), 0.5)
    return {"left": 0, "right": 1}.get(text.get_ha(), 0.5)


def tikz_of(figure):
    """The whole file."""
    dots_per_inch = figure.get_dpi()
    figure.set_dpi(72)
    try:
        width, height = 72 * figure.get_figwidth(), 72 * figure.get_figheight()
        renderer = TikzRenderer(width, height)
        figure.draw(renderer)
    finally:
        figure.set_dpi(dots_per_inch)
    return "\n".join(["% A figure of rcme plot; needs \\usepackage{tikz}.", "\\begin{tikzpicture}[x=1bp, y=1bp]",
                      f"\\path[use as bounding box] (0,0) rectangle {point(width, height)};", *renderer.lines,
                      "\\end{tikzpicture}", ""])
