"""The recipes of the committed results (results/results.toml), and how one is followed."""

import csv
import functools
import io
import json
import os
import resource
import shlex
import shutil
import subprocess
import time
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from audit_table import TABLES, without_times

ROOT = Path(__file__).resolve().parents[2]
RESULTS = ROOT / "results"
RECIPES, MADE, DIGESTS = RESULTS / "results.toml", RESULTS / "made.json", RESULTS / "digests.json"
LONG_MINUTES = 10  # of CPU time, from which on a result is made only where it is asked for
KEYS = {"name", "folder", "cpu_minutes", "needs", "commands", "files", "machine", "digest"}


class ResultError(Exception):
    """The message of a failed step, without a traceback."""


@dataclass
class Recipe:
    """One committed result."""

    name: str
    folder: str
    cpu_minutes: float
    commands: list
    files: list  # names, or {from, as}: what lies in the scratch folder under another name
    needs: list = field(default_factory=list)
    machine: list = field(default_factory=list)
    digest: list = field(default_factory=list)

    def pairs(self):
        """(file in the scratch folder, committed file, what has to be done to it) of every file."""
        for entry in self.files:
            if isinstance(entry, str):
                entry = {"from": entry, "as": entry}
            yield entry["from"], RESULTS / self.folder / entry["as"], entry.get("table")

    def is_long(self):
        return self.cpu_minutes >= LONG_MINUTES

    def missing(self, programs):
        """What the commands need and what is not there."""
        names = {shlex.split(command)[0] for command in self.commands + self.digest}
        found = [name if name == "rcme" else f"{name} (built by cmake --build build/release --target thorough)"
                 for name in sorted(names) if "/" not in name and not (programs / name).exists()]
        found += [each for each in map(with_data, self.needs) if "/" in each and not (ROOT / each).exists()]
        wanted = [each.removeprefix("estimator ") for each in self.needs if each.startswith("estimator ")]
        there = estimators_of(programs / "rcme") if wanted and "rcme" not in found else wanted
        return found + [f"estimator {name} in rcme (its library was not there when rcme was built)"
                        for name in wanted if name not in there]


def estimators_of(program):
    """The names of a program's estimators."""
    listed = subprocess.run([str(program), "list", "estimators"], text=True, check=True, capture_output=True)
    return {line.split()[0] for line in listed.stdout.splitlines() if line.strip() and not line.startswith(" ")}


@functools.lru_cache(maxsize=None)
def stated_data():
    with open(RECIPES, "rb") as file:
        return tomllib.load(file)["data"]


def data():
    """{name: {path, what}} of the data that the repository does not hold; RCME_NAME in the environment gives another path."""
    return {name: entry | {"path": os.environ.get(f"RCME_{name}", entry["path"])} for name, entry in stated_data().items()}


def with_data(text):
    """A command or need with paths in the place of {PAIRS} and its like."""
    for name, entry in data().items():
        text = text.replace("{" + name + "}", entry["path"])
    return text


def with_name(value, name):
    """A value of an entry with the name in the place of {each}."""
    if isinstance(value, list):
        return [with_name(part, name) for part in value]
    if isinstance(value, dict):
        return {key: with_name(part, name) for key, part in value.items()}
    return value.replace("{each}", name) if isinstance(value, str) else value


def written_out(entry):
    """The entries that one entry stands for."""
    common = {key: value for key, value in entry.items() if key != "each"}
    return [with_name(common, name) for name in entry["each"]] if "each" in entry else [common]


def read_recipes(path=RECIPES):
    with open(path, "rb") as file:
        entries = [one for entry in tomllib.load(file)["result"] for one in written_out(entry)]
    recipes = {}
    for entry in entries:
        unknown = set(entry) - KEYS
        if unknown:
            raise ResultError(f"{path}: result '{entry.get('name')}': unknown key '{min(unknown)}'; "
                              f"known: {', '.join(sorted(KEYS))}")
        if entry["name"] in recipes:
            raise ResultError(f"{path}: two results named '{entry['name']}'")
        recipes[entry["name"]] = Recipe(**entry)
    return recipes


def chosen(recipes, names, with_long):
    """The recipes of these names or folders; without names all, the long ones only where wanted."""
    if not names:
        return [recipe for recipe in recipes.values() if with_long or not recipe.is_long()]
    wanted = []
    for name in names:
        found = [recipe for recipe in recipes.values() if name in (recipe.name, recipe.folder)]
        if not found:
            raise ResultError(f"no result '{name}'; there are: {', '.join(recipes)}")
        wanted += [recipe for recipe in found if recipe not in wanted]
    return wanted


VERDICTS = ("integrity",)  # commands of `rcme` whose exit codes 1 and 3 are what they found


