"""Reads reliability.json, which `rcme reliability` writes. It checks and names; it computes nothing.

    format, study, by, histogram_edges, entries: [estimator, group, source, n, refused, and where n is not 0
    mean_probability, failure, sure_failed, sure, brier,
    calibration_slope, area_under_curve, risk_coverage_area, calibration_error, curve, band, bins, histogram, risk_coverage]
Keys that are not drawn are not looked at.
"""

import math
from dataclasses import dataclass

from common.json_file import is_finite, read_object

ORIGIN = ("rcme reliability", "rcme reliability 1")
STATED, PROXY = "stated", "inlier_share"


@dataclass(frozen=True)
class Measured:
    """NaN: not known."""

    value: float
    lower: float
    upper: float


@dataclass(frozen=True)
class Bin:
    mean_probability: float
    failure: Measured
    n: int


@dataclass(frozen=True)
class Entry:
    """One estimator in one group."""

    estimator: str
    group: str
    source: str
    n: int
    refused: int
    mean_probability: float
    failure: Measured
    sure_failed: Measured
    sure: Measured
    brier: Measured
    slope: Measured
    auc: Measured
    risk_coverage_area: Measured
    calibration_error: float
    error_if_calibrated: float
    curve: tuple  # (probability, share that failed), rising, straight lines between
    band: tuple  # (probability, lower, upper)
    bins: tuple
    histogram: tuple  # numbers per bin of the file's edges
    risk_coverage: tuple  # (coverage, risk), rising coverage
    is_of_population: bool  # its trials are of draws of a population


@dataclass(frozen=True)
class Reliability:
    path: str
    study: str
    by: str
    sure_below: float
    edges: tuple
    entries: tuple  # those with a probability


def read_measured(parent, key):
    node = parent.node(key)
    interval = node.get("interval", lambda ends: isinstance(ends, list) and len(ends) == 2 and
                        all(end is None or is_finite(end) for end in ends), "two numbers or nulls")
    return Measured(node.number_or("value", math.nan), *(math.nan if end is None else end for end in interval))


def read_bin(node):
    return Bin(node.fraction("mean_probability"), read_measured(node, "failure"), node.node("failure").count("n"))


def read_curve(entry):
    """Both ends of every step."""
    points = []
    for node in entry.nodes("curve", "step"):
        points += [(node.fraction(end), node.fraction("recalibrated")) for end in ("first", "last")]
    return tuple(points)


def read_histogram(node, num_bins):
    counts = node.get("histogram", lambda value: isinstance(value, list) and len(value) == num_bins and
                      all(type(count) is int and count >= 0 for count in value), f"a list of {num_bins} whole numbers")
    return tuple(counts)


def read_entry(node, num_bins):
    error = node.node("calibration_error")
    return Entry(
        node.text("estimator"), node.text("group"), node.one_of("source", (STATED, PROXY)), node.count("n"),
        node.count("refused"), node.fraction("mean_probability"), *(read_measured(node, key) for key in (
            "failure", "sure_failed", "sure", "brier", "calibration_slope", "area_under_curve", "risk_coverage_area")),
        error.fraction("value"), error.fraction("mean_if_calibrated"), read_curve(node),
        tuple(tuple(point.fraction(key) for key in ("probability", "lower", "upper"))
              for point in node.nodes("band", "point")),
        tuple(map(read_bin, node.nodes("bins", "bin"))), read_histogram(node, num_bins),
        tuple((point.fraction("coverage"), point.fraction("risk")) for point in node.nodes("risk_coverage", "point")),
        "intervals_of" in node.value)


def read_reliability(path):
    """The Reliability in the file `path`; a cut-off or foreign file is an error."""
    file = read_object(path, *ORIGIN)
    edges = file.get("histogram_edges", lambda value: isinstance(value, list) and len(value) > 1 and
                     all(map(is_finite, value)), "a list of numbers")
    entries = tuple(read_entry(node, len(edges) - 1) for node in file.nodes("entries", "entry") if node.count("n") > 0)
    if not entries:
        raise file.error("has no estimator with a probability; there is nothing to draw")
    return Reliability(path, file.text("study"), file.text("by"), file.fraction("sure_below"), tuple(edges), entries)
