"""Reads gate.json, which `rcme gate` writes. It checks and names; it computes nothing.

    format, study, old, new, verdict, level, trials_per_condition, conditions, tests: [quantity, verdict, pairs, change, interval,
    margin]
Keys that are not drawn are not looked at.
"""

from dataclasses import dataclass

from common.json_file import is_finite, read_object

ORIGIN = ("rcme gate", "rcme gate 1")
VERDICTS = ("worse", "not worse", "undecided")
NOT_MEASURED = "not measured"


@dataclass(frozen=True)
class Test:
    quantity: str
    verdict: str
    pairs: int
    change: float  # None: not measured
    interval: tuple  # of the change
    margin: float


@dataclass(frozen=True)
class Gate:
    path: str
    study: str
    old: str  # empty: the new version is compared with a limit
    new: str
    verdict: str
    level: float
    rounds: int  # trials of each condition
    conditions: int
    tests: tuple


def read_test(node):
    verdict = node.one_of("verdict", (*VERDICTS, NOT_MEASURED))
    margin = node.get("margin", lambda value: is_finite(value) and value > 0, "a number above 0")
    if verdict == NOT_MEASURED:
        return Test(node.text("quantity"), verdict, node.count("pairs"), None, (), margin)
    interval = node.get("interval", lambda ends: isinstance(ends, list) and len(ends) == 2 and all(map(is_finite, ends)) and
                        ends[0] <= ends[1], "two rising numbers")
    return Test(node.text("quantity"), verdict, node.count("pairs"), node.get("change", is_finite, "a finite number"), tuple(interval),
                margin)


def read_gate(path):
    """The Gate in the file `path`; a cut-off or foreign file is an error, and so is one without quantities."""
    file = read_object(path, *ORIGIN)
    tests = tuple(read_test(node) for node in file.nodes("tests", "test"))
    if all(test.verdict == NOT_MEASURED for test in tests):
        raise file.error("has no quantity that was measured; there is nothing to draw")
    return Gate(path, file.text("study"), file.text("old"), file.text("new"), file.one_of("verdict", VERDICTS), file.fraction("level"),
                file.count("trials_per_condition"), file.count("conditions"), tests)
