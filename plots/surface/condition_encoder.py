"""Conditions as numbers that a model can take: features of their levels, in groups.

A group is what a reader asks about as one thing: a factor by itself, or a choice (scene, noise, ...) with the keys that only
some of its words bring. Features are orthogonal under the population, so that a sum over them splits a surface into main
effects and interactions (functional ANOVA).
"""

import dataclasses

import numpy as np
from numpy.polynomial import legendre

from common.number_text import parse_number

ABSENT = "-"
DEGREES, NESTED_DEGREES = 8, 3  # of the polynomials of a number; of one that few conditions have
FEW_LEVELS = 12  # a number with so many levels is not spread evenly over its range


@dataclasses.dataclass
class Column:
    """One factor. `words`: the levels of a choice; None: a number, of which `low` and `high` are the ends, in the logarithm
    where `is_log`. `owner`: the choice that brings it, None for a factor by itself."""
    name: str
    words: list = None
    shares: np.ndarray = None  # of the words, among the conditions that have the factor
    low: float = 0.0
    high: float = 1.0
    is_log: bool = False
    degrees: int = 1
    mixing: np.ndarray = None  # of the polynomials of a number with few levels: makes them orthogonal
    presence: float = 1.0  # share of the conditions that have the factor
    owner: str = None


@dataclasses.dataclass
class Block:
    """Columns of the feature matrix that share one variance."""
    group: str
    columns: np.ndarray  # of the feature matrix
    is_nested: bool


class ConditionEncoder:
    """`fit(levels)` learns the factors from a table of levels (texts, a row a condition, "-": absent); `encode(levels)`
    gives the features, conditions x features. Factors with one level are left out."""

    def fit(self, levels, scales=None, owners=None):
        """`scales`: {factor: "log" or "linear", or (that, low, high)} where it is known; else what makes the levels more
        evenly spread. `owners`: {factor: choice that brings it}; else found from where the factor is absent."""
        names = [name for name in levels.columns if levels[name].nunique() > 1]
        owners = {name: (owners or {}).get(name) or self._find_owner(levels, names, name) for name in names}
        self.columns = [describe_column(levels[name], owners[name], (scales or {}).get(name)) for name in names]
        self._lay_out()
        return self

    @property
    def groups(self):
        """Their names, in the order of the factors."""
        return list(dict.fromkeys(block.group for block in self.blocks))

    def members(self, group):
        """The factors of a group, the one that it is named after first."""
        return [column.name for column in self.columns if (column.owner or column.name) == group]

    def columns_of(self, group):
        """Places of a group's features in the feature matrix."""
        return np.concatenate([block.columns for block in self.blocks if block.group == group])

    def encode(self, levels):
        return np.hstack([features_of(column, levels[column.name]) for column in self._ordered] or
                         [np.zeros((len(levels), 0))])

    def positions(self, name, levels):
        """Of a number: where its levels lie in its range, 0..1; NaN where absent."""
        column = next(column for column in self.columns if column.name == name)
        return position_in(column, levels)

    @staticmethod
    def _find_owner(levels, names, name):
        """A factor that at least half of the conditions do not have belongs to the choice whose words best say where it is:
        most of the conditions with such a word have it."""
        has_factor = is_there(levels[name])
        if has_factor.mean() > 0.5:
            return None
        shares = {}
        for choice in names:
            if choice == name or are_numbers(levels[choice]) or (levels[choice] == ABSENT).mean() >= 0.5:
                continue
            has_word = levels[choice].isin(set(levels[choice][has_factor]))
            shares[choice] = has_factor.sum() / has_word.sum()
        best = max(shares, key=shares.get, default=None)  # of equals the first
        return best if best is not None and shares[best] > 0.5 else None

    def _lay_out(self):
        """Blocks side by side: a choice's words, then the keys that it brings."""
        self._ordered, self.blocks, self.degrees, self.highest = [], [], [], []
        place = 0
        for head in (column for column in self.columns if column.owner is None):
            nested = [column for column in self.columns if column.owner == head.name]
            for members, is_nested in (([head], False), (nested, True)):
                begin = place
                for column in members:
                    degrees = degrees_of(column)
                    self._ordered.append(column)
                    self.degrees += degrees
                    self.highest += [max(degrees) if column.words is None else 1] * len(degrees)
                    place += len(degrees)
                if place > begin:
                    self.blocks.append(Block(head.name, np.arange(begin, place), is_nested))
        self.degrees, self.highest = np.array(self.degrees, int), np.array(self.highest, int)


