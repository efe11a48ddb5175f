"""How a rate, or a mean, depends on the condition: a Gaussian process on the logit of the rate (or on the mean itself),
which knows how few trials a condition has and that conditions, and draws with several conditions, differ by more than
their factors.

    model = ConditionModel().fit(levels, successes, trials)   # levels: a table of texts, a row a condition
    rate, low, high = model.predict_rate(candidates)

The posterior given the counts is Laplace's approximation (Rasmussen and Williams, Gaussian processes for machine learning,
ch. 3); variances and roughness are the mode of their posterior under the working response of that approximation (penalised
quasi-likelihood: Breslow and Clayton 1993). Numbers are SciPy's; no library of processes has this covariance with counts.
"""

import copy

import numpy as np
from scipy import linalg, optimize
from scipy.special import expit, ndtri

from surface.anova_kernel import CONSTANT, AnovaKernel, log_likelihood, log_prior
from surface.condition_encoder import ConditionEncoder

MOST_FOR_VARIANCES = 500  # conditions from which variances are learned; all count in the prediction
NO_EFFECT = -30.0  # logarithm of a variance that is none
MAX_ROUNDS = 5  # of working response and variances


class ConditionModel:
    """See above. `encoder`: one that is fitted already, to levels that are more than those of the conditions."""

    def __init__(self, encoder=None):
        self.encoder = encoder

    def fit(self, levels, successes, trials, start=None, draws=None):
        """`successes` of `trials` in each condition; those without trials do not count. `start`: a fitted model whose
        variances are the first guess. `draws`: the number of each condition's draw, where draws have several conditions."""
        successes, trials = np.asarray(successes, float), np.asarray(trials, float)
        self.has_counts, self.center, self.spread = True, 0.0, 1.0
        is_used = trials > 0
        self._begin(levels[is_used], start, None if draws is None else draws[is_used])
        self._fit_counts(successes[is_used], trials[is_used], start)
        return self

    def fit_values(self, levels, mean, standard_error, start=None, draws=None):
        """Of a quantity that is no rate: its mean in each condition with the standard error from the condition's trials.
        Conditions without a mean do not count."""
        mean, standard_error = np.asarray(mean, float), np.asarray(standard_error, float)
        self.has_counts = False
        is_used = np.isfinite(mean) & np.isfinite(standard_error)
        mean, variance = mean[is_used], standard_error[is_used]**2
        self.center, self.spread = mean.mean(), max(mean.std(), 1e-9)
        self._begin(levels[is_used], start, None if draws is None else draws[is_used])
        response = (mean - self.center) / self.spread
        noise = np.maximum(variance / self.spread**2, 1e-6)
        self._learn(response, noise)
        self._condition_on(response, noise)
        return self

    def predict(self, levels, own=True):
        """Mean and standard deviation on the logit scale (of `fit_values`: on that of the values): what the model does not
        know about the rate of a condition of a further draw, without the noise of its trials. own=False: of the surface
        alone."""
        mean, variance = self._predict_features(self.encoder.encode(levels))
        variance = variance + own * self.kernel.unexplained_variance
        return self.center + self.spread * mean, self.spread * np.sqrt(variance)

    def predict_rate(self, levels, confidence=0.9):
        """Each condition's expected rate (or mean), with the interval that holds it with that probability."""
        mean, sd = self.predict(levels)
        half = ndtri(0.5 + 0.5 * confidence) * sd
        if not self.has_counts:
            return mean, mean - half, mean + half
        return average_rate(mean, sd**2), expit(mean - half), expit(mean + half)

    def covariance(self, levels):
        """Of the surface at these conditions, on the logit scale (or that of values), given what is known: a matrix."""
        features = self.encoder.encode(levels)
        half = linalg.solve_triangular(self.root, self.kernel.surface(self.features, features), lower=True)
        return self.spread**2 * (self.kernel.surface(features, features) - half.T @ half)

    def draw_surfaces(self, number, random):
        """Surfaces from the posterior, as Surface; `random`: a numpy Generator. Variances are drawn as well."""
        thetas = self._draw_parameters(number, random)
        return [self._draw_surface(theta, random) for theta in thetas]

    def log_evidence_without(self, group, learn_again=False):
        """How much the logarithm of the marginal likelihood falls when a group of factors has no effect; with `learn_again`
        the other variances may take its place."""
        without = copy.copy(self)
        without.kernel = AnovaKernel(self.encoder, self.kernel.theta.copy())
        fixed = [place for place, block in enumerate(self.encoder.blocks) if block.group == group]
        without.kernel.theta[fixed] = NO_EFFECT
        if learn_again:
            without._learn(self.response, self.noise, fixed)
        return self._evidence(self.kernel) - self._evidence(without.kernel)

    # ---- fitting

    def _begin(self, levels, start, draws):
        if self.encoder is None:
            self.encoder = ConditionEncoder().fit(levels)
        self.features = self.encoder.encode(levels)
        self.draws = draws
        self.kernel = AnovaKernel(self.encoder, None if start is None else start.kernel.theta, draws is not None)
        order = np.random.default_rng(1).permutation(len(self.features))
        self.learned_from = np.sort(order[:MOST_FOR_VARIANCES])

    def _fit_counts(self, successes, trials, start):
        """Working responses and variances in turns, until the variances stay; once from a good start."""
        logit = np.log((successes + 0.5) / (trials - successes + 0.5))
        noise = 1 / (successes + 0.5) + 1 / (trials - successes + 0.5)
        if start is not None:
            logit, noise = self._find_mode(successes, trials)
        for _ in range(MAX_ROUNDS if start is None else 1):
            before = self.kernel.theta
            self._learn(logit, noise)
            logit, noise = self._find_mode(successes, trials)
            if np.abs(np.exp(0.5 * self.kernel.theta) - np.exp(0.5 * before)).max() < 0.02:
                break
        self._condition_on(logit, noise)

    def _learn(self, response, noise, fixed=()):
        """Variances and roughness: the mode of their posterior. Those at the places `fixed` stay."""
        used = self.learned_from
        features, response, noise, draws = self.features[used], response[used], noise[used], self._draws_learned_from()

        def objective(theta):
            value, gradient = log_likelihood(AnovaKernel(self.encoder, theta), features, response, noise, draws, True)
            prior, slope = log_prior(theta, len(self.encoder.blocks))
            return (-value - prior, -gradient - slope) if np.isfinite(value) else (1e25, 0 * gradient)
        bounds = self.kernel.bounds
        bounds[list(fixed)] = NO_EFFECT
        found = optimize.minimize(objective, self.kernel.theta, jac=True, bounds=bounds, method="L-BFGS-B",
                                  options={"maxiter": 40, "ftol": 1e-6})
        self.kernel = AnovaKernel(self.encoder, found.x)

    def _find_mode(self, successes, trials):
        """Working response and its noise variance at the most likely logits (Newton's method, halving steps)."""
        K = self._covariance_of_logits()
        latent, objective, a = np.zeros(len(trials)), -np.inf, None
        for _ in range(50):
            rate = expit(latent)
            noise = 1 / np.maximum(trials * rate * (1 - rate), 1e-8)
            response = latent + (successes - trials * rate) * noise
            a_new = linalg.solve(K + np.diag(noise), response, assume_a="pos")
            step, best = 1.0, objective
            for _ in range(12):
                a_try = a_new if a is None else a + step * (a_new - a)
                latent_try = K @ a_try
                value = np.sum(successes * latent_try - trials * np.logaddexp(0, latent_try)) - 0.5 * a_try @ latent_try
                if value > objective:
                    break
                step /= 2
            gain = value - best
            if not gain > 0:
                break
            a, latent, objective = a_try, latent_try, value
            if gain < 1e-6:
                break
        rate = expit(latent)
        noise = 1 / np.maximum(trials * rate * (1 - rate), 1e-8)
        return latent + (successes - trials * rate) * noise, noise

    def _condition_on(self, response, noise):
        self.response, self.noise = response, noise
        self.root = linalg.cholesky(self._covariance_of_logits() + np.diag(noise), lower=True)
        self.weights = linalg.cho_solve((self.root, True), response)

    def _covariance_of_logits(self):
        """Prior, of the conditions that the model was fitted to."""
        return self.kernel.surface(self.features, self.features) + self.kernel.deviations(np.zeros(len(self.features)), self.draws)

    def _draws_learned_from(self):
        return None if self.draws is None else self.draws[self.learned_from]

    def _evidence(self, kernel, gradient=False):
        """Logarithm of the marginal likelihood of the working responses."""
        used = self.learned_from
        return log_likelihood(kernel, self.features[used], self.response[used], self.noise[used], self._draws_learned_from(),
                              gradient)

    # ---- predicting

    def _predict_features(self, features):
        """Mean and variance of f (standardised)."""
        cross = self.kernel.surface(self.features, features)
        half = linalg.solve_triangular(self.root, cross, lower=True)
        variance = self.kernel.surface_diag(features) - np.sum(half**2, axis=0)
        return cross.T @ self.weights, np.maximum(variance, 1e-12)

    def _draw_parameters(self, number, random):
        """Variances and roughness from the normal distribution around their mode (curvature: differences of gradients)."""
        mode, bounds = self.kernel.theta, self.kernel.bounds

        def slope(theta):
            prior_slope = log_prior(theta, len(self.encoder.blocks))[1]
            return self._evidence(AnovaKernel(self.encoder, theta), gradient=True)[1] + prior_slope
        step = 0.05
        curvature = np.array([(slope(mode + step * e) - slope(mode - step * e)) / (2 * step) for e in np.eye(len(mode))])
        values, vectors = np.linalg.eigh(-0.5 * (curvature + curvature.T))
        sds = 1 / np.sqrt(np.maximum(values, 0.25))  # at most a factor e^2 in a variance
        draws = mode + (random.standard_normal((number, len(mode))) * sds) @ vectors.T
        return np.clip(draws, bounds[:, 0], bounds[:, 1])

    def _draw_surface(self, theta, random):
        """Matheron's rule: a surface from the prior, moved by what the responses say of it."""
        kernel = AnovaKernel(self.encoder, theta)
        prior = draw_prior(kernel, random)
        noise = self.noise + kernel.own_variance
        residual = self.response - prior.at(self.features) - np.sqrt(noise) * random.standard_normal(len(noise))
        if kernel.has_draws:
            residual -= np.sqrt(kernel.draw_variance) * random.standard_normal(self.draws.max() + 1)[self.draws]
        K = kernel.surface(self.features, self.features) + kernel.deviations(self.noise, self.draws)
        return move(prior, kernel, self.features, linalg.solve(K, residual, assume_a="pos"), self)

    def mean_surface(self):
        """The posterior mean as a Surface."""
        none = Surface(0.0, np.zeros(self.features.shape[1]), np.zeros((self.features.shape[1],) * 2), 0.0)
        return move(none, self.kernel, self.features, self.weights, self)


