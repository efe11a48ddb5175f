#!/usr/bin/python3
"""A made-up audit.json with every shape a figure has to stand; run as: fake_audit.py DIR

Values only look plausible: they follow from no experiment. The same call gives the same file.
"""

import json
import math
import pathlib
import random
import sys

ALPHAS = (0.5, 0.2, 0.1, 0.05, 0.01)
SIGMAS = ("0.05", "0.1", "0.2", "0.5", "1", "2", "5")
SCENES = ("cube", "random_points", "wall", "corridor")


def target(quantity, kind, measured, nominal=None, low=None, high=None, half=None, n=20000, verdict=None, **more):
    """One target; its verdict follows from the interval and the range unless given."""
    half = 4 * math.sqrt(max(measured * (1 - measured), 1 / n) / n) if half is None and kind == "rate" else half or 0
    interval = [measured - half, measured + half]
    if kind == "rate":
        interval = [max(0, interval[0]), min(1, interval[1])]
    if verdict is None:
        verdict = verdict_of(interval, low, high)
    return {"quantity": quantity, "kind": kind, "nominal": nominal, "low": low, "high": high, "threshold": None,
            "measured": measured, "interval": interval, "n": n, "verdict": verdict, "trials_to_decide": None, **more}


def verdict_of(interval, low, high):
    if low is None and high is None:
        return "measured"
    low, high = -math.inf if low is None else low, math.inf if high is None else high
    if low <= interval[0] and interval[1] <= high:
        return "holds"
    return "does not hold" if interval[1] < low or interval[0] > high else "undecided"


def coverage(bias, n=20000, noise=None, what="coverage"):
    """The five targets of a coverage row; `bias` moves all of them down, on the logit scale."""
    targets = []
    for alpha in ALPHAS:
        nominal, margin = 1 - alpha, 0.2 * alpha * (1 - alpha) + 0.002
        logit = math.log(nominal / alpha) - bias + (noise.gauss(0, 0.02) if noise else 0)
        measured = round(n / (1 + math.exp(-logit))) / n
        targets.append(target(f"{what} at alpha {alpha:g}", "rate", measured, nominal, nominal - margin,
                              min(1, nominal + margin), n=n, threshold=3.84))
    return targets


def evidence(targets, verdict="measured", **conditions):
    return {"conditions": {name: str(level) for name, level in conditions.items()}, "num_trials": 20000,
            "verdict": verdict, "targets": targets}


def claim(name, rows, verdict="holds", reading="rank-aware", figure_x="", up_to=None):
    return {"id": name, "family": name.split(".")[0], "label": "eq::metric", "reading": reading, "sentence": "A sentence.",
            "statistic": "a statistic", "verdict": verdict, "holds_up_to_sigma_px": up_to, "figure_x": figure_x,
            "evidence": rows}


def inlier(noise):
    """Coverage over the noise: one series, four series, one that fails, one with exact zeros and ones."""
    grow = {sigma: 0.02 * float(sigma) ** 1.5 for sigma in SIGMAS}
    return [
        claim("inlier.true_pose.rank_aware", [evidence(coverage(0, noise=noise), sigma_px=s, num_points=8)
                                              for s in SIGMAS], figure_x="sigma_px"),
        claim("inlier.true_pose.as_printed", [evidence(coverage(-2.5, noise=noise), sigma_px=s, num_points=8)
                                              for s in SIGMAS], "does not hold", "as printed", "sigma_px"),
        claim("inlier.estimated_pose.rank_aware",
              [evidence(coverage(20 * grow[s] / float(n), noise=noise), sigma_px=s, num_points=n, scene="cube")
               for n in (8, 20, 100) for s in SIGMAS], "holds in the small-noise limit only", figure_x="sigma_px", up_to=0.5),
        claim("inlier.extremes", [evidence(coverage(bias, n=500), sigma_px=s)
                                  for s, bias in zip(("0", *SIGMAS), (9, 4, 2, 0, 0, -2, -4, -30))], "undecided",
              figure_x="sigma_px"),
    ]


