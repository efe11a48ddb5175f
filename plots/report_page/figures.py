"""The figures of the report, as pictures inside the page: rates against a factor that varies alone, heat maps where
factors vary together, differences to the reference, and of one condition a mark for each estimator."""

import itertools
import math
import shlex

from common import style
from common.command_line import PlotError
from common.summary_csv import where
from page.html import code, element, joined
from page.picture import picture_of
from rates import cells, differences, estimator_marks, lines
from rates.selection import titles_in_words, usual_quantities, with_sharpness
from reliability_figure import panels as reliability

MEASURES = ("nees_coverage", "auc_10_deg", "failure_probability")  # of a figure of their own
EVENTS = ("failure", "failure_or_refusal")
MAX_SLICES = 6  # heat maps of one run


def drawn(draw, alt, caption, command):
    """One figure with its words, or the reason why it is not there."""
    try:
        picture = picture_of(draw, alt)
    except PlotError as error:
        return element("p", f"{caption} Not drawn: {error}", class_="note")
    return element("figure", picture, element("figcaption", f"{caption} Drawn by ", code(command))) + "\n"


def script_command(run, script, arguments):
    """How to draw a figure of the summary by hand; paired differences are of the comparison."""
    name, words = ("summary", ["summarize", run.facts["run"]]) if script != "paired_difference" else (
        "comparison", ["compare", run.facts["run"], "--against", run.facts["reference"]])
    return (f"rcme {shlex.join(words)} --format csv --out {name}.csv && "
            f"rcme plot {script} {name}.csv {shlex.join(arguments)} --out {script}")


def in_running_text(factor):
    words, unit = style.split_unit(factor)
    return words + (f" ({unit})" if unit else "")


def quantities_of(run):
    return usual_quantities(run.summary)


def measures_of(run):
    """Those that some estimator has a number of, a coverage with its sharpness."""
    rows = run.summary.rows
    return with_sharpness(run.summary, [quantity for quantity in MEASURES
                                        if ((rows.quantity == quantity) & (rows.n != "0")).any()])


def line_figure(run, x, quantities):
    caption = f"{titles_in_words(quantities)} against {in_running_text(x)}."
    return drawn(lambda: lines.draw(run.summary, x, quantities),
                 f"{caption} A line per estimator with the band of its 95 % intervals; the numbers are in the table "
                 "of results.", caption,
                 script_command(run, "failure_rate", ["--x", x, "--quantities", ",".join(quantities)]))


def marks_figure(run, quantities):
    """Of a run with one condition."""
    caption = f"{titles_in_words(quantities)} of each estimator."
    return drawn(lambda: estimator_marks.draw(run.summary, quantities),
                 f"{caption} A mark per estimator with its 95 % interval; the numbers are in the table of results.", caption,
                 script_command(run, "failure_rate", ["--quantities", ",".join(quantities)]))


def heat_map_figure(run, x, y, fixed):
    """`fixed`: [(factor, level)] of the others that vary."""
    caption = f"{titles_in_words(quantities_of(run))} over {in_running_text(x)} and {in_running_text(y)}" + "".join(
        f", {style.level_in_words(*pair)}" for pair in fixed) + "."
    conditions = [f"{factor}={level}" for factor, level in fixed]
    arguments = ["--x", x, "--y", y, "--quantities", ",".join(quantities_of(run))]
    return drawn(lambda: cells.draw_pages(where(run.summary, conditions), x, y, quantities_of(run))[0],
                 f"{caption} A heat map per estimator with the rate and its exact 95 % interval in each cell; the numbers "
                 "are in the table of results.", caption,
                 script_command(run, "heat_map",
                                arguments + [word for text in conditions for word in ("--where", text)]))


def difference_figure(run, x):
    reference = style.label_of(run.facts["reference"])
    caption = f"Difference to {reference} on the same trials, against {in_running_text(x)}."
    return drawn(lambda: differences.draw(run.comparison, x, list(EVENTS)),
                 f"{caption} Differences of the rates of failures, and of failures and refusals, with Tango's 95 % "
                 "intervals; filled marks where Holm's p-value is below 0.05; the numbers are in the tables of paired "
                 "comparisons.", caption,
                 script_command(run, "paired_difference", ["--x", x, "--event", ",".join(EVENTS)]))


def reliability_figure(run):
    """Of the estimators that state probabilities."""
    caption = "Stated probabilities of failure against what happened."
    return drawn(lambda: reliability.draw(run.reliability),
                 f"{caption} Per estimator the reliability curve in the band of right probabilities, a histogram of the "
                 "probabilities, and the risk-coverage curves; the numbers are in the table above.", caption,
                 f"rcme {shlex.join(['reliability', run.facts['run']])} --format json --out reliability.json && "
                 "rcme plot reliability reliability.json --out reliability")


def heat_maps(run, x, y, others):
    """One for each combination of levels of the other factors, as far as a page bears."""
    slices = list(itertools.product(*([(factor, level) for level in dict.fromkeys(run.summary.rows[factor])]
                                      for factor in others)))
    figures = [heat_map_figure(run, x, y, fixed) for fixed in slices[:MAX_SLICES]]
    if len(slices) > MAX_SLICES:
        figures.append(element("p", f"Drawn are {MAX_SLICES} of {len(slices)} combinations of {', '.join(others)}; the "
                               "others by the same command with other levels.", class_="note"))
    return joined(figures)


def is_full_factorial(rows, factors):
    """Whether every combination of levels is there; a study may also vary one factor at a time."""
    num_combinations = math.prod(rows[factor].nunique() for factor in factors)
    return len(rows[factors].drop_duplicates()) == num_combinations


def figures(run):
    """All figures of a run, by which factors vary and how."""
    if run.is_of_population:
        return element("p", "The conditions are draws of a population, no two of which share their levels. How a rate depends "
                       "on them: ", code(f"rcme surface {shlex.quote(run.facts['run'])}"), ".", class_="note")
    rows = run.summary.rows
    varying = [factor for factor in run.summary.factors if rows[factor].nunique() > 1]
    if not varying:
        return marks_figure(run, quantities_of(run) + measures_of(run))
    by_levels = sorted(varying, key=lambda factor: -rows[factor].nunique())  # equal ones in the order of the study
    if len(varying) > 1 and is_full_factorial(rows, varying):
        x, y = sorted(by_levels[:2], key=varying.index)
        parts, compared = [heat_maps(run, x, y, [factor for factor in varying if factor not in (x, y)])], by_levels[:1]
    else:
        parts, compared = [line_figure(run, factor, quantities_of(run)) for factor in varying], varying
    if measures_of(run):
        parts += [line_figure(run, factor, measures_of(run)) for factor in compared]
    if run.comparison is not None:
        parts += [difference_figure(run, factor) for factor in compared]
    return joined(parts)
