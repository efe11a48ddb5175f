"""What is known of the event's rate at draws that were not tried."""

import numpy as np
from sklearn.ensemble import ExtraTreesRegressor


class Surrogate:
    """Extremely randomised trees: they take words and absent keys as they are, and many irrelevant keys."""

    def __init__(self, features, events, trials, seed):
        tried = trials > 0
        self.model = ExtraTreesRegressor(n_estimators=30, min_samples_leaf=2, max_features=0.5, random_state=seed)
        self.model.fit(features[tried], events[tried] / trials[tried], sample_weight=trials[tried])

    def tree_rates(self, features):
        """(trees, draws)."""
        return np.array([tree.predict(features) for tree in self.model.estimators_], dtype=np.float32)

    def rates(self, features):
        return self.model.predict(features)


def choose_promising(tree_rates, number, rng):
    """Draws to try next, by their columns: each is the best of those that remain for ten of the trees (Thompson sampling:
    where the trees disagree, different ones win). Ties are broken at random."""
    chosen, is_taken = [], np.zeros(tree_rates.shape[1], dtype=bool)
    for _ in range(min(number, len(is_taken))):
        score = tree_rates[rng.integers(0, len(tree_rates), 10)].mean(axis=0) + 1e-6 * rng.random(len(is_taken))
        score[is_taken] = -1.0
        best = int(np.argmax(score))
        is_taken[best] = True
        chosen.append(best)
    return chosen