def sigma_p(noise):
    """Means of different size in one claim, words along x, a condition that repeats x in other units."""
    def row(sigma, scene):
        bias = 0.03 * float(sigma)
        nees = target("mean NEES over 5", "mean", 1 + bias + noise.gauss(0, 0.004), 1, 0.95, 1.05, 0.012)
        ratio = target("standard deviation, rotation about x", "mean", 1.01 + bias, 1, 0.95, 1.05, 0.02)
        condition = target("condition number of Sigma_p", "mean", 5e4 * (1 + float(sigma)), half=4e3)
        return evidence([nees, ratio, condition], sigma_px=sigma, sigma_rad=float(sigma) / 700, scene=scene)
    return [
        claim("sigma_p.nees", [row(s, scene) for scene in SCENES[:2] for s in SIGMAS], "undecided", figure_x="sigma_px"),
        claim("sigma_p.per_scene", [evidence(coverage(0.1 * i, noise=noise), scene=scene, num_points=20)
                                    for i, scene in enumerate(SCENES)], "does not hold", figure_x="scene"),
        claim("sigma_p.long_words", [evidence([target("bias of the rotation (mrad)", "mean", 0.01 * i, 0, -0.02, 0.02, 0.008)],
                                              scene=f"{scene} with a very long description of its geometry")
                                     for i, scene in enumerate(SCENES)], "does not hold", figure_x="scene"),
    ]


def mle(noise):
    """So many series that they need panels of their own; a range that follows x."""
    rows = [evidence([target("efficiency", "rate", 0.9 - 0.02 * i - 0.01 * j + noise.gauss(0, 0.004), None, 0.7 + 0.02 * k,
                             0.95, n=5000)], num_points=n, scene=scene, outlier_ratio=o)
            for k, n in enumerate((8, 20, 50, 200, 1000)) for i, scene in enumerate(SCENES)
            for j, o in enumerate(("0", "0.3", "0.6"))]
    growing = [evidence([target("mean of the cost", "mean", n - 4.9, n - 5, 0.97 * (n - 5), 1.03 * (n - 5), 0.01 * n)],
                        num_points=n) for n in (8, 10, 20, 50, 200, 1000)]
    return [claim("mle.efficiency", rows, "holds", "", "num_points"),
            claim("mle.degrees_of_freedom", growing, "holds", figure_x="num_points")]


def mu(noise):
    """A ROC curve, a ROC curve of several scenes, and a table."""
    thresholds = [round(-6 + 0.25 * i, 2) for i in range(25)] + [-3.53]

    def rates(shift, **conditions):
        return evidence([target(f"accepted at mu {m:g}", "rate", round(1 / (1 + math.exp(-2.2 * (m - shift))), 4), n=3000,
                                threshold=m) for m in thresholds], **conditions)
    table = [target("accepted at the default mu", "rate", 0.63, None, 0.9, None, n=3000),
             target("mu of equal error", "mean", -3.1, -3.53, -3.7, -3.3, 0.1)]
    return [claim("mu.as_printed.roc", [rates(-4.6, models="good"), rates(-2.8, models="contaminated")], "measured",
                  "as printed"),
            claim("mu.scenes.roc", [rates(shift, models=models, scene=scene, sigma_px=1) for scene, gap in
                                    (("cube", 1.2), ("wall", 0.2)) for models, shift in
                                    (("good", -4 - gap), ("contaminated", -4 + gap))], "measured"),
            claim("mu.default", [evidence(table, sigma_px=1)], "does not hold", "as printed")]


def complexity(noise):
    """A rate and an exponent; five orders of magnitude."""
    fits = [evidence([target("exponent of the time in N", "mean", 1.02 + 0.02 * i, 1, 0.9, 1.1, 0.04, n=30),
                      target("exponent of the time in the number of correspondences", "mean", 0.98, 1, 0.9, 1.1, 0.15, n=30),
                      target("share of the refinement", "rate", 0.031, None, None, 0.05, n=3000),
                      target("constant (microseconds)", "mean", 1234.5 * (1 + i), half=80, n=30),
                      target("remainder", "mean", 0, 0, -1e-5, 1e-5, 0, n=30)], estimator=e)
            for i, e in enumerate(("standard", "rcme", "prcme"))]
    times = [evidence([target("time per pair (ms)", "mean", 0.002 * n ** 1.01, half=0.0002 * n, n=50)], num_points=n)
             for n in (10, 100, 1000, 10000, 100000)]
    return [claim("complexity.exponents", fits), claim("complexity.time", times, "measured", "", "num_points")]


def estimator(noise):
    """25 rows of evidence under long names, and a claim with both."""
    rows = [evidence([target("failure rate of the estimator is at most that of standard RANSAC", "rate",
                             min(1, abs(noise.gauss(0.02, 0.02))), None, None, 0.05, n=2000)],
                     scene=SCENES[i % 4], outlier_ratio=f"{0.1 * (i % 7):g}", sigma_px=SIGMAS[i % 7], num_points=20 + i)
            for i in range(25)]
    return [claim("estimator.rcme.never_worse_than_standard_in_any_scene_of_the_study", rows, "undecided",
                  "rank-aware, predictive likelihood as the criterion of selection"),
            claim("estimator.order", [evidence(coverage(0.2 * i, n=3000, noise=noise), estimator=e) for i, e in
                                      enumerate(("rcme", "prcme"))], "does not hold")]