class Surface:
    """f as a quadratic form of the features: constant + F w + 1/2 F W F', where W has no entries within a group. `own`: the
    variance of what no factor explains, of a condition and of its draw."""

    def __init__(self, constant, linear, pairs, own):
        self.constant, self.linear, self.pairs, self.own = constant, linear, pairs, own
        self.center, self.spread, self.has_counts = 0.0, 1.0, False

    def at(self, features):
        """At each row of features: f, standardised."""
        return Exchange(self, features).values

    def expected(self, standardised):
        """The mean rate (or value) of conditions with that f, over what no factor explains."""
        value = self.center + self.spread * standardised
        return average_rate(value, self.own) if self.has_counts else value


class Exchange:
    """A surface at conditions, and at what they are when some of their factors are exchanged. With x the features at
    `columns` and W the surface's pairs, f = rest + x . slopes + 1/2 x W x', where rest and slopes are of the others."""

    def __init__(self, surface, features):
        self.surface, self.features = surface, features
        self.products = features @ surface.pairs
        self.values = surface.constant + features @ surface.linear + 0.5 * np.sum(self.products * features, axis=1)

    def exchanged(self, columns, others):
        """Conditions x rows of `others`: f where a condition's features at `columns` are those of a row of `others`."""
        within = self.surface.pairs[np.ix_(columns, columns)]
        own, theirs = self.features[:, columns], others[:, columns]
        slopes = self.surface.linear[columns] + self.products[:, columns] - own @ within
        rest = self.values - np.sum(own * slopes, axis=1) - 0.5 * np.sum((own @ within) * own, axis=1)
        return rest[:, None] + slopes @ theirs.T + 0.5 * np.sum((theirs @ within) * theirs, axis=1)


