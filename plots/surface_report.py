#!/usr/bin/python3
"""Makes the folder of `rcme surface`: a model of one quantity over the conditions of a run, how well it predicts, what it says
of the factors, and which conditions to run next.

report.txt, the figures check, indices, curves and maps, and every number in cross_validation.csv, indices.csv, curves.csv,
maps.csv and proposed.csv; next.yaml is the study of the proposed draws.
"""

import argparse
import csv
import io
import math
import os
import re
import sys
import time

from common.command_line import Parser, PlotError, run
from common import sheet, style
from common.whole_file import write_text

EXAMPLE = """
`rcme surface` starts this script with the file it needs:
  rcme surface run.sqlite --propose 32 --out surface
"""
STEPS = (5, *[1] * 10, 5, 3, 4, 2, 4, 2, 3)  # how long each takes: fit, folds, the five of effects, proposals, figures


class Progress:
    """Work done and time left, on standard error; nothing in the first two seconds."""

    def __init__(self):
        self.done, self.begin, self.last = 0, time.monotonic(), -math.inf
        self.is_terminal, self.has_printed = sys.stderr.isatty(), False

    def step(self):
        self.done += 1
        now = time.monotonic()
        elapsed = now - self.begin
        if elapsed < 2 or not self.is_terminal and now - self.last < 5:
            return
        self.last, self.has_printed = now, True
        done, total = sum(STEPS[:self.done]), sum(STEPS)
        text = f"surface: {100 * done / total:.0f} %, about {elapsed / done * (total - done):.0f} s left"
        print(f"\r{text:<60}" if self.is_terminal else text, end="" if self.is_terminal else "\n", file=sys.stderr, flush=True)

    def end(self):
        if self.has_printed and self.is_terminal:
            print(file=sys.stderr)


def parse(arguments):
    parser = Parser(prog="rcme surface", description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", metavar="SURFACE.json", help="what the program has collected of the runs")
    parser.add_argument("--out", required=True, metavar="DIR", help="folder to write into; it is made")
    parser.add_argument("--propose", type=int, default=0, metavar="N", help="so many further draws of the population")
    parser.add_argument("--level", type=float, help="choose where it is least certain on which side of it a condition lies")
    parser.add_argument("--no-figures", action="store_true", help="write the report and the tables alone")
    return parser.parse_args(arguments)


def make(arguments):
    """The paths of what was written."""
    options = parse(arguments)
    try:
        import scipy  # noqa: F401  (no other figure needs it)
    except ImportError:
        raise PlotError("python3 has no scipy, which the model needs; on Debian: apt-get install python3-scipy.")
    from surface.cross_validation import cross_validate
    from surface.effects import measure_effects
    from surface.proposals import propose
    from surface.report_text import report_of
    from surface.surface_data import read_surface_data
    data = read_surface_data(options.data)
    check_level(options, data)
    make_folder(options.out)
    progress = Progress()
    model = data.fit()
    progress.step()
    check = cross_validate(data, model, progress.step)
    effects = measure_effects(data, model, progress.step) if check.beats_constant else None
    proposed = propose(data, model, options.propose, options.level) if options.propose else None
    progress.step()
    figures = {} if options.no_figures else figures_of(data, model, check, effects)
    progress.step()
    report = report_of(data, check, effects, proposed, options.level, options.out)
    written = write_all(options, data, check, effects, proposed, figures, report)
    progress.end()
    print(report)
    return written


def check_level(options, data):
    if options.level is not None and data.is_rate and not 0 < options.level < 1:
        raise PlotError(f"--level {options.level:g}: of a rate it lies between 0 and 1.")
    if options.propose and not len(data.candidates):
        raise PlotError("--propose: the population has no further draws.")


def make_folder(out):
    try:
        os.makedirs(out, exist_ok=True)
    except OSError as error:
        raise PlotError(f"--out {out}: cannot be made ({error.strerror}).")


def figures_of(data, model, check, effects):
    from surface import panels
    figures = {"check": panels.draw_check(data, check)}
    if effects is not None:
        figures["indices"] = panels.draw_indices(data, effects)
        figures["curves"] = panels.draw_curves(data, model, effects)
        if effects.maps.is_known.any():
            figures["maps"] = panels.draw_maps(data, model, effects)
    return figures


def write_all(options, data, check, effects, proposed, figures, report):
    def place(name):
        return os.path.join(options.out, name)
    tables = {"cross_validation": data.conditions[["run", "condition", "draw"]].iloc[check.rows.place].reset_index(
        drop=True).join(check.rows.drop(columns="place").reset_index(drop=True))}
    if effects is not None:
        tables |= {"indices": effects.indices, "curves": effects.curves, "maps": effects.maps}
    if proposed is not None:
        tables["proposed"] = proposed
    texts = {place("report.txt"): report}
    texts |= {place(f"{name}.csv"): csv_text(table) for name, table in tables.items()}
    if proposed is not None:
        texts[place("next.yaml")] = next_study(data, proposed)
    remove_stale(options.out, {os.path.basename(path) for path in texts} | {f"{name}.{kind}" for name in figures
                                                                           for kind in sheet.current().formats})
    for path, text in texts.items():
        write_text(path, text)
    return [*texts, *(path for name, figure in figures.items() for path in style.save(figure, place(name)))]


def csv_text(table):
    """A text that a spreadsheet would take for a formula begins with an apostrophe, as in the program's own tables."""
    def cell(value):
        if isinstance(value, float):
            return "" if math.isnan(value) else f"{value:.6g}"
        text = str(value)
        return "'" + text if text[:1] in FORMULA_BEGINS and not is_number(text) else text
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(map(cell, table.columns))
    writer.writerows([cell(value) for value in row] for row in table.itertuples(index=False))
    return text.getvalue()


FORMULA_BEGINS = tuple("=+-@\t\r\uff1d\uff0b\uff0d\uff20")


def is_number(text):
    try:
        float(text)
    except ValueError:
        return False
    return True


OWN_FILES = [*(f"{name}.csv" for name in ("indices", "curves", "maps", "proposed")), "next.yaml",
             *(f"{name}.{kind}" for name in ("check", "indices", "curves", "maps") for kind in sheet.FORMATS)]


def remove_stale(folder, kept):
    """What an earlier call has written into the folder and this one does not is of another surface."""
    for name in OWN_FILES:
        if name not in kept and os.path.exists(os.path.join(folder, name)):
            os.remove(os.path.join(folder, name))


def next_study(data, proposed):
    """The study in full, as the program has written it, with these draws alone."""
    draws = ", ".join(str(draw) for draw in sorted(set(proposed.draw)))
    text = re.sub(r"^conditions:\n", lambda _: f"conditions:\n  draws: [{draws}]\n", data.study_yaml, count=1, flags=re.MULTILINE)
    text = re.sub(r"^name: (.*)$", r"name: \1_next", text, count=1, flags=re.MULTILINE)
    return "# Draws that `rcme surface` has proposed. They are no random sample of the population.\n" + text.rstrip("\n") + "\n"


def main(arguments=None):
    return run("surface", make, arguments)


if __name__ == "__main__":
    sys.exit(main())
