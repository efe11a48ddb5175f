"""A made-up integrity.json: values follow from no experiment."""


def diagram(error="rotation", limit=1, **changes):
    """200 trials; the bins are decades from .01 deg."""
    return {"error": error, "alert_limit_deg": limit, "trials": 200, "without_motion": 20, "without_truth": 0,
            "regions": {"available": 90, "misleading": 7, "hazardous": 2, "unavailable": 78, "unavailable_misleading": 3},
            "cells": [{"error": 0, "level": 1, "n": 90}, {"error": 1, "level": 0, "n": 7}, {"error": 2, "level": 1, "n": 2},
                      {"error": 1, "level": 3, "n": 78}, {"error": 3, "level": 2, "n": 3}], **changes}


def row(error, value=0.0667, lower=0.0351, upper=0.1135):
    return {"error": error, "misleading": value, "misleading_interval": [lower, upper], "risk": "exceeded"}


def content(*diagrams, **changes):
    diagrams = diagrams or (diagram(), diagram("direction", 5))
    return {"format": "rcme integrity 1", "study": "demo", "estimator": "rcme_calibrated", "risk": 0.001, "refused": 20,
            "edges_deg": [0.01, 0.1, 1.0, 10.0, 180.0], "diagrams": list(diagrams),
            "all": [row(one["error"]) for one in diagrams], **changes}
