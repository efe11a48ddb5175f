"""Draws of a population as columns, as numbers for a model, and the boxes of levels that regions are."""

import dataclasses

import numpy as np

from common.number_text import is_number

ABSENT = "-"  # the level of a key that a draw does not have
IDLE_SHARE = 0.01  # of the draws with a key


def mostly_numbers(levels):
    """A key may be a number but for a word with some scenes, as parallax_deg: none."""
    there = levels[levels != ABSENT]
    return len(there) > 0 and np.mean([is_number(level) for level in there]) >= 0.8


class Table:
    """Draws by column: numbers as floats with NaN where the draw has none, words as text with ABSENT."""

    def __init__(self, columns, size):
        self.columns, self.size = columns, size

    def row(self, i):
        return {key: column[i] for key, column in self.columns.items()}

    def take(self, rows):
        return Table({key: column[rows] for key, column in self.columns.items()}, len(rows))


class Space:
    """What the keys of a population are, learned from a large pool of its draws."""

    def __init__(self, keys, rows):
        """`rows`: the levels of each draw as texts, in the order of `keys`."""
        self.keys = list(keys)
        texts = np.array(rows, dtype=object).reshape(len(rows), len(self.keys))
        self.numeric = {key: mostly_numbers(texts[:, j]) for j, key in enumerate(self.keys)}
        self.pool = self.table(rows)
        self.is_whole = {key: self.numeric[key] and bool(np.all(np.isnan(c) | (c == np.round(c))))
                         for key, c in self.pool.columns.items()}
        self.sorted = {key: np.sort(column[~np.isnan(column)]) for key, column in self.pool.columns.items()
                       if self.numeric[key]}
        self.words = {key: sorted(set(self.pool.columns[key]) - {ABSENT}) for key in self.keys if not self.numeric[key]}

    def table(self, rows):
        texts = np.array(rows, dtype=object).reshape(len(rows), len(self.keys))
        columns = {}
        for j, key in enumerate(self.keys):
            if self.numeric[key]:
                columns[key] = np.array([float(t) if is_number(t) else np.nan for t in texts[:, j]])
            else:
                columns[key] = texts[:, j]
        return Table(columns, len(rows))

    def share_below(self, key, values):
        """The share of the population's draws with this key whose number is less, ties counted half: within [0, 1]."""
        known = self.sorted[key]
        return (np.searchsorted(known, values, "left") + np.searchsorted(known, values, "right")) / (2 * len(known))

    def value_at(self, key, share):
        """The inverse of share_below, between the numbers of the pool."""
        known = self.sorted[key]
        return float(f"{np.interp(share * len(known) - 0.5, np.arange(len(known)), known):.6g}")  # as levels are written

    def varies(self, key):
        return len(self.words[key]) > 1 if not self.numeric[key] else self.sorted[key][0] < self.sorted[key][-1]

    def encode(self, table):
        """(draws, features): numbers by their share below, -0.2 where absent; a column of 0 and 1 for each word."""
        features = []
        for key in self.keys:
            column = table.columns[key]
            if not self.varies(key) and not np.any(self.pool.columns[key] == ABSENT):
                continue
            if self.numeric[key]:
                features.append(np.where(np.isnan(column), -0.2, self.share_below(key, np.nan_to_num(column))))
            else:
                features.extend((column == word).astype(float) for word in self.words[key])
        return np.array(features, dtype=np.float32).T.reshape(table.size, -1)


@dataclasses.dataclass(frozen=True)
class Box:
    """Draws whose numbers lie in ranges (both ends belong) and whose words are among some; a draw without a key is not
    restricted by it."""
    limits: tuple  # of (key, (from, to) or a frozenset of words), in the order of the space's keys

    @staticmethod
    def of(space, limits):
        """Without the limits that every draw of the population meets; ends that all of them meet are infinite."""
        kept = []
        for key in space.keys:
            limit = limits.get(key)
            if limit is None or (isinstance(limit, frozenset) and limit >= set(space.words[key])):
                continue
            if not isinstance(limit, frozenset) and limit[0] < limit[1]:
                least, most = space.sorted[key][[0, -1]]
                limit = (-np.inf if limit[0] <= least else limit[0], np.inf if limit[1] >= most else limit[1])
                if np.isinf(limit).all():
                    continue
            kept.append((key, limit))
        return Box(tuple(kept))

    def contains(self, table):
        inside = np.ones(table.size, dtype=bool)
        for key, limit in self.limits:
            column = table.columns[key]
            if isinstance(limit, frozenset):
                inside &= np.isin(column.astype(str), sorted(limit) + [ABSENT])
            else:
                inside &= np.isnan(column) | ((column >= limit[0]) & (column <= limit[1]))
        return inside

    def neighbourhood(self, space):
        """With half of its width more at both ends of every range, by shares of the population, and with all words of a key
        if it has most of them."""
        limits = dict(self.limits)
        for key, limit in self.limits:
            if isinstance(limit, frozenset):
                if 2 * len(limit) > len(space.words[key]):
                    del limits[key]
            else:
                lower, upper = (float(space.share_below(key, end)) for end in limit)
                more = (upper - lower) / 2
                limits[key] = (min(limit[0], space.value_at(key, lower - more)), max(limit[1], space.value_at(key, upper + more)))
        return Box.of(space, limits)

    def without_idle_ends(self, space):
        """Without the ends of ranges beyond which hardly any draw lies."""
        limits = dict(self.limits)
        for key, limit in self.limits:
            if not isinstance(limit, frozenset):
                below, beyond = (float(space.share_below(key, end)) for end in limit)
                limits[key] = (-np.inf if below < IDLE_SHARE else limit[0], np.inf if beyond > 1 - IDLE_SHARE else limit[1])
        return Box.of(space, limits)

    def meet(self, space, other):
        """The draws in both, which hold at least one."""
        limits = dict(self.limits)
        for key, limit in other.limits:
            if key not in limits:
                limits[key] = limit
            elif isinstance(limit, frozenset):
                limits[key] = limits[key] & limit
            else:
                limits[key] = max(limits[key][0], limit[0]), min(limits[key][1], limit[1])
        return Box.of(space, limits)

    def share(self, table):
        return float(self.contains(table).mean())

    def sides(self, space, levels):
        """Boxes around a draw outside of this one, each beyond one of its limits. Draws without that key lie in both."""
        for key, limit in self.limits:
            level, known = levels[key], space.sorted.get(key)
            if isinstance(limit, frozenset):
                if level != ABSENT and level not in limit:
                    yield Box.of(space, {key: frozenset(space.words[key]) - limit})
            elif level < limit[0]:
                yield Box(((key, (-np.inf, known[np.searchsorted(known, limit[0], "left") - 1])),))
            elif level > limit[1]:
                yield Box(((key, (known[np.searchsorted(known, limit[1], "right")], np.inf)),))


def overlap(one, other, pool):
    """The draws in both boxes, as a share of those in the smaller one."""
    a, b = one.contains(pool), other.contains(pool)
    return float((a & b).sum() / max(1, min(a.sum(), b.sum())))
