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
    draws: np.ndarray  # the number of each row's draw: conditions of one draw are not independent

    @property
    def gain(self):
        """Mean gain in the log score per condition, with its 95 % interval over draws."""
        gains = (self.rows.log_score - self.rows.log_score_constant).to_numpy()
        half = stats.t.ppf(0.975, self.num_draws - 1) * standard_error_of_mean(gains, self.draws)
        return gains.mean(), gains.mean() - half, gains.mean() + half

    @property
    def inside(self):
        """Share of the held-out conditions inside of their predictive interval, with its 95 % interval (exact where every
        draw has one condition), and the share that is expected (counts are whole, so more than 90 %)."""
        is_inside = self.rows.is_inside.to_numpy(float)
        return (is_inside.mean(), *interval_over_draws(is_inside, self.draws), self.rows.expected_inside.mean())

    @property
    def num_draws(self):
        return len(set(self.draws))

    @property
    def beats_constant(self):
        return self.gain[1] > 0


def exact_interval(count, n, confidence=0.95):
    """Clopper and Pearson's."""
    tail = 0.5 - 0.5 * confidence
    return (stats.beta.ppf(tail, count, n - count + 1) if count > 0 else 0.0,
            stats.beta.ppf(1 - tail, count + 1, n - count) if count < n else 1.0)


def standard_error_of_mean(values, draws):
    """sqrt(J / (J - 1) sum_j s_j^2) / n, with s_j the sum of a draw's deviations from the mean; J draws, n values."""
    sums = np.bincount(np.unique(draws, return_inverse=True)[1], values - values.mean())
    return np.sqrt(len(sums)) * sums.std(ddof=1) / len(values)


def interval_over_draws(is_inside, draws):
    """95 % interval of a share: Clopper and Pearson's of as many conditions as would be worth as much if they were
    independent (Korn and Graubard 1998): n over the design effect, times (t_(n-1) / t_(J-1))^2 with the 97.5 % points of
    Student's t; at most n. Where all or none are inside, J."""
    n, num_draws, share = len(is_inside), len(set(draws)), is_inside.mean()
    if num_draws == n:
        worth = n
    elif share in (0, 1):
        worth = num_draws
    else:
        effect = (standard_error_of_mean(is_inside, draws) / standard_error_of_mean(is_inside, np.arange(n)))**2
        t_ratio = stats.t.ppf(0.975, n - 1) / stats.t.ppf(0.975, num_draws - 1)
        worth = min(n, n / effect * t_ratio**2)
    return exact_interval(share * worth, worth)


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
    return CrossValidation(rows, transform_histogram(pd.concat(transforms).to_numpy()), data.draw_numbers[rows.place])


def assign_folds(data):
    """A fold for each condition, the same for those of one draw."""
    draws = data.draw_numbers
    return np.random.default_rng(1).permutation(draws.max() + 1)[draws] % FOLDS


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
