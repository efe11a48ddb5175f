"""Made-up runs as `rcme report` hands them to plots/report.py, and the tests' common ground."""

import inspect
import json
from unittest import mock

from plot_test_case import PlotTestCase

import report
from page.picture import picture_of
from report_page import figures as report_figures

SUMMARY_HEADER = "study,condition,{factors}estimator,quantity,kind,value,lower,upper,standard_error,n\n"
COMPARISON_HEADER = ("study,condition,{factors}estimator,reference,event,n,both,estimator_only,reference_only,neither,"
                     "risk_difference,lower,upper,p_mcnemar,p_holm\n")
EVIL = '<script>alert("1")</script>&'  # a name is whatever a study says


def facts(**changes):
    """run.json of a run with one factor, two conditions and two estimators."""
    return {"format": "rcme report 1", "run": "runs/a b.sqlite", "rcme_version": "0.1.0", "name": "demo", "description": "What fails?", "seed": 7,
            "trials_done": 15, "trials_planned": 20, "until": "", "study_yaml": "name: demo\nseed: 7\n",
            "reference": "standard", "factors": ["noise"], "estimators": ["standard", "mine"],
            "conditions": [{"index": index, "levels": [level], "trials_done": 10 - 5 * index,
                            "trials_end": 10 - 5 * index, "trials_planned": 10,
                            "first": [{"failure": None, "refusal": None}, {"failure": 3, "refusal": 1}]}
                           for index, level in enumerate(("gaussian", "laplace"))],
            "failure_bounds": [{"name": "max_rotation_error_deg", "value": "3", "unit": "deg"}],
            "quantities": [{"name": "failure", "kind": "rate", "doc": "a motion beyond a bound"}],
            "events": [{"name": "failure", "doc": "a motion beyond a bound"},
                       {"name": "failure_or_refusal", "doc": "one of the two"}], **changes}


def summary(study="demo", levels=(("gaussian",), ("laplace",)), estimators=("standard", "mine"), factors=("noise",)):
    """Every number is different, and none follows from another."""
    text, number = SUMMARY_HEADER.format(factors="".join(f"{factor}," for factor in factors)), 0.001
    for condition, level in enumerate(levels):
        for estimator in estimators:
            for quantity in ("success", "failure", "no_candidate"):
                number += 0.0023
                text += ",".join([quoted(study), str(condition), *map(quoted, level), quoted(estimator), quantity, "rate",
                                  f"{number:.4f}", f"{number - 0.0005:.4f}", f"{number + 0.3:.4f}", "", "10"]) + "\n"
            text += ",".join([quoted(study), str(condition), *map(quoted, level), quoted(estimator), "nees", "mean",
                              f"{50 * number:.4f}", "", "", f"{number:.5f}", "9"]) + "\n"
    return text


def comparison(study="demo", levels=(("gaussian",), ("laplace",)), others=("mine",), factors=("noise",)):
    text = COMPARISON_HEADER.format(factors="".join(f"{factor}," for factor in factors))
    for condition, level in enumerate(levels):
        for estimator in others:
            for event, p_holm in (("failure", "0.0123"), ("failure_or_refusal", "0.0789")):
                text += ",".join([quoted(study), str(condition), *map(quoted, level), quoted(estimator), "standard", event,
                                  "10", "1", "2", "3", "4", "-0.1", "-0.4", "0.2", "0.0045", p_holm]) + "\n"
    return text


def quoted(text):
    return '"' + text.replace('"', '""') + '"'


def picture_once(draw, alt, known={}):
    """picture_of, but what was drawn of the same tables in the same way is not drawn again: so are most pages of these tests."""
    given = dict(inspect.getclosurevars(draw).nonlocals)
    run = given.pop("run")
    tables = [table.rows.to_csv() for table in (run.summary, run.comparison) if table is not None]
    key = (alt, draw.__code__, repr(sorted(given.items())), repr(run.reliability), *tables)
    if key not in known:
        known[key] = picture_of(draw, alt)
    return known[key]


class ReportTest(PlotTestCase):
    script, given = report, ["data"]

    def setUp(self):
        super().setUp()
        self.enterContext(mock.patch.object(report_figures, "picture_of", picture_once))
        self.data, self.out = self.folder / "data", self.folder / "report.html"
        self.data.mkdir()

    def add_run(self, number=1, run_json=None, summary_csv=None, comparison_csv=None):
        folder = self.data / f"run_{number:04}"
        folder.mkdir(exist_ok=True)
        (folder / "run.json").write_text(json.dumps(run_json or facts()))
        (folder / "summary.csv").write_text(summary_csv or summary())
        if comparison_csv != "":
            (folder / "comparison.csv").write_text(comparison_csv or comparison())

    def run_main(self, *arguments):
        return self.run_script(self.data, "--out", self.out, *arguments)

    def page(self):
        self.assertEqual(self.run_main(), (0, f"{self.out}\n", ""))
        return self.out.read_text(encoding="utf-8")
