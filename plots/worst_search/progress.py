"""What a search costs, before it and while it runs, on standard error."""

import sys
import time

from worst_search.search import spent_by

SECONDS_BETWEEN = 5.0


def duration(seconds):
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min"


class Progress:
    def __init__(self):
        self.total, self.last = 0, 0.0

    def begin(self, objective, plan):
        exploring, growing, fresh = spent_by(objective, plan)
        self.total = exploring + growing + fresh
        print(f"worst: about {self.total} trials: {exploring} look for draws, at most {growing} try them again and grow "
              f"regions around them, {fresh} are fresh ones", file=sys.stderr)

    def show(self, objective):
        if not self.total or time.monotonic() - self.last < SECONDS_BETWEEN:
            return
        self.last = time.monotonic()
        left = max(0, self.total - objective.calls) * objective.seconds / max(1, objective.calls)
        print(f"worst: {objective.calls} of about {self.total} trials, about {duration(left)} left", file=sys.stderr)

    def end(self, objective):
        print(f"worst: {objective.calls} trials, {duration(objective.seconds)} of trials", file=sys.stderr)
