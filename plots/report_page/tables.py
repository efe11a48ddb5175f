"""The tables of the report. Numbers are those of the files, in per cent where they are rates; none is computed."""

import itertools
import shlex

from common import style
from page.html import Html, code, definitions, details, element, joined, table
from rates.selection import difference_interval_in_words, interval_in_words, test_in_words, title_of
from reliability_figure.reliability_file import STATED

SHOWN = ("failure", "failure_or_refusal", "no_candidate", "other_refusal", "kappa_flag", "nees_coverage", "sd_over_crb",
         "rotation_sd_deg", "direction_sd_deg", "nees_median", "energy_score_deg", "log_score", "available", "misleading", "rotation_error_deg",
         "direction_error_deg", "auc_5_deg", "auc_10_deg", "auc_20_deg", "maa_10_deg",
         "max_error_median_deg", "rotation_ause", "rotation_ause_random", "direction_ause",
         "direction_ause_random")  # of the results; all others stand in the table of every number
PANEL = {"impossible": "impossible", "parallax_median_deg": "parallax", "homography_share": "plane", "crb_direction_deg": "bound"}
WORST_MARGINALS = 12
MANY_ROWS = 40  # a longer table is folded
SIGNIFICANCE_LEVEL = 0.05
DASH = "\u2013"


def small(*children):
    return element("small", *children)


def in_per_cent(text):
    return f"{100 * float(text):.2f}"


def rate_cell(row):
    """With the verdict of a coverage."""
    verdict = [Html("<br>"), small(row["verdict"])] if row.get("verdict") else []
    return joined([f"{in_per_cent(row['value'])} %", Html("<br>"),
                   small(f"[{in_per_cent(row['lower'])}, {in_per_cent(row['upper'])}]"), *verdict])


def mean_cell(row):
    if not row["standard_error"]:  # of one trial
        return joined([f"{float(row['value']):.3g}"])
    return joined([f"{float(row['value']):.3g}", Html("<br>"), small(f"\u00b1 {float(row['standard_error']):.2g}")])


def median_cell(row):
    """Without an interval where few trials, or looking again and again, leave none. Where refusals may be more than half, it
    has no upper end."""
    value = f"{float(row['value']):.3g}"
    if not row["lower"]:
        return joined([value])
    upper = f"{float(row['upper']):.3g}" if row["upper"] else "\u221e"
    return joined([value, Html("<br>"), small(f"[{float(row['lower']):.3g}, {upper}]")])


def cell(row, num_trials):
    """One number with its interval or standard error, and its n where that is not the row's."""
    if row is None or row["n"] == "0":
        return DASH
    whole = {"rate": rate_cell, "score": rate_cell, "share": rate_cell, "mean": mean_cell, "median": median_cell,
             "area": median_cell}[row["kind"]](row)
    return whole if row["n"] == num_trials else joined([whole, Html("<br>"), small(f"n = {row['n']}")])


def heading(quantity):
    """In words, and as the command line calls it; long names may break after a '_'."""
    breakable = [part for word in quantity.split("_") for part in (word, "_", Html("<wbr>"))][:-2]
    return joined([title_of(quantity), Html("<br>"), element("code", *breakable)])


def replay_command(run, condition, trial):
    return code(f"rcme replay {shlex.quote(run.facts['run'])} --condition {condition} --trial {trial}")


def trial_to_replay(run, condition, estimator):
    """The first failure or refusal of an estimator in a condition, else the first trial."""
    if run.is_of_population:
        return DASH
    first = run.facts["conditions"][condition]["first"][run.facts["estimators"].index(estimator)]
    for event in ("failure", "refusal"):
        if first[event] is not None:
            return joined([first[event], Html("<br>"), small(f"first {event}")])
    return "0"


def condition_heading(run, row, factors, with_replay=False):
    """'condition 4: outlier ratio = 0.4', and how to run one of its trials again."""
    if run.is_of_population:
        return f"all {len(run.facts['conditions'])} conditions, with intervals of the population that they are drawn from"
    levels = ", ".join(style.level_in_words(factor, row[factor]) for factor in factors)
    words = f"condition {row['condition']}" + (f": {levels}" if levels else "")
    return joined([words, element("span", replay_command(run, row["condition"], "T"), class_="aside")
                   if with_replay else ""])


