"""What `rcme surface` hands over: one quantity of one estimator in every condition of one or more runs, what is known of the
factors, and later draws of the population."""

import json
from dataclasses import dataclass

import numpy as np
import pandas as pd

from common.command_line import PlotError
from common.regular_file import read_bytes
from surface.condition_encoder import ConditionEncoder
from surface.condition_model import ConditionModel
from surface.memory import check_memory

FORMAT = "rcme surface data 1"
LEAST_CONDITIONS = 20
POOLED_TRIALS = 4  # how many trials' worth the spread of all conditions counts within one


@dataclass
class SurfaceData:
    study: str
    study_yaml: str
    estimator: str
    quantity: str  # "failure", "coverage" or "P-y"
    runs: list  # of dicts: path, study, is_sample
    names: list  # of factors
    conditions: pd.DataFrame  # run, condition, draw, n, mean, sd; those with trials that say something
    levels: pd.DataFrame  # of these conditions: texts
    is_sample: np.ndarray  # whether a condition is a random draw of the population
    num_without: int  # conditions that say nothing of the quantity
    candidates: pd.DataFrame  # draw and levels
    encoder: ConditionEncoder

    @property
    def is_rate(self):
        return self.quantity != "P-y"

    @property
    def trials(self):
        return self.conditions.n.to_numpy(float)

    @property
    def successes(self):
        """Events in each condition."""
        return np.round(self.conditions["mean"].to_numpy(float) * self.trials)

    @property
    def draw_numbers(self):
        """0, 1, ... for the draw of each condition, counted anew; a condition of no draw counts as one."""
        keys = [(run, draw if draw == draw else condition) for run, draw, condition in
                self.conditions[["run", "draw", "condition"]].astype(float).itertuples(index=False)]
        return pd.factorize(pd.Series(keys, dtype=object))[0]

    @property
    def shared_draws(self):
        """The same, or None where every draw has one condition."""
        numbers = self.draw_numbers
        return None if len(set(numbers)) == len(numbers) else numbers

    def standard_errors(self):
        """Of each condition's mean. Few equal trials do not mean that it is known: the spread of all conditions counts as
        that of some trials more."""
        n, spread = self.trials, np.nan_to_num(self.conditions["sd"].to_numpy(float))
        pooled = np.sum((n - 1) * spread**2) / max(np.sum(n - 1), 1)
        return np.sqrt(((n - 1) * spread**2 + POOLED_TRIALS * pooled) / (n - 1 + POOLED_TRIALS) / n)

    def fit(self, chosen=slice(None), start=None, encoder=None):
        """A ConditionModel of the chosen conditions."""
        model, levels, draws = ConditionModel(encoder or self.encoder), self.levels[chosen], self.shared_draws
        draws = None if draws is None else draws[chosen]
        if self.is_rate:
            return model.fit(levels, self.successes[chosen], self.trials[chosen], start, draws)
        return model.fit_values(levels, self.conditions["mean"].to_numpy(float)[chosen], self.standard_errors()[chosen],
                                start, draws)


def read_surface_data(path):
    """Raises PlotError for what is no such file, and for too few conditions or too many for this machine's memory."""
    content = read_bytes(path)
    try:
        data = json.loads(content.decode())
    except (ValueError, RecursionError) as error:
        raise PlotError(f"{path}: cannot be read ({error}).") from error
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise PlotError(f"{path}: is not of format '{FORMAT}'; `rcme surface` makes it.")
    try:
        return surface_data_of(data)
    except (KeyError, TypeError, IndexError, AttributeError) as error:
        raise PlotError(f"{path}: is not a whole file of `rcme surface` ({error!r}).") from error


def surface_data_of(data):
    names = [factor["name"] for factor in data["factors"]]
    conditions = pd.DataFrame(data["conditions"])
    levels = table_of(names, conditions.pop("levels"))
    candidates = pd.DataFrame(data["candidates"], columns=["draw", "levels"])
    candidate_levels = table_of(names, candidates.pop("levels"))
    is_used = conditions.n > 0
    if is_used.sum() < LEAST_CONDITIONS:
        raise PlotError(f"a surface needs at least {LEAST_CONDITIONS} conditions with trials that say something of "
                        f"{data['quantity']}; there are {is_used.sum()}.")
    is_sample = conditions.run.map(lambda run: data["runs"][run]["is_sample"]).to_numpy(bool)
    encoder = ConditionEncoder().fit(pd.concat([levels, candidate_levels], ignore_index=True), scales_of(data["factors"]))
    check_memory(int(is_used.sum()), len(encoder.groups))
    return SurfaceData(data["study"], data["study_yaml"], data["estimator"], data["quantity"], data["runs"], names,
                       conditions[is_used].reset_index(drop=True), levels[is_used].reset_index(drop=True),
                       is_sample[is_used], int((~is_used).sum()), pd.concat([candidates, candidate_levels], axis=1),
                       encoder)


def table_of(names, rows):
    return pd.DataFrame(list(rows), columns=names, dtype=str)


def scales_of(factors):
    """Of the factors whose range the population states: "log" or "linear" and its ends."""
    return {factor["name"]: (factor["scale"], factor["low"], factor["high"])
            for factor in factors if factor["scale"] and factor["high"] > factor["low"]}
