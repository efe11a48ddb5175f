#!/usr/bin/python3
"""Puts the page of `rcme report` together: one HTML file that needs no other, for one or more runs.

It prints what the files say and computes nothing: every rate, interval, difference and p-value is the program's.
"""

import argparse
import base64
import os
import re
import shlex
import sys

from common.command_line import Parser, PlotError, check_folder, run as run_script
from common.style import label_of, split_unit
from common.whole_file import write_text
from page.html import code, definitions, details, element, joined, listed, page
from page.script import SCRIPT
from page.style import CSS
from report_page import tables
from report_page.data import read_runs
from report_page.figures import figures, reliability_figure

EXAMPLE = """
example:
  rcme report run.sqlite --out report.html
calls this script; by hand, with FOLDER/run_0001/ holding run.json, summary.csv and comparison.csv:
  plots/report.py FOLDER --out report.html
"""


def file_name(name):
    """A study's name as a file may be called."""
    return re.sub("[^A-Za-z0-9._-]+", "_", name).strip("._-")[:80] or "study"


def study_section(run):
    """What was asked, in words and in full."""
    facts = run.facts
    bounds = " or ".join(map(bound_in_words, facts["failure_bounds"]))
    parts = [element("p", facts["description"])] if facts["description"] else []
    parts.append(definitions([
        ("result file", code(facts["run"])), ("seed", facts["seed"]), ("trials done", tables.trials_of(facts)),
        ("conditions", len(facts["conditions"])),
        ("decided before the run", "see above" if facts.get("preregistration") else "nothing: the study has no lock"), ("estimators", "; ".join(map(name_and_label, facts["estimators"]))),
        ("a failure is", f"a motion with {bounds}"), ("page made by", f"rcme {facts['rcme_version']}")]))
    if facts.get("ademp"):
        parts += [element("h4", "Aims, data, estimands, methods, performance"),
                  definitions([(key, text) for key, text in facts["ademp"]])]
    parts.append(details("The study in full (YAML)", element("pre", code(facts["study_yaml"])),
                         element("p", study_link(run)), class_="study"))
    return joined(parts)


def name_and_label(label):
    """As in tables and figures, and as the study and the commands call it."""
    return label if label_of(label) == label else f"{label_of(label)} ({label})"


def bound_in_words(bound):
    """{"name": "max_rotation_error_deg", "value": "3", "unit": "deg"} -> 'rotation error > 3 deg'."""
    words = split_unit(bound["name"])[0].removeprefix("max ")
    return f"{words} > {bound['value']} {bound['unit']}".strip()


def study_link(run):
    """The study as a file to save, out of the page itself."""
    data = base64.b64encode(run.facts["study_yaml"].encode()).decode()
    name = f"{file_name(run.facts['name'])}.yaml"
    return element("a", f"Save the study as {name}", href=f"data:text/yaml;base64,{data}", download=name)


def findings_section(run):
    sentences = run.facts.get("findings", [])
    if not sentences:
        return element("p", "Nothing to say of failures: no trial has a known truth.", class_="note")
    return element("ul", *(element("li", sentence) for sentence in sentences), class_="findings")


def decided_section(run):
    """What was decided before the run, with its verdicts, and what was decided after."""
    decided = run.facts["preregistration"]
    if decided["locked"]:
        lead = element("p", f"Locked at {decided['locked_at']} by {decided['program']}, before the run; SHA-256 ",
                       code(decided["sha256"]), ".")
    else:
        lead = element("p", "The study states these hypotheses, but has no lock: nothing shows that they were written before "
                       "the run.", class_="note")
    parts = [lead]
    if decided["hypotheses"]:
        parts.append(tables.hypotheses(decided))
    elif decided["locked"]:
        parts.append(element("p", "It states no hypothesis."))
    if decided["deviations"]:
        parts += [element("p", "Decided after: the run departs from its lock."),
                  element("ul", *(element("li", text) for text in decided["deviations"]))]
        parts += [element("p", f"Reason: {reason}") for reason in decided["reasons"]]
    parts.append(element("p", "Decided after: all else of this run on this page. It explores."))
    return joined(parts)


