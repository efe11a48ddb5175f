"""The generated blocks of the pages.

A page shows a block between two comments, and the file of the same name with `.in` after it says what each is made of:

    README.md                              README.md.in
    <!-- begin generated: NAME -->         === NAME
    what is shown                          KIND ARGUMENT
    <!-- end generated: NAME -->           key: value

`scripts/results --blocks` writes what is shown; nobody types it. Kinds:

    rates TABLE ... the rows of one table or several; a row per level of `rows`, a column per level of `across` (default: estimator), each cell the
                    quantities of `cells`; further columns about the problem by `scene: quantity as Heading; ...`;
                    `where` picks rows, `only` picks columns, `having` leaves out rows without that column, `format`
                    says how a cell is shown (tables.py)
    table TABLE ... the columns of `columns` ("column as Heading; format: NAME as Heading; ...") of the rows of `where`; `beginning` picks
                    rows whose first cell begins with one of "TEXT; TEXT; ..."
    say             the lines below it, with numbers in braces: {TABLE: conditions | format}; `use` names a table and
                    `where` conditions that hold for all of them
    text FILE       lines of a committed text file as they stand; `from` and `to` say with what the first and the last begin, `before`
                    with what the line after them does, `lines` how many at most
    same PAGE NAME  the block NAME of another page, named from the root of the repository
    made NAME ...   what made the results: command, commit, CPU minutes
    ...             the kinds of special_blocks.py
"""

import re

from recipes import ROOT, RESULTS, ResultError
from special_blocks import SPECIAL
from tables import filled, levels_of, markdown, read_table, select, shown, the_row, words_of

BLOCK = re.compile(r"<!-- begin generated: (\S+) -->\n.*?<!-- end generated: (\S+) -->", re.DOTALL)
TEMPLATE = re.compile(r"^=== (\S+)\n(.*?)(?=^=== |\Z)", re.DOTALL | re.MULTILINE)
NUMBER = re.compile(r"\{([^{}]+)\}")
KEY = re.compile(r"^([a-z]+): (.*)$")


def pages():
    return sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "examples").glob("*/README.md"), RESULTS / "README.md",
                   *RESULTS.glob("*/README.md")])


def template_file(page):
    return page.with_name(page.name + ".in")


def templates(page):
    """{name of a block: what it is made of} of a page."""
    path = template_file(page)
    return dict(TEMPLATE.findall(path.read_text(encoding="utf-8"))) if path.exists() else {}


class Spec:
    """What a block asks for: its kind, its argument, its keys, and the lines that are none."""

    def __init__(self, text):
        lines = text.rstrip().splitlines()
        self.kind, _, self.argument = lines[0].partition(" ")
        self.keys, self.lines = {}, []
        for line in lines[1:]:
            match = KEY.match(line) if not self.lines else None
            if match:
                self.keys[match[1]] = match[2].strip()
            else:
                self.lines.append(line)

    def get(self, key, default=""):
        return self.keys.get(key, default)

    def parts(self, key):
        """[(what, heading)] of "what as Heading; what as Heading"."""
        parts = [part.strip() for part in self.get(key).split(";") if part.strip()]
        return [(what.strip(), (heading or what).strip()) for what, _, heading in
                (part.partition(" as ") for part in parts)]


def rates(spec):
    rows = [row for name in spec.argument.split() for row in read_table(name)]
    rows = select(rows, spec.get("where")) if spec.get("where") else list(rows)
    factors, across = spec.parts("rows"), spec.get("across", "estimator")
    scene = spec.parts("scene")
    cells, form = words_of(spec.get("cells")), spec.get("format", "rate")
    columns = [(level, level) for level in levels_of(rows, across) if level != "scene"]
    if spec.get("only"):
        columns = spec.parts("only")
    head = [name for _, name in factors] + [name for _, name in columns] + [name for _, name in scene]
    body = []
    for key in dict.fromkeys(tuple(row[factor] for factor, _ in factors) for row in rows):
        here = [row for row in rows if tuple(row[factor] for factor, _ in factors) == key]
        if spec.get("having") and not any(row[across] == spec.get("having") for row in here):
            continue
        line = list(key)
        for level, _ in columns:
            line.append(" / ".join(cell(here, across, level, each, form) for each in cells or [""]))
        body.append(line + [shown(the_row(here, f"scene, {quantity}"), "natural") for quantity, _ in scene])
    return markdown(head, body)


