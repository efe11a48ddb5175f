"""The examples of CONTRIBUTING.md, "How to add": a folder per path with path.toml and the files to write, laid out as in the tree.

    row        the path's row of the table
    name       what `x` stands for there
    models     files that the row names to be read, not to be changed
    is_listed  whether the example is in a list of the program: the steps above the table follow
    targets    what is built
    tests      a regular expression for ctest
    commands   what a user would then do, run in a folder of its own; `rcme` is the program that was built
    register   edits: in `file`, `insert` follows the text `after`, which stands there once

`python3 paths.py` does what an example says. Here: what an example makes, and whether the row says the same.
"""

import dataclasses
import itertools
import pathlib
import re
import tomllib

FOLDER = pathlib.Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
CONTRIBUTING = "CONTRIBUTING.md"
LISTS = {"docs/equations.md"}  # of the steps above the table
FILE = re.compile(r"`([\w./{},]+\.(?:h|cc|py|md|toml|yaml|\{h,cc\}))`")


@dataclasses.dataclass(frozen=True)
class Edit:
    file: str
    after: str
    insert: str


@dataclasses.dataclass(frozen=True)
class Example:
    path: str  # the name of its folder
    row: str
    name: str
    models: tuple
    is_listed: bool
    targets: tuple
    tests: str
    commands: tuple
    edits: tuple
    written: tuple  # files, from the root of the tree

    @property
    def edited(self):
        return tuple(dict.fromkeys(edit.file for edit in self.edits))

    @property
    def num_registered(self):
        return sum(max(1, edit.insert.count("\n")) for edit in self.edits)


def read_example(folder):
    entry = tomllib.loads((folder / "path.toml").read_text(encoding="utf-8"))
    files = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*")
                   if path.is_file() and path.name != "path.toml" and "__pycache__" not in path.parts)
    return Example(folder.name, entry["row"], entry["name"], tuple(entry["models"]), entry.get("is_listed", False),
                   tuple(entry["targets"]), entry["tests"], tuple(entry.get("commands", ())),
                   tuple(Edit(**edit) for edit in entry.get("register", ())), tuple(files))


def read_examples(folder=FOLDER):
    """{path: Example}."""
    return {file.parent.name: read_example(file.parent) for file in sorted(folder.glob("*/path.toml"))}


def edited_text(text, edit):
    """The text with the edit; ValueError where it no longer fits."""
    if text.count(edit.after) != 1:
        raise ValueError(f"{edit.file}: stands {text.count(edit.after)} times: {edit.after!r}")
    return text.replace(edit.after, edit.after + edit.insert)


def apply(example, tree):
    """Writes the example's files into the tree and makes its edits."""
    for file in example.written:
        target = tree / file
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes((FOLDER / example.path / file).read_bytes())
    for edit in example.edits:
        file = tree / edit.file
        file.write_text(edited_text(file.read_text(encoding="utf-8"), edit), encoding="utf-8")


def table_rows(page):
    """{row: its cells "write" and "register" as one text} of the table "How to add"."""
    table = page[page.index("| to add |"):].split("\n\n")[0]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()[2:]]
    return {row: " ".join(rest) for row, *rest in cells}


def choices(token):
    """What a name with braces stands for, and whether all of it or one: `x.{h,cc}` is two files, `{a,b}/x.cc` either."""
    parts = re.split(r"\{([^}]*)\}", token)
    options = [part.split(",") if place % 2 else [part] for place, part in enumerate(parts)]
    return ["".join(choice) for choice in itertools.product(*options)], token.endswith("}")


def is_named_as(file, token, name):
    """Whether a file of the tree is what a row calls `token`: its end, with the example's name for `x`."""
    wanted = re.sub(r"(?<![\w])x(?=[._])", name, token)
    return file == wanted or file.endswith("/" + wanted)


def disagreements(example, page):
    """Where the example does not do what its row says, as sentences."""
    rows = table_rows(page)
    if example.row not in rows:
        return [f"{example.path}: the table has no row '{example.row}'"]
    tokens = FILE.findall(rows[example.row])
    made = [*example.written, *example.edited]
    wrong = []
    for file in [*made, *example.models]:
        names = [name for token in tokens for name in choices(token)[0]]
        if file not in LISTS and not any(is_named_as(file, name, example.name) for name in names):
            wrong.append(f"{example.path}: the row does not name {file}")
    for token in tokens:
        names, are_all = choices(token)
        is_met = [any(is_named_as(file, name, example.name) for file in [*made, *example.models]) for name in names]
        if not (all(is_met) if are_all else any(is_met)):
            wrong.append(f"{example.path}: the row names {token}, which the example does not touch")
    return wrong