def run(command, out, programs, draws=True):
    """Runs one command of a recipe; "> FILE" at its end keeps what it prints. Without `draws` a program finds no Python that
    starts, and leaves its figures out."""
    words = shlex.split(with_data(command.replace("{out}", str(out))))
    target = None
    if len(words) > 2 and words[-2] == ">":
        target, words = words[-1], words[:-2]
    is_ours = "/" not in words[0]
    program = programs / words[0] if is_ours else Path(words[0])
    environment = {**os.environ, "RCME_PROGRAMS": str(programs)}
    if is_ours and not draws:
        environment["PYTHONHOME"] = "/nowhere"
    done = subprocess.run([str(program), *words[1:]], cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode != 0 and not (done.returncode in (1, 3) and words[1] in VERDICTS):
        last = done.stderr.decode(errors="replace").strip().splitlines()[-3:]
        raise ResultError(f"'{command}' ended with {done.returncode}: " + " / ".join(last))
    if target:
        Path(target).write_bytes(done.stdout)


def make(recipe, out, programs, say=lambda words: None):
    """Follows the recipe into `out`; returns the CPU seconds that its commands took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    out.mkdir(parents=True, exist_ok=True)
    for number, command in enumerate(recipe.commands, 1):
        start = time.monotonic()
        say(f"{recipe.name}: {number} of {len(recipe.commands)}: {with_data(command).replace('{out}/', '')}")
        run(command, out, programs)
        say(f"{recipe.name}: {number} of {len(recipe.commands)}: {time.monotonic() - start:.0f} s")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def content(path, table):
    """The bytes of a file that was made, as they are committed."""
    if not path.exists():
        raise ResultError(f"{path.name} was not written by the commands")
    return TABLES[table](json.loads(path.read_text())).encode() if table else path.read_bytes()


def is_same(path, target, table):
    if not target.exists():
        return False
    new, old = content(path, table), target.read_bytes()
    if table == "audit":
        return without_times(new.decode()) == without_times(old.decode())
    if new == old or target.suffix != ".csv":
        return new == old
    new, old = without_newer_columns(new.decode(), old.decode()), old.decode()
    return without_newer_quantities(new, old) == old


def without_newer_columns(new, old):
    """A table without the columns that the committed one does not have, as without_newer_quantities; one without such
    columns stays as it is written."""
    cells = list(csv.reader(new.splitlines()))
    header = next(csv.reader(old.splitlines()), [])
    kept = [place for place, name in enumerate(cells[0] if cells else []) if name in header]
    if not cells or len(kept) == len(cells[0]) or any(len(row) != len(cells[0]) for row in cells):
        return new
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([row[place] for place in kept] for row in cells)
    return text.getvalue()


def without_newer_quantities(new, old):
    """A summary without the rows of quantities of which the committed one has none: one that the program learned since is no
    change of the result."""
    lines = new.splitlines(keepends=True)
    cells = list(csv.reader(lines))
    if not cells or "quantity" not in cells[0] or len(cells) != len(lines):
        return new
    place = cells[0].index("quantity")
    known = {row[place] for row in csv.reader(old.splitlines()) if len(row) > place}
    return "".join(line for line, row in zip(lines, cells) if row[place] in known)


def differing(recipe, out):
    """The committed files that are not what lies in `out`; those that hold times are left out."""
    return [str(target.relative_to(ROOT)) for made, target, table in recipe.pairs()
            if target.name not in recipe.machine and not is_same(out / made, target, table)]


def keep(recipe, out, cpu_seconds):
    """Replaces the committed files by what lies in `out`, and notes what made them; no time of a resumed run."""
    contents = [(target, content(out / made, table)) for made, target, table in recipe.pairs()]
    for target, data in contents:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(data)
    made = json.loads(MADE.read_text()) if MADE.exists() else {}
    made[recipe.name] = code_version()
    if cpu_seconds is not None:
        made[recipe.name]["cpu_minutes"] = round(cpu_seconds / 60, 1)
    MADE.write_text(json.dumps(made, indent=1, sort_keys=True) + "\n")


def code_version():
    """The last commit that changed the programs or the plots, and whether there are changes that are in no commit."""
    code = ["CMakeLists.txt", "cmake", "parameters", "stats", "estimator", "peers", "simulator", "experiments", "plots",
            ":!*.md"]

    def git(*words):
        return subprocess.run(["git", *words, "--", *code], cwd=ROOT, text=True, check=True,
                              capture_output=True).stdout.strip()
    commit, date = git("log", "-1", "--format=%h %cs").split()
    if git("status", "--porcelain", "--untracked-files=no"):
        commit += " with changes"
    return {"commit": commit, "date": date}


def fresh(folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)


def default_programs():
    return Path(os.environ.get("RCME_PROGRAMS", ROOT / "build" / "release" / "bin"))
