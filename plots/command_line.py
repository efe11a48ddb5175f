"""What the scripts of this room share at the command line: one kind of error and a parser that raises it."""

import argparse


class PlotError(Exception):
    """Something the user can put right; its text is one sentence that names the file, the thing and what is allowed."""


class Parser(argparse.ArgumentParser):
    """A parser whose complaints are PlotErrors, so that they are printed like every other."""

    def error(self, message):
        raise PlotError(f"{message}; see --help.")
