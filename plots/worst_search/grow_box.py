"""From one draw at which an estimator fails to the box of draws around it at which it fails as well."""

import math

import numpy as np

from worst_search.space import Box

CUT_NATS = 1.2  # of evidence against what lies beyond the end of a range
AXIS_DRAWS = 8  # of a key whose other keys are held
PEEL_Z = 2.3  # standard deviations by which a slice has to fail less often than the rest to be cut off


def point_box(space, levels, free):
    """All keys as at this draw but one. Keys that other words of the free one bring are free as well."""
    limits = {}
    for key in space.keys:
        level = levels[key]
        if key == free or not space.varies(key):
            continue
        if space.numeric[key]:
            if not np.isnan(level):
                limits[key] = (level, level)
        elif level != "-":
            limits[key] = frozenset([level])
    return Box.of(space, limits)


def evidence(events, trials, inside, outside):
    """Log likelihood ratio of each draw for the rate inside of the box against that outside."""
    return events * math.log(inside / outside) + (trials - events) * math.log((1 - inside) / (1 - outside))


def range_around(space, key, level, tried, inside, outside, is_widening=False):
    """The numbers of a key around `level` for which the trials speak; up to half way to the first beyond, or
    only as far as trials reach."""
    at = float(space.share_below(key, level))
    shares = space.share_below(key, np.nan_to_num(tried.table.columns[key]))
    there = ~np.isnan(tried.table.columns[key]) & (tried.trials > 0)
    gain = evidence(tried.events, tried.trials, inside, outside)
    ends = []
    for is_beyond, sign in ((shares < at, -1), (shares >= at, 1)):
        side = np.flatnonzero(there & is_beyond)
        side = side[np.argsort(sign * shares[side], kind="stable")]
        total = np.concatenate(([0.0], np.cumsum(gain[side])))
        best = int(len(total) - 1 - np.argmax(total[::-1]))  # of equal ones the farthest
        if total[best] - total[-1] < CUT_NATS:
            ends.append(0.0 if sign < 0 else 1.0)
            continue
        last = at if best == 0 else float(shares[side[best - 1]])
        ends.append(last if is_widening else (last + float(shares[side[best]])) / 2)
    lower, upper = space.value_at(key, ends[0]), space.value_at(key, ends[1])
    return min(lower, level), max(upper, level)


def words_around(space, key, level, tried, inside, outside):
    """The words of a key for which the trials speak, or do not speak against."""
    gain = evidence(tried.events, tried.trials, inside, outside)
    column = tried.table.columns[key]
    return frozenset(word for word in space.words[key]
                     if word == level or float(gain[column == word].sum()) >= 0.0)


def widen(objective, name, box, around, inside, outside):
    """Lets one limited key after the other free within the box `around`, and takes back what the trials do not speak
    against."""
    space, limits = objective.space, dict(box.limits)
    for key, limit in box.limits:
        free = Box.of(space, {k: v for k, v in limits.items() if k != key}).meet(space, around)
        tried = objective.try_box(f"{name}_{key}", free, 2 * AXIS_DRAWS)
        if isinstance(limit, frozenset):
            limits[key] = limit | words_around(space, key, None, tried, inside, outside)
        else:
            ends = [range_around(space, key, end, tried, inside, outside, True) for end in limit]
            limits[key] = min(limit[0], ends[0][0]), max(limit[1], ends[1][1])
    return Box.of(space, limits).meet(space, around)


def first_box(objective, name, levels, around, inside, outside):
    """Varies one key after the other within the box `around`, which holds this draw."""
    space, limits = objective.space, {}
    for key in space.keys:
        level = levels[key]
        is_absent = np.isnan(level) if space.numeric[key] else level == "-"
        if is_absent or not space.varies(key):
            continue
        number = AXIS_DRAWS if space.numeric[key] else max(AXIS_DRAWS, 2 * len(space.words[key]))
        tried = objective.try_box(f"{name}_{key}", point_box(space, levels, key).meet(space, around), number)
        find = range_around if space.numeric[key] else words_around
        limits[key] = find(space, key, level, tried, inside, outside)
    return Box.of(space, limits).meet(space, around)


def slices(space, box, tried):
    """(key, limit that remains, draws that go): a tenth, a fifth or a third of the draws at either end of a number's
    range, or one word."""
    limits = dict(box.limits)
    for key in space.keys:
        column = tried.table.columns[key]
        if space.numeric[key]:
            there = np.flatnonzero(~np.isnan(column))
            if len(there) < 10 or column[there].min() == column[there].max():
                continue
            order = there[np.argsort(column[there], kind="stable")]
            lower, upper = limits.get(key, (space.sorted[key][0], space.sorted[key][-1]))
            for share in (0.1, 0.2, 0.35, 0.5):
                size = max(1, round(share * len(order)))
                cut = (column[order[size - 1]] + column[order[size]]) / 2
                yield key, (cut, upper), np.isin(np.arange(len(column)), there) & (column < cut)
                cut = (column[order[-size]] + column[order[-size - 1]]) / 2
                yield key, (lower, cut), np.isin(np.arange(len(column)), there) & (column > cut)
        else:
            words = set(column) - {"-"}
            for word in sorted(words) if len(words) > 1 else []:
                yield key, frozenset(limits.get(key, frozenset(space.words[key]))) - {word}, column == word


def fails_less(tried, gone, kept):
    """Standard deviations by which the rate of the draws that go is below that of the others."""
    (e1, n1), (e2, n2) = ((tried.events[rows].sum(), tried.trials[rows].sum()) for rows in (gone, kept))
    if n1 == 0 or n2 == 0:
        return -math.inf
    pooled = (e1 + e2 + 1) / (n1 + n2 + 2)
    return float((e2 / n2 - e1 / n1) / math.sqrt(pooled * (1 - pooled) * (1 / n1 + 1 / n2)))


def peel(space, box, tried, least_share, least_z=PEEL_Z):
    """Cuts off the slice that fails least often, as long as it is `least_z` standard deviations below the rest (PRIM, with
    a test in place of a fixed share) and the box keeps `least_share` of the population. Returns the box and the draws in it."""
    inside = np.ones(tried.table.size, dtype=bool)
    while True:
        best = (least_z, None, None, None)
        for key, limit, gone in slices(space, box, tried.subset(inside)):
            rows = np.flatnonzero(inside)[gone]
            out = np.zeros_like(inside)
            out[rows] = True
            z = fails_less(tried, out, inside & ~out)
            if z > best[0]:
                smaller = Box.of(space, {**dict(box.limits), key: limit})
                if smaller.share(space.pool) >= least_share:
                    best = (z, smaller, out, key)
        if best[1] is None:
            return box, tried.subset(inside)
        box, inside = best[1], inside & ~best[2]
