#!/usr/bin/python3
"""OpenCV's five-point RANSAC as an estimator of {process: "python3 examples/any_language/opencv_estimator.py"}: a line of JSON
with a problem in, a line with the answer out. As a module it gives `estimate`, the same for rcme.run."""

import json
import sys
import time

import cv2
import numpy as np

cv2.setNumThreads(1)
THRESHOLD_SIGMAS = 2.0
CONFIDENCE = 0.999


def estimate(x1, x2, camera1, camera2, options):
    """N x 2 points (px), cameras as dicts, options sigma_px and seed; ((R, t), {"inliers": indices}), or None."""
    rays = [(np.asarray(x) - camera["params"][2:]) / camera["params"][:2] for x, camera in ((x1, camera1), (x2, camera2))]
    focal_px = np.mean([camera["params"][:2] for camera in (camera1, camera2)])
    cv2.setRNGSeed(options["seed"])
    E, mask = cv2.findEssentialMat(*rays, np.eye(3), cv2.RANSAC, CONFIDENCE, THRESHOLD_SIGMAS * options["sigma_px"] / focal_px)
    if E is None or E.shape != (3, 3):
        return None
    count, R, t, mask = cv2.recoverPose(E, *rays, np.eye(3), mask=mask)
    return ((R, t.ravel()), {"inliers": np.flatnonzero(mask)}) if count >= 6 else None


def answer_to(problem):
    """The answer as a dict; the id says which problem it answers, the seconds are those of the estimate alone."""
    start = time.process_time()
    found = estimate(problem["x1"], problem["x2"], problem["camera1"], problem["camera2"], problem)
    about = {"id": problem["id"], "seconds": time.process_time() - start}
    if found is None:
        return {**about, "status": "no_candidate"}
    (R, t), info = found
    return {**about, "R": R.tolist(), "t": t.tolist(), "inliers": info["inliers"].tolist()}


def main():
    for line in sys.stdin:
        print(json.dumps(answer_to(json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
