"""A few trials of every committed result, as hashes.

A trial is a pure function of study, seed, condition and number, so the first trials of a committed run are those of a
short one. Every field is hashed but the times: numbers with all their bits, so that nothing is equal that is not the
same. The kernels give the same bits on every instruction set, and so do these hashes.

A column that result files got later is no part of the older hashes: those that came together are a group with a part of
its own (LATER), "condition 0, standard, density". What was stored before a group existed is compared without it and
stays a proof of all that it covers; from the next time on that a result is stored, it covers the group too. A new column
without a group changes every hash, so that none comes in unnoticed.
"""

import hashlib
import json
import re
import sqlite3

from audit_table import audit_rows
from recipes import DIGESTS, ResultError, fresh, run

NOT_HASHED = {"seconds", "checksum"}  # the wall time, and what is computed from it
LATER = {"density": ("density", "rotation_sd_deg", "direction_sd_deg", "sd_over_crb", "log_det_cov", "energy_score_deg",
                     "log_score"),
         "levels": ("rotation_level_deg", "direction_level_deg")}  # columns of later versions, by group
GROUPS = {column: group for group, columns in LATER.items() for column in columns}
ANY_NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")  # what people read is compared without its words
SKIPPED = re.compile(r"\.(png|pdf|md)$")  # figures and pages say what the tables say


def bits(value):
    return value.hex() if isinstance(value, float) else str(value)


def hash_of(text):
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def trials_of(path):
    """{"condition 0, standard": text of the fields of its trials} of a result file; "problem" is the scene itself."""
    database = sqlite3.connect(f"file:{path}?mode=ro", uri=True)
    database.row_factory = sqlite3.Row
    labels = dict(database.execute("SELECT estimator, label FROM estimators").fetchall())
    texts = {}
    for table in ("problems", "trials"):
        for row in database.execute(f"SELECT * FROM {table} ORDER BY condition, trial"):
            who = labels[row["estimator"]] if table == "trials" else "problem"
            for group in ("", *LATER):
                fields = [f"{name} {bits(row[name])}" for name in row.keys()
                          if name not in NOT_HASHED | {"estimator"} and GROUPS.get(name, "") == group]
                if fields:
                    part = f"condition {row['condition']}, {who}" + (f", {group}" if group else "")
                    texts[part] = texts.get(part, "") + "\n".join(fields) + "\n"
    database.close()
    return texts


def parts_of(path):
    """What is hashed of a file, part by part, so that a difference says where it is."""
    if path.suffix == ".sqlite":
        return trials_of(path)
    if path.name == "audit.json":
        texts = {}
        for row in audit_rows(json.loads(path.read_text())):
            part = f"{row['claim']} at {row['conditions']}"
            texts[part] = texts.get(part, "") + "\n" + " ".join(bits(value) for value in row.values())
        return texts
    text = path.read_text()
    return {"all numbers": " ".join(ANY_NUMBER.findall(text))} if path.suffix == ".txt" else {"all lines": text}


def digests_of(recipe, scratch, programs, known):
    """Runs the result's few trials and hashes what they give; `known`: what the same commands gave for others."""
    commands = tuple(recipe.digest)
    if commands in known:
        return known[commands]
    out = scratch / recipe.name
    fresh(out)
    for command in recipe.digest:
        run(command, out, programs, draws=False)
    found = {}
    for path in sorted(out.iterdir()):
        if not SKIPPED.search(path.name) and path.suffix in (".sqlite", ".json", ".csv", ".txt"):
            found |= {f"{path.name}: {part}": hash_of(text) for part, text in parts_of(path).items()}
    if recipe.digest and not found:
        raise ResultError(f"{recipe.name}: its commands for the digests gave nothing")
    known[commands] = found
    return found


def stored():
    return json.loads(DIGESTS.read_text()) if DIGESTS.exists() else {}


def store(new):
    DIGESTS.write_text(json.dumps(stored() | new, indent=0, sort_keys=True) + "\n")


def group_of(part):
    """The group of LATER that a part is of; none: of the first columns."""
    file_name, _, what = part.partition(": ")
    group = what.rpartition(", ")[2]
    return group if file_name.endswith(".sqlite") and what.count(", ") > 1 and group in LATER else None


def compared(old, new):
    """The parts that `old` covers: all but those of groups that it has no part of."""
    known = {group_of(part) for part in old} | {None}
    return [part for part in dict.fromkeys([*old, *new]) if group_of(part) in known]


def difference(name, old, new):
    """What a failing test says: which result, the first part that differs, and how to make it again."""
    parts = [part for part in compared(old, new) if old.get(part) != new.get(part)]
    if not parts:
        return None
    return (f"{name}: the program no longer gives this result: {len(parts)} of {len(new)} parts differ, first "
            f"'{parts[0]}'. If that is meant: scripts/results {name} && scripts/results --digests {name}")