def by_condition(pairs, heading):
    """[(row, cells)] as groups of a table, one per condition."""
    return [(heading(members[0][0]), [cells for _, cells in members])
            for members in (list(members) for _, members in
                            itertools.groupby(pairs, key=lambda pair: pair[0]["condition"]))]


def grouped(rows):
    """[(first row, {quantity: row})] of each condition and estimator, in the order of the file."""
    groups = {}
    for row in rows.to_dict("records"):
        groups.setdefault((row["condition"], row["estimator"]), []).append(row)
    return [(group[0], {row["quantity"]: row for row in group}) for group in groups.values()]


def results(run):
    """A row per condition and estimator with the main quantities."""
    groups = grouped(run.summary.rows)
    shown = [quantity for quantity in SHOWN if any(quantity in of for _, of in groups)]
    lines = []
    for row, of in groups:
        num_trials = of["not_scored"]["n"] if "not_scored" in of else max((number["n"] for number in of.values()), key=int)
        lines.append((row, [trial_to_replay(run, int(row["condition"]), row["estimator"]), style.label_of(row["estimator"]),
                            num_trials, *(cell(of.get(quantity), num_trials) for quantity in shown)]))
    return table(
        f"Rates of each estimator {'over all conditions' if run.is_of_population else 'in each condition'}, in per cent of "
        f"its n trials with {interval_in_words(run.summary.rows[run.summary.rows.kind == 'rate'])} intervals, scores with anytime-valid "
        "ones, medians with distribution-free ones, areas (AUSE) with Student's, and means with their Monte-Carlo standard "
        "errors; n stands with a "
        "number that is not of all trials. "
        "T is a trial worth a look: the command beside the condition runs it again.",
        ["T", "estimator", "n", *map(heading, shown)],
        by_condition(lines, lambda row: condition_heading(run, row, run.summary.factors, with_replay=True)),
        num_names=2, class_="results")


def measured_cell(measured, digits=3, scale=1, unit=""):
    """A number of reliability.json with its interval."""
    value, lower, upper = (scale * part for part in (measured.value, measured.lower, measured.upper))
    if value != value:
        return DASH
    interval = [Html("<br>"), small(f"[{lower:.{digits}f}, {upper:.{digits}f}]")] if lower == lower and upper == upper else []
    return joined([f"{value:.{digits}f}{unit}", *interval])


def reliability(run):
    """A row per estimator: how good its probabilities of failure are."""
    at_most = f"{run.reliability.sure_below:g}"
    lines = [[style.label_of(entry.estimator), "stated" if entry.source == STATED else "inlier share", entry.n,
              entry.refused, f"{entry.mean_probability:.4f}", measured_cell(entry.failure, 4), measured_cell(entry.brier, 4),
              joined([f"{entry.calibration_error:.4f}", Html("<br>"), small(f"if right: {entry.error_if_calibrated:.4f}")]),
              measured_cell(entry.slope, 2), measured_cell(entry.auc), measured_cell(entry.risk_coverage_area, 4),
              measured_cell(entry.sure_failed, 2, 100, " %"), measured_cell(entry.sure, 2, 100, " %")]
             for entry in run.reliability.entries]
    return table(
        "Probability of failure P, of the answers whose truth is known, with 95 % intervals, the trials of a scene as one "
        "cluster. Brier: mean of (P - y)\u00b2, 0 best. ECE: calibration error in ten bins, below it what right "
        "probabilities would have. Slope: 1 is right, below 1 too sure. AURC: mean failure rate over all shares of trials "
        "answered, surest first; a refusal comes last and counts as a failure. Of an estimator that states no P, its share of "
        "inliers stands in, recalibrated on the other half of the scenes of this run.",
        ["estimator", "P from", "n", "refused", "mean P", "failed", "Brier", "ECE", "slope", "AUC", "AURC",
         f"failed at P \u2264 {at_most}", f"trials at P \u2264 {at_most}"], [(None, lines)], class_="results")