def draw_prior(kernel, random):
    """A Surface from the prior."""
    variances = kernel.feature_variances()
    sds = np.sqrt(variances)
    pairs = random.standard_normal((len(sds), len(sds))) * np.sqrt(kernel.tau) * np.outer(sds, sds)
    pairs = np.triu(pairs)
    pairs = (pairs + pairs.T) * between_groups(kernel.encoder)
    return Surface(np.sqrt(CONSTANT) * random.standard_normal(), sds * random.standard_normal(len(sds)), pairs, 0.0)


def move(surface, kernel, features, weights, model):
    """The surface with K(., features) weights added."""
    variances = kernel.feature_variances()
    linear = surface.linear + variances * (features.T @ weights)
    pairs = kernel.tau * np.outer(variances, variances) * (features.T @ (features * weights[:, None]))
    moved = Surface(surface.constant + CONSTANT * weights.sum(), linear,
                    surface.pairs + pairs * between_groups(kernel.encoder), kernel.unexplained_variance)
    moved.center, moved.spread, moved.has_counts = model.center, model.spread, model.has_counts
    return moved


def between_groups(encoder):
    """1 where two features are of different groups."""
    group = np.zeros(len(encoder.degrees), int)
    for number, block in enumerate(encoder.blocks):
        group[block.columns] = encoder.groups.index(block.group)
    return (group[:, None] != group[None, :]).astype(float)


def average_rate(logit, variance):
    """Mean of expit over a normal distribution (MacKay 1992: the probit's, good to about 0.01)."""
    return expit(logit / np.sqrt(1 + np.pi * variance / 8))
