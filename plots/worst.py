#!/usr/bin/python3
"""Searches a population for regions in which an estimator is worst, and measures each with fresh trials: what `rcme worst`
runs. FOLDER holds study.yaml and pool.csv, and receives everything else."""

import csv
import hashlib
import os
import sys

from worst_search.run_rcme import end_with_parent

if __name__ == "__main__":
    end_with_parent()  # before the imports that take long

from common.command_line import Parser, PlotError, run
from common.whole_file import write_text

try:
    from worst_search.progress import Progress
    from worst_search.report import write_report
    from worst_search.run_trials import CLAIMS, QUANTITIES, TrialsOfRun
    from worst_search.search import Plan, find_worst
    from worst_search.space import Space
except ImportError as missing:
    sys.exit(f"worst: Python lacks {missing.name}; on Debian: apt-get install python3-sklearn python3-yaml")

PILOT_DRAWS = 64  # whose time says how many trials --minutes allows
DEFAULT_TRIALS = 5000
MANY_TRIALS = 3000  # with fewer, fewer and smaller looks into each box
HELD_OUT = 0.25  # of the pool, its last draws: the search does not see them, and shares of the population are counted on them
SHARE_OF_TIME = 0.8  # for the trials; the rest for the search itself and the pictures


def parse(arguments):
    parser = Parser(prog="rcme worst", description=__doc__)
    parser.add_argument("folder", metavar="FOLDER")
    parser.add_argument("--rcme", required=True, metavar="PROGRAM", help="whose `run` makes the trials")
    parser.add_argument("--estimator", action="append", required=True, metavar="LABEL", help="a second one: the reference")
    parser.add_argument("--quantity", choices=list(QUANTITIES), default="failure")
    parser.add_argument("--trials", type=int, default=0, help=f"0: {DEFAULT_TRIALS}, or what --minutes allows")
    parser.add_argument("--minutes", type=int, default=0)
    parser.add_argument("--regions", type=int, default=3)
    parser.add_argument("--fresh", type=int, default=300)
    parser.add_argument("--claim", type=float)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--allow-process", action="store_true")
    return parser.parse_args(arguments)


def read_pool(path):
    """(keys, numbers of the draws, levels)."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    return rows[0][1:], [int(row[0]) for row in rows[1:]], [row[1:] for row in rows[1:]]


def split_pool(keys, rows):
    """(Space of the draws that are searched, Table of those that are held out). Of the design sobol the two parts are not
    independent, but intervals of shares hold: with at least 97 % for the largest and the smallest of 60 random boxes (95 %
    nominal, 15,000 and 5,000 draws of 12 axes)."""
    num_searched = len(rows) - int(HELD_OUT * len(rows))
    space = Space(keys, rows[:num_searched])
    return space, space.table(rows[num_searched:])


def check_is_same(folder, options):
    """Answers in the folder are those of one search: another one is refused."""
    with open(os.path.join(folder, "study.yaml"), "rb") as file:
        study = hashlib.sha256(file.read()).hexdigest()
    words = [f"{key} = {value}" for key, value in sorted(vars(options).items())
             if key not in ("folder", "rcme", "threads", "allow_process")]
    text = "\n".join([f"study = {study}", *words, ""])
    path = os.path.join(folder, "search.txt")
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            known = file.read()
        if known != text:
            raise PlotError(f"{folder} holds a search with other arguments or of another study; give another folder.")
    else:
        write_text(path, text)


def budget_of(options, objective):
    if options.trials or not options.minutes:
        return options.trials or DEFAULT_TRIALS
    objective.try_draws("pilot", range(min(PILOT_DRAWS, objective.space.pool.size)), 1)
    each = objective.seconds / max(1, objective.calls)
    return max(500, int(SHARE_OF_TIME * 60 * options.minutes / max(each, 1e-6)))


def search(arguments):
    options = parse(arguments)
    check_is_same(options.folder, options)
    keys, numbers, rows = read_pool(os.path.join(options.folder, "pool.csv"))
    progress = Progress()
    more = ["--allow-process"] if options.allow_process else []
    space, held_out = split_pool(keys, rows)
    objective = TrialsOfRun(options.folder, options.rcme, space, numbers, options.quantity, options.estimator,
                            options.threads, more, progress.show)
    claim = CLAIMS[options.quantity] if options.claim is None else options.claim
    budget = budget_of(options, objective)
    plan = Plan(budget=budget, num_regions=options.regions, num_fresh=options.fresh, claim=claim,
                num_raced=min(120, budget // 20), box_draws=min(80, max(40, budget // 40)),
                num_looks=3 if budget >= MANY_TRIALS else 2, seed=int(objective.study["seed"]))
    progress.begin(objective, plan)
    regions = find_worst(objective, plan)
    progress.end(objective)
    return write_report(objective, plan, regions, held_out)


def main(arguments=None):
    return run("worst", search, arguments)


if __name__ == "__main__":
    sys.exit(main())