def severity_section(run):
    """The panel beside the figures."""
    return joined([element("p", "How hard the problems are, whoever solves them. Impossible: the Cramer-Rao bound exceeds what "
                           "counts as a failure; parallax in degrees; plane: the share of matches that one homography explains; "
                           "bound: the Cramer-Rao bound of the direction, degrees."),
                   tables.severity_panel(run)])


def results_section(run):
    is_short = len(run.facts["conditions"]) * len(run.facts["estimators"]) <= tables.MANY_ROWS
    severity = [details("The problems: all measures of severity", tables.severity(run))] if len(run.problems.rows) else []
    return joined([details("Main quantities", tables.results(run), is_open=is_short), *severity, tables.quantities(run),
                   details("Every number", tables.every_number(run))])


def comparison_section(run):
    """Against the reference, a table per event; the first is open where it is short."""
    if run.comparison is None:
        reason = run.facts.get("caution") or "the study has one estimator: there is nothing to compare"
        return element("p", f"{reason[:1].upper()}{reason[1:]}.", class_="note")
    caution = run.facts.get("caution")
    is_short = len(run.comparison.rows) <= tables.MANY_ROWS * len(run.facts["events"])
    return joined([
        *([element("p", f"Caution: {caution}.", class_="note")] if caution else []),
        element("p", "All estimators saw the same problems, so every trial is a pair. Positive differences are more "
                "trials with the event than ", label_of(run.facts["reference"]), " had."),
        *(details(event["name"].replace("_", " ").capitalize(), tables.comparison(run, event),
                  is_open=is_short and position == 0) for position, event in enumerate(run.facts["events"]))])


def same_trials(run):
    """(options of `rcme run` for the trials of this page, in words what they do not give)"""
    facts, conditions = run.facts, run.facts["conditions"]
    if facts["until"]:
        return facts["until"], ""
    most, but = max(condition["trials_end"] for condition in conditions), ""
    has_stopped = "anytime_valid" in set(run.whole_summary.rows.get("interval", []))
    if any(not condition["trials_done"] == condition["trials_end"] == (
            most if has_stopped else min(most, condition["trials_planned"])) for condition in conditions):
        but += ("But this page has fewer trials of some conditions than the commands give (see \"trials done\" below): "
                "the run was cut off or stopped by --until. ")
    if has_stopped:
        but += "Because of --until, intervals on this page are anytime-valid; those of the commands are exact. "
    return f"--trials {most}", but


def again_section(run):
    """The commands that give the same numbers once more."""
    facts, name = run.facts, file_name(run.facts["name"])
    here, reference = shlex.quote(facts["run"]), shlex.quote(facts["reference"])
    options, but = same_trials(run)
    pooled = " --pooled" if run.is_of_population else ""
    return joined([
        element("p", "A trial is a function of (seed, condition, trial) alone: these commands give the same numbers, "
                "whatever the number of threads. ", but, study_link(run), ", then:"),
        element("pre", code(f"rcme run {name}.yaml {options} --out {name}.sqlite\n"
                            f"rcme summarize {name}.sqlite{pooled} --format csv\n"
                            f"rcme compare {name}.sqlite{pooled} --against {reference} --format csv\n"
                            f"rcme report {name}.sqlite --against {reference} --out {name}.html")),
        element("p", "The numbers of this page, out of the result file at hand:"),
        listed(joined(["rates, means, intervals, n: ", code(f"rcme summarize {here}{pooled} --format csv"),
                       ", the row of that condition, estimator and quantity; the names are those below the headings and of ",
                       code("rcme list quantities")]),
               joined(["differences and p-values: ",
                       code(f"rcme compare {here}{pooled} --against {reference} --format csv")]),
               joined(["one trial with everything about it: ",
                       code(f"rcme replay {here} --condition C --trial T"),
                       ", with C of the table below and T from 0"])),
        tables.conditions(run)])


