#!/usr/bin/python3
"""Made-up tune.json and transfer.json; run as: fake_tune.py DIR

Values only look plausible: they follow from no experiment, and intervals not from n. The same call gives the same file.
"""

import itertools
import json
import math
import pathlib
import random
import sys

MUS = ("-6", "-3.5", "-2", "-1", "0", "0.5", "1", "1.5", "2", "3", "4", "6", "8", "12", "20")
LAMBDAS = ("0.1", "0.25", "0.5", "0.75", "1", "1.5", "2")


def rate(value, half=0.02, n=400):
    if value is None:
        return {"value": None, "lower": 0, "upper": 1, "n": 0}
    value = min(1, max(0, value))
    return {"value": value, "lower": max(0, value - half), "upper": min(1, value + 1.4 * half), "n": n}


def target(kind="failure", **changes):
    words = {"failure": "at most 5 % of the trials fail (and at most 50 % are refused), except with probability 0.05",
             "false_refusal": "at most 5 % of the good motions are refused, except with probability 0.05",
             "risk": "1 failure + 0.2 refusal is least"}
    return {"kind": kind, "at_most": None if kind == "risk" else 0.05,
            "max_refusal": 0.5 if kind == "failure" else None, "delta": 0.05, "words": words[kind], **changes}


def option(name, levels, unit=""):
    return {"name": name, "unit": unit, "levels": list(levels)}


def logistic(x):
    return 1 / (1 + math.exp(-x))


def setting(levels, noise):
    """Failure falls and refusal grows with the number in front; words count as their length."""
    numbers = [float(level) if level.lstrip("-").replace(".", "").isdigit() else len(level) / 10 for level in levels]
    mu, rest = numbers[0], sum(numbers[1:])
    failure = 0.45 * logistic(-0.8 * (mu - 1.2 + 0.5 * rest)) + 0.012
    refusal = 0.9 * logistic(0.7 * (mu - 6 + rest))
    return {"levels": list(levels), "failure": rate(failure + noise.gauss(0, 0.003)),
            "refusal": rate(refusal + noise.gauss(0, 0.004), 0.03), "false_refusal": rate(0.6 * refusal),
            "is_on_front": False, "is_on_path": False, "is_certified": False}


def settings(options, seed=1):
    noise = random.Random(seed)
    found = [setting(levels, noise) for levels in itertools.product(*(option["levels"] for option in options))]
    for one in found:
        place = one["refusal"]["value"], one["failure"]["value"]
        one["is_on_path"] = not any(better["refusal"]["value"] < place[0] and
                                    better["failure"]["value"] < place[1] - 0.004 for better in found)
        one["is_on_front"] = one["is_on_path"]
        one["is_certified"] = one["is_on_path"] and one["failure"]["upper"] < 0.065
    return found


def chosen(one):
    return {"levels": one["levels"], "failure_or_refusal": rate(one["failure"]["value"] + one["refusal"]["value"]),
            **{key: one[key] for key in ("failure", "refusal", "false_refusal")}}


def other(label, words, levels, failure, refusal):
    return {"label": label, "words": words, "levels": levels, "failure": rate(failure), "refusal": rate(refusal),
            "failure_or_refusal": rate(failure + refusal)}


def roc(estimator, population, score, power, marks):
    """A curve y = x^power."""
    xs = [(i / 60) ** 2 for i in range(61)]
    curve = [[None if x in (0, 1) else round(-8 + 20 * x, 3), x, x ** power] for x in xs]
    return {"estimator": estimator, "population": population, "score": score, "num_good": 900, "num_bad": 850, "curve": curve,
            "auc": {"value": 1 / (1 + power), "lower": 1 / (1 + power) - 0.013, "upper": 1 / (1 + power) + 0.011},
            "marks": [{"words": words, "false_accept_rate": x, "true_accept_rate": x ** power} for words, x in marks]}


def rocs():
    return [roc("rcme_as_printed", "samples", "psi, nats", 0.35, [("paper, mu = -3.53", 0.31)]),
            roc("rcme_as_printed", "winners", "psi, nats", 0.55, [("paper, mu = -3.53", 0.52)]),
            roc("rcme_rank_aware", "samples", "excess entropy, nats", 0.12,
                [("as in the study, mu = 6", 0.04), ("tuned, mu = 1.5", 0.055)]),
            roc("rcme_rank_aware", "winners", "excess entropy, nats", 0.2,
                [("as in the study, mu = 6", 0.02), ("tuned, mu = 1.5", 0.11)])]


def tune(options=None, kind="failure", **changes):
    options = options or [option("mu", MUS, "nats"), option("lambda", LAMBDAS)]
    found = settings(options)
    certified = [one for one in found if one["is_certified"]]
    best = min(certified, key=lambda one: one["refusal"]["value"], default=None)
    numbers = [one["name"] for one in options[:2]] == ["mu", "lambda"] or None
    rest = [one["levels"][0] for one in options[2:]]
    return {"format": "rcme tuning 1", "study": "tune_mu_lambda", "estimator": "rcme_rank_aware", "seed": 1,
            "target": target(kind), "options": options, "settings": found, "tuned": best and chosen(best),
            "others": [other("rcme_as_printed", "as in the study", numbers and ["-3.53", "0.5", *rest], 0.31, 0.02),
                       other("rcme_rank_aware", "as in the study", numbers and ["6", "0.5", *rest], 0.022, 0.5),
                       other("rcme_rank_aware", "mu = 40", numbers and ["40", "3", *rest], 0.01, 0.88),
                       other("standard", "", None, 0.41, 0.0), other("prcme", "", None, 0.33, 0.01)],
            "roc": rocs(), **changes}


def families(count):
    scenes = ("room", "corridor", "street", "facade", "cube", "wall")
    motions = ("forward", "sideways", "turning", "slow", "mixed")
    pairs = [(scene, motion) for motion in motions for scene in scenes][:count]
    noise = random.Random(2)
    found = [{"words": f"scene = {scene}, motion = {motion}" if count > 6 else f"scene = {scene}",
              "levels": [noise.choice(MUS[5:12]), noise.choice(LAMBDAS)], "why": ""} for scene, motion in pairs]
    for number in range(3, count, 11):
        found[number].update(levels=None, why="unreachable: nearest 7.3 % failure at 50 % refusal")
    return found


def cell(i, j, noise):
    value = min(0.9, abs(noise.gauss(0.03 + 0.004 * abs(i - j), 0.02)))
    if noise.random() < 0.1:
        value += 0.3 * noise.random()
    half = 0.012
    verdict = "holds" if value + half < 0.06 else "does not hold" if value - half > 0.05 else "undecided"
    return {"tuned_on": i, "verified_on": j, "rate": rate(value, half), "failure": rate(value, half),
            "refusal": rate(noise.random() ** 2), "false_refusal": rate(0.1), "verdict": verdict}


def transfer(count=6, kind="failure", **changes):
    noise, found = random.Random(3), families(count)
    cells = [cell(i, j, noise) for i in range(count) if found[i]["levels"] for j in range(count)]
    return {"format": "rcme transfer 1", "study": "tune_mu_lambda", "estimator": "rcme_rank_aware", "seed": 1,
            "target": target(kind), "options": [option("mu", MUS, "nats"), option("lambda", LAMBDAS)],
            "families": found, "cells": cells, **changes}


if __name__ == "__main__":
    for name, value in (("tune", tune()), ("transfer", transfer())):
        pathlib.Path(sys.argv[1], f"{name}.json").write_text(json.dumps(value, indent=1))
