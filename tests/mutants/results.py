"""The committed results: one line per mutant (results.csv), and the score of each room (RESULTS.md)."""

import csv
import math

from judge import Verdict

FIELDS = ("room", "file", "name", "outcome", "by")


def read_verdicts(path):
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return [Verdict(**row) for row in csv.DictReader(file)]


def write_verdicts(path, verdicts):
    with path.open("w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(FIELDS)
        rows.writerows([getattr(verdict, field) for field in FIELDS] for verdict in verdicts)


def binomial_tail(k, n, p):
    """P(Binomial(n, p) >= k)."""
    return math.fsum(math.comb(n, i) * p**i * (1.0 - p)**(n - i) for i in range(k, n + 1))


def root_of(rising, level):
    """Where a rising function on [0, 1] takes a value."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if rising(middle) < level else (low, middle)
    return 0.5 * (low + high)


def clopper_pearson(k, n, confidence=0.95):
    tail = 0.5 * (1.0 - confidence)
    lower = 0.0 if k == 0 else root_of(lambda p: binomial_tail(k, n, p), tail)
    upper = 1.0 if k == n else root_of(lambda p: binomial_tail(k + 1, n, p), 1.0 - tail)
    return lower, upper


def score_row(label, verdicts):
    caught = sum(v.outcome == "caught" for v in verdicts)
    equivalent = sum(v.outcome == "equivalent" for v in verdicts)
    n = len(verdicts) - equivalent
    if n == 0:
        return f"| {label} | {len(verdicts)} | {equivalent} | 0 | - | - |"
    lower, upper = clopper_pearson(caught, n)
    return (f"| {label} | {len(verdicts)} | {equivalent} | {caught} | {n - caught} | "
            f"{100 * caught / n:.1f} % [{100 * lower:.1f}, {100 * upper:.1f}] |")


def summary(verdicts, rooms):
    lines = ["| room | mutants | equivalent | caught | not caught | score, exact 95 % interval |",
             "|---|---|---|---|---|---|"]
    for room in rooms:
        of_room = [v for v in verdicts if v.room == room]
        if of_room:
            lines.append(score_row(room, of_room))
    lines.append(score_row("all", verdicts))
    for outcome, title in (("survived", "Survived"), ("not reached", "Not reached by any test of the room"),
                           ("equivalent", "Equivalent")):
        of_outcome = [v for v in verdicts if v.outcome == outcome]
        if of_outcome:
            lines += ["", f"{title}:", ""]
            lines += [f"- {v.room} `{v.name}` ({v.file})" + (f": {v.by}" if v.by else "") for v in of_outcome]
    return "\n".join(lines) + "\n"
