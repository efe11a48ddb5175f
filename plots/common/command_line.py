"""What the scripts of this room share at the command line: one kind of error, a parser that raises it, and the way from
arguments to a written figure."""

import argparse
import contextlib
import gc
import os
import sys

from common import sheet
from common.interrupt import STOPPED, interrupts_raised
from common.plot_error import PlotError
from common.style_file import read_style


class Parser(argparse.ArgumentParser):
    """A parser whose complaints are PlotErrors, so that they are printed like every other."""

    def error(self, message):
        raise PlotError(f"{message}; see --help.")


class FigureParser(Parser):
    """With the options that every figure has but --out, which has its own default. `least_width`: inches below which this kind of
    figure cannot be drawn; `out_is_folder`: of several figures."""

    def __init__(self, least_width=sheet.NARROWEST, out_is_folder=False, **arguments):
        super().__init__(formatter_class=argparse.RawDescriptionHelpFormatter, **arguments)
        self.least_width = least_width
        self.out_is_folder = out_is_folder
        group = self.add_argument_group("for a paper")
        group.add_argument("--width", type=float, metavar="INCHES",
                           help="as wide as it is printed (a column of IEEEtran: 3.48, of article: 3.17); texts then have 7 to 9 points")
        group.add_argument("--labels", action="append", default=[], metavar="NAME=TEXT",
                           help="what to print for an estimator, a factor, a level or a quantity; repeatable")
        group.add_argument("--highlight", default="", metavar="A,B",
                           help="draw these estimators in colour and the others grey")
        group.add_argument("--no-caption", action="store_true", help="leave out the small print below the figure")
        group.add_argument("--format", action="append", metavar="A,B",
                           help=f"what to write, of {', '.join(sheet.FORMATS)} (default: png,pdf)")
        group.add_argument("--style", metavar="FILE.toml",
                           help="a file with width, caption, formats, highlight, [labels] and [colors], for all figures of a "
                           "paper; what the command line gives comes first")

    def parse_args(self, arguments=None, namespace=None):
        options = super().parse_args(arguments, namespace)
        shared, labels = read_style(options.style), dict(map(label_of, options.labels))
        highlight = tuple(filter(None, options.highlight.split(",")))
        formats = shared.get("formats", ["png", "pdf"]) if options.format is None else names_of("--format", ",".join(options.format), "pdf")
        options.sheet = sheet.Sheet(
            width=self.checked_width(shared.get("width") if options.width is None else options.width),
            labels={**shared.get("labels", {}), **labels}, has_caption=shared.get("caption", True) and not options.no_caption,
            formats=checked_formats(formats), highlight=highlight or tuple(shared.get("highlight", ())),
            colors=shared.get("colors", {}), asked=(*(("--labels", name) for name in labels),
                                                    *(("--highlight", name) for name in highlight)))
        if not self.out_is_folder:
            check_figure_path(options.out)
        return options

    def checked_width(self, width):
        if width is not None and not self.least_width <= width <= sheet.WIDEST:
            raise PlotError(f"--width {width:g}: give inches between {self.least_width:g} and {sheet.WIDEST:g}.")
        return width


def label_of(text):
    name, equals, label = text.partition("=")
    if not name or not equals:
        raise PlotError(f"--labels {text}: expected name=text.")
    return name, label


def checked_formats(formats):
    for name in formats:
        if name not in sheet.FORMATS:
            raise PlotError(f"--format {name}: is not known; allowed: {', '.join(sheet.FORMATS)}.")
    return tuple(formats)


def check_names_were_met():
    """A label or a highlight of the command line for what the figure does not show is a mistake."""
    in_use = sheet.current()
    for option, name in in_use.asked:
        if name not in in_use.met:
            raise PlotError(f"{option} {name}: the figure shows nothing of that name; it shows {', '.join(in_use.met)}.")


def names_of(option, text, example):
    """The names in 'A,B', each once; none is an error."""
    names = list(dict.fromkeys(filter(None, text.split(","))))
    if not names:
        raise PlotError(f"{option}: name at least one, such as {example}.")
    return names


def check_figure_path(out):
    """--out of a script that writes PATH.png and PATH.pdf."""
    folder, name = os.path.split(out)
    if not name or name.endswith((".png", ".pdf", ".svg", ".tikz")):
        raise PlotError(f"--out {out}: give a file path without .png or .pdf; the formats add theirs.")
    check_folder(out)


def check_folder(out):
    folder = os.path.dirname(out)
    if not os.path.isdir(folder or "."):
        raise PlotError(f"--out {out}: there is no folder {folder}.")


def printable(text):
    """With escapes in place of what a terminal would not show as it is: names come from files."""
    return "".join(c if c.isprintable() or c == "\n" else ascii(c)[1:-1] for c in text)


@contextlib.contextmanager
def rare_garbage_collection():
    """A figure is a hundred thousand objects that live until it is written: looking through them takes a tenth to a fifth of the time."""
    usual = gc.get_threshold()
    gc.set_threshold(100_000, 50, 1000)
    try:
        yield
    finally:
        gc.set_threshold(*usual)


def run(name, make, arguments):
    """The exit code of a script: `make(arguments)` writes and returns the paths, which are printed; what the user can put
    right, and an interrupt, is one line on standard error."""
    try:
        with interrupts_raised(), rare_garbage_collection():
            written = make(arguments)
    except PlotError as error:
        print(f"{name}: {printable(str(error))}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"{name}: cannot write {error.filename or 'the output'}: {error.strerror}.", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
        return STOPPED
    print("\n".join(written))
    return 0


def draw_figure(name, parse, draw, arguments):
    """`run` of a script that draws one figure: options = parse(arguments), draw(options) is the figure."""
    return draw_figures(name, parse, lambda options: {"": draw(options)}, arguments)


def draw_figures(name, parse, draw, arguments, dpi=None):
    """The same of a script that draws several: draw(options) is {what its name adds to --out: figure}, all of them
    before the first is written."""
    return run(name, lambda arguments: written_figures(parse(arguments), draw, dpi), arguments)


def numbered(name, figures):
    """{name: the first figure, name_2: the second, ...}"""
    return {name + (f"_{number}" if number > 1 else ""): figure for number, figure in enumerate(figures, 1)}


def written_figures(options, draw, dpi=None):
    """The paths."""
    from common import style  # here, so that a script without figures need not load matplotlib, which takes half a second
    with sheet.use(getattr(options, "sheet", sheet.Sheet())):
        figures = draw(options)
        check_names_were_met()
        return [path for more, figure in figures.items() for path in style.save(figure, options.out + more, dpi or style.RC["savefig.dpi"])]
