"""Functions with known regions in which an event is frequent, in place of an estimator: twelve factors, ten numbers and two
words of five, uniform and independent."""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "plots"))

from worst_search.objective import Objective, Tried
from worst_search.space import Space, Table

NUMBERS = [f"x{i}" for i in range(10)]
WORDS = ["a", "b"]
NAMES = ["one", "two", "three", "four", "five"]
POOL = 20_000


def uniform_draws(number, rng):
    columns = {key: rng.random(number) for key in NUMBERS}
    columns.update({key: rng.choice(np.array(NAMES, dtype=object), number) for key in WORDS})
    return Table(columns, number)


class PlantedRegion(Objective):
    """The event has rate `outside`, and `inside` in the union of the boxes; around one with `slope` it decays with the
    distance over `slope`, in units of the numbers' ranges."""

    def __init__(self, boxes, seed, inside=0.9, outside=0.02, slope=0.0, pool_size=POOL):
        self.boxes, self.seed, self.inside, self.outside, self.slope = boxes, seed, inside, outside, slope
        pool = uniform_draws(pool_size, np.random.default_rng([seed, 100]))
        rows = [[repr(pool.columns[k][i]) if k in NUMBERS else pool.columns[k][i] for k in NUMBERS + WORDS]
                for i in range(pool_size)]
        self.space, self.calls = Space(NUMBERS + WORDS, rows), 0

    def distance(self, box, table):
        """Zero inside; infinite where a word differs."""
        square = np.zeros(table.size)
        for key, limit in box.items():
            column = table.columns[key]
            if isinstance(limit, frozenset):
                square[~np.isin(column.astype(str), sorted(limit))] = np.inf
            else:
                square += np.maximum(0, np.maximum(limit[0] - column, column - limit[1])) ** 2
        return np.sqrt(square)

    def is_inside(self, table):
        return np.any([self.distance(box, table) == 0 for box in self.boxes], axis=0) if self.boxes else \
            np.zeros(table.size, dtype=bool)

    def rates(self, table):
        rates = np.full(table.size, self.outside)
        for box in self.boxes:
            distance = self.distance(box, table)
            near = np.exp(-distance / self.slope) if self.slope > 0 else (distance == 0).astype(float)
            rates = np.maximum(rates, self.inside * near)
        return rates

    def tried(self, name, table, trials):
        self.calls += table.size * trials
        rng = np.random.default_rng([self.seed, *name.encode()])
        events = rng.binomial(trials, self.rates(table))
        return Tried(table, events, np.full(table.size, trials), np.zeros(table.size, dtype=int))

    def try_draws(self, name, numbers, trials, first=0):
        return self.tried(name, self.space.pool.take(np.asarray(numbers)), trials - first)

    def try_box(self, name, box, number):
        rng = np.random.default_rng([self.seed, 200, *name.encode()])
        table = uniform_draws(number, rng)
        for key in NUMBERS:  # a Latin hypercube
            table.columns[key] = (rng.permutation(number) + table.columns[key]) / number
        for key, limit in box.limits:
            column = table.columns[key]
            if isinstance(limit, frozenset):
                table.columns[key] = rng.permutation(np.resize(np.array(sorted(limit), dtype=object), number))
            else:
                lower, upper = max(limit[0], 0.0), min(limit[1], 1.0)
                table.columns[key] = lower + (upper - lower) * column
        return self.tried(name, table, 1)


def cases(rng):
    """{name: (boxes, slope, levels a factor of the coarsest grid that surely has a point in it)}. Places are drawn."""
    def side(width):
        start = rng.random() * (1 - width)
        return (start, start + width)

    def word():
        return frozenset([NAMES[rng.integers(5)]])

    def box(numbers, width, words):
        chosen = rng.permutation(NUMBERS)[:numbers]
        return {**{k: side(width) for k in chosen}, **{k: word() for k in WORDS[:words]}}

    other = {"a": frozenset(["one"]), "b": frozenset(["two"]), "x0": side(0.15811), "x1": side(0.15811)}
    another = {"a": frozenset(["four"]), "b": frozenset(["five"]), "x2": side(0.15811), "x3": side(0.15811)}
    return {
        "box in 3 numbers": ([box(3, 0.1, 0)], 0.0),
        "box in 2 numbers and 2 words": ([box(2, 0.15811, 2)], 0.0),
        "box in 6 numbers": ([box(6, 0.31623, 0)], 0.0),
        "box in 10 numbers": ([box(10, 0.50119, 0)], 0.0),
        "slope around a box in 3 numbers": ([box(3, 0.1, 0)], 0.15),
        "two boxes in 2 numbers and 2 words": ([other, another], 0.0),
        "nothing": ([], 0.0),
    }
