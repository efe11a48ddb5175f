"""The search: try draws where the event may be frequent, take the best of them again, and grow a box around each.

Its own rates are the largest of many, so they are too high; nothing of them is reported. Fresh trials of each box are.
"""

import dataclasses

import numpy as np

from common.plot_error import PlotError
from worst_search.grow_box import AXIS_DRAWS, first_box, peel, widen
from worst_search.intervals import clopper_pearson, simultaneous_rate
from worst_search.objective import Tried
from worst_search.space import Box, overlap
from worst_search.surrogate import Surrogate, choose_promising

MIN_EVENTS = 4  # in a look into a box; with fewer it is given up
# Where the event is frequent, the draws tried so far say more than a walk from one of them: from this many events on, a
# box is cut from all of them, to no less than this share of the population. Each cut is the best of hundreds, so that it
# has to be this many standard deviations clear.
MIN_CARVED, LEAST_CARVED, CARVE_Z = 200, 0.01, 4.0
MAX_CYCLES, LEAST_EXPLORED = 6, 200  # exploring, racing and growing again with what is left
INTERVALS_OF_REGION = 2  # its rate and its share of the population, which all hold together
NUM_LOOKED_AT = 3000  # draws of which the surrogate says which to try


@dataclasses.dataclass
class Plan:
    """What a search may spend, in trials, and what it looks for."""
    budget: int
    num_regions: int = 3
    claim: float = 0.1  # a region is a find if its fresh rate is above
    num_fresh: int = 200  # trials of each region
    share_guided: float = 0.5  # of the draws: chosen by the surrogate; the others are the next of the population
    num_batches: int = 6
    num_raced: int = 120  # draws that are tried again
    box_draws: int = 80  # of each look into a box
    num_looks: int = 3
    least_share: float = 2e-4  # of the population, that a box keeps
    most_overlap: float = 0.2
    seed: int = 1
    method: str = "search"  # or random: every draw is the next of the population


@dataclasses.dataclass
class Region:
    box: Box
    seed_draw: int  # of the pool
    search_rate: float  # of the last look into the box: only to choose by
    name: str = ""  # of the request for its fresh trials
    rate: object = None  # intervals.Rate, of fresh trials
    fresh: object = None  # objective.Counts
    is_find: bool = False  # the interval lies above the claim


class Evidence:
    """Events and trials at every draw of the pool."""

    def __init__(self, size):
        self.events, self.trials = np.zeros(size), np.zeros(size)
        self.asked = np.zeros(size, dtype=int)  # trials of each draw, also those that do not count

    @property
    def tried(self):
        return self.asked > 0

    def add(self, numbers, tried, asked):
        np.add.at(self.events, numbers, tried.events)
        np.add.at(self.trials, numbers, tried.trials)
        self.asked[numbers] = asked


def region_cost(objective, plan):
    """The most trials that growing one box takes."""
    space = objective.space
    present = np.mean([[not (np.isnan(c[i]) if space.numeric[k] else c[i] == "-") for k, c in space.pool.columns.items()
                        if space.varies(k)] for i in range(min(50, space.pool.size))], axis=0)
    axes = sum(share * (8 if space.numeric[k] else max(8, 2 * len(space.words[k])))
               for share, k in zip(present, filter(space.varies, space.pool.columns)))
    return int(axes) + plan.num_looks * plan.box_draws + (plan.num_looks - 1) * 12 * AXIS_DRAWS


