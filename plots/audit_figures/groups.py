"""Which targets of a claim may share an axis, and what tells its rows apart. It sorts; it computes nothing.

A group holds quantities of one kind and of similar size. 'coverage at alpha 0.5', '... at alpha 0.2' and so on are one
quantity at several significance levels: a group of their own.
"""

import math
import re
from dataclasses import dataclass

from common import style

STRONG_ALPHA = 0.05
SIMILAR_RATIO = 10  # sizes further apart do not share an axis


@dataclass(frozen=True)
class Row:
    """One target together with the conditions it was measured at."""

    conditions: dict
    target: object


@dataclass(frozen=True)
class Group:
    name: str  # what the axis shows: the quantity, '' if there are several
    rows: tuple
    has_alphas: bool

    @property
    def targets(self):
        return [row.target for row in self.rows]

    @property
    def quantities(self):
        return list(dict.fromkeys(target.quantity for target in self.targets))

    @property
    def is_rate(self):
        return self.rows[0].target.kind == "rate"

    def axis_name(self):
        name = self.name or ("Rate" if self.is_rate else "Value")
        return name[:1].upper() + name[1:] + (" (%)" if self.is_rate else "")


def split_alpha(quantity):
    """'coverage at alpha 0.05' -> ('coverage', 0.05); a quantity without alpha -> (quantity, None)."""
    match = re.fullmatch(r"(.+) at alpha ([0-9.]+(?:e-?[0-9]+)?)", quantity)
    return (match[1], float(match[2])) if match else (quantity, None)


def strong_alpha(targets):
    """The significance level that is drawn strong: 0.05, or the one nearest to it."""
    return min((split_alpha(target.quantity)[1] for target in targets), key=lambda alpha: abs(alpha - STRONG_ALPHA))


def rows_of(claim):
    return [Row(evidence.conditions, target) for evidence in claim.evidence for target in evidence.targets]


def size_of(rows):
    """The largest value that has to be on the axis; 0 if there is none."""
    values = [abs(value) for row in rows for target in [row.target]
              for value in (target.measured, target.nominal, target.low, target.high) if math.isfinite(value)]
    return max(values, default=0)


def groups_of(rows):
    """The Groups of these rows, in the order of the file."""
    by_stem, by_quantity = {}, {}
    for row in rows:
        stem, alpha = split_alpha(row.target.quantity)
        if alpha is None:
            by_quantity.setdefault((row.target.kind, row.target.quantity), []).append(row)
        else:
            by_stem.setdefault((row.target.kind, stem), []).append(row)
    groups = [alpha_group(stem, members) for (_, stem), members in by_stem.items()]
    for kind in dict.fromkeys(kind for kind, _ in by_quantity):
        groups += similar_groups([members for (other, _), members in by_quantity.items() if other == kind])
    return sorted(groups, key=lambda group: rows.index(group.rows[0]))


def alpha_group(stem, rows):
    nominals = {row.target.nominal for row in rows}
    several = len(nominals) > 1 and all(0 < nominal < 1 for nominal in nominals)
    return Group(stem if several else "", tuple(rows), True) if several else plain_group(rows)


def plain_group(rows):
    quantities = {row.target.quantity for row in rows}
    return Group(quantities.pop() if len(quantities) == 1 else "", tuple(rows), False)


def similar_groups(quantities):
    """Each quantity's rows stay together; quantities join as long as the largest is at most ten times the smallest."""
    groups, smallest = [], 0
    for rows in sorted(quantities, key=size_of):
        size = size_of(rows)
        if not groups or size > SIMILAR_RATIO * smallest > 0:
            groups.append([])
            smallest = size
        smallest = smallest or size  # zeros fit with anything
        groups[-1].append(rows)
    return [plain_group([row for rows in members for row in rows]) for members in groups]


def varying(rows, but=""):
    """Names of the conditions that tell these rows apart (one that some rows lack does too), `but` one.

    A condition that `but` already determines, such as the same noise in other units, tells nothing more.
    """
    names = dict.fromkeys(name for row in rows for name in row.conditions if name != but)
    return [name for name in names if
            len({(row.conditions.get(but) if but else 0, row.conditions.get(name)) for row in rows}) >
            len({row.conditions.get(but) if but else 0 for row in rows})]


def fixed(rows, but=()):
    """'num points = 8, scene = cube': the conditions that all rows share, except those in `but`."""
    first = rows[0].conditions if rows else {}
    return [style.level_in_words(name, level) for name, level in first.items() if name not in but and
            all(row.conditions.get(name) == level for row in rows)]


def in_words(conditions, names):
    return ", ".join(style.level_in_words(name, conditions[name]) for name in names if name in conditions)