def cell(rows, across, level, quantity, form):
    """One quantity of one column; a dash where the table has none."""
    found = [row for row in rows if row[across] == level]
    if quantity:
        found = [row for row in found if quantity in (row.get("quantity"), row.get("event"))]
    if len(found) > 1:
        raise ResultError(f"{len(found)} rows for one cell ({level} {quantity}); say more in `where`")
    return shown(found[0], form) if found else "-"


def table(spec):
    rows = [row for name in spec.argument.split() for row in read_table(name)]
    rows = select(rows, spec.get("where")) if spec.get("where") else rows
    columns = spec.parts("columns")
    forms = [what[len("format: "):] if what.startswith("format: ") else f"column {what}" for what, _ in columns]
    body = [[shown(row, form) for form in forms] for row in rows]
    if spec.get("beginning"):
        body = [line for line in body if line[0].startswith(tuple(text for text, _ in spec.parts("beginning")))]
    return markdown([heading for _, heading in columns], body)


def say(spec):
    def number(match):
        body, _, form = match[1].partition(" | ")
        named = re.match(r"(\w+/\w+): (.*)", body, re.DOTALL)
        name, conditions = named.groups() if named else (spec.get("use"), body)
        everywhere = spec.get("where")
        rows = read_table(name.strip())
        return shown(the_row(rows, ", ".join(filter(None, [everywhere, conditions]))), form.strip() or "percent")

    return filled(NUMBER.sub(number, "\n".join(spec.lines).strip("\n")))


def text(spec):
    path = RESULTS / spec.argument
    if not path.exists():
        raise ResultError(f"there is no {spec.argument} under results")
    lines = [line.rstrip() for line in path.read_text().splitlines()]
    if spec.get("from"):
        lines = lines[next(i for i, line in enumerate(lines) if line.startswith(spec.get("from"))):]
    if spec.get("to"):
        lines = lines[:next(i for i, line in enumerate(lines) if line.startswith(spec.get("to"))) + 1]
    if spec.get("before"):
        lines = lines[:next(i for i, line in enumerate(lines) if line.startswith(spec.get("before")))]
    if spec.get("lines"):
        lines = lines[:int(spec.get("lines"))]
    return "```text\n" + "\n".join(lines).strip("\n") + "\n```"


def same(spec):
    page, name = spec.argument.split()
    return render(Spec(templates(ROOT / page)[name]))


KINDS = {"rates": rates, "table": table, "say": say, "text": text, "same": same, **SPECIAL}


def render(spec):
    if spec.kind not in KINDS:
        raise ResultError(f"no kind of block '{spec.kind}'; there are: {', '.join(KINDS)}")
    return KINDS[spec.kind](spec)


def rendered(page):
    """The page with every block as the committed tables give it."""
    content, made_of = page.read_text(encoding="utf-8"), templates(page)
    where, names = page.relative_to(ROOT), block_names(page)
    if content.count("<!-- begin generated:") != len(names):
        raise ResultError(f"{where}: a block begins and does not end")
    if sorted(names) != sorted(made_of):
        raise ResultError(f"{where} has the blocks {sorted(names)}, {template_file(page).name} those of {sorted(made_of)}")

    def block(match):
        name = match[1]
        if match[2] != name:
            raise ResultError(f"{where}: block '{name}' ends as '{match[2]}'")
        try:
            shown_text = render(Spec(made_of[name]))
        except (ResultError, KeyError, ValueError, StopIteration) as error:
            raise ResultError(f"{where}: block '{name}': {error or type(error).__name__}") from error
        return f"<!-- begin generated: {name} -->\n{shown_text}\n<!-- end generated: {name} -->"

    return BLOCK.sub(block, content)


def block_names(page):
    return [match[0] for match in BLOCK.findall(page.read_text(encoding="utf-8"))]


def write_blocks():
    """Renders every page; returns the pages that changed."""
    changed = []
    for page in pages():
        content = rendered(page)
        if content != page.read_text(encoding="utf-8"):
            page.write_text(content, encoding="utf-8")
            changed.append(page)
    return changed


def stale_pages():
    """The pages whose blocks are not what the committed tables give, and how many blocks were looked at."""
    return [page for page in pages() if rendered(page) != page.read_text(encoding="utf-8")]


def unaccounted(recipes):
    """Committed files under results that no recipe makes, and files of recipes that are not there."""
    known = {target for recipe in recipes.values() for _, target, _ in recipe.pairs()}
    own = {RESULTS / name for name in ("results.toml", "made.json", "digests.json")}
    there = {path for path in RESULTS.rglob("*") if path.is_file() and path.name not in ("README.md", "README.md.in")}
    return sorted(there - known - own), sorted(known - there)
