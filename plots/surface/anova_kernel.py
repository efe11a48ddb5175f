"""The covariance of a surface over conditions: main effects of groups of factors, interactions of two groups, what is
common to the conditions of one draw of the population, and what is each condition's own.

    f(x) = c + sum_g f_g(x) + sum_{g<h} f_gh(x),   Var f_g = K_g = sum_{b in g} v_b F_b diag(omega(r)) F_b',
    Var f_gh = tau K_g o K_h (elementwise),         h(x) = f(x) + d + e,
    e ~ N(0, s2) for each condition, d ~ N(0, t2) for each draw; without d if every draw has one condition.

Of a number the polynomial of degree d has the share omega_d ~ r^(d-1) of the variance, so r says how rough the surface is.
Functional ANOVA: Duvenaud, Nickisch and Rasmussen, Additive Gaussian processes (2011); Gu, Smoothing spline ANOVA (2002).
"""

import numpy as np
from scipy import linalg

BOUNDS = {"variance": (1e-5, 1e2), "tau": (1e-3, 1e2), "roughness": (0.02, 0.97), "own": (1e-5, 1e2), "draw": (1e-5, 1e2)}
CONSTANT = 25.0  # variance of the constant


class AnovaKernel:
    """`theta`: logarithms of the variance of each block of the encoder, tau, roughness r, each condition's own variance and,
    where draws have several conditions, that of a draw. `encoder`: its blocks, degrees and highest degrees; points are rows
    of features. `has_draws`: for a start without theta."""

    def __init__(self, encoder, theta=None, has_draws=False):
        self.encoder, self.num_blocks = encoder, len(encoder.blocks)
        starts = [np.log(0.05 if block.is_nested else 0.15) for block in encoder.blocks]
        self.theta = np.array([*starts, np.log(0.3), np.log(0.4), *[np.log(0.3)] * (1 + has_draws)]
                              if theta is None else theta)
        self.has_draws = len(self.theta) > self.num_blocks + 3
        self.columns = [encoder.columns_of(group) for group in encoder.groups]

    @property
    def bounds(self):
        kinds = ["variance"] * len(self.encoder.blocks) + ["tau", "roughness", "own"] + ["draw"] * self.has_draws
        return np.log([BOUNDS[kind] for kind in kinds])

    @property
    def own_variance(self):
        return np.exp(self.theta[self.num_blocks + 2])

    @property
    def draw_variance(self):
        return np.exp(self.theta[-1]) if self.has_draws else 0.0

    @property
    def unexplained_variance(self):
        """Of one condition: its own and that of its draw."""
        return self.own_variance + self.draw_variance

    @property
    def tau(self):
        return np.exp(self.theta[self.num_blocks])

    def feature_variances(self):
        """v_b omega_d of each feature: the prior variance of its weight."""
        return self._block_values(np.exp(self.theta)) * self._roughness_shares()[0]

    def _block_values(self, values):
        """Of each feature the value of its block."""
        spread = np.empty(len(self.encoder.degrees))
        for block, value in zip(self.encoder.blocks, values):
            spread[block.columns] = value
        return spread

    def _roughness_shares(self):
        """omega_d of each feature, and the derivative of its logarithm by log r."""
        r, powers = np.exp(self.theta[self.num_blocks + 1]), self.encoder.degrees - 1
        totals, slopes = np.ones(len(powers)), np.zeros(len(powers))  # slopes: of log total by log r
        for highest in set(self.encoder.highest):
            terms = r**np.arange(highest)
            totals[self.encoder.highest == highest] = np.sum(terms)
            slopes[self.encoder.highest == highest] = np.sum(np.arange(highest) * terms) / np.sum(terms)
        return r**powers / totals, powers - slopes

    def surface(self, X, Y):
        """Covariance of f between points, len(X) x len(Y)."""
        return self._sum_of(self._group_kernels(X, Y), (len(X), len(Y)))

    def _group_kernels(self, X, Y):
        """K_g, a matrix per group."""
        variances = self.feature_variances()
        return [(X[:, columns] * variances[columns]) @ Y[:, columns].T for columns in self.columns]

    def _sum_of(self, groups, shape):
        """c + sum K_g + tau * sum over pairs K_g o K_h."""
        first, squares = np.zeros(shape), np.zeros(shape)
        for K in groups:
            first += K
            squares += K**2
        return CONSTANT + first + 0.5 * self.tau * (first**2 - squares)

    def deviations(self, noise, draws):
        """Covariance of what the factors do not explain, with that noise variance of each condition; `draws`: the number of
        each condition's draw, None without a variance of draws."""
        own = np.diag(noise + self.own_variance)
        return own + self.draw_variance * of_one_draw(draws) if self.has_draws else own

    def surface_diag(self, X):
        """Variance of f at each point."""
        squares = X**2 * self.feature_variances()
        return self._sum_of([squares[:, columns].sum(axis=1) for columns in self.columns], len(X))

    def slopes(self, X, M, draws):
        """1/2 sum_ij M_ij dK_ij / dtheta for the K of the points X, with the deviations; M: symmetric.

        Of a feature with variance d in group g, dK/dlog d = d x x' o (1 + tau (sum_h K_h - K_g)).
        """
        groups = self._group_kernels(X, X)
        first = sum(groups, np.zeros_like(M))
        by_feature = np.empty(X.shape[1])
        for columns, K in zip(self.columns, groups):
            weighted = M * (1 + self.tau * (first - K))
            by_feature[columns] = 0.5 * np.sum(X[:, columns] * (weighted @ X[:, columns]), axis=0)
        by_feature *= self.feature_variances()
        pairs = 0.5 * self.tau * np.sum(M * 0.5 * (first**2 - sum((K**2 for K in groups), np.zeros_like(M))))
        by_block = [by_feature[block.columns].sum() for block in self.encoder.blocks]
        by_draw = [0.5 * self.draw_variance * np.sum(M[of_one_draw(draws)])] if self.has_draws else []
        return np.array([*by_block, pairs, by_feature @ self._roughness_shares()[1], 0.5 * self.own_variance * np.trace(M),
                         *by_draw])


