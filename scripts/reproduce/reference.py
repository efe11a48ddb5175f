"""The tables of docs/reference and the schema of studies: see scripts/reference.

A page holds a table between the lines `<!-- begin list: NAME -->` and `<!-- end list: NAME -->`, NAME one of `rcme list`."""

import argparse
import difflib
import pathlib
import re
import subprocess
import sys

from study_schema import study_schema_text

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ROOT / "docs" / "reference"
SCHEMA = ROOT / "docs" / "study.schema.json"
SHORTENED = ("options", "settings")  # lists of what many take: one row for all whose other columns are equal
GROUPS = {"*loop*": ("standard", "prcme", "rcme", "msac", "mlesac", "lo_ransac", "cov_ransac", "m_estimator")}  # docs/reference/estimators.md
TABLE = re.compile(r"(<!-- begin list: (\S+) -->\n).*?(<!-- end list: \2 -->)", re.DOTALL)


def list_as_markdown(program, name):
    """The same text wherever it is made: without estimators that are not in every build, and versions of libraries."""
    lines = subprocess.run([program, "list", name, "--format", "markdown"], check=True, capture_output=True,
                           text=True).stdout.strip().splitlines()
    lines = [line for line in lines if not line.startswith("| poselib")]
    lines = [re.sub(r"\b(OpenCV|OpenGV) [\d.]+\b", r"\1", line) for line in lines]
    if name in SHORTENED:
        lines = joined(shorter_ranges(merged(lines)), column=1)
    if name == "keys":
        lines = joined(lines, column=1)
    if name == "claims":
        lines = joined(lines, column=0, separator="; ", more=2)
    return "\n".join(lines) + "\n"


def joined(lines, column, separator=", ", more=None):
    """Rows that differ only in one column (and in the column `more`) as one, with lists in these cells."""
    alike = {}
    for line in lines[2:]:
        cells = line.removeprefix("| ").removesuffix(" |").split(" | ")
        alike.setdefault(tuple(cell for place, cell in enumerate(cells) if place not in (column, more)), []).append(cells)
    rows = []
    for many in alike.values():
        cells = list(many[0])
        for place in {column, more} - {None}:
            of_all = [row[place] for row in many]
            cells[place] = separator.join(of_all if len(set(of_all)) > 1 else of_all[:1])
        rows.append("| " + " | ".join(cells) + " |")
    return [*lines[:2], *rows]


def shorter_ranges(lines):
    """`a number in [0, 1]` as `[0, 1]`, `a whole number in [1, 9]` as `whole [1, 9]`."""
    return [line.replace("| a number in [", "| [").replace("| a whole number in [", "| whole [") for line in lines]


def short_names(names, all_names):
    """The names as a list; "all but NAME", and the name of a group of estimators, where these are shorter."""
    others = [name for name in all_names if name not in names]
    if len(names) > 4 and len(others) < 3:
        return "all but " + " and ".join(others) if others else "all"
    for group, members in GROUPS.items():
        if set(members) <= set(names):
            names = [group, *(name for name in names if name not in members)]
    return ", ".join(names)


def merged(lines):
    """Rows that differ only in their first cell as one, with these cells in a list: "scene: plane, room; motion: forward"."""
    takers, of_kind = {}, {}
    for line in lines[2:]:
        first, rest = line.removeprefix("| ").split(" | ", 1)
        kind, colon, name = first.rpartition(": ")
        takers.setdefault(rest, {}).setdefault(kind + colon, []).append(name)
        of_kind.setdefault(kind + colon, {})[name] = None
    rows = ["; ".join(kind + short_names(names, of_kind[kind]) for kind, names in kinds.items()) + " | " + rest
            for rest, kinds in takers.items()]
    return [*lines[:2], *("| " + row for row in rows)]


def written_files(program):
    """(path, what it should be) of each page and of the schema."""
    for page in sorted(PAGES.glob("*.md")):
        yield page, TABLE.sub(lambda m: m[1] + list_as_markdown(program, m[2]) + m[3], page.read_text())
    yield SCHEMA, study_schema_text(program)


def main():
    parser = argparse.ArgumentParser(prog="scripts/reference", description=__doc__.split("\n\n")[0])
    parser.add_argument("--check", action="store_true", help="only compare; exit code 1 where a page is out of date")
    parser.add_argument("--program", default="build/release/bin/rcme", help="default: %(default)s")
    arguments = parser.parse_args()
    is_stale = False
    for page, new in written_files(arguments.program):
        old = page.read_text() if page.exists() else ""
        if new == old:
            continue
        if not arguments.check:
            page.write_text(new)
            print(f"written: {page.relative_to(ROOT)}")
            continue
        is_stale = True
        print(f"{page.relative_to(ROOT)} is not what the program says; `scripts/reference` writes it anew:")
        print("\n".join(difflib.unified_diff(old.splitlines(), new.splitlines(), "page", "program", lineterm="", n=0)))
    sys.exit(1 if is_stale else 0)


if __name__ == "__main__":
    main()
