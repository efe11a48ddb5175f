"""The rates of a summary, checked: what the figures of rates share."""

import math

from common import style
from common.command_line import PlotError
from common.summary_csv import numbers

TITLES = {  # other quantities: their name in words
    "failure": "Failure rate", "success": "Success rate",
    "no_candidate": "Detect-fail rate",  # the paper's word
    "other_refusal": "Other refusals",
    "kappa_flag": "Kappa-flag rate", "nees_coverage": "NEES coverage",
}


def title_of(quantity):
    return TITLES.get(quantity, style.in_words(quantity))


def check_factor(summary, option, factor):
    """The factor an option names must be one of the study's."""
    if factor not in summary.factors:
        raise PlotError(f"{summary.path}: {option} {factor} is not a factor of this study; "
                        f"allowed: {', '.join(summary.factors) or 'none, the study varies nothing'}.")


def check_one_study(summary):
    studies = list(dict.fromkeys(summary.rows.study))
    if len(studies) > 1:
        raise PlotError(f"{summary.path}: holds several studies; choose one: "
                        f"--where study={' or study='.join(studies)}.")


def select_rates(summary, quantities):
    """The rows of the asked rates, with `value`, `lower`, `upper` and `n` as numbers; NaN where n is 0."""
    path = summary.path
    rates = list(dict.fromkeys(summary.rows.quantity[summary.rows.kind == "rate"]))
    for quantity in quantities:
        if quantity not in rates:
            raise PlotError(f"{path}: has no rate called '{quantity}'; allowed: {', '.join(rates) or 'none'}.")
    check_one_study(summary)
    summary = summary.with_rows(summary.rows[(summary.rows.kind == "rate") & summary.rows.quantity.isin(quantities)])
    selected = summary.rows.assign(
        n=numbers(summary, "n"),
        **{column: numbers(summary, column, may_be_empty=True) for column in ("value", "lower", "upper")})
    for row in selected.itertuples():
        if not (0 <= row.lower <= row.value <= row.upper <= 1 or (row.n == 0 and math.isnan(row.value))):
            raise PlotError(f"{path}: line {row.line}: a rate must lie in its interval and both in 0..1, "
                            "and may be empty only where n is 0.")
    selected.loc[selected.value.isna(), ["lower", "upper"]] = math.nan  # the interval 0..1 of no trials says nothing
    return selected


def check_no_repetition(path, part, keys, at):
    """One row per `keys`; `at` says of a row where it stands."""
    repeated = part[part.duplicated(keys)]
    if len(repeated):
        row = repeated.iloc[0]
        raise PlotError(f"{path}: line {row.line}: {row.estimator} has a second {row[keys[-1]]} at {at(row)}; "
                        "choose one condition with --where condition=NAME.")


INTERVALS = {"exact": "exact 95 % (Clopper-Pearson)", "anytime_valid": "anytime-valid 95 % (confidence sequence)",
             "weighted": "weighted 95 % (Fay-Feuer, cautious upper end)"}


def interval_in_words(rows):
    """The kind of the rates' intervals; a table from before there were several has exact ones."""
    kinds = list(dict.fromkeys(kind for kind in rows.get("interval", ["exact"]) if kind))
    return " or ".join(INTERVALS.get(kind, kind) for kind in kinds)


def n_in_words(rows, per):
    """'n = 400 per point', or the range where they differ."""
    low, high = int(rows.n.min()), int(rows.n.max())
    return f"n = {low} per {per}" if low == high else f"n = {low}\u2013{high} per {per}"


def fixed_levels(rows, factors):
    """The levels that all rows share, in words."""
    return [style.level_in_words(factor, rows[factor].iloc[0]) for factor in factors if rows[factor].nunique() == 1]
