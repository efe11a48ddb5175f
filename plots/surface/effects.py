"""What a surface says of its factors: shares of the variance between conditions (Sobol indices), partial dependence, and maps
of two factors; all on the scale of the rate itself (or of the mean), with intervals from surfaces drawn from the posterior.

Conditions stand for their population: of each, some factors are exchanged for those of another. So factors count as independent
in the population, as its draws are.
"""

import itertools
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats
from scipy.special import expit

from surface.condition_encoder import is_there
from surface.condition_model import Exchange
from surface.cross_validation import NODE_WEIGHTS, NODES

NUM_SURFACES = 60
CONDITIONS_FOR_INDICES, CONDITIONS_FOR_CURVES = 160, 80
CONFIDENCE = 0.95  # of indices
BAND = 0.9  # of curves and maps
POINTS_OF_CURVE, POINTS_OF_MAP = 25, 16
WIDEST_BAND = 0.3  # where a band of a map is wider, the model does not know
NEAR, LEAST_NEAR = 0.15, 2  # of a number's range; so many conditions have to be so near to a cell
ROWS_OF_WORD = 6  # conditions that stand for a word of a choice


@dataclass
class Effects:
    indices: pd.DataFrame  # a row a group, and one for what is each condition's own
    curves: pd.DataFrame  # group, level, position, rate, lower, upper
    maps: pd.DataFrame  # first, second, levels and positions, rate, lower, upper, num_near, is_known
    spread: float  # standard deviation of the rate between conditions


def measure_effects(data, model, progress=lambda: None, with_maps=True):
    random = np.random.default_rng(1)
    surfaces = model.draw_surfaces(NUM_SURFACES, random)
    progress()
    sample = data.levels[data.is_sample] if data.is_sample.any() else data.levels
    matters = {group: tested(data, model, group) for group in model.encoder.groups}
    progress()
    indices, spread = measure_indices(model, surfaces, sample, random, matters)
    progress()
    curves = measure_curves(model, surfaces, sample, random)
    progress()
    maps = measure_maps(model, surfaces, sample, random, data.levels, choose_pairs(model, sample, indices)) if with_maps else None
    progress()
    return Effects(indices, curves, maps, spread)


# ---- indices


def tested(data, model, group):
    """Whether the marginal likelihood falls, without a group, by more than chance allows for any of the groups (likelihood
    ratio, Bonferroni; on the edge of the variances' range the test is cautious)."""
    num_variances = sum(block.group == group for block in model.encoder.blocks)
    bound = 0.5 * stats.chi2.ppf(1 - 0.05 / len(model.encoder.groups), num_variances)
    return model.log_evidence_without(group) > bound and model.log_evidence_without(group, learn_again=True) > bound


def measure_indices(model, surfaces, sample, random, matters):
    """First-order and total share of each group in the variance between conditions, and the share of no factor. The lower end
    of an interval is 0 where the group may not matter at all."""
    features = model.encoder.encode(sample)
    rows, spreads = [], []
    for surface in surfaces:
        chosen = features[random.integers(len(features), size=CONDITIONS_FOR_INDICES)]
        others = features[random.integers(len(features), size=CONDITIONS_FOR_INDICES)]
        total, own = split_variance(surface, np.vstack([chosen, others]))
        spreads.append(np.sqrt(total))
        exchange = Exchange(surface, chosen)
        for group in model.encoder.groups:
            first, with_others = group_variances(exchange, model.encoder.columns_of(group), others)
            rows.append((group, first / total, with_others / total))
        rows.append((None, own / total, own / total))
    drawn = pd.DataFrame(rows, columns=["group", "first", "total"])
    table = []
    for group, part in drawn.groupby("group", sort=False, dropna=False):
        name = group if isinstance(group, str) else ""
        summary = [number for kind in ("first", "total") for number in summarise(part[kind])]
        if name and not matters[name]:
            summary[1] = summary[4] = 0.0
        table.append((name, " ".join(model.encoder.members(name)[1:]) if name else "", *summary, not name or matters[name]))
    columns = ["group", "with_keys", "first", "first_lower", "first_upper", "total", "total_lower", "total_upper", "matters"]
    return pd.DataFrame(table, columns=columns), float(np.median(spreads))


def summarise(values):
    tail = 0.5 - 0.5 * CONFIDENCE
    return np.clip([values.median(), values.quantile(tail), values.quantile(1 - tail)], 0, 1)


def split_variance(surface, features):
    """Variance of the rate between conditions, and the part of it that is their own."""
    f = surface.at(features)
    if not surface.has_counts:
        value = surface.center + surface.spread * f
        own = surface.spread**2 * surface.own
        return max(value.var(ddof=1) + own, 1e-15), own
    rates = expit(f[:, None] + np.sqrt(surface.own) * NODES)
    means = rates @ NODE_WEIGHTS
    own = np.mean(rates**2 @ NODE_WEIGHTS - means**2)
    return max(means.var(ddof=1) + own, 1e-15), own


def group_variances(exchange, columns, others):
    """First-order and total variance of a group: its features exchanged for those of every other condition. What the mean over
    finitely many conditions adds to the variance of that mean is taken off."""
    rates = exchange.surface.expected(exchange.exchanged(columns, others))
    total = rates.var(axis=1, ddof=1).mean()
    num = len(rates)
    first = (rates.mean(axis=0).var(ddof=1) - total / num) * num / (num - 1)
    return max(first, 0.0), total


# ---- curves and maps