def reliability_section(run):
    return joined([tables.reliability(run), reliability_figure(run),
                   element("p", "Made by ", code(f"rcme reliability {shlex.quote(run.facts['run'])}"), "; with ",
                           code("--by FACTOR"), " per level.")])


def sections(run):
    """(findings and figures, the panel beside them, what follows), each [(part of the id, heading, content)]."""
    beside = [("severity", "Severity of the problems", severity_section(run))] if len(run.problems.rows) else []
    first = [("findings", "Findings", findings_section(run)), ("figures", "Figures", figures(run))]
    if run.marginals is not None:
        first.insert(0, ("marginals", "Where it is not what it claims", tables.marginals(run)))
    if run.facts.get("preregistration"):
        first.insert(0, ("decided", "Decided before the run", decided_section(run)))
    parts = [("results", "Results", results_section(run))]
    if run.reliability is not None:
        parts.append(("reliability", "Probability of failure", reliability_section(run)))
    return first, beside, parts + [
        ("comparison", "Paired comparisons", comparison_section(run)), ("study", "The study", study_section(run)),
        ("again", "How to get these numbers again", again_section(run))]


def title_of(run):
    return f"Run {run.number}: {run.facts['name']}"


def contents(runs, of_runs):
    """The table of contents, folded: the findings come first."""
    entries = [joined([element("a", title_of(run), href=f"#{run.anchor()}"),
                       listed(*(element("a", heading, href=f"#{run.anchor(part)}")
                                for group in of_run for part, heading, _ in group))])
               for run, of_run in zip(runs, of_runs)]
    return element("nav", details("Contents", listed(*entries)), aria_label="Contents")


def run_section(run, of_run):
    def in_order(group):
        return joined(element("h3", heading, id=run.anchor(part)) + "\n" + content + "\n" for part, heading, content in group)
    first, beside, following = of_run
    top = in_order(first)
    if beside:
        top = element("div", element("div", top), element("aside", in_order(beside), aria_label="Severity"), class_="beside")
    return element("section", element("h2", title_of(run), id=run.anchor()), "\n", top, in_order(following))


def report(runs):
    """The whole page."""
    names = ", ".join(dict.fromkeys(run.facts["name"] for run in runs))
    of_runs = [sections(run) for run in runs]
    header = element("header", element("h1", f"Report: {names}"), element(
        "p", "Robust two-view camera-motion estimators on simulated or real matches with known truth. Every rate comes with "
        "its exact interval and its n.", class_="subtitle"))
    overview = [tables.overview(runs)] if len(runs) > 1 else []
    return page(f"rcme report: {names}", CSS, SCRIPT, joined([
        header, "\n", contents(runs, of_runs), "\n",
        element("main", *overview, "\n", *(run_section(run, of_run) for run, of_run in zip(runs, of_runs)))]))


def parse(arguments):
    parser = Parser(prog="report.py", description=__doc__, epilog=EXAMPLE,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", help="a folder run_NNNN per run, as `rcme report` writes them")
    parser.add_argument("--out", required=True, metavar="PAGE.html", help="the page to write")
    options = parser.parse_args(arguments)
    if not os.path.isdir(options.folder):
        raise PlotError(f"there is no folder {options.folder}.")
    if not os.path.basename(options.out):
        raise PlotError(f"--out {options.out}: give the path of a file.")
    check_folder(options.out)
    return options


def make(arguments):
    options = parse(arguments)
    write_text(options.out, report(read_runs(options.folder)))
    return [options.out]


def main(arguments=None):
    return run_script("report.py", make, arguments)


if __name__ == "__main__":
    sys.exit(main())
