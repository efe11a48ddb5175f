"""Reads tune.json, which `rcme tune` writes, and transfer.json, of `rcme transfer`. It checks and names; it computes
nothing.

    tune.json: format, study, estimator, seed, target, options, settings, tuned, others, roc
    transfer.json: format, study, estimator, seed, target, options, families, cells
    rate: value, lower, upper, n; a null value: n is 0
Keys that are not drawn are not looked at. Levels are texts, in the order of the options.
"""

import itertools
import math
from dataclasses import dataclass

from common import style
from common.number_text import is_number
from common.json_file import is_finite, read_object
from common.number_text import number_text

TUNING, TRANSFER = ("rcme tune", "rcme tuning 1"), ("rcme transfer", "rcme transfer 1")  # command, format
FALSE_REFUSAL, VIOLATED, UNDECIDED = "false_refusal", "does not hold", "undecided"
TARGETS = (FALSE_REFUSAL, "failure", "accepted_failure", "risk")
VERDICTS = ("holds", VIOLATED, UNDECIDED)
SETTING_RATES = ("failure", "refusal", "false_refusal")
SAMPLES, WINNERS = "samples", "winners"


@dataclass(frozen=True)
class Rate:
    """NaN where n is 0."""

    value: float
    lower: float
    upper: float
    n: int


@dataclass(frozen=True)
class Target:
    kind: str
    at_most: float  # of the rate that `kind` names; NaN: none
    max_refusal: float  # NaN: none
    words: str

    def level(self, quantity):
        """What this rate may be at most; NaN if the target does not bound it."""
        return self.at_most if quantity == self.kind else self.max_refusal if quantity == "refusal" else math.nan


@dataclass(frozen=True)
class Option:
    name: str
    unit: str
    levels: tuple

    @property
    def is_numeric(self):
        return all(map(is_number, self.levels))

    def symbol(self):
        return self.name.removesuffix(f"_{self.unit}").replace("_", " ")

    def label(self):
        return self.symbol() + (f" ({self.unit})" if self.unit else "")

    def level_in_words(self, level):
        return f"{self.symbol()} = {number_text(float(level)) if is_real(level) else level} {self.unit}".rstrip()


@dataclass(frozen=True)
class Setting:
    """Levels of all options and the rates on the trials that verify."""

    levels: tuple
    rates: dict  # quantity -> Rate
    is_on_front: bool = False  # none fails and is refused as seldom, and one of the two less often
    is_on_path: bool = False  # one of those that were tested
    is_certified: bool = False


@dataclass(frozen=True)
class Other:
    """Another estimator on the same trials."""

    label: str
    words: str
    levels: tuple  # None: no point of the tuned estimator's surface
    rates: dict

    def name(self):
        return style.label_of(self.label) + (f" ({self.words})" if self.words else "")


@dataclass(frozen=True)
class Mark:
    words: str
    false_accept_rate: float
    true_accept_rate: float


@dataclass(frozen=True)
class Roc:
    estimator: str
    population: str
    score: str
    auc: Rate
    num_good: int
    num_bad: int
    curve: tuple  # (false accept rate, true accept rate), from accepting nothing to accepting all
    marks: tuple


@dataclass(frozen=True)
class Tune:
    path: str
    study: str
    estimator: str
    seed: int
    target: Target
    options: tuple
    settings: tuple
    tuned: Setting  # None: no setting met the target
    others: tuple
    rocs: tuple


@dataclass(frozen=True)
class Family:
    words: str
    levels: tuple  # None: could not be tuned
    why: str


@dataclass(frozen=True)
class Cell:
    tuned_on: int
    verified_on: int
    rate: Rate  # what the target bounds
    refusal: Rate
    verdict: str


@dataclass(frozen=True)
class Transfer:
    path: str
    study: str
    estimator: str
    seed: int
    target: Target
    options: tuple
    families: tuple
    cells: tuple


def read_rate(parent, key):
    node = parent.node(key)
    value, lower, upper = (node.number_or(part, math.nan) for part in ("value", "lower", "upper"))
    n = node.count("n")
    return checked(node, Rate(value, lower, upper, n), is_empty=n == 0)


def checked(node, rate, is_empty):
    """The rate; without bounds where it has no value, for the interval 0..1 of no trials says nothing."""
    if math.isnan(rate.value) and is_empty:
        return Rate(math.nan, math.nan, math.nan, rate.n)
    if not 0 <= rate.lower <= rate.value <= rate.upper <= 1:
        raise node.error("is no rate: 'value' must lie in 'lower'..'upper' and both in 0..1, and may be null only "
                         "where 'n' is 0")
    return rate


def read_rates(node, quantities):
    return {quantity: read_rate(node, quantity) for quantity in quantities}


def read_target(node):
    kind = node.one_of("kind", TARGETS)
    return Target(kind, node.fraction_or("at_most", math.nan), node.fraction_or("max_refusal", math.nan),
                  node.text("words"))


def read_options(file):
    options = tuple(Option(node.text("name"), node.text("unit"), node.texts("levels"))
                    for node in file.nodes("options", "option"))
    names = [option.name for option in options]
    if not options or len(set(names)) < len(names) or not all(option.levels for option in options):
        raise file.error("needs 'options': one or more, each with its own 'name' and one or more 'levels'")
    for option in options:
        if len(set(map(float, option.levels) if option.is_numeric else option.levels)) < len(option.levels):
            raise file.error(f"has option {option.name} with 'levels' {', '.join(option.levels)}; expected different "
                             "ones")
    return options


