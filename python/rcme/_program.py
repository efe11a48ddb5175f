"""The command `rcme` of an installed package: the program that lies in it."""

import os
import pathlib
import sys


def main():
    """Replaces this process by the program. Figures are drawn by this Python where Debian's has no matplotlib."""
    program = pathlib.Path(__file__).resolve().parent / "bin" / "rcme"
    os.environ["PATH"] = os.pathsep.join([os.path.dirname(sys.executable), os.environ.get("PATH", os.defpath)])
    os.execv(program, [program, *sys.argv[1:]])