def spent_by(objective, plan):
    """(trials for exploration, for boxes and races, fresh ones)."""
    fresh = plan.num_regions * plan.num_fresh
    growing = (plan.num_regions + 1) * region_cost(objective, plan) + plan.num_raced * 5
    exploring = min(max(plan.budget - fresh - growing, plan.budget // 4), objective.space.pool.size)
    return exploring, max(0, plan.budget - fresh - exploring), fresh


def explore(objective, plan, evidence, number, cycle):
    space = objective.space
    features = space.encode(space.pool) if plan.method == "search" else None
    rng = np.random.default_rng([plan.seed, cycle])
    size = -(-number // plan.num_batches)
    following = 0
    for batch in range(plan.num_batches):
        if evidence.tried.all():
            return
        is_first = cycle == 0 and batch == 0
        guided = 0 if is_first or plan.method != "search" else int(plan.share_guided * size)
        chosen = []
        if guided and 0 < evidence.events.sum() < evidence.trials.sum():
            surrogate = Surrogate(features[evidence.tried], evidence.events[evidence.tried],
                                  evidence.trials[evidence.tried], plan.seed)
            free = np.flatnonzero(~evidence.tried)
            looked_at = np.sort(rng.permutation(free)[:NUM_LOOKED_AT])
            rates = surrogate.tree_rates(features[looked_at])
            chosen = [int(looked_at[i]) for i in choose_promising(rates, guided, rng)]
        is_taken = evidence.tried
        is_taken[chosen] = True
        while len(chosen) < size and following < space.pool.size:
            if not is_taken[following]:
                chosen.append(following)
            following += 1
        if not chosen:
            return
        numbers = np.array(sorted(chosen))
        evidence.add(numbers, objective.try_draws(f"explore_{cycle}_{batch}", numbers, 1), 1)


def posterior(objective, plan, evidence):
    """A rate at every tried draw: its own trials, with those of its neighbourhood as four more."""
    space, rate = objective.space, np.zeros(evidence.tried.size)
    tried = evidence.tried
    features = space.encode(space.pool.take(np.flatnonzero(tried)))
    around = Surrogate(features, evidence.events[tried], evidence.trials[tried], plan.seed + 1).rates(features)
    rate[tried] = (evidence.events[tried] + 4 * around) / (evidence.trials[tried] + 4)
    return rate


RACE = ((1.0, 3), (0.35, 6), (0.12, 14))  # the share of num_raced that goes on to this many trials


def race(objective, plan, evidence, cycle):
    """Tries the draws again that look worst, ever fewer of them: one event may be luck."""
    first = 1
    for lap, (share, trials) in enumerate(RACE):
        if not evidence.events.any():
            return
        rate = posterior(objective, plan, evidence)
        rate[(evidence.events == 0) | (evidence.asked != first)] = 0.0
        best = np.argsort(-rate, kind="stable")[:max(1, int(share * plan.num_raced))]
        best = np.sort(best[rate[best] > 0])
        if len(best) == 0:
            return
        evidence.add(best, objective.try_draws(f"race_{cycle}_{lap}", best, trials, first), trials)
        first = trials


def worst_draws(plan, evidence):
    """Raced draws at which the event is surely more frequent than the claim says, the worst first."""
    raced = np.flatnonzero(evidence.trials > 1)
    lower = np.array([clopper_pearson(int(evidence.events[i]), int(evidence.trials[i]), 0.9)[0] for i in raced])
    return [int(raced[i]) for i in np.argsort(-lower, kind="stable") if lower[i] > plan.claim]


def rates_apart(plan, inside):
    """(rate inside of a box, rate outside) between which its ends are sought."""
    inside = min(max(inside, 0.3), 0.9)
    return inside, min(0.5 * inside, max(0.2, plan.claim))


def box_beside(space, draw, evidence, regions):
    """The box beside the regions within which a draw's box may grow: of each region the side with the most events, so that
    the worst of what is left becomes a box of its own."""
    box, levels = Box(()), space.pool.row(draw)
    for region in regions:
        weights = np.where(region.box.contains(space.pool), -evidence.events, evidence.events)
        sides = list(region.box.sides(space, levels))
        if sides:  # none: the draw lies in the region
            box = box.meet(space, max(sides, key=lambda side: weights[side.contains(space.pool)].sum()))
    return box


def carve(objective, plan, name, draw, evidence, beside):
    """A region cut from the draws tried so far in the box `beside`; None if there are too few events."""
    space = objective.space
    rows = np.flatnonzero(evidence.tried & beside.contains(space.pool))
    if evidence.events[rows].sum() < MIN_CARVED:
        return None
    tried = Tried(space.pool.take(rows), evidence.events[rows], evidence.trials[rows], np.zeros(len(rows)))
    box, _ = peel(space, beside, tried, LEAST_CARVED, CARVE_Z)
    looked = objective.try_box(f"{name}_carved", box, plan.box_draws)
    rate = (looked.events.sum() + 1) / (looked.trials.sum() + 2)
    return Region(box.without_idle_ends(space), draw, rate) if rate > plan.claim else None


def grow(objective, plan, name, draw, evidence, beside):
    """A region grown from this draw within the box `beside`; None if the event is hardly more frequent there."""
    space = objective.space
    inside, outside = rates_apart(plan, (evidence.events[draw] + 1) / (evidence.trials[draw] + 2))
    box = first_box(objective, f"{name}_axis", space.pool.row(draw), beside, inside, outside)
    for look in range(plan.num_looks):
        tried = objective.try_box(f"{name}_look_{look}", box, plan.box_draws)
        if tried.events.sum() < MIN_EVENTS:
            return None
        box, kept = peel(space, box, tried, plan.least_share)
        rate = (kept.events.sum() + 1) / (kept.trials.sum() + 2)
        if look + 1 < plan.num_looks:
            box = widen(objective, f"{name}_wider_{look}", box, beside, *rates_apart(plan, rate))
    return Region(box.without_idle_ends(space), draw, rate) if rate > plan.claim else None


def next_draw(objective, plan, evidence, regions, given_up):
    """The worst draw in no region and, if there is one, in no neighbourhood of a region; None: there is none."""
    space = objective.space
    draws = np.array([draw for draw in worst_draws(plan, evidence) if draw not in given_up], dtype=int)
    table = space.pool.take(draws)
    for boxes in ([r.box.neighbourhood(space) for r in regions], [r.box for r in regions]):
        is_free = np.ones(len(draws), dtype=bool)
        for box in boxes:
            is_free &= ~box.contains(table)
        if is_free.any():
            return int(draws[np.argmax(is_free)])
    return None


def grow_regions(objective, plan, evidence, regions, given_up):
    """Adds boxes that hardly overlap with the others, until there is one more than is reported. `given_up`: draws around
    which there is none."""
    space = objective.space
    while len(regions) <= plan.num_regions and left_of(objective, plan) >= region_cost(objective, plan):
        draw = next_draw(objective, plan, evidence, regions, given_up)
        if draw is None:
            return
        name, beside = f"region_{draw}", box_beside(space, draw, evidence, regions)
        region = carve(objective, plan, name, draw, evidence, beside) or grow(objective, plan, name, draw, evidence, beside)
        given_up.add(draw)
        if region and all(overlap(region.box, other.box, space.pool) <= plan.most_overlap for other in regions):
            regions.append(region)


def left_of(objective, plan):
    """Trials that may be spent before the fresh ones."""
    return plan.budget - plan.num_regions * plan.num_fresh - objective.calls


def find_worst(objective, plan):
    """Regions, the worst first by their fresh trials."""
    evidence, regions, given_up = Evidence(objective.space.pool.size), [], set()
    exploring = spent_by(objective, plan)[0]
    for cycle in range(MAX_CYCLES):
        explore(objective, plan, evidence, exploring, cycle)
        if not evidence.trials.any():
            raise PlotError(f"none of the {objective.calls} trials so far counts: {objective.what_counts}")
        race(objective, plan, evidence, cycle)
        grow_regions(objective, plan, evidence, regions, given_up)
        exploring = left_of(objective, plan) // 2
        if exploring < LEAST_EXPLORED or len(regions) >= plan.num_regions:
            break
    regions.sort(key=lambda region: -region.search_rate)
    regions = regions[:plan.num_regions]
    for number, region in enumerate(regions):
        region.name = f"fresh_{number}"
        fresh = objective.try_box(region.name, region.box, plan.num_fresh)
        region.fresh = fresh.total(objective.is_difference)
        region.rate = simultaneous_rate(region.fresh, INTERVALS_OF_REGION * len(regions))
        region.is_find = region.rate.lower > plan.claim
    return sorted(regions, key=lambda region: -region.rate.lower)
