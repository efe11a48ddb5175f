"""Reads what `rcme report` writes for its page: a folder run_NNNN per run with run.json, summary.csv and, where there is
more than one estimator, comparison.csv, where one states probabilities, reliability.json, where conditions are draws of a
population, marginals.csv (experiments/statistics/report_data.h)."""

import pathlib
from dataclasses import dataclass

from common.command_line import PlotError
from common.json_file import read_object
from common.summary_csv import Summary, numbers, read_comparison, read_summary, read_table
from reliability_figure.reliability_file import read_reliability

FORMAT = "rcme report 1"
NEEDED = {  # key of run.json: its type
    "run": str, "rcme_version": str, "name": str, "description": str, "seed": int, "trials_done": int,
    "trials_planned": int, "until": str, "study_yaml": str, "reference": str, "factors": list, "estimators": list, "conditions": list,
    "failure_bounds": list, "quantities": list, "events": list,
}
MARGINAL_NUMBERS = ("value", "lower", "upper", "claimed", "excess")
MARGINAL_COLUMNS = ("estimator", "regime", "quantity", *MARGINAL_NUMBERS, "num_conditions", "n")
SCENE = "scene"  # the "estimator" of rows that describe the simulated problems themselves


@dataclass(frozen=True)
class Run:
    """One run: `facts` is run.json, `problems` the summary's rows about the problems, `summary` its others."""

    number: int
    facts: dict
    whole_summary: Summary
    comparison: object  # Summary, or None where there is nothing to compare
    reliability: object = None  # Reliability, or None where no estimator states probabilities
    marginals: object = None  # Table, or None where the conditions are no draws of a population

    def of_scene(self):
        """Which rows of the summary describe the problems; a study may also call an estimator so."""
        return (self.whole_summary.rows.estimator == SCENE) & (SCENE not in self.facts["estimators"])

    @property
    def is_of_population(self):
        """Whether the tables are of all conditions together, with intervals of the population they are drawn from."""
        return bool(self.facts.get("is_of_population"))

    @property
    def summary(self):
        return self.whole_summary.with_rows(self.whole_summary.rows[~self.of_scene()])

    @property
    def problems(self):
        return self.whole_summary.with_rows(self.whole_summary.rows[self.of_scene()])

    def anchor(self, part=""):
        """The id of a place on the page."""
        return f"run-{self.number}" + (f"-{part}" if part else "")


def read_facts(path):
    facts = read_object(str(path), "rcme report", FORMAT).value
    for key, kind in NEEDED.items():
        if not isinstance(facts.get(key), kind):
            raise PlotError(f"{path}: has no {key}, or not as {kind.__name__}; expected what 'rcme report' writes.")
    return facts


def check(table, columns, facts):
    """Numbers are numbers, there where n is not 0, and conditions those of the run."""
    counts, known = numbers(table, "n"), {str(condition["index"]) for condition in facts["conditions"]}
    for column in columns:
        for value, n, line in zip(numbers(table, column, may_be_empty=True), counts, table.rows["line"]):
            if value != value and n > 0 and column in ("value", "risk_difference", "p_value", "p_mcnemar", "p_holm"):
                raise PlotError(f"{table.path}: line {line}: column {column} is empty although n is not 0.")
    for condition, line in zip(table.rows["condition"], table.rows["line"]):
        if condition not in known:
            raise PlotError(f"{table.path}: line {line}: run.json has no condition {condition}.")


def read_run(number, folder):
    facts = read_facts(folder / "run.json")
    summary, comparison = read_summary(str(folder / "summary.csv")), None
    check(summary, ("value", "lower", "upper", "standard_error"), facts)
    if (folder / "comparison.csv").exists():
        comparison = read_comparison(str(folder / "comparison.csv"))
        p_value = "p_value" if "p_value" in comparison.rows else "p_mcnemar"
        check(comparison, ("risk_difference", "lower", "upper", p_value, "p_holm"), facts)
        comparison.path = "comparison.csv"  # from here on a message is part of the page
    summary.path = "summary.csv"
    return Run(number, facts, summary, comparison, read_stated(folder / "reliability.json"),
               read_marginals(folder / "marginals.csv"))


def read_stated(path):
    return read_reliability(str(path)) if path.exists() else None


def read_marginals(path):
    """Their numbers as floats; the claim of a failure rate is NaN."""
    if not path.exists():
        return None
    table = read_table(str(path), MARGINAL_COLUMNS, "rcme marginals RUN --format csv")
    for column in MARGINAL_NUMBERS:
        table.rows[column] = numbers(table, column, may_be_empty=True)
    return table


def read_runs(folder):
    folders = sorted(pathlib.Path(folder).glob("run_*"))
    if not folders:
        raise PlotError(f"{folder}: holds no folder run_0001; expected what 'rcme report' writes.")
    return [read_run(number, path) for number, path in enumerate(folders, 1)]
