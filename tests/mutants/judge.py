"""What becomes of one mutant: the tests that reach it, cheapest first, until one fails."""

import dataclasses

from room_tests import run_tests

FIRST_BATCH_CPU_S = 1.0  # batches double: a few tests where one of them catches it, few processes where none does


@dataclasses.dataclass(frozen=True)
class Verdict:
    room: str
    file: str
    name: str
    outcome: str  # caught, survived, not reached, equivalent
    by: str       # the test that caught it, or how it ended; why it is equivalent


def batches(traced):
    """Tests of one program each, cheapest first; each batch costs about twice as much as the one before."""
    batch, cost, allowed = [], 0.0, FIRST_BATCH_CPU_S
    for test in sorted(traced, key=lambda t: t.cpu_s):
        other = batch and (batch[0].test.program != test.test.program or not test.test.name)
        if other or cost > allowed:
            yield batch
            batch, cost, allowed = [], 0.0, allowed if other else 2.0 * allowed
        batch.append(test)
        cost += test.cpu_s
    if batch:
        yield batch


def judge(mutant, number, traced, tree):
    """`traced`: the tests that reach the mutant."""
    verdict = lambda outcome, by="": Verdict(mutant.room, mutant.file, mutant.name, outcome, by)  # noqa: E731
    if not traced:
        return verdict("not reached")
    for batch in batches(traced):
        cost = sum(test.cpu_s for test in batch)
        run = run_tests([test.test for test in batch], tree, {"RCME_MUTANT": str(number)}, 20.0 + 10.0 * cost)
        if not run.passed:
            return verdict("caught", run.how)
    return verdict("survived")
