#!/usr/bin/python3
"""How often a search finds regions that were planted, with how many calls, and what it finds where there is nothing.

usage: planted_search.py OUT [REPETITIONS]

Writes OUT/planted_search.csv. A region counts as found if it is reported as a find (its interval of fresh trials lies above
the claim) and the event's true rate there is at least half of that in the planted region; as a false find if the true rate
is not above the claim. Random draws and a grid get as many calls; their events are tried again in the same race, and their
worst draws get the fresh trials.
"""

import csv
import sys
from pathlib import Path

import numpy as np

from planted_regions import NAMES, NUMBERS, WORDS, PlantedRegion, cases
from worst_search.intervals import simultaneous_rate
from worst_search.objective import Counts
from worst_search.search import Evidence, Plan, explore, find_worst, race, worst_draws
from worst_search.space import Table

BUDGETS = {"search": (1500, 5000), "random": (5000,), "grid": (5000,)}
SMALL = {"num_regions": 1, "num_fresh": 100, "num_raced": 60}  # of the small budget
NUM_CHECKED = 2000  # draws of a region that say what its true rate is


def grid_pool(rng):
    """All combinations of two levels of each factor, in random order."""
    number = 2 ** (len(NUMBERS) + len(WORDS))
    bits = (np.arange(number)[:, None] >> np.arange(len(NUMBERS) + len(WORDS))) & 1
    columns = {key: 0.25 + 0.5 * bits[:, j] for j, key in enumerate(NUMBERS)}
    for j, key in enumerate(WORDS):
        columns[key] = np.array(rng.permutation(NAMES)[:2], dtype=object)[bits[:, len(NUMBERS) + j]]
    return Table(columns, number).take(rng.permutation(number))


def worst_points(objective, plan):
    """[(true rate, whether it is a find, where)]: draws as they come, the worst tried again, the best of these with fresh trials."""
    evidence = Evidence(objective.space.pool.size)
    spare = plan.num_raced * 5 + plan.num_regions * plan.num_fresh
    explore(objective, plan, evidence, min(plan.budget - spare, objective.space.pool.size), 0)
    race(objective, plan, evidence, 0)
    draws = worst_draws(plan, evidence)[:plan.num_regions]
    found = []
    for draw in draws:
        rate = float(objective.rates(objective.space.pool.take(np.array([draw])))[0])
        events = int(np.random.default_rng([plan.seed, draw]).binomial(plan.num_fresh, rate))
        objective.calls += plan.num_fresh
        interval = simultaneous_rate(Counts(events, plan.num_fresh), len(draws))
        where = objective.space.pool.take(np.array([draw]))
        found.append((rate, interval.lower > plan.claim, where))
    return found


def regions_of(objective, plan):
    """The same of regions, with draws of each."""
    found = []
    for region in find_worst(objective, plan):
        calls = objective.calls
        table = objective.try_box("check", region.box, NUM_CHECKED).table
        objective.calls = calls
        found.append((float(objective.rates(table).mean()), region.is_find, table))
    return found


def one_search(name, method, budget, repetition):
    """(calls, planted regions, of these found, false finds)."""
    boxes, slope = cases(np.random.default_rng([7, repetition]))[name]
    objective = PlantedRegion(boxes, repetition + 1, slope=slope)
    plan = Plan(budget=budget, seed=repetition + 1, method="search" if method == "search" else "random",
                num_batches=6 if method == "search" else 1, **({} if budget > 2000 else SMALL))
    if method == "grid":
        objective.space.pool = grid_pool(np.random.default_rng([9, repetition]))
    found = (regions_of if method == "search" else worst_points)(objective, plan)
    near = set()
    for rate, is_find, table in found:
        if is_find and rate >= 0.5 * objective.inside:
            near.add(int(np.argmin([np.median(np.minimum(objective.distance(box, table), 9)) for box in boxes])))
    return objective.calls, len(boxes), len(near), sum(is_find and rate <= plan.claim for rate, is_find, _ in found)


def rows_of(repetitions):
    for name in cases(np.random.default_rng(0)):
        for method, budgets in BUDGETS.items():
            for budget in budgets:
                ends = np.array([one_search(name, method, budget, r) for r in range(repetitions)])
                yield {"planted": name, "method": method, "calls": round(float(ends[:, 0].mean())),
                       "searches": repetitions, "regions": int(ends[:, 1].sum()), "found": int(ends[:, 2].sum()),
                       "false_finds": int(ends[:, 3].sum())}


def main(arguments):
    out, repetitions = Path(arguments[0]), int(arguments[1]) if len(arguments) > 1 else 20
    with open(out / "planted_search.csv", "w", encoding="utf-8", newline="") as file:
        writer = None
        for row in rows_of(repetitions):
            writer = writer or csv.DictWriter(file, list(row), lineterminator="\n")
            if file.tell() == 0:
                writer.writeheader()
            writer.writerow(row)
            file.flush()


if __name__ == "__main__":
    main(sys.argv[1:])
