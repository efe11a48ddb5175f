"""What the scripts of this room share at the command line: one kind of error, a parser that raises it, and the way from
arguments to a written figure."""

import argparse
import os
import sys

from common import style


class PlotError(Exception):
    """Something the user can put right; its text is one sentence that names the file, the thing and what is allowed."""


class Parser(argparse.ArgumentParser):
    """A parser whose complaints are PlotErrors, so that they are printed like every other."""

    def error(self, message):
        raise PlotError(f"{message}; see --help.")


def names_of(option, text, example):
    """The names in 'A,B', each once; none is an error."""
    names = list(dict.fromkeys(filter(None, text.split(","))))
    if not names:
        raise PlotError(f"{option}: name at least one, such as {example}.")
    return names


def check_figure_path(out):
    """--out of a script that writes PATH.png and PATH.pdf."""
    folder, name = os.path.split(out)
    if not name or name.endswith((".png", ".pdf")):
        raise PlotError(f"--out {out}: give a file path without .png or .pdf; both are written.")
    check_folder(out)


def check_folder(out):
    folder = os.path.dirname(out)
    if not os.path.isdir(folder or "."):
        raise PlotError(f"--out {out}: there is no folder {folder}.")


def run(name, make, arguments):
    """The exit code of a script: `make(arguments)` writes and returns the paths, which are printed; what the user can put
    right is one line on standard error."""
    try:
        written = make(arguments)
    except PlotError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"{name}: cannot write {error.filename or 'the output'}: {error.strerror}.", file=sys.stderr)
        return 2
    print("\n".join(written))
    return 0


def draw_figure(name, parse, draw, arguments):
    """`run` of a script that draws one figure: options = parse(arguments), draw(options) is the figure."""
    return draw_figures(name, parse, lambda options: {"": draw(options)}, arguments)


def draw_figures(name, parse, draw, arguments):
    """The same of a script that draws several: draw(options) is {what its name adds to --out: figure}, all of them
    before the first is written."""
    def make(arguments):
        options = parse(arguments)
        return [path for more, figure in draw(options).items() for path in style.save(figure, options.out + more)]
    return run(name, make, arguments)
