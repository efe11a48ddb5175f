"""The lists of mutants: TOML files, a table per source file, a line per mutant:

    ["stats/intervals.cc"]
    wilson_without_continuity = { was = 'text of the file', now = 'what it becomes', in = 'a unique text around it' }

`was` stands once in the file, or once in the text `in`, which stands once in the file. It is a whole expression, or whole
statements that end with ';' and declare nothing. `equivalent = 'why'` marks a mutant that no test can tell from the
original. A mutant belongs to the innermost room that its file is in, whichever list it stands in.
"""

import dataclasses
import pathlib
import re
import tomllib

FOLDER = pathlib.Path(__file__).resolve().parent
SOURCE = FOLDER.parents[1]
FOLDERS = {  # of each room
    "stats": "stats", "simulator": "simulator", "estimator": "estimator", "calibrated": "estimator/calibrated",
    "robust_covariance": "estimator/robust_covariance", "peers": "peers", "experiments": "experiments",
    "pieces": "experiments/core/work", "rare": "experiments/rare", "sequences": "experiments/real/sequences",
    "truth_free": "experiments/real/truth_free", "plots": "plots", "python": "python"}
ROOMS = tuple(FOLDERS)
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


def is_whole(code):
    """Whether a piece of C++ can be an expression or statements: brackets that close, and for an expression no word that begins
    a statement and no operator at an end that lacks its operand. Not exact; what it lets pass, the build of the mutants shows."""
    code = re.sub(r'"(\\.|[^"\\])*"|\'(\\.|[^\'\\])\'', "_", code)
    opened = []
    for character in code:
        if character in "([{":
            opened.append(")]}"["([{".index(character)])
        elif character in ")]}" and (not opened or opened.pop() != character):
            return False
    if opened:
        return False
    if code.endswith(";"):
        return not re.match(r"(const|constexpr|auto|static|double|int)\b", code)
    return not re.match(r"(if|else|for|while|return|case|const|constexpr|auto)\b|[/<>|?:,=]|[-*+] ", code) \
        and not re.search(r"[-+*/=<>&|?:,]$", code)


def find_once(text, part, where):
    """Where `part` begins in `text`."""
    count = text.count(part)
    if count != 1:
        raise EntryError(f"{where}: {'not found' if count == 0 else f'stands {count} times'}: {part!r}")
    return text.index(part)


def room_of(file):
    """The innermost room that the file is in."""
    rooms = [room for room, folder in FOLDERS.items() if file.startswith(folder + "/")]
    return max(rooms, key=lambda room: len(FOLDERS[room]), default=None)


def read_entry(list_name, file, source, name, entry):
    where = f"tests/mutants/{list_name}: {file}: {name}"
    if room_of(file) is None:
        raise EntryError(f"{where}: the file is in none of the rooms {', '.join(ROOMS)}")
    if not isinstance(entry, dict) or not {"was", "now"} <= set(entry) <= KEYS:
        raise EntryError(f"{where}: give was and now, and in and equivalent where needed")
    if entry["was"] == entry["now"] or not entry["was"] or entry["was"] != entry["was"].strip():
        raise EntryError(f"{where}: was is empty, begins or ends with a blank, or is what it becomes")
    if entry["was"].endswith(";") != entry["now"].endswith(";") and entry["now"] and file.endswith((".cc", ".h")):
        raise EntryError(f"{where}: was and now must both be expressions or both be statements")
    if file.endswith((".cc", ".h")) and not (is_whole(entry["was"]) and is_whole(entry["now"])):
        raise EntryError(f"{where}: was and now must be whole expressions, or whole statements that declare nothing")
    around = entry.get("in", entry["was"])
    begin = find_once(source, around, where) + find_once(around, entry["was"], where)
    return Mutant(room_of(file), file, name, entry["was"], entry["now"], begin, entry.get("equivalent", ""))


def read_list(path, source_folder):
    """The mutants of a list, in its order."""
    try:
        tables = tomllib.loads(path.read_text())
    except tomllib.TOMLDecodeError as error:
        raise EntryError(f"tests/mutants/{path.name}: {error}") from error
    mutants = []
    for file, entries in tables.items():
        try:
            source = (source_folder / file).read_text()
        except OSError as error:
            raise EntryError(f"tests/mutants/{path.name}: {file}: {error.strerror}") from error
        mutants += [read_entry(path.name, file, source, name, entry) for name, entry in entries.items()]
    return mutants


def read_rooms(source_folder=SOURCE, lists_folder=FOLDER):
    """The mutants of each room, in the order of the lists' names."""
    mutants, names = {room: [] for room in ROOMS}, set()
    for path in sorted(lists_folder.glob("*.toml")):
        for mutant in read_list(path, source_folder):
            if (mutant.room, mutant.name) in names:
                raise EntryError(f"tests/mutants/{path.name}: {mutant.file}: {mutant.name}: the name stands twice in "
                                 f"the room {mutant.room}")
            names.add((mutant.room, mutant.name))
            mutants[mutant.room].append(mutant)
    return mutants