def sharpness_of(row):
    """Beside a coverage: the stated sd over its bound."""
    text = getattr(row, "sd_over_crb", "")
    return [Html("<br>"), small(f"sd {float(text):.3g} times the bound")] if text else []


def marginals(run):
    """The regimes in which an estimator is farthest from what is claimed, the first of them first."""
    rows = run.marginals.rows
    worst = rows[(rows.excess > 0) & (rows.regime != "all")]
    lines = [[style.label_of(row.estimator), row.regime, row.quantity,
              joined([f"{100 * row.value:.2f} %", Html("<br>"), small(f"[{100 * row.lower:.2f}, {100 * row.upper:.2f}]"),
                      *sharpness_of(row)]),
              f"{100 * row.claimed:.0f} %", f"{row.num_conditions} ({int(row.n):,})"]
             for row in worst.head(WORST_MARGINALS).itertuples()]
    if not lines:
        return element("p", "In no regime does an interval exclude what is claimed.")
    return table(
        f"The {len(lines)} of {len(worst)} regimes that are farthest from what is claimed, by the distance of the interval "
        f"in its half widths. The {len(rows)} intervals hold together with 95 % for the population of conditions, so that "
        "the worst may be looked for. P: stated probability of failure.",
        ["estimator", "conditions with", "quantity", "value", "claimed", "conditions (trials)"], [(None, lines)],
        num_names=2, class_="results")


def severity(run):
    """A row per condition: how hard its problems are."""
    factors = run.problems.factors
    groups = grouped(run.problems.rows)
    quantities = list(dict.fromkeys(run.problems.rows.quantity))
    lines = []
    for row, of in groups:
        num_trials = max((number["n"] for number in of.values()), key=int)
        lines.append([row["condition"], *(row[factor] for factor in factors), num_trials,
                      *(cell(of.get(quantity), num_trials) for quantity in quantities)])
    return table("What the simulated problems of each condition are like, whoever solves them: means of n trials with "
                 "their Monte-Carlo standard errors.",
                 ["condition", *map(style.in_words, factors), "n", *map(heading, quantities)], [(None, lines)],
                 1 + len(factors))


def severity_panel(run):
    """The same in short, to stand beside the figures: what most decides whether a problem can be solved."""
    factors = [factor for factor in run.problems.factors if run.problems.rows[factor].nunique() > 1]
    groups = grouped(run.problems.rows)
    shown = [quantity for quantity in PANEL if any(quantity in of for _, of in groups)]
    lines = []
    for row, of in groups:
        levels = ", ".join(style.level_text(row[factor]) for factor in factors) or row["condition"]
        lines.append([levels, *(cell(of.get(quantity), of[quantity]["n"] if quantity in of else "") for quantity in shown)])
    return table(f"By {', '.join(map(style.in_words, factors)).lower() or 'condition'}.",
                 ["problems", *(PANEL[quantity] for quantity in shown)], [(None, lines)])


def difference_cell(row):
    points = [f"{100 * float(text):+.2f}" for text in (row["risk_difference"], row["lower"], row["upper"])]
    return joined([points[0], Html("<br>"), small(f"[{points[1]}, {points[2]}]")])


def p_value(text):
    return f"{float(text):.3g}"


def comparison_cells(row):
    counts = [row["both"], row["estimator_only"], row["reference_only"], row["neither"]]
    if row["n"] == "0":
        return [row["n"], *counts, DASH, DASH, DASH]
    is_sure = float(row["p_holm"]) < SIGNIFICANCE_LEVEL
    holm = element("strong", p_value(row["p_holm"]), " *") if is_sure else p_value(row["p_holm"])
    return [row["n"], *counts, difference_cell(row), p_value(row.get("p_value") or row["p_mcnemar"]), holm]


