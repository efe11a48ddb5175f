"""Reads integrity.json, which `rcme integrity` writes. It checks and names; it computes nothing.

    format, study, estimator, risk, refused, edges_deg, diagrams: [error, alert_limit_deg, trials, without_motion, regions, cells:
    [error, level, n]], all: [error, misleading, misleading_interval]
Keys that are not drawn are not looked at.
"""

from dataclasses import dataclass

from common.json_file import is_finite, read_object

ORIGIN = ("rcme integrity", "rcme integrity 1")
REGIONS = ("available", "misleading", "hazardous", "unavailable", "unavailable_misleading")


@dataclass(frozen=True)
class Diagram:
    error: str  # rotation or direction
    limit_deg: float
    trials: int
    without_motion: int
    regions: dict  # answers of each of REGIONS
    cells: tuple  # (bin of the error, bin of the level, answers)
    misleading: tuple  # share of the answers, and its interval: (value, lower, upper); empty: no answers


@dataclass(frozen=True)
class Integrity:
    path: str
    study: str
    estimator: str
    risk: float
    edges: tuple  # deg, rising
    diagrams: tuple


def read_cell(node, num_bins):
    cell = tuple(node.get(key, lambda value: type(value) is int and 0 <= value < num_bins, f"a number of one of {num_bins} bins")
                 for key in ("error", "level"))
    return (*cell, node.count("n"))


def read_misleading(file, error):
    """Of the row of that error in the table of all conditions."""
    row = next((row for row in file.nodes("all", "row") if row.text("error") == error), None)
    if row is None:
        raise file.error(f"has no row of '{error}' in 'all'")
    value = row.fraction_or("misleading", None)
    if value is None:
        return ()
    return (value, *row.get("misleading_interval", lambda ends: isinstance(ends, list) and len(ends) == 2 and all(map(is_finite, ends)),
                             "two numbers"))


def read_diagram(file, node, num_bins):
    regions = node.node("regions")
    diagram = Diagram(
        node.text("error"), node.get("alert_limit_deg", lambda value: is_finite(value) and 0 < value <= 180, "a number in (0, 180]"),
        node.count("trials"), node.count("without_motion"), {region: regions.count(region) for region in REGIONS},
        tuple(read_cell(cell, num_bins) for cell in node.nodes("cells", "cell")), read_misleading(file, node.text("error")))
    answers = sum(diagram.regions.values())
    if answers != sum(n for _, _, n in diagram.cells) or answers + diagram.without_motion != diagram.trials:
        raise node.error("has regions and cells of different numbers of answers")
    return diagram


def read_integrity(path):
    """The Integrity in the file `path`; a cut-off or foreign file is an error, and so is one without answers."""
    file = read_object(path, *ORIGIN)
    edges = file.get("edges_deg", lambda value: isinstance(value, list) and len(value) > 1 and all(map(is_finite, value)) and
                     0 < value[0] and all(a < b for a, b in zip(value, value[1:])), "a list of rising numbers above 0")
    diagrams = tuple(read_diagram(file, node, len(edges) - 1) for node in file.nodes("diagrams", "diagram"))
    if not any(diagram.cells for diagram in diagrams):
        raise file.error("has no answer with a known truth; there is nothing to draw")
    return Integrity(path, file.text("study"), file.text("estimator"), file.fraction("risk"), tuple(edges), diagrams)