def check_levels(node, levels, options, are_known=True):
    """One level per option; a known level is one of the option's, another at least a number where those are."""
    if len(levels) != len(options):
        raise node.error(f"has {len(levels)} 'levels'; expected {len(options)}, one of each option")
    for option, level in zip(options, levels):
        if are_known and level not in option.levels:
            raise node.error(f"has the level '{level}' of {option.name}; expected one of {', '.join(option.levels)}")
        if option.is_numeric and not is_real(level):
            raise node.error(f"has the level '{level}' of {option.name}; expected a number")


def is_real(text):
    """A number, infinite ones too."""
    try:
        return not math.isnan(float(text))
    except ValueError:
        return False


def read_setting(node):
    return Setting(node.texts("levels"), read_rates(node, SETTING_RATES),
                   *map(node.boolean, ("is_on_front", "is_on_path", "is_certified")))


def read_settings(file, options):
    settings = tuple(map(read_setting, file.nodes("settings", "setting")))
    combinations = list(itertools.product(*(option.levels for option in options)))
    for number, (setting, levels) in enumerate(zip(settings, combinations), 1):
        if setting.levels != levels:
            raise file.error(f"has as setting {number} {', '.join(setting.levels)}; expected {', '.join(levels)}: all "
                             "combinations of levels, the first option slowest")
    if len(settings) != len(combinations):
        raise file.error(f"has {len(settings)} 'settings'; the options' levels have {len(combinations)} combinations")
    return settings


def read_tuned(node, options):
    if node is None:
        return None
    tuned = Setting(node.texts("levels"), read_rates(node, SETTING_RATES))
    check_levels(node, tuned.levels, options)
    return tuned


def read_other(node, options):
    other = Other(node.text("label"), node.text("words"), node.texts_or_none("levels"),
                  read_rates(node, ("failure", "refusal")))
    if other.levels is not None:
        check_levels(node, other.levels, options, are_known=False)
    return other


def read_curve(node):
    """The points without their thresholds."""
    curve = node.get("curve", lambda points: isinstance(points, list) and all(map(is_point, points)),
                     "a list of [mu, false accept rate, true accept rate], each null or a number, rates in 0..1")
    return tuple((false_rate, true_rate) for _, false_rate, true_rate in curve if None not in (false_rate, true_rate))


def is_point(value):
    return (isinstance(value, list) and len(value) == 3 and all(part is None or is_finite(part) for part in value) and
            all(rate is None or 0 <= rate <= 1 for rate in value[1:]))


def read_auc(node, is_empty):
    parts = [node.number_or(part, math.nan) for part in ("value", "lower", "upper")]
    return checked(node, Rate(*parts, n=0), is_empty)


def read_roc(node):
    num_good, num_bad = node.count("num_good"), node.count("num_bad")
    return Roc(node.text("estimator"), node.one_of("population", (SAMPLES, WINNERS)), node.text("score"),
               read_auc(node.node("auc"), is_empty=0 in (num_good, num_bad)), num_good, num_bad, read_curve(node),
               tuple(map(read_mark, node.nodes("marks", "mark"))))


def read_mark(node):
    return Mark(node.text("words"), node.fraction_or("false_accept_rate", math.nan),
                node.fraction_or("true_accept_rate", math.nan))


def read_head(path, kind):
    """(the file's node, what both kinds begin with)."""
    file = read_object(path, *kind)
    return file, (path, file.text("study"), file.text("estimator"), file.whole_number("seed"),
                  read_target(file.node("target")), read_options(file))


def read_tune(path):
    """The Tune in the file `path`; a cut-off or foreign file is an error."""
    file, head = read_head(path, TUNING)
    options = head[-1]
    return Tune(*head, read_settings(file, options), read_tuned(file.node_or_none("tuned"), options),
                tuple(read_other(node, options) for node in file.nodes("others", "other")),
                tuple(map(read_roc, file.nodes("roc", "roc"))))


def read_family(node, options):
    family = Family(node.text("words"), node.texts_or_none("levels"), node.text("why"))
    if family.levels is not None:
        check_levels(node, family.levels, options)
    return family


def read_cell(node, families):
    cell = Cell(node.count("tuned_on"), node.count("verified_on"), read_rate(node, "rate"), read_rate(node, "refusal"),
                node.one_of("verdict", VERDICTS))
    if max(cell.tuned_on, cell.verified_on) >= len(families):
        raise node.error(f"has 'tuned_on': {cell.tuned_on}, 'verified_on': {cell.verified_on}; expected numbers of "
                         f"families, 0 to {len(families) - 1}")
    if families[cell.tuned_on].levels is None:
        raise node.error(f"has 'tuned_on': {cell.tuned_on}, a family without 'levels'; expected none for it")
    return cell


def read_transfer(path):
    """The Transfer in the file `path`; errors as read_tune."""
    file, head = read_head(path, TRANSFER)
    families = tuple(read_family(node, head[-1]) for node in file.nodes("families", "family"))
    if not families:
        raise file.error("has no families ('families' is empty), so there is nothing to draw")
    cells = tuple(read_cell(node, families) for node in file.nodes("cells", "cell"))
    if len({(cell.tuned_on, cell.verified_on) for cell in cells}) < len(cells):
        raise file.error("has two cells of one pair of families; expected one")
    return Transfer(*head, families, cells)