def comparison(run, event):
    """One event: a row per condition and estimator."""
    reference = style.label_of(run.facts["reference"])
    rows = run.comparison.rows[run.comparison.rows.event == event["name"]]
    lines = [(row, [style.label_of(row["estimator"]), *comparison_cells(row)]) for row in rows.to_dict("records")]
    caption = joined([
        code(event["name"]), f" ({event['doc']}): in how many of n trials it happened to the estimator and to {reference}; "
        f"rate of the estimator minus rate of {reference}, in percentage points, with its "
        f"{difference_interval_in_words(rows)} interval; {test_in_words(rows)} p, and that adjusted by Holm for all tests "
        f"of the comparison, of every event (* and bold: below {SIGNIFICANCE_LEVEL:g})."])
    return table(caption, ["estimator", "n", "both", "estimator only", f"{reference} only", "neither", "difference",
                           f"p ({test_in_words(rows)})", "p (Holm)"],
                 by_condition(lines, lambda row: condition_heading(run, row, run.comparison.factors)))


def stated_sharpness(one):
    """Of a hypothesis about coverage: how wide the regions are, of each estimator (medians)."""
    for who, key in (("estimator", "sharpness"), ("against", "sharpness_against")):
        stated = one.get(key)
        if stated and stated["sd_over_crb"] is not None:
            yield f"{one[who]}: stated sd {stated['sd_over_crb']:.3g} times the least possible"
        elif stated and stated["rotation_sd_deg"] is not None:
            yield (f"{one[who]}: stated sd {stated['rotation_sd_deg']:.2g} deg of rotation, "
                   f"{stated['direction_sd_deg']:.2g} deg of direction")


def hypotheses(decided):
    """What was stated before the run, a row each."""
    rows = []
    for one in decided["hypotheses"]:
        value = DASH
        if one["n"] and one["value"] is not None:
            lower, upper = one["interval"]
            value = joined([f"{100 * one['value']:.2f} %", Html("<br>"), small(f"[{100 * lower:.2f}, {100 * upper:.2f}]")])
            value = joined([value, *[part for words in stated_sharpness(one) for part in (Html("<br>"), small(words))]])
        why = [Html("<br>"), small(one["why_open"])] if one["why_open"] else []
        rows.append([one["hypothesis"], value, f"{one['n']:,}", joined([element("strong", one["verdict"]), *why])])
    caption = (f"All {len(rows)} intervals together hold with {100 * decided['confidence']:.0f} %, each with "
               f"{100 * decided['confidence_each']:.2f} %; they are of the trials that were asked for beforehand.")
    return table(caption, ["hypothesis", "value", "n", "verdict"], [(None, rows)])


def every_number(run):
    """The summary as it is: a row per condition, estimator and quantity."""
    summary = run.whole_summary
    columns = ["condition", *summary.factors, "estimator", "quantity", "kind", "value", "lower", "upper",
               "standard_error", "n"]
    rows = [list(cells) for cells in summary.rows[columns].itertuples(index=False, name=None)]
    return table(joined(["All rows of ", code(f"rcme summarize {shlex.quote(run.facts['run'])} --format csv"),
                         "; rates are fractions, empty cells unknown."]),
                 columns, [(None, rows)], 3 + len(summary.factors))


def quantities(run):
    """What each name means, as `rcme list quantities`."""
    return details("What each quantity is", definitions(
        [(code(q["name"]), f"{q['kind']}: {q['doc']}") for q in run.facts["quantities"]]))


def overview(runs):
    rows = [[element("a", str(run.number), href=f"#{run.anchor()}"), run.facts["name"], code(run.facts["run"]),
             len(run.facts["conditions"]), "; ".join(map(style.label_of, run.facts["estimators"])), trials_of(run.facts)]
            for run in runs]
    return table("The runs on this page.", ["run", "study", "result file", "conditions", "estimators", "trials done"],
                 [(None, rows)], class_="overview")


def trials_of(facts):
    """Of a run or of a condition."""
    return f"{facts['trials_done']:,} of {facts['trials_planned']:,}"


def conditions(run):
    """Every condition with its levels and the command that replays its first trial."""
    facts = run.facts
    rows = [[condition["index"], *condition["levels"], trials_of(condition), replay_command(run, condition["index"], 0)]
            for condition in facts["conditions"]]
    return table("The conditions and their trials; the last column runs the first trial of each again.",
                 ["condition", *map(style.in_words, facts["factors"]), "trials done", "replay"], [(None, rows)],
                 1 + len(facts["factors"]), class_="conditions")
