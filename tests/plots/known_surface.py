"""Conditions whose rates are known, for the tests of plots/surface: levels as a run has them, and what happened in them."""

import numpy as np
import pandas as pd


def conditions(number, seed, num_idle=2):
    """Levels of `number` conditions and the logit of the rate of each: sigma_px (in its logarithm), outlier_ratio, a law of
    noise of which one brings dof, an interaction, and factors without effect."""
    random = np.random.default_rng(seed)
    sigma, ratio = np.exp(random.uniform(np.log(0.1), np.log(3), number)), random.uniform(0, 0.8, number)
    law, dof = random.choice(["gaussian", "student_t", "octave"], number), random.uniform(3, 10, number)
    logit = -1 + 1.2 * np.log(sigma) + 3 * (ratio - 0.4) + 1.5 * (ratio - 0.4) * np.log(sigma)
    logit += np.where(law == "student_t", 1 - 0.2 * (dof - 6), 0)
    levels = {"sigma_px": texts(sigma), "outlier_ratio": texts(ratio), "noise": law,
              "student_dof": np.where(law == "student_t", texts(dof), "-")}
    levels |= {f"idle_{i}": texts(random.uniform(0, 1, number)) for i in range(num_idle)}
    return pd.DataFrame(levels), logit


def texts(numbers):
    return np.array([f"{number:.6g}" for number in numbers])


def events(logit, trials, own_sd, seed):
    """How many of the trials of each condition are an event; conditions differ by `own_sd` beyond their factors."""
    random = np.random.default_rng([seed, 1])
    own = own_sd * random.standard_normal(len(logit))
    return random.binomial(trials, 1 / (1 + np.exp(-logit - own)))


def crossed_conditions(num_draws, num_levels, seed):
    """Draws of a population, each crossed with levels of num_matches: levels, logits and the number of each condition's draw.
    Nothing that is drawn has an effect, but draws differ with a standard deviation of 1; a level has an effect of 0.5."""
    drawn, _ = conditions(num_draws, seed)
    draws, level = np.repeat(np.arange(num_draws), num_levels), np.tile(np.arange(num_levels), num_draws)
    of_draw = np.random.default_rng([seed, 11]).standard_normal(num_draws)[draws]
    levels = drawn.loc[draws].reset_index(drop=True).assign(num_matches=texts(50.0 * 2**level))
    return levels, -1 + of_draw - 0.5 * level, draws


def surface_file(levels, successes, trials, candidates=None, is_sample=True, quantity="failure", draws=None):
    """What `rcme surface` hands over, as a value for JSON. `draws`: the number of each condition's draw, if not its own."""
    draws = range(len(levels)) if draws is None else draws
    def row(number, levels):
        return {"draw": number, "levels": list(levels)}
    conditions = [{"run": 0, "condition": c, **row(int(draws[c]), levels.iloc[c]), "n": trials, "mean": successes[c] / trials,
                   "sd": float(np.sqrt(successes[c] / trials * (1 - successes[c] / trials)))} for c in range(len(levels))]
    ends = {"sigma_px": ("log", 0.1, 3), "outlier_ratio": ("linear", 0, 0.8)}
    factors = [{"name": name, "scale": None, **dict(zip(("scale", "low", "high"), ends.get(name, ())))} for name in levels]
    return {"format": "rcme surface data 1", "study": "known", "estimator": "rcme", "quantity": quantity,
            "study_yaml": "name: known\nconditions:\n  number: 9\n  ranges: {sigma_px: {log: [0.1, 3]}}\n",
            "runs": [{"path": "run.sqlite", "study": "known", "is_sample": is_sample}], "factors": factors,
            "conditions": conditions,
            "candidates": [] if candidates is None else [row(len(levels) + c, candidates.iloc[c]) for c in range(len(candidates))]}
