"""The rates of a summary, checked: what the figures of rates share."""

import math
import re

from common import sheet, style
from common.command_line import PlotError
from common.summary_csv import numbers

TITLES = {  # other quantities: their name in words
    "failure": "Failure rate", "success": "Success rate", "failure_or_refusal": "Failure or refusal rate",
    "no_candidate": "No-candidate rate",
    "other_refusal": "Other refusals",
    "failure_probability": "Stated probability of failure",
    "kappa_flag": "Kappa-flag rate", "nees_coverage": "NEES coverage",
    "nees": "Mean NEES of successes", "nees_median": "Median NEES",
    "sd_over_crb": "Stated sd over its bound", "rotation_ause": "AUSE of rotation", "direction_ause": "AUSE of direction",
    "rotation_ause_random": "AUSE of rotation, random order", "direction_ause_random": "AUSE of direction, random order",
    "rotation_error_deg": "Mean rotation error of successes (deg)", "direction_error_deg": "Mean direction error of successes (deg)",
    "rotation_error_median_deg": "Median rotation error (deg)", "direction_error_median_deg": "Median direction error (deg)",
    "max_error_median_deg": "Median of the greater error (deg)",
    "auc_5_deg": "AUC@5\u00b0", "auc_10_deg": "AUC@10\u00b0", "auc_20_deg": "AUC@20\u00b0", "maa_10_deg": "mAA(10\u00b0)",
}
ANSWERED = "_answered"  # the suffix of measures that leave refusals out
DRAWN_KINDS = ("rate", "score", "share")  # numbers between 0 and 1 with an interval
NUMBER_KINDS = {"median": "medians with distribution-free", "area": "areas with Student's",
                "mean": "means without"}  # of any size; interval if known
FAILURES = ("failure", "failure_or_refusal", "no_candidate")  # what is drawn unless asked otherwise: the first two of a table
REFUSALS = ("no_candidate", "other_refusal")  # together all of them
ERROR_MEDIANS = ("rotation_error_median_deg", "direction_error_median_deg")
ERROR = re.compile(f"_error(_median)?_deg({ANSWERED})?$")
SHARPNESS = ("sd_over_crb", "rotation_sd_deg", "direction_sd_deg", "log_det_cov")


def listed(labels):
    """'Standard and pRCME'; all in quotes where one has a comma."""
    quote = '"' if any("," in label for label in labels) else ""
    texts = [f"{quote}{label}{quote}" for label in labels]
    return " and ".join(filter(None, [", ".join(texts[:-1]), texts[-1]]))


def title_of(quantity):
    measure = quantity.removesuffix(ANSWERED)
    if measure in TITLES and quantity.endswith(ANSWERED):
        return sheet.current().text_of(quantity, TITLES[measure] + ", refusals left out")
    return sheet.current().text_of(quantity, TITLES[quantity]) if quantity in TITLES else style.in_words(quantity)


def titles_in_words(quantities):
    """'Failure rate and no-candidate rate', 'NEES coverage, AUC@10 and ...'."""
    titles = [title if place == 0 or title[1:2].isupper() else title[:1].lower() + title[1:]
              for place, title in enumerate(map(title_of, quantities))]
    return " and ".join([", ".join(titles[:-1]), titles[-1]] if len(titles) > 1 else titles)


def usual_quantities(summary):
    """Failures without and with refusals, so that an estimator does not look good by refusing; an old table lacks the second."""
    present = set(summary.rows.quantity)
    return [quantity for quantity in FAILURES if quantity in present][:2] or list(FAILURES[:1])


def is_error(quantity):
    """Whether it is an angle between a motion and the truth."""
    return ERROR.search(quantity) is not None


def refusals_in_words(summary, rows, quantities):
    """The greatest rate of refusals in the drawn conditions, as the caption of a figure whose failure rate does not show them
    needs it; no_candidate and other_refusal exclude each other."""
    if "failure" not in quantities or "success" in quantities or set(REFUSALS) <= set(quantities):
        return []
    table = summary.rows
    table = table[table.quantity.isin(REFUSALS) & (table.n != "0") & table.condition.isin(rows.condition) &
                  table.estimator.isin(rows.estimator)]
    shares = table.assign(value=numbers(summary.with_rows(table), "value"))
    sums = shares.groupby(["condition", "estimator"], sort=False).value.sum()
    if not (sums > 0).any():
        return []
    condition, estimator = sums.idxmax()
    place = table[table.condition == condition].iloc[0]
    varying = [factor for factor in summary.factors if rows[factor].nunique() > 1]
    at = " and ".join(style.level_in_words(factor, place[factor]) for factor in varying)
    return [f"greatest refusal rate: {100 * sums.max():.3g} % ({style.label_of(estimator)}{', at ' * bool(at)}{at})"]


def with_sharpness(summary, quantities):
    """The same with sd_over_crb behind a coverage, where the table has it and no sharpness is asked for: a region covers
    as often as it likes if it is wide enough."""
    rows = summary.rows
    is_known = ((rows.quantity == "sd_over_crb") & (rows.n != "0")).any()
    if "nees_coverage" not in quantities or not is_known or set(quantities) & set(SHARPNESS):
        return list(quantities)
    place = quantities.index("nees_coverage") + 1
    return [*quantities[:place], "sd_over_crb", *quantities[place:]]


