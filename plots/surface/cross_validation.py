"""Whether a surface predicts conditions that it has not seen: ten folds of conditions (conditions of one draw in one fold),
against the model without factors, in which every condition has its own rate around one mean."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import special, stats

from surface.condition_encoder import ConditionEncoder

FOLDS = 10
CONFIDENCE = 0.9  # of the predictive intervals
BINS = 10  # of the histogram of probability integral transforms
NODES, NODE_WEIGHTS = np.polynomial.hermite_e.hermegauss(64)
NODE_WEIGHTS = NODE_WEIGHTS / NODE_WEIGHTS.sum()
MAX_STEPS = 100  # of Newton's method


@dataclass
class CrossValidation:
    rows: pd.DataFrame  # a row a held-out condition: log_score, log_score_constant, is_inside, expected_inside, bounds
    histogram: np.ndarray  # shares of the transforms in equal bins; flat if calibrated

    @property
    def gain(self):
        """Mean gain in the log score per condition, with its 95 % interval over conditions."""
        gains = (self.rows.log_score - self.rows.log_score_constant).to_numpy()
        half = stats.t.ppf(0.975, len(gains) - 1) * gains.std(ddof=1) / np.sqrt(len(gains))
        return gains.mean(), gains.mean() - half, gains.mean() + half

    @property
    def inside(self):
        """Share of the held-out conditions inside of their predictive interval, with its exact 95 % interval, and the share
        that is expected (counts are whole, so more than 90 %)."""
        inside, n = int(self.rows.is_inside.sum()), len(self.rows)
        return (inside / n, *exact_interval(inside, n), self.rows.expected_inside.mean())

    @property
    def beats_constant(self):
        return self.gain[1] > 0


def exact_interval(count, n, confidence=0.95):
    """Clopper and Pearson's."""
    tail = 0.5 - 0.5 * confidence
    return (stats.beta.ppf(tail, count, n - count + 1) if count > 0 else 0.0,
            stats.beta.ppf(1 - tail, count + 1, n - count) if count < n else 1.0)


def cross_validate(data, model, progress=lambda: None):
    """Fits to all folds but one and predicts that; scores conditions that are random draws of the population, or all where
    none is."""
    folds, rows, transforms = assign_folds(data), [], []
    is_scored = data.is_sample if data.is_sample.any() else np.ones(len(folds), bool)
    nothing = ConditionEncoder().fit(data.levels.iloc[:, :0])
    constant = data.fit(encoder=nothing)
    for fold in range(FOLDS):
        held = np.flatnonzero((folds == fold) & is_scored)
        if len(held):
            with_factors = predict_held_out(data, data.fit(folds != fold, model), held)
            without = predict_held_out(data, data.fit(folds != fold, constant, nothing), held)
            rows.append(with_factors.drop(columns=["below", "up_to"]).assign(
                fold=fold, log_score_constant=without.log_score))
            transforms.append(with_factors[["below", "up_to"]])
        progress()
    rows = pd.concat(rows).sort_values("place")
    return CrossValidation(rows, transform_histogram(pd.concat(transforms).to_numpy()))


def assign_folds(data):
    """A fold for each condition, the same for those of one draw."""
    keys = [(run, draw if draw == draw else condition) for run, draw, condition in
            data.conditions[["run", "draw", "condition"]].astype(float).itertuples(index=False)]
    distinct = list(dict.fromkeys(keys))
    order = np.random.default_rng(1).permutation(len(distinct))
    fold_of = {key: place % FOLDS for key, place in zip(distinct, order)}
    return np.array([fold_of[key] for key in keys])


def predict_held_out(data, model, held):
    mean, sd = model.predict(data.levels.iloc[held])
    observed = data.conditions["mean"].to_numpy(float)[held]
    if data.is_rate:
        scored = [score_count(*numbers) for numbers in zip(data.successes[held], data.trials[held], mean, sd)]
    else:
        scored = [score_value(*numbers) for numbers in zip(observed, data.standard_errors()[held], mean, sd)]
    rows = pd.DataFrame(scored, columns=["log_score", "lower", "upper", "is_inside", "expected_inside", "below", "up_to"])
    return rows.assign(place=held, observed=observed, predicted=model.predict_rate(data.levels.iloc[held])[0])


def score_count(successes, trials, mean, sd):
    """Of a count whose rate has a normal logit. Bounds are rates."""
    mass = count_masses(int(trials), mean, sd)
    up_to = np.cumsum(mass)
    k, tail = int(successes), 0.5 - 0.5 * CONFIDENCE
    low, high = np.searchsorted(up_to, tail), np.searchsorted(up_to, 1 - tail)
    high = min(high, int(trials))
    return (np.log(max(mass[k], 1e-300)), low / trials, high / trials, low <= k <= high, mass[low:high + 1].sum(),
            up_to[k] - mass[k], up_to[k])


def count_masses(trials, mean, sd):
    """Probabilities of 0 .. trials events: the binomial distribution, averaged over the logit. Each count has its own nodes
    (adaptive Gauss-Hermite quadrature): centred at the mode of likelihood x normal, in units of the width of that peak,
    which is about 1 / sqrt(n p q) and may be far below sd."""
    counts = np.arange(trials + 1)[:, None]
    mode, width = integrand_peaks(counts, trials, mean, sd)
    logits = mode + width * NODES
    logs = (counts * logits - trials * np.logaddexp(0, logits) - 0.5 * ((logits - mean) / sd)**2 + 0.5 * NODES**2
            + np.log(width / sd)
            + special.gammaln(trials + 1) - special.gammaln(counts + 1) - special.gammaln(trials - counts + 1))
    mass = np.exp(logs) @ NODE_WEIGHTS
    return mass / mass.sum()


def integrand_peaks(counts, trials, mean, sd):
    """Mode and width of exp(g), g(x) = k x - n log(1 + e^x) - (x - mean)^2 / (2 sd^2), for each count k; with h = -d2g/dx2 the
    width is h^(-1/2). Newton's method with log(1 + |s|) in place of each step s: it never overshoots, as |dh/dx| <= h."""
    mode = np.full(counts.shape, float(mean))
    for _ in range(MAX_STEPS):
        rate = special.expit(mode)
        curvature = trials * rate * (1 - rate) + 1 / sd**2
        step = (counts - trials * rate - (mode - mean) / sd**2) / curvature
        mode = mode + np.sign(step) * np.log1p(np.abs(step))
        if np.abs(step).max() < 1e-6:
            break
    return mode, 1 / np.sqrt(curvature)


def score_value(observed, standard_error, mean, sd):
    predictive = stats.norm(mean, np.hypot(sd, standard_error))
    low, high = predictive.interval(CONFIDENCE)
    at = predictive.cdf(observed)
    return predictive.logpdf(observed), low, high, low <= observed <= high, CONFIDENCE, at, at


def transform_histogram(bounds):
    """Shares in equal bins of transforms that lie anywhere between two bounds (Czado, Gneiting and Held 2009)."""
    edges = np.linspace(0, 1, BINS + 1)
    low, high = bounds[:, 0], np.maximum(bounds[:, 1], bounds[:, 0] + 1e-9)
    reached = np.clip((edges[:, None] - low) / (high - low), 0, 1).mean(axis=1)
    return np.diff(reached)