def failure(noise):
    """One row only; a zero; nothing but nulls; intervals without an end."""
    nothing = target("ratio of the errors", "mean", 1, 1, None, None, verdict="undecided", n=0)
    nothing.update(measured=None, interval=[None, None], nominal=None)
    open_end = target("mean error (deg)", "mean", 3.2, None, None, 5, verdict="undecided", n=40)
    open_end["interval"] = [1.1, None]
    over_x = [evidence([dict(target("mean error (deg)", "mean", 0.5 + 0.5 * i, None, None, 2, 0.3, n=400))], outlier_ratio=o)
              for i, o in enumerate(("0", "0.2", "0.4", "0.6", "0.8"))]
    over_x[2]["targets"][0].update(measured=None, interval=None)
    over_x[3]["targets"][0].update(interval=[1.2, None], verdict="undecided")
    over_x[4]["targets"][0].update(interval=[1.2, 9e9], verdict="undecided")
    return [claim("failure.zero", [evidence([target("failure rate", "rate", 0, None, None, 0.01, n=2000)], sigma_px=1)],
                  figure_x="sigma_px"),
            claim("failure.nulls", [evidence([nothing, open_end], sigma_px=1)], "undecided"),
            claim("failure.gaps", over_x, "undecided", figure_x="outlier_ratio"),
            claim("failure.empty", [], "undecided"), claim("failure.no_targets", [evidence([], sigma_px=1)], "undecided")]


def entropy(noise):
    """25 series, 25 levels; nothing measured; equal bounds; one name without a break; values far apart and negative."""
    levels = [str(2 * i) for i in range(25)]
    many = [evidence([target("entropy", "mean", -5 + 0.1 * i + 0.01 * j, half=0.05)], num_points=levels[i],
                     scene=f"s{j}")
            for i in range(25) for j in range(25)]
    words = [evidence([target("entropy", "mean", -5 + 0.1 * i, -4, -4, -4, half=0.05)], scene=f"scene_{i}") for i in range(25)]
    nothing = [evidence([dict(one, measured=None, interval=[None, None], verdict="undecided") for one in coverage(0)],
                        sigma_px=s) for s in SIGMAS]
    ones = [evidence([dict(one, measured=1, interval=[0.999, 1], verdict="does not hold") for one in coverage(0)],
                     sigma_px=s) for s in SIGMAS]
    wild = [evidence([target("ratio", "mean", value, 1, 0.5, 2, half=abs(value) / 3)], sigma_px=s)
            for s, value in zip(SIGMAS, (1.0, 1.1, 0.9, 1e3, 1e9, 1e-7, 2))]
    jumps = [evidence([target("ratio", "mean", value, 1, 0.5, 2, half=1)], sigma_px=s)
             for s, value in zip(SIGMAS, (1.0, -1.1, 0.9, 1e7, -4e8, 0, 2))]
    return [claim("entropy.many", many, "measured", figure_x="num_points"), claim("entropy.words", words, figure_x="scene"),
            claim("entropy.nothing", nothing, "undecided", figure_x="sigma_px"),
            claim("entropy.ones", ones, "does not hold", figure_x="sigma_px", up_to=0.2),
            claim("entropy." + "x" * 90, wild, "does not hold", "y" * 30, figure_x="sigma_px"),
            claim("entropy.jumps", jumps, "does not hold", figure_x="sigma_px")]


def early_stop(noise):
    """A family of twenty claims."""
    return [claim(f"early_stop.{i}", [evidence(coverage(0.02 * i, noise=noise), sigma_px=s, num_points=n)
                                      for n in (8, 100)[:1 + i % 2] for s in SIGMAS], figure_x="sigma_px") for i in range(20)]


def fake_audit():
    noise = random.Random(1)
    families = (inlier, sigma_p, mle, mu, complexity, estimator, failure, entropy, early_stop)
    claims = [one for family in families for one in family(noise)]
    claims.append(claim("new_family.alone", [evidence(coverage(0, noise=noise), sigma_px=s) for s in SIGMAS], "holds",
                        figure_x="sigma_px"))
    return {"format": "rcme audit 1", "study": "", "seed": 1, "budget": "quick", "confidence_per_target": 0.99992, "num_targets": 600,
            "claims": claims}


if __name__ == "__main__":
    pathlib.Path(sys.argv[1], "audit.json").write_text(json.dumps(fake_audit(), indent=1))