def sharpness_in_words(summary, quantities):
    """Of a figure of coverages that has no room for sharpness: the range of the medians in the table."""
    rows = summary.rows[(summary.rows.quantity == "sd_over_crb") & (summary.rows.n != "0")]
    if "nees_coverage" not in quantities or not len(rows):
        return []
    values = sorted(map(float, rows.value))
    return [f"stated sd {values[0]:.3g} to {values[-1]:.3g} times the Cram\u00e9r-Rao bound (medians)"]


def kind_in_words(rows):
    """'Rate', 'Score', or both."""
    return " or ".join(dict.fromkeys(rows.kind)).capitalize()


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


def check_quantities(summary, quantities, kinds):
    """Those of these kinds are allowed."""
    allowed = list(dict.fromkeys(summary.rows.quantity[summary.rows.kind.isin(kinds)]))
    for quantity in quantities:
        of_other_kinds = summary.rows.kind[summary.rows.quantity == quantity]
        if quantity not in allowed and len(of_other_kinds):
            raise PlotError(f"{summary.path}: '{quantity}' is a {of_other_kinds.iloc[0]}, and this figure has rates and scores only; "
                            "'rcme plot failure_rate' draws it.")
        if quantity not in allowed:
            raise PlotError(f"{summary.path}: has no quantity called '{quantity}'; allowed: {', '.join(allowed) or 'none'}.")


def select_rates(summary, quantities, or_numbers=False):
    """The rows of the asked rates or scores, with `value`, `lower`, `upper` and `n` as numbers; NaN where n is 0.
    `or_numbers`: medians, means and areas too, which are of any size and may have no interval."""
    path, kinds = summary.path, (*DRAWN_KINDS, *(NUMBER_KINDS if or_numbers else ()))
    check_quantities(summary, quantities, kinds)
    check_one_study(summary)
    summary = summary.with_rows(summary.rows[summary.rows.kind.isin(kinds) & summary.rows.quantity.isin(quantities)])
    selected = summary.rows.assign(
        n=numbers(summary, "n"),
        **{column: numbers(summary, column, may_be_empty=True) for column in ("value", "lower", "upper")})
    for row in selected.itertuples():
        if row.kind in NUMBER_KINDS and not (row.lower > row.value or row.value > row.upper):
            continue
        if not (0 <= row.lower <= row.value <= row.upper <= 1 or (row.n == 0 and math.isnan(row.value))):
            raise PlotError(f"{path}: line {row.line}: a {row.kind} must lie in its interval and both in 0..1, "
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


# Of paired comparisons: what a file calls a test and an interval, in words.
OF_POPULATION = "95 % population"
TESTS = {"mcnemar": "McNemar", "discordant_sequence": "anytime-valid", "betting": "betting", "population": "population"}
DIFFERENCE_INTERVALS = {"tango": "Tango's 95 %", "betting": "anytime-valid 95 % (betting)", "population": OF_POPULATION}


def test_in_words(rows):
    """A table from before there were several tests has McNemar's."""
    return " or ".join(TESTS.get(test, test) for test in dict.fromkeys(rows.get("test", ["mcnemar"])))


def difference_interval_in_words(rows):
    return " or ".join(DIFFERENCE_INTERVALS.get(kind, kind) for kind in dict.fromkeys(rows.get("interval", ["tango"])))


INTERVALS = {"exact": "exact 95 % (Clopper-Pearson)", "anytime_valid": "anytime-valid 95 % (confidence sequence)",
             "weighted": "weighted 95 % (Fay-Feuer, cautious upper end)", "betting": "anytime-valid 95 % (betting)",
             "population": OF_POPULATION,
             "log_student": "approximate 95 % (Student on the logarithm)"}


def interval_in_words(rows):
    """The kind of the intervals of rates and scores; a table from before there were several has exact ones."""
    kinds = list(dict.fromkeys(kind for kind in rows.get("interval", ["exact"]) if kind))
    return " or ".join(INTERVALS.get(kind, kind) for kind in kinds)


def number_intervals_in_words(rows):
    """The same of medians, areas and means: ['medians with distribution-free']. `effective_n` is of a population."""
    of_population = "effective_n" in rows and (rows.effective_n != "").any()
    return [f"{kind}s with {OF_POPULATION}" if of_population and kind != "mean" else words
            for kind, words in NUMBER_KINDS.items() if (rows.kind == kind).any()]


def n_in_words(rows, per):
    """'n = 400 per point', or the range where they differ."""
    low, high = int(rows.n.min()), int(rows.n.max())
    return f"n = {low} per {per}" if low == high else f"n = {low}\u2013{high} per {per}"


def fixed_levels(rows, factors):
    """The levels that all rows share, in words."""
    return [style.level_in_words(factor, rows[factor].iloc[0]) for factor in factors if rows[factor].nunique() == 1]
