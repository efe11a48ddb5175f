"""Committed tables (CSV), and the choice of their rows by words.

A condition is "column=level", "column=level|level" or a bare word: the label of an estimator, or a quantity. Levels
that are numbers are compared as numbers.
"""

import csv
import functools
import re
import textwrap

from recipes import RESULTS, ResultError

VALUE_COLUMNS = ("value", "coverage", "risk_difference", "measured")
BARE_COLUMNS = ("estimator", "quantity", "event", "claim", "covariance")


@functools.lru_cache(maxsize=None)
def read_table(name):
    """The rows of results/NAME.csv, or of a CSV file named from the root of the repository."""
    path = RESULTS / f"{name}.csv"
    if not path.exists():
        raise ResultError(f"there is no table {path.name} in {path.parent}")
    with open(path, newline="", encoding="utf-8") as file:
        return tuple(csv.DictReader(file))


def as_number(text):
    try:
        return float(text)
    except ValueError:
        return None


def is_level(text, wanted):
    number, other = as_number(text), as_number(wanted)
    return number == other if number is not None and other is not None else text == wanted


def words_of(text):
    return [word.strip() for word in text.split(",") if word.strip()]


def condition_of(rows, word):
    """(column, levels) of one condition."""
    column, equals, levels = word.partition("=")
    if not equals:
        column, levels = next((name for name in BARE_COLUMNS if name in rows[0]
                               and any(row[name] == word for row in rows)), None), word
        if column is None:
            raise ResultError(f"'{word}' is no {' or '.join(BARE_COLUMNS)} of the table")
    if column not in rows[0]:
        raise ResultError(f"the table has no column '{column}'; it has {', '.join(rows[0])}")
    return column, levels.split("|")


def select(rows, text):
    """The rows that meet every condition of a comma-separated list."""
    for word in words_of(text):
        column, levels = condition_of(rows, word)
        rows = [row for row in rows if any(is_level(row[column], level) for level in levels)]
        if not rows:
            raise ResultError(f"no row with {word} (in '{text}')")
    return rows


def the_row(rows, text):
    found = select(rows, text)
    if len(found) > 1:
        raise ResultError(f"{len(found)} rows with '{text}', not one")
    return found[0]


def levels_of(rows, column):
    """The levels of a column in the order of the table."""
    return list(dict.fromkeys(row[column] for row in rows))


def value_of(row):
    column = next((name for name in VALUE_COLUMNS if name in row), None)
    if column is None:
        raise ResultError(f"the table has none of the columns {', '.join(VALUE_COLUMNS)}")
    return row[column]


# What a row is shown as: a rate in per cent or as a share, with or without its interval, a number, the count.

def rate(row, digits=1, unit=""):
    """A dash where nothing was counted."""
    if not value_of(row):
        return "-"
    value = float(value_of(row))
    if not row.get("lower"):
        return f"{100 * value:.{digits}f}{unit}"
    lower, upper = float(row["lower"]), float(row["upper"])
    return f"{100 * value:.{digits}f} [{100 * lower:.{digits}f}, {100 * upper:.{digits}f}]{unit}"


def rate_of_n(row):
    return f"{rate(row)} of {int(row['n']):,}" if value_of(row) else "-"


def share(row, digits=3):
    value = f"{float(value_of(row)):.{digits}f}"
    if not row.get("lower"):
        return value
    return f"{value} [{float(row['lower']):.{digits}f}, {float(row['upper']):.{digits}f}]"


def number(row, digits=3):
    return f"{float(value_of(row)):.{digits}g}"


def scientific(row):
    error = f" +- {float(row['standard_error']):.1e}" if row.get("standard_error") else ""
    return f"{float(value_of(row)):.2g}{error} [{float(row['lower']):.2g}, {float(row['upper']):.2g}]"


def natural(row):
    """A rate as a rate, a mean as a number."""
    if row.get("kind", "rate") == "rate":
        return rate(row)
    return share(row, 3) if row.get("lower") else number(row)


def covered(row):
    """The share of loops within their region, of `rcme validate --loops`."""
    value, lower, upper = (100 * float(row[name]) for name in ("covered", "covered_lower", "covered_upper"))
    return f"{value:.0f} [{lower:.0f}, {upper:.0f}] %"


def rms_over_sd(row):
    value, lower, upper = (float(row[name] or "inf") for name in ("rms_over_sd", "rms_over_sd_lower", "rms_over_sd_upper"))
    words = [f"{each:.2f}" if each < 10 else f"{each:.0f}" for each in (value, lower, upper)]
    return f"{words[0]} [{words[1]}, {words[2]}]"


FORMATS = {
    "rate": rate, "percent": lambda row: rate(row, 1, " %"), "percent2": lambda row: rate(row, 2, " %"),
    "rate2": lambda row: rate(row, 2), "rate_of_n": rate_of_n, "value": lambda row: f"{100 * float(value_of(row)):.1f}",
    "share": share, "share4": lambda row: share(row, 4), "number": number, "scientific": scientific,
    "n": lambda row: f"{int(row['n']):,}", "natural": natural,
    "covered": covered, "rms_over_sd": rms_over_sd,
    "wrong_and_right": lambda row: f"{row['does_not_hold']} / {row['holds']}",
    "verdict": lambda row: row["verdict"], "claim": lambda row: row["claim_verdict"],
}


def shown(row, form):
    """A row in one of the formats above, or one of its columns, as it stands ("column NAME") or with so many digits
    ("column NAME .3g")."""
    if form.startswith("column "):
        _, name, *digits = form.split()
        return f"{float(row[name]):{digits[0]}}" if digits else row[name]
    if form not in FORMATS:
        raise ResultError(f"no format '{form}'; there are: {', '.join(FORMATS)}, column NAME")
    return FORMATS[form](row)


def filled(text, width=140):
    """Prose in lines of the pages' width; items of a list keep their indentation, rows of a table their line, and intervals
    and links are not broken."""
    parts = []
    for line in text.splitlines():
        if not parts or not line or not parts[-1] or line.startswith(("|", "- ")) or parts[-1].startswith("|"):
            parts.append(line)
        else:
            parts[-1] += " " + line.strip()
    return "\n".join(part if part.startswith("|") else wrapped(part, width) for part in parts)


def wrapped(part, width):
    whole = re.sub(r"\[[^\[\]]*\]", lambda match: match[0].replace(" ", "\0"), part)
    return textwrap.fill(whole, width, subsequent_indent="  " if part.startswith("- ") else "", break_long_words=False,
                         break_on_hyphens=False).replace("\0", " ")


def markdown(head, body):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(line) + " |" for line in body])
