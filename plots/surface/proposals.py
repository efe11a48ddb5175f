"""Which draws of the population to run next: one after the other where the surface is least known, as if those chosen before
had been run already."""

import numpy as np
import pandas as pd
from scipy import linalg
from scipy.special import expit
from scipy.stats import norm


def propose(data, model, number, level=None):
    """A table of `number` candidates: draw, levels, what the model expects, and the score that chose each: the standard
    deviation of the rate (or mean) there, or with `level` the probability that it lies on the other side of that level than
    the model thinks. All conditions of a draw are chosen together."""
    candidates = data.candidates
    levels = candidates[data.names]
    mean, _ = model.predict(levels, own=False)
    cov = model.covariance(levels)
    noise = noise_of_condition(data, model, mean)
    rate, lower, upper = model.predict_rate(levels)
    draws, chosen, scores = candidates.draw.to_numpy(), [], []
    while len(chosen) < number and len(chosen) < len(set(draws)):
        score = undecided(model, mean, cov.diagonal(), level)
        score[np.isin(draws, chosen)] = -1
        best = draws[int(np.argmax(score))]
        chosen.append(best)
        scores.append(score.max())
        places = np.flatnonzero(draws == best)
        said = cov[np.ix_(places, places)] + np.diag(noise[places]) + model.spread**2 * model.kernel.draw_variance
        cov = cov - cov[:, places] @ np.linalg.solve(said, cov[places])
    rows = pd.DataFrame({"draw": draws, "rate": rate, "lower": lower, "upper": upper}).join(levels)
    order = pd.DataFrame({"draw": chosen, "order": range(1, len(chosen) + 1), "score": scores})
    return order.merge(rows, on="draw", how="left")


def undecided(model, mean, variance, level):
    sd = np.sqrt(np.maximum(variance, 0))
    if level is not None:
        at = np.log(level / (1 - level)) if model.has_counts else level
        return norm.cdf(-np.abs(mean - at) / np.maximum(sd, 1e-12))
    slope = expit(mean) * (1 - expit(mean)) if model.has_counts else 1.0
    return slope * sd


def noise_of_condition(data, model, mean):
    """Variance of what a further condition would say of the surface, beside that of its draw: its own and that of the usual
    number of trials."""
    own = model.spread**2 * model.kernel.own_variance
    if not data.is_rate:
        return np.full(len(mean), own + np.median(data.standard_errors())**2)
    rate = expit(mean)
    return own + 1 / np.maximum(np.median(data.trials) * rate * (1 - rate), 0.05)