def of_one_draw(draws):
    """Which pairs of conditions are of the same draw: a matrix."""
    return draws[:, None] == draws[None, :]


def log_likelihood(kernel, features, response, noise, draws=None, gradient=False):
    """Of responses with that noise variance: log N(response; 0, K + diag(noise)); with `gradient` also that by theta."""
    K = kernel.surface(features, features) + kernel.deviations(noise, draws)
    try:
        root = linalg.cholesky(K, lower=True)
    except linalg.LinAlgError:
        return (-np.inf, np.zeros(len(kernel.theta))) if gradient else -np.inf
    weights = linalg.cho_solve((root, True), response)
    value = -0.5 * response @ weights - np.sum(np.log(np.diag(root))) - 0.5 * len(response) * np.log(2 * np.pi)
    if not gradient:
        return value
    inverse = linalg.cho_solve((root, True), np.eye(len(response)))
    return value, kernel.slopes(features, np.outer(weights, weights) - inverse, draws)


def log_prior(theta, num_blocks):
    """Of the logarithms, and its gradient: standard deviations are exponential (their mean: 0.5; 1 for each condition's
    own and for a draw), tau and roughness lognormal. Keeps the variance of a factor near zero unless the conditions say
    otherwise."""
    value, gradient = 0.0, np.zeros(len(theta))
    for place, scale in [*((b, 0.5) for b in range(num_blocks)), *((b, 1.0) for b in range(num_blocks + 2, len(theta)))]:
        sd = np.exp(0.5 * theta[place])
        value += 0.5 * theta[place] - sd / scale
        gradient[place] = 0.5 - 0.5 * sd / scale
    for place, center, width in ((num_blocks, np.log(0.3), 1.5), (num_blocks + 1, np.log(0.4), 0.7)):
        away = (theta[place] - center) / width
        value -= 0.5 * away**2
        gradient[place] = -away / width
    return value, gradient
