"""Another implementation of the M-estimators, for tests/estimator/refinement/m_estimation_test.cc: prints the constants
that stand there. Needs NumPy and SciPy.

Sampson residuals of 24 matches, three of them wrong, least sum of rho by scipy.optimize.least_squares with its own
Huber loss and with Tukey's given as a function; derivatives by differences.
"""

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

FOCAL, CENTRE, SIGMA = 500.0, np.array([320.0, 240.0]), 0.5
K = np.array([[FOCAL, 0.0, CENTRE[0]], [0.0, FOCAL, CENTRE[1]], [0.0, 0.0, 1.0]])
R_TRUE = Rotation.from_rotvec([0.05, -0.1, 0.02]).as_matrix()
T_TRUE = np.array([1.0, 0.1, 0.2]) / np.linalg.norm([1.0, 0.1, 0.2])


def project(points):
    return FOCAL * points[:, :2] / points[:, 2:] + CENTRE


def make_matches():
    rng = np.random.default_rng(1)
    points = np.column_stack([rng.uniform(-2, 2, 24), rng.uniform(-1.5, 1.5, 24), rng.uniform(3, 8, 24)])
    x1, x2 = project(points), project(points @ R_TRUE.T + T_TRUE)
    x1, x2 = x1 + SIGMA * rng.normal(size=x1.shape), x2 + SIGMA * rng.normal(size=x2.shape)
    x2[[3, 11, 17]] += [[8.0, -12.0], [-20.0, 15.0], [3.0, 6.0]]
    return np.round(np.column_stack([x1, x2]), 2)


def motion(parameters):
    """Rotation vector beside the true rotation, direction by two tangents at the true one."""
    tangents = np.linalg.svd(T_TRUE[None, :])[2][1:]
    t = T_TRUE + tangents.T @ parameters[3:]
    return Rotation.from_rotvec(parameters[:3]).as_matrix() @ R_TRUE, t / np.linalg.norm(t)


def residuals(parameters, matches):
    R, t = motion(parameters)
    skew = np.array([[0, -t[2], t[1]], [t[2], 0, -t[0]], [-t[1], t[0], 0]])
    F = np.linalg.inv(K).T @ skew @ R @ np.linalg.inv(K)
    x1, x2 = (np.column_stack([matches[:, k:k + 2], np.ones(len(matches))]) for k in (0, 2))
    line2, line1 = x1 @ F.T, x2 @ F
    gradient = np.sqrt(np.sum(line1[:, :2] ** 2 + line2[:, :2] ** 2, axis=1))
    return np.sum(x2 * line2, axis=1) / (SIGMA * gradient)


def tukey(z):
    """rho, rho', rho'' of z = (r / c)^2 as least_squares takes them: sum 0.5 c^2 rho(z)."""
    inside = np.minimum(z, 1.0)
    return np.array([(1 - (1 - inside) ** 3) / 3, np.where(z < 1, (1 - inside) ** 2, 0.0),
                     np.where(z < 1, -2 * (1 - inside), 0.0)])


def main():
    matches = make_matches()
    for row in matches:
        print("    {" + ", ".join(f"{x:g}" for x in row) + "},")
    for name, loss, scale in (("huber", "huber", 1.345), ("tukey", tukey, 4.685)):
        fit = least_squares(residuals, np.zeros(5), args=(matches,), loss=loss, f_scale=scale,
                            xtol=1e-15, ftol=1e-15, gtol=1e-15, jac="3-point")
        R, t = motion(fit.x)
        print(name, "cost", repr(fit.cost), "R", R.ravel().tolist(), "t", t.tolist())


if __name__ == "__main__":
    main()