def are_numbers(levels):
    """Whether all levels that are there are numbers, or so many that the words stand for having none (parallax_deg: none)."""
    distinct = [level for level in set(levels) if level != ABSENT]
    num_numbers = sum(not np.isnan(parse_number(level)) for level in distinct)
    return num_numbers == len(distinct) or num_numbers > FEW_LEVELS


def is_there(levels):
    """Which conditions have the factor."""
    if are_numbers(levels):
        return np.array([not np.isnan(parse_number(level)) for level in levels], bool)
    return (levels != ABSENT).to_numpy()


def describe_column(levels, owner, scale):
    """The Column of one factor."""
    there = levels[is_there(levels)]
    column = Column(levels.name, owner=owner, presence=len(there) / len(levels))
    if not are_numbers(levels) or there.nunique() < 2:
        counts = there.value_counts(sort=False)
        column.words, column.shares = list(counts.index), counts.to_numpy() / len(there)
        return column
    numbers = there.astype(float).to_numpy()
    kind, column.low, column.high = scale if isinstance(scale, tuple) else (scale, numbers.min(), numbers.max())
    column.is_log = kind == "log" or kind is None and is_even_in_logarithm(numbers)
    if column.is_log:
        column.low, column.high = np.log(column.low), np.log(column.high)
    distinct = len(set(numbers))
    column.degrees = min(NESTED_DEGREES if owner else DEGREES, distinct - 1)
    if distinct <= FEW_LEVELS:
        basis = legendre.legvander(2 * position_in(column, there) - 1, column.degrees)
        column.mixing = np.linalg.inv(np.linalg.qr(basis)[1]) * np.sqrt(len(there))
    return column


def is_even_in_logarithm(numbers):
    """Whether they are closer to an even spread in their logarithm than as they are (Kolmogorov's distance)."""
    if numbers.min() <= 0 or len(set(numbers)) < 4:
        return False

    def distance(values):
        values = np.sort((values - values.min()) / np.ptp(values))
        return np.abs(values - (np.arange(len(values)) + 0.5) / len(values)).max()
    return distance(np.log(numbers)) < distance(numbers)


def position_in(column, levels):
    """0..1 within the range of a number; levels outside of it count as its ends. NaN where absent."""
    numbers = np.array([parse_number(level) for level in levels])
    with np.errstate(divide="ignore", invalid="ignore"):
        numbers = np.log(numbers) if column.is_log else numbers
    return np.clip((numbers - column.low) / (column.high - column.low), 0, 1)


def degrees_of(column):
    """Of each feature of a column: the degree of its polynomial; 1 for words and for 'absent'."""
    degrees = [1] * len(column.words) if column.words is not None else list(range(1, column.degrees + 1))
    return degrees + [1] * has_indicator(column)


def has_indicator(column):
    """Whether the column says by itself that the factor is absent: where a choice does not say it."""
    return column.owner is None and column.presence < 1


def features_of(column, levels):
    """Conditions x features, with a mean square of about one among the conditions that have the factor; 0 where absent."""
    if column.words is not None:
        has_factor = (levels != ABSENT).to_numpy()
        hot = np.array([[level == word for word in column.words] for level in levels], float)
        features = (hot - column.shares) / np.sqrt(max(1 - np.sum(column.shares**2), 1e-9))
    else:
        positions = position_in(column, levels)
        has_factor = ~np.isnan(positions)
        positions = np.where(has_factor, positions, 0.5)
        basis = legendre.legvander(2 * positions - 1, column.degrees)
        mixing = np.diag(np.sqrt(2 * np.arange(column.degrees + 1) + 1)) if column.mixing is None else column.mixing
        features = (basis @ mixing)[:, 1:]
    features = features.reshape(len(levels), -1) * has_factor[:, None]
    if has_indicator(column):
        share = column.presence
        indicator = ((~has_factor) - (1 - share)) / np.sqrt(share * (1 - share))
        features = np.column_stack([features, indicator])
    return features
