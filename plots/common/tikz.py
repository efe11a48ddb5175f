"""A figure as TikZ: matplotlib's own backend draws every line and area, and every text is a node that LaTeX sets in the
document's own font.

    \\usepackage{tikz}
    ...
    \\input{figure.tikz}
"""

import io
import math

from matplotlib.backend_bases import RendererBase
from matplotlib.backends.backend_pgf import RendererPgf

from common.command_line import PlotError

FARTHEST = 10000  # big points; TeX knows no dimension beyond 16383 pt
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


class TikzRenderer(RendererPgf):
    """That backend but for its texts: it starts LaTeX to measure them, and takes what stands in them for commands."""

    def get_text_width_height_descent(self, s, prop, ismath):
        return RendererBase.get_text_width_height_descent(self, s, prop, ismath)

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
        red, green, blue, opacity = gc.get_rgb()
        styles = [f"anchor={ {0: 'base west', 0.5: 'base', 1: 'base east'}[place]}", "inner sep=0pt", "outer sep=0pt",
                  f"text={{rgb,1:red,{red:.4g};green,{green:.4g};blue,{blue:.4g}}}", f"font={{{font}}}"]
        if opacity < 1:
            styles.append(f"text opacity={opacity:.3g}")
        if angle:
            styles.append(f"rotate={number(angle)}")
        self.fh.write(f"\\node[{', '.join(styles)}] at ({number(x)},{number(y)}) {{{escaped(s)}}};\n")

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
        lines = io.StringIO()
        figure.draw(TikzRenderer(figure, lines))
    finally:
        figure.set_dpi(dots_per_inch)
    width, height = (number(72 * inches) for inches in figure.get_size_inches())
    return "\n".join(["% A figure of rcme plot; needs \\usepackage{tikz}.", "\\begingroup\\makeatletter%",
                      "\\begin{tikzpicture}[x=1bp, y=1bp]", f"\\path[use as bounding box] (0,0) rectangle ({width},{height});",
                      lines.getvalue() + "\\end{tikzpicture}", "\\endgroup%", ""])
