"""rcme: robust two-view camera motion with its uncertainty, and its validation on simulated scenes.

    pose, info = rcme.estimate_relative_pose(x1, x2, camera1, camera2, {"sigma_px": 0.7})

estimates one motion, `estimate_relative_poses` those of many pairs; `simulate` gives the matches of a simulated trial with their truth, `write_pairs` brings such of your own into studies; `run` tries estimators on a study,
functions of Python among them, `replay` one trial of it; `summarize`, `compare`, `reliability` and `audit` say what came of it, as data frames, `trials` gives
every trial;
`plot` draws them on axes of yours. docs/python.md begins at the beginning.

Conventions, everywhere:

- A point X1 in camera 1's frame is X2 = R X1 + t in camera 2's; cameras look along +z, x to the right, y down. The scale
  cannot be seen: |t| = 1.
- Points are in pixels, N x 2, distorted as the camera's model says; (0, 0) is the centre of the top-left pixel. Points and
  cameras that share COLMAP's origin, its corner, may stay as they are: half a pixel hardly changes an answer.
- pose_cov is 6 x 6, of [w1, w2, w3, dt1, dt2, dt3]: the true R is Exp([w]x) R, w in rad, and the true t
  is t + dt, both along the axes of camera 2; dt has no unit. Its rank is 5: nothing along t. For a normalised
  error square leave that direction out (docs/python.md).
- Numbers that nobody knows are NaN (of a data frame), or None (of a dict).
- A wrong argument is a ValueError that names it, what it was and what is expected. What goes wrong in an estimate is no
  exception but a status.
"""

import pathlib

from rcme import _rcme, plot
from rcme._estimate import Pose, Poses, estimate_relative_pose, estimate_relative_poses, estimators, intrinsics
from rcme._rcme import __version__
from rcme._pairs import write_pairs
from rcme._study import conditions, conform, replay, run, simulate, tune
from rcme._tables import audit, compare, reliability, summarize, trials

__all__ = ["Pose", "Poses", "audit", "compare", "conditions", "conform", "estimate_relative_pose", "estimate_relative_poses",
           "estimators", "intrinsics", "plot", "reliability", "replay", "run", "simulate", "summarize", "trials", "tune", "write_pairs", "__version__"]

# The studies, estimator files and populations that come with the package, by name.
_rcme.use_share(str(pathlib.Path(__file__).resolve().parent / "share" / "rcme"))