def grid_of(model, group, sample, num_points, random):
    """Points of a group's axis: a table with level and position, and for each a list of rows of levels that stand for it."""
    column = next(column for column in model.encoder.columns if column.name == group)
    if column.words is not None:
        points = []
        for place, word in enumerate(column.words):
            there = np.flatnonzero((sample[group] == word).to_numpy())
            if len(there):
                rows = sample.iloc[random.permutation(there)[:ROWS_OF_WORD]]
                points.append((word, float(place), rows))
        return points
    has_factor = is_there(sample[group])
    distinct = sorted(set(sample[group][has_factor]), key=float)
    if len(distinct) > num_points:
        positions = (np.arange(num_points) + 0.5) / num_points
        numbers = column.low + positions * (column.high - column.low)
        distinct = [f"{number:.6g}" for number in (np.exp(numbers) if column.is_log else numbers)]
    template = sample.iloc[[int(np.flatnonzero(has_factor)[0])]]
    return [(level, float(model.encoder.positions(group, [level])[0]), template.assign(**{group: level}))
            for level in distinct]


def stacked(model, points):
    """Features of the rows of all points, and the matrix that averages over the rows of each (points x rows)."""
    features = model.encoder.encode(pd.concat([rows for _, _, rows in points], ignore_index=True))
    counts = [len(rows) for _, _, rows in points]
    average = np.zeros((len(points), sum(counts)))
    for point, (end, count) in enumerate(zip(np.cumsum(counts), counts)):
        average[point, end - count:end] = 1 / count
    return features, average


def band_of(values):
    """Mean and band over drawn surfaces, axis 0."""
    return values.mean(axis=0), *np.quantile(values, [0.5 - 0.5 * BAND, 0.5 + 0.5 * BAND], axis=0)


def measure_curves(model, surfaces, sample, random):
    """The mean rate of the population where every condition had that level of one group."""
    features, table = model.encoder.encode(sample), []
    exchanges = [Exchange(surface, features[random.integers(len(features), size=CONDITIONS_FOR_CURVES)])
                 for surface in surfaces]
    for group in model.encoder.groups:
        points = grid_of(model, group, sample, POINTS_OF_CURVE, random)
        others, average = stacked(model, points)
        curves = [average @ mean_where(exchange, model.encoder.columns_of(group), others) for exchange in exchanges]
        for (level, position, _), *numbers in zip(points, *band_of(np.array(curves))):
            table.append((group, level, position, *numbers))
    return pd.DataFrame(table, columns=["group", "level", "position", "rate", "lower", "upper"])


def mean_where(exchange, columns, others):
    """Mean rate of the conditions where all had the features of each row of `others` at these columns."""
    return exchange.surface.expected(exchange.exchanged(columns, others)).mean(axis=0)


def choose_pairs(model, sample, indices, most_groups=6, most_pairs=4):
    """Of the groups that matter most: the pairs that interact most on the scale of the rate, on the posterior mean."""
    matter = indices[(indices.group != "") & indices.matters].sort_values("total", ascending=False)
    groups, random, surface = list(matter.group[:most_groups]), np.random.default_rng(1), model.mean_surface()
    strength = {}
    for pair in itertools.combinations(groups, 2):
        rates, *_ = pair_rates(model, [surface], sample, random, pair, 8)
        rates = rates[0]
        strength[pair] = (rates - rates.mean(0) - rates.mean(1)[:, None] + rates.mean()).var()
    return sorted(strength, key=strength.get, reverse=True)[:most_pairs]


def pair_rates(model, surfaces, sample, random, pair, num_points):
    """Mean rates where two groups have certain levels: surfaces x points of the first x points of the second, and the points
    of both."""
    features = model.encoder.encode(sample)
    first, second = (grid_of(model, group, sample, num_points, random) for group in pair)
    (first_features, first_average), (second_features, second_average) = stacked(model, first), stacked(model, second)
    columns_1, columns_2 = (model.encoder.columns_of(group) for group in pair)
    both = np.repeat(first_features, len(second_features), axis=0)
    both[:, columns_2] = np.tile(second_features[:, columns_2], (len(first_features), 1))
    values = []
    for surface in surfaces:
        chosen = features[random.integers(len(features), size=CONDITIONS_FOR_CURVES)]
        rates = mean_where(Exchange(surface, chosen), np.concatenate([columns_1, columns_2]), both)
        values.append(first_average @ rates.reshape(len(first_features), -1) @ second_average.T)
    return np.array(values), first, second


def measure_maps(model, surfaces, sample, random, levels, pairs):
    table = []
    for pair in pairs:
        values, first, second = pair_rates(model, surfaces, sample, random, pair, POINTS_OF_MAP)
        rate, lower, upper = band_of(values)
        near = [[is_near(model, group, level, levels) for level, _, _ in points] for group, points in zip(pair, (first, second))]
        for i, j in itertools.product(range(len(first)), range(len(second))):
            num_near = int(np.sum(near[0][i] & near[1][j]))
            is_known = num_near >= LEAST_NEAR and upper[i, j] - lower[i, j] <= WIDEST_BAND
            table.append((*pair, first[i][0], second[j][0], first[i][1], second[j][1], rate[i, j], lower[i, j], upper[i, j],
                          num_near, is_known))
    return pd.DataFrame(table, columns=["first", "second", "first_level", "second_level", "first_position", "second_position",
                                        "rate", "lower", "upper", "num_near", "is_known"])


def is_near(model, group, level, levels):
    """Which conditions are near to a level: the same word, or a number within NEAR of the range."""
    column = next(column for column in model.encoder.columns if column.name == group)
    if column.words is not None:
        return (levels[group] == level).to_numpy()
    position = model.encoder.positions(group, [level])[0]
    with np.errstate(invalid="ignore"):
        return np.abs(model.encoder.positions(group, levels[group]) - position) <= NEAR
