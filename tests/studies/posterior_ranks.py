#!/usr/bin/env python3
"""What the ranks of rcme_posterior_ranks say: histograms, and whether P holds for other bounds than the stated ones.

    tests/studies/posterior_ranks.py RANKS.csv --out DIR

writes DIR/posterior_ranks.csv (a quantity of a group of trials per row, with its 95 % interval by bootstrap over conditions)
and DIR/posterior_ranks.png. Quantities: the share of the ranks in each tenth, nominal .1; of each pair of bounds the failure
rate, the mean P, and the expected calibration error in ten bins.
"""

import argparse
import pathlib
import sys

import numpy
import pandas

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "plots"))
from common import style  # noqa: E402

BOUNDS = ((1, 5), (2, 10), (3, 15), (5, 20), (10, 40))
RANKS = {"direction_rank": "direction", "rotation_rank": "rotation", "nees_rank": "motion"}
TENTHS, REPETITIONS = 10, 400


def groups_of(trials):
    """The masks of trials that are reported apart, by name."""
    verified = trials.is_verified == 1
    return {"all": numpy.ones(len(trials), bool), "verified": verified, "extrapolated": ~verified,
            "weak direction": trials.is_weak == 1, "sure (P at most .1)": trials.failure_probability <= 0.1}


def tenths(ranks):
    """The share of the ranks in each tenth."""
    place = numpy.minimum((ranks * TENTHS).astype(int), TENTHS - 1)
    return numpy.bincount(place, minlength=TENTHS) / len(ranks)


def calibration_error(stated, failed):
    """Expected calibration error in ten bins of equal width."""
    place = numpy.minimum((stated * TENTHS).astype(int), TENTHS - 1)
    return numpy.abs(numpy.bincount(place, stated - failed, TENTHS)).sum() / len(stated)


def bootstrap(trials, statistic):
    """The statistic of the trials, and its 95 % interval over their conditions."""
    members = [rows.to_numpy() for _, rows in pandas.Series(range(len(trials))).groupby(trials.condition.to_numpy())]
    random = numpy.random.default_rng(1)
    arrays = {name: trials[name].to_numpy() for name in trials}
    again = []
    for _ in range(REPETITIONS):
        drawn = numpy.concatenate([members[k] for k in random.integers(len(members), size=len(members))])
        again.append(statistic({name: array[drawn] for name, array in arrays.items()}))
    return statistic(arrays), *numpy.quantile(again, (0.025, 0.975), axis=0)


def statistics():
    """What is computed of a group, by name; a function of its columns."""
    all_of = {}
    for column, what in RANKS.items():
        all_of[f"{what} rank"] = lambda t, column=column: tenths(t[column])
    for rotation, direction in BOUNDS:
        def failed(t, r=rotation, d=direction):
            return (t["rotation_error_deg"] > r) | (t["direction_error_deg"] > d)

        name, column = f"{rotation} deg {direction} deg", f"p_{rotation}_{direction}"
        all_of[f"failed, {name}"] = lambda t, failed=failed: failed(t).mean()
        all_of[f"mean P, {name}"] = lambda t, column=column: t[column].mean()
        all_of[f"ECE, {name}"] = lambda t, failed=failed, column=column: calibration_error(t[column], failed(t))
    all_of["narrowed"] = lambda t: (t["narrowed"] < 1).mean()
    return all_of


def table_of(trials):
    """The rows of posterior_ranks.csv."""
    rows = []
    for group, here in groups_of(trials).items():
        part = trials[here]
        for quantity, statistic in statistics().items():
            values, lower, upper = (numpy.atleast_1d(x) for x in bootstrap(part, statistic))
            for k, value in enumerate(values):
                rows.append({"group": group, "trials": len(part), "conditions": part.condition.nunique(), "quantity": quantity,
                             "tenth": k + 1 if len(values) > 1 else "", "value": f"{value:.4f}", "lower": f"{lower[k]:.4f}",
                             "upper": f"{upper[k]:.4f}"})
    return pandas.DataFrame(rows)


def draw(table, path):
    """The histograms of all trials and of the verified ones."""
    figure, axes = style.new_figure(rows=2, columns=3)
    for row, group in enumerate(("all", "verified")):
        for column, what in enumerate(RANKS.values()):
            part = table[(table.group == group) & (table.quantity == f"{what} rank")]
            place = part.tenth.astype(int) / TENTHS - 0.05
            value, lower, upper = (part[name].astype(float) for name in ("value", "lower", "upper"))
            here = axes[row, column]
            here.bar(place, value, width=0.09, color=style.SKY_BLUE)
            here.vlines(place, lower, upper, color=style.BLACK, linewidth=0.8)
            here.axhline(1 / TENTHS, color=style.VERMILLION, linewidth=0.8)
            here.set(title=f"{what}, {group} (n = {part.trials.iloc[0]})", xlabel="rank of the truth", xlim=(0, 1))
    for row in axes:
        row[0].set_ylabel("share of the trials")
    style.save(figure, str(path))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ranks")
    parser.add_argument("--out", default=".", type=pathlib.Path)
    arguments = parser.parse_args()
    table = table_of(pandas.read_csv(arguments.ranks))
    table.to_csv(arguments.out / "posterior_ranks.csv", index=False)
    draw(table, arguments.out / "posterior_ranks")


if __name__ == "__main__":
    main()
