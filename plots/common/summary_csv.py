"""Reads the program's tables, above all what `rcme summarize RUN.sqlite --format csv` prints. It checks and selects;
it computes nothing.

One row per (condition, estimator, quantity):
    study,condition,<one column per factor>,estimator,quantity,kind,value,lower,upper,standard_error,n,...
"""

import csv
import io
import math
import re

import pandas

from common.command_line import PlotError
from common.regular_file import read_bytes

MARKED = re.compile("^'(?=[' ]*[=+\\-@\t\r\uff1d\uff0b\uff0d\uff20])")
COLUMNS = ("study", "condition", "estimator", "quantity", "kind", "value", "lower", "upper", "standard_error", "n")


COMPARISON_COLUMNS = ("study", "condition", "estimator", "reference", "event", "n", "both", "estimator_only",
                      "reference_only", "neither", "risk_difference", "lower", "upper", "p_mcnemar", "p_holm")


def text_of_cell(cell):
    """The text that the program wrote: one that a spreadsheet would take for a formula has an apostrophe in front."""
    return MARKED.sub("", cell) if cell.startswith("'") else cell


class Table:
    """The rows of one CSV file as text, and each row's line in the file (column `line`)."""

    def __init__(self, path, rows):
        self.path, self.rows = path, rows


class Summary(Table):
    """A table of rates and means with the names of its factors."""

    def __init__(self, path, rows, factors):
        super().__init__(path, rows)
        self.factors = factors

    def with_rows(self, rows):
        return Summary(self.path, rows, self.factors)


def read_table(path, columns, origin):
    """The Table in the file `path`, which the command `origin` wrote and which has at least these columns; a cut-off or
    foreign file is an error, never a shorter table."""
    content = read_bytes(path)
    try:
        reader = csv.reader(io.StringIO(content.decode("utf-8-sig"), newline=""), strict=True)
        header = next(reader, [])
        lines = [(row, reader.line_num) for row in reader if row]
    except (csv.Error, UnicodeDecodeError) as error:
        raise PlotError(f"{path}: is not a CSV file ({error}).")
    missing = [column for column in columns if column not in header]
    if missing:
        raise PlotError(f"{path}: has no column {', '.join(missing)}; expected the output of '{origin}'.")
    repeated = sorted({column for column in header if header.count(column) > 1})
    if repeated:
        raise PlotError(f"{path}: has more than one column {', '.join(repeated)}.")
    for row, line in lines:
        if len(row) != len(header):
            raise PlotError(f"{path}: line {line} has {len(row)} fields, but the header has {len(header)} columns; "
                            "is the file cut off?")
    if not lines:
        raise PlotError(f"{path}: has a header but no rows.")
    rows = pandas.DataFrame([list(map(text_of_cell, row)) for row, _ in lines], columns=header, dtype=str)
    rows["line"] = [line for _, line in lines]
    return Table(path, rows)


def read_with_factors(path, columns, origin):
    rows = read_table(path, columns, origin).rows
    header = list(rows.columns)
    return Summary(path, rows, header[header.index("condition") + 1:header.index("estimator")])


def read_summary(path):
    """The Summary in the file `path`; errors as read_table."""
    return read_with_factors(path, COLUMNS, "rcme summarize RUN.sqlite --format csv")


def read_comparison(path):
    """The same of paired comparisons: one row per (condition, estimator, event)."""
    return read_with_factors(path, COMPARISON_COLUMNS, "rcme compare RUN.sqlite --format csv")


def same_level(text, wanted):
    """Whether two spellings mean one level: equal text, or equal numbers ('0.50' and '0.5')."""
    try:
        return text == wanted or float(text) == float(wanted)
    except ValueError:
        return False


def where(summary, conditions):
    """The rows with key = value for each 'key=value'; a key given more than once allows any of its values."""
    keys = ["study", "condition", *summary.factors, "estimator"]
    return summary.with_rows(rows_where(summary.path, summary.rows, keys, conditions))


def of_estimators(summary, names):
    """The rows of these estimators; without names all."""
    present = list(dict.fromkeys(summary.rows.estimator))
    for name in names:
        if name not in present:
            raise PlotError(f"--estimators {name}: {summary.path} has no such estimator; allowed: {', '.join(present)}.")
    return summary.with_rows(summary.rows[summary.rows.estimator.isin(names)]) if names else summary


def rows_where(path, rows, allowed_keys, conditions):
    """The same of any rows whose columns `allowed_keys` are texts."""
    wanted, is_wanted = {}, [True] * len(rows)
    for condition in conditions:
        key, equals, level = condition.partition("=")
        if not equals or key not in allowed_keys:
            raise PlotError(f"--where {condition}: expected key=value with a key among {', '.join(allowed_keys)}.")
        levels = list(dict.fromkeys(rows[key]))
        if not any(same_level(text, level) for text in levels):
            raise PlotError(f"--where {condition}: {path} has no such {key}; it has {', '.join(levels)}.")
        wanted.setdefault(key, []).append(level)
    for key, levels in wanted.items():
        is_wanted = [so_far and any(same_level(text, level) for level in levels)
                     for so_far, text in zip(is_wanted, rows[key])]
    if not any(is_wanted):
        raise PlotError(f"{path}: no row has {' and '.join(conditions)} together.")
    return rows[is_wanted]


def numbers(table, column, may_be_empty=False):
    """One column of a table's rows as floats; NaN where the file has nothing and may. Only the value of a mean or
    median may be infinite: some trials' were."""
    def number(text, kind, line):
        if may_be_empty and text == "":
            return math.nan
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if math.isnan(value) or math.isinf(value) and (column, kind) not in (("value", "mean"), ("value", "median")):
            raise PlotError(f"{table.path}: line {line}: column {column} must be a number, not '{text}'.")
        return value
    kinds = table.rows.get("kind", [""] * len(table.rows))
    return [number(*cell) for cell in zip(table.rows[column], kinds, table.rows["line"])]
