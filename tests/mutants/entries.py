"""The lists of mutants: one TOML file a room, a table per source file, a line per mutant:

    ["stats/intervals.cc"]
    wilson_without_continuity = { was = 'text of the file', now = 'what it becomes', in = 'a unique text around it' }

`was` stands once in the file, or once in the text `in`, which stands once in the file. It is a whole expression, or whole
statements that end with ';' and declare nothing. `equivalent = 'why'` marks a mutant that no test can tell from the
original.
"""

import dataclasses
import pathlib
import tomllib

FOLDER = pathlib.Path(__file__).resolve().parent
SOURCE = FOLDER.parents[1]
ROOMS = ("stats", "simulator", "estimator", "peers", "experiments", "plots")
KEYS = {"was", "now", "in", "equivalent"}


class EntryError(Exception):
    """An entry that is wrong, or no longer fits its source; the message names it."""


@dataclasses.dataclass(frozen=True)
class Mutant:
    room: str
    file: str  # from the root of the source tree
    name: str  # unique in its room
    was: str
    now: str
    begin: int  # where `was` stands in the file
    equivalent: str = ""

    @property
    def end(self):
        return self.begin + len(self.was)


def find_once(text, part, where):
    """Where `part` begins in `text`."""
    count = text.count(part)
    if count != 1:
        raise EntryError(f"{where}: {'not found' if count == 0 else f'stands {count} times'}: {part!r}")
    return text.index(part)


def read_entry(room, file, source, name, entry):
    where = f"tests/mutants/{room}.toml: {file}: {name}"
    if not isinstance(entry, dict) or not {"was", "now"} <= set(entry) <= KEYS:
        raise EntryError(f"{where}: give was and now, and in and equivalent where needed")
    if entry["was"] == entry["now"] or not entry["was"] or entry["was"] != entry["was"].strip():
        raise EntryError(f"{where}: was is empty, begins or ends with a blank, or is what it becomes")
    if entry["was"].endswith(";") != entry["now"].endswith(";") and entry["now"] and file.endswith((".cc", ".h")):
        raise EntryError(f"{where}: was and now must both be expressions or both be statements")
    around = entry.get("in", entry["was"])
    begin = find_once(source, around, where) + find_once(around, entry["was"], where)
    return Mutant(room, file, name, entry["was"], entry["now"], begin, entry.get("equivalent", ""))


def read_room(room, source_folder=SOURCE, lists_folder=FOLDER):
    """The mutants of a room, in the order of its list."""
    path = lists_folder / f"{room}.toml"
    try:
        tables = tomllib.loads(path.read_text()) if path.exists() else {}
    except tomllib.TOMLDecodeError as error:
        raise EntryError(f"tests/mutants/{room}.toml: {error}") from error
    mutants, names = [], set()
    for file, entries in tables.items():
        try:
            source = (source_folder / file).read_text()
        except OSError as error:
            raise EntryError(f"tests/mutants/{room}.toml: {file}: {error.strerror}") from error
        for name, entry in entries.items():
            if name in names:
                raise EntryError(f"tests/mutants/{room}.toml: {file}: {name}: the name stands twice")
            names.add(name)
            mutants.append(read_entry(room, file, source, name, entry))
    return mutants
