"""A study that runs within a second, and estimators to try on it."""

import numpy as np

STUDY = {
    "name": "small", "seed": 1, "trials": 20,
    "data": {"scene": "uniform_volume", "num_matches": 100, "sigma_px": 0.5},
    "factors": {"outlier_ratio": [0.1, 0.4]},
    "estimators": [{"name": "standard", "options": {"num_iterations": 50}},
                   {"name": "rcme", "label": "rcme_rank_aware", "options": {"reading": "rank_aware", "num_iterations": 50}}],
}
TUNED_STUDY = {
    **STUDY, "factors": {"outlier_ratio": [0.2]},
    "tune": {"estimator": "rcme_rank_aware", "options": {"mu": [-2, 0, 5]}, "target": "failure", "at_most": 0.5,
             "max_refusal": 0.9, "explore": 30, "calibrate": 60, "verify": 40},
}


def rotation_angle(R_a, R_b):
    """Degrees between two rotations."""
    return np.degrees(np.arccos(np.clip((np.trace(R_a.T @ R_b) - 1) / 2, -1, 1)))


def angle(a, b):
    """Degrees between two directions."""
    return np.degrees(np.arccos(np.clip(a @ b / np.linalg.norm(a) / np.linalg.norm(b), -1, 1)))


def vector_of(R):
    """The rotation vector (rad) of a rotation by less than 180 degrees."""
    axis = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    sine = np.linalg.norm(axis) / 2
    return axis / 2 if sine < 1e-12 else axis / (2 * sine) * np.arctan2(sine, (np.trace(R) - 1) / 2)
