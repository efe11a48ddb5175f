"""The report of `rcme surface`: what a reader needs, in 80 columns."""

import os
import shlex
import textwrap

WIDTH = 80
QUANTITY = {"failure": "share of the trials that failed", "coverage": "truth within the stated 95 % region",
            "P-y": "stated probability of failure less the failure"}


def report_of(data, check, effects, proposed, level, out):
    """`out`: the folder that receives next.yaml, as the user gave it."""
    parts = [heading(data), verdict(check, data), calibration(check, data)]
    if check.beats_constant:
        parts += [indices_table(effects), groups_in_words(effects), ranges_table(effects, data), what_is_not_known(effects)]
    else:
        parts.append(paragraph(
            "So this run does not show that the quantity depends on the factors, or it has too few conditions or trials to "
            "show how. Shares, effects and maps are left out."))
    if proposed is not None:
        parts.append(proposals(proposed, level, data, out))
    return "\n".join(parts)


def paragraph(text):
    return "\n".join(textwrap.wrap(text, WIDTH)) + "\n"


def percent(value):
    return f"{round(100 * value)}"


def with_interval(value, lower, upper):
    return f"{percent(value):>4} [{percent(lower)}, {percent(upper)}]"


def heading(data):
    trials = data.trials
    spread = f"{trials.min():.0f}" if trials.min() == trials.max() else f"{trials.min():.0f} to {trials.max():.0f}"
    lines = [f"Surface of {data.quantity} ({QUANTITY[data.quantity]})", f"Study {data.study}, estimator {data.estimator}", ""]
    of_draws = "" if data.shared_draws is None else f" of {len(set(data.shared_draws))} draws"
    text = (f"{len(trials)} conditions{of_draws} with {spread} trials each that count, {int(trials.sum())} in all. "
            + (f"{data.num_without} conditions have no such trial. " if data.num_without else ""))
    if of_draws:
        text += ("Conditions of one draw share what its factors do not explain: intervals and cross-validation count draws, not "
                 "conditions. ")
    num_sample = int(data.is_sample.sum())
    if num_sample == 0:
        text += ("None of them is a random draw of a population: they are levels that somebody chose, or draws that were "
                 "proposed. The surface holds where they lie, and no share or mean speaks for a population.")
    elif num_sample < len(trials):
        text += (f"{num_sample} are random draws of the population; the other {len(trials) - num_sample} were chosen. All "
                 "shape the surface; the check below, shares and means over conditions take the random draws alone.")
    else:
        text += "All are random draws of the population."
    if num_sample:
        mean = data.conditions["mean"][data.is_sample].mean()
        text += f" Mean over the random draws, each the same weight: {100 * mean:.1f} %."
    if "sd_over_crb" in data.conditions:
        sharpness = data.conditions["sd_over_crb"].dropna()
        text += (f" The stated sd is {sharpness.min():.3g} to {sharpness.max():.3g} times its Cramer-Rao bound (geometric "
                 "mean of a condition): a region covers as often as it likes if it is wide enough.")
    return "\n".join(lines) + paragraph(text)


def verdict(check, data):
    gain, low, high = check.gain
    text = (f"Tenfold cross-validation over {len(check.rows)} conditions: the log score of a held-out condition is {gain:+.3f} "
            f"[{low:+.3f}, {high:+.3f}] against the model in which every condition has its own "
            f"{'rate' if data.is_rate else 'value'} around one mean. ")
    text += ("The model predicts conditions that it has not seen better than that."
             if check.beats_constant else "THE MODEL DOES NOT PREDICT BETTER THAN THE CONSTANT.")
    return paragraph(text)


def calibration(check, data):
    share, low, high, expected = check.inside
    return paragraph(f"Calibration: {percent(share)} % [{percent(low)}, {percent(high)}] of the held-out conditions lie in their "
                     f"90 % predictive interval; {percent(expected)} % are expected"
                     + (", as counts are whole numbers." if data.is_rate else "."))


def indices_table(effects):
    lines = ["Shares of the variance between conditions, % [95 % interval]", "",
             f"{'factor':<26}{'first-order':>17}{'total':>17}"]
    rows = effects.indices[effects.indices.group != ""].sort_values("total", ascending=False)
    for row in rows.itertuples():
        name = row.group + (" +" if row.with_keys else "")
        lines.append(f"{name:<26}{with_interval(row.first, row.first_lower, row.first_upper):>17}"
                     f"{with_interval(row.total, row.total_lower, row.total_upper):>17}")
    own = effects.indices[effects.indices.group == ""].iloc[0]
    lines.append(f"{'(no factor explains)':<26}{'':>17}{with_interval(own.total, own.total_lower, own.total_upper):>17}")
    return "\n".join(lines) + "\n"


def groups_in_words(effects):
    has_keys = bool((effects.indices.with_keys != "").any())
    text = ("First-order: what the factor alone explains. Total: with its interactions. An interval that begins at 0 is of a "
            "factor that may not matter: a likelihood-ratio test (5 % over all factors) does not tell it from none. ")
    if has_keys:
        text += "A choice with + counts together with the keys that only some of its words have (indices.csv names them). "
    return paragraph(text + f"The quantity's standard deviation between conditions is {100 * effects.spread:.0f} points.")


def ranges_table(effects, data):
    over = "the population" if data.is_sample.any() else "these conditions"
    lines = [f"Mean over {over} where all conditions have one level, % [90 % band]", "",
             f"{'factor':<20}{'least':>14} {'at':<15}{'most':>14} at"]
    matter = effects.indices[effects.indices.matters & (effects.indices.group != "")].sort_values("total", ascending=False)
    for group in matter.group:
        curve = effects.curves[effects.curves.group == group]
        least, most = (curve.loc[place] for place in (curve.rate.idxmin(), curve.rate.idxmax()))
        cells = [f"{with_interval(point.rate, point.lower, point.upper):>14} {shown(point.level):<15}" for point in (least, most)]
        lines.append(f"{group[:19]:<20}{''.join(cells)}".rstrip())
    if matter.empty:
        lines.append("(no factor by itself is certain to matter)")
    return "\n".join(lines) + "\n"


def shown(level):
    """A level as a short text."""
    try:
        return f"{float(level):.3g}"
    except ValueError:
        return level[:15]


def what_is_not_known(effects):
    if effects.maps is None or effects.maps.empty:
        return paragraph("No two factors are certain enough to matter for a map of both.")
    lines = ["Maps of two factors", ""]
    for (first, second), cells in effects.maps.groupby(["first", "second"], sort=False):
        lines.append(f"  {first} x {second}: {int((~cells.is_known).sum())} of {len(cells)} cells not known")
    return "\n".join(lines) + "\n\n" + paragraph(
        "Not known: the 90 % band of a cell is wider than 30 points, or fewer than two conditions lie within 15 % of the range "
        "of both numbers (or at the same words). Such cells are grey and hatched.")


def proposals(proposed, level, data, out):
    study = shlex.quote(os.path.join(out, "next.yaml"))
    where = "the quantity is least known" if level is None else f"it is least certain on which side of {level:g} a condition lies"
    num = proposed.draw.nunique()
    return paragraph(
        f"Proposed: {num} of {data.candidates.draw.nunique()} later draws of the population, one after the other where {where}, "
        "each as if those before had been run. What the simulator cannot make shows when they are run.") + (
            f"\n  rcme run {study} --out next.sqlite\n  rcme surface RUN.sqlite next.sqlite --out OUT\n\n") + paragraph(
                "They were chosen for what they say of the surface, and are no random sample: they may enter no rate over "
                "the population.")
