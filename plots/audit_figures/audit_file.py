"""Reads DIR/audit.json, which `rcme audit --out DIR` writes. It checks and names; it computes nothing.

    audit: format, study, seed, budget, confidence_per_target, claims
    claim: id, family, reading, verdict, holds_up_to_sigma_px, figure_x, evidence
    evidence (one combination of conditions): conditions, targets
    target (one measured quantity): quantity, kind, nominal, low, high, threshold, measured, interval, n, verdict, side
Keys beyond these are not drawn and not looked at. A null is "none": no nominal value, no bound on that side, no finite
measured value.
"""

import math
import re
from dataclasses import dataclass

from common.command_line import PlotError
from common.json_file import is_finite, read_object

FORMAT = "rcme audit 1"
HOLDS, HOLDS_AT_SMALL_NOISE, DOES_NOT_HOLD = "holds", "holds in the small-noise limit only", "does not hold"
UNDECIDED, MEASURED, NOT_POSSIBLE = "undecided", "measured", "not possible"
TARGET_VERDICTS = (HOLDS, DOES_NOT_HOLD, UNDECIDED, MEASURED)
CLAIM_VERDICTS = (HOLDS, HOLDS_AT_SMALL_NOISE, DOES_NOT_HOLD, UNDECIDED, MEASURED, NOT_POSSIBLE)
KINDS = ("rate", "mean")
SIDES = ("", "too narrow", "too wide", "too narrow and too wide")  # how a confidence region is wrong


@dataclass(frozen=True)
class Target:
    """One measured quantity. NaN: no such value. -inf and inf: no bound on that side."""

    quantity: str
    kind: str
    nominal: float
    low: float
    high: float
    threshold: float
    measured: float
    lower: float
    upper: float
    n: int
    verdict: str
    side: str = ""

    @property
    def is_claim(self):
        """Whether there is an allowed range at all."""
        return self.low > -math.inf or self.high < math.inf


@dataclass(frozen=True)
class Evidence:
    conditions: dict  # name of the condition -> its level, as text
    targets: tuple
    not_possible: str = ""  # why it cannot be measured there


@dataclass(frozen=True)
class Claim:
    id: str
    family: str
    reading: str
    verdict: str
    holds_up_to_sigma_px: float
    figure_x: str  # the condition drawn along x; "" if there is none
    evidence: tuple
    label: str = ""  # where the paper says it
    sentence: str = ""
    statistic: str = ""  # what was measured, in words
    side: str = ""


@dataclass(frozen=True)
class Audit:
    path: str
    study: str  # "": the built-in scenes
    seed: int
    budget: str
    confidence_per_target: float
    claims: tuple

    def families(self):
        """{family: its claims}, in the order of the file."""
        return {family: [claim for claim in self.claims if claim.family == family]
                for family in dict.fromkeys(claim.family for claim in self.claims)}


def read_target(node):
    interval = node.get("interval", is_interval, "null or [lower, upper], each a finite number or null")
    lower, upper = interval or (None, None)
    target = Target(
        quantity=node.text("quantity"), kind=node.one_of("kind", KINDS), nominal=node.number_or("nominal", math.nan),
        low=node.number_or("low", -math.inf), high=node.number_or("high", math.inf),
        threshold=node.number_or("threshold", math.nan), measured=node.number_or("measured", math.nan),
        lower=-math.inf if lower is None else lower, upper=math.inf if upper is None else upper,
        n=node.count("n"), verdict=node.one_of("verdict", TARGET_VERDICTS), side=side_if_any(node))
    if target.low > target.high:
        raise node.error(f"has 'low' {target.low:g} above 'high' {target.high:g}")
    if target.kind == "rate" and not (math.isnan(target.measured) or 0 <= target.measured <= 1):
        raise node.error(f"has 'measured': {target.measured:g}; a rate must lie in 0..1")
    return target


def is_interval(value):
    if value is None:
        return True
    return (isinstance(value, list) and len(value) == 2 and all(end is None or is_finite(end) for end in value)
            and (None in value or value[0] <= value[1]))


def read_evidence(node):
    conditions = node.get("conditions", lambda value: isinstance(value, dict) and
                          all(isinstance(level, str) for level in value.values()), "an object of texts")
    return Evidence(conditions, tuple(map(read_target, node.nodes("targets", "target"))), text_if_any(node, "not_possible"))


def side_if_any(node):
    return node.one_of("side", SIDES) if "side" in node.value else ""


def text_if_any(node, key):
    return node.text(key) if key in node.value else ""


def read_claim(node):
    node.place += f" ('{node.text('id')}')"
    family = node.get("family", lambda value: isinstance(value, str) and re.fullmatch(r"[A-Za-z0-9_-]+", value),
                      "a name of letters, digits, '_' and '-', because it becomes part of a file's name")
    claim = Claim(id=node.text("id"), family=family, reading=node.text("reading"),
                  verdict=node.one_of("verdict", CLAIM_VERDICTS),
                  holds_up_to_sigma_px=node.number_or("holds_up_to_sigma_px", math.nan),
                  figure_x=node.text("figure_x"),
                  evidence=tuple(map(read_evidence, node.nodes("evidence", "evidence"))), side=side_if_any(node),
                  **{key: text_if_any(node, key) for key in ("label", "sentence", "statistic")})
    for number, evidence in enumerate(claim.evidence, 1):
        if claim.figure_x and claim.figure_x not in evidence.conditions:
            raise node.error(f"has 'figure_x': '{claim.figure_x}', but evidence {number} has no such key in 'conditions'")
    return claim


def read_audit(path):
    """The Audit in the file `path`; a cut-off or foreign file is an error, never a shorter audit."""
    node = read_object(path, "rcme audit --out DIR", FORMAT)
    audit = Audit(path, study=node.text("study"), seed=node.whole_number("seed"),
                  budget=node.text("budget"), confidence_per_target=node.fraction("confidence_per_target"),
                  claims=tuple(map(read_claim, node.nodes("claims", "claim"))))
    if not audit.claims:
        raise PlotError(f"{path}: has no claims ('claims' is empty), so there is nothing to draw.")
    return audit
