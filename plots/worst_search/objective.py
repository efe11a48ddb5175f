"""What the search asks for: counts of an event at draws of a population. The trials behind them are `rcme run`'s
(run_trials.py), or a function's that is known (tests)."""

import dataclasses

import numpy as np


@dataclasses.dataclass
class Counts:
    """Over some trials: `trials` are those that count (of sure_failure: the sure answers), `reverse` the events of the
    other estimator alone, for a difference."""
    events: int
    trials: int
    reverse: int = 0
    is_difference: bool = False


@dataclasses.dataclass
class Tried:
    """Draws and what became of their trials; arrays of one length."""
    table: object
    events: np.ndarray
    trials: np.ndarray
    reverse: np.ndarray

    def subset(self, rows):
        rows = np.flatnonzero(rows)
        return Tried(self.table.take(rows), self.events[rows], self.trials[rows], self.reverse[rows])

    def total(self, is_difference):
        return Counts(int(self.events.sum()), int(self.trials.sum()), int(self.reverse.sum()), is_difference)


class Objective:
    """`space`: of the population, with its pool. Every request has a name of its own; the same name asks for the same."""

    space = None
    is_difference = False
    what_counts = ""  # of the answers, as a sentence, for the message that none does
    calls = 0  # trials that were asked for so far

    def try_draws(self, name, numbers, trials, first=0):
        """Tried: of each of these draws of the pool its trials number `first` to `trials` - 1."""
        raise NotImplementedError

    def try_box(self, name, box, number):
        """Tried: one trial of each of `number` draws of the population within a box, of a seed of their own."""
        raise NotImplementedError
