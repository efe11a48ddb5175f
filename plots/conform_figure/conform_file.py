"""Reads the report that `rcme conform` prints as JSON, or a CSV table of its regions. It checks and names; it computes nothing.

    format, estimator, is_check, answers, level, regions: [region, coverage, coverage_interval, hardest_quarter,
    hardest_quarter_interval, size_deg, hardest_deg, all_motions]
Keys that are not drawn are not looked at.
"""

import math
from dataclasses import dataclass

from common.command_line import PlotError
from common.json_file import is_finite, read_object
from common.summary_csv import Table, numbers, read_table, rows_where

ORIGIN = ("rcme conform --format json", "rcme conform report 1")
PARTS = ("coverage", "hardest_quarter")
SIZES = ("size_deg", "hardest_deg")
NUMBERS = (*(part + end for part in PARTS for end in ("", "_lower", "_upper")), *SIZES, "all_motions")


@dataclass(frozen=True)
class Region:
    name: str
    shares: tuple  # coverage of all answers and of the hardest quarter: (value, lower, upper); NaN: no answers
    sizes: tuple  # the same two, deg; NaN: none
    all_motions: float  # share of the regions that hold all motions


@dataclass(frozen=True)
class Report:
    path: str
    estimator: str
    origin: str  # in words
    answers: int
    level: float
    regions: tuple


def share_of(node, key):
    is_share = lambda value: value is None or is_finite(value) and 0 <= value <= 1  # noqa: E731
    ends = node.get(f"{key}_interval", lambda ends: isinstance(ends, list) and len(ends) == 2 and all(map(is_share, ends)),
                    "two numbers in 0..1 or null")
    return (node.fraction_or(key, math.nan), *(math.nan if end is None else end for end in ends))


def read_region(node):
    return Region(node.text("region"), tuple(share_of(node, key) for key in PARTS),
                  tuple(node.number_or(key, math.nan) for key in SIZES), node.fraction("all_motions"))


def checked(report):
    """`report`, if there is something to draw."""
    if not any(math.isfinite(region.shares[0][0]) for region in report.regions):
        raise PlotError(f"{report.path}: has no region with a coverage; there is nothing to draw.")
    return report


def read_report(path):
    """The Report in the file `path`; a cut-off or foreign file is an error, and so is one without regions."""
    file = read_object(path, *ORIGIN)
    origin = "the file's own rule, on new problems" if file.boolean("is_check") else "cross-validated"
    return checked(Report(path, file.text("estimator"), origin, file.count("answers"), file.fraction("level"),
                          tuple(read_region(node) for node in file.nodes("regions", "region"))))


def read_table_of_regions(path, level, conditions):
    """The same of a CSV table: one row per region of one estimator, after selection by 'key=value'."""
    if not 0 < level < 1:
        raise PlotError(f"--level {level:g}: give a probability between 0 and 1, such as 0.9.")
    rows = read_table(path, ("estimator", "answers", "region", *NUMBERS), "rcme conform --format csv").rows
    keys = [column for column in rows.columns[:list(rows.columns).index("region")]]
    rows = rows_where(path, rows, keys, conditions)
    for key in keys:
        found = list(dict.fromkeys(rows[key]))
        if len(found) > 1:
            raise PlotError(f"{path}: has several rows of a region; choose with --where {key}=, of {', '.join(found)}.")
    table, first = Table(path, rows), rows.iloc[0]
    columns = {column: numbers(table, column, may_be_empty=True) for column in NUMBERS}
    regions = tuple(Region(name, tuple(tuple(columns[part + end][row] for end in ("", "_lower", "_upper")) for part in PARTS),
                           tuple(columns[size][row] for size in SIZES), columns["all_motions"][row])
                    for row, name in enumerate(rows.region))
    origin = ", ".join(first[key] for key in keys if key not in ("estimator", "answers"))
    return checked(Report(path, first.estimator, origin, int(numbers(table, "answers")[0]), level, regions))
