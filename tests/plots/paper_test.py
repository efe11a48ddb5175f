#!/usr/bin/python3
"""Tests of what every figure of `rcme plot` owes a paper: --width, --labels, --no-caption, --format; run as:
/usr/bin/python3 tests/plots/paper_test.py

The tables are committed results, with up to thirteen estimators and names as studies have them, and the made-up files of
the other tests.
"""

import contextlib
import functools
import importlib
import io
import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest
from unittest import mock

from plot_test_case import PLOTS, PlotTestCase

import closure_test
import conform_test
import crossings_test
import fake_audit
import fake_integrity
import fake_reliability
import fake_tune
import gate_test
import validation_test
from audit_power_test import TABLE as POWER
from common import sheet, style, tikz
from common.summary_csv import read_summary, where
from drawn_text import do_overlap, drawn_texts, problems_of

ROOT = PLOTS.parent
RESULTS = ROOT / "results"
WIDTHS = (3.3, 7.0)
LATEX = shutil.which("pdflatex")


def few_claims():
    """Of each way to draw a claim one: curves, forests, a ROC curve."""
    whole = fake_audit.fake_audit()
    return {**whole, "claims": [claim for claim in whole["claims"] if claim["family"] in ("inlier", "mu", "complexity")]}


def benchmarks():
    def time(scale):
        return {"median": 10 * scale, "lower": 9 * scale, "upper": 12 * scale}
    cases = [{"group": "stage", "name": name, "microseconds": time(1 + place)}
             for place, name in enumerate(("hypothesis_search/fast", "hypothesis_search/reference", "sampson_distances/fast"))]
    cases += [{"group": group, "name": name, "microseconds": time(100)}
              for group, name in (("estimator", "rcme_calibrated"), ("peer", "opencv_usac_accurate"), ("trial", "trial"))]
    series = {name: [{"size": size, **time(size)} for size in (100, 1000, 10000)] for name in ("n", "n_scoring", "iterations", "trials")}
    return {"run": {"problem": "500 matches", "rounds": 30, "clock": "processor time", "instruction_set": "AVX2", "cores": 2},
            "ratios": {f"exponent_{name}": 1.0 for name in series}, "cases": cases, "series": series}


def cases(folder):
    """[(kind, arguments before --out, whether --out is a folder)] of every kind of figure."""
    def written(name, content):
        path = pathlib.Path(folder) / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return str(path)
    peers, atlas = RESULTS / "peers", RESULTS / "atlas"
    probabilities = fake_reliability.content(*(fake_reliability.entry(name) for name in ("rcme_calibrated", "poselib", "mine")))
    return [
        ("failure_rate", [str(atlas / "failure_vs_outliers.csv"), "--x", "outlier_ratio"], False),
        ("failure_rate", [str(peers / "peers_indoor_like.csv"), "--x", "scene", "--where", "outlier_ratio=0.5",
                          "--quantities", "failure,success,auc_10_deg"], False),
        ("failure_rate", [str(atlas / "failure_one_at_a_time.csv"), "--x", "motion", "--log-y"], False),
        ("failure_rate", [str(peers / "peers_uniform.csv"), "--x", "outlier_ratio", "--quantities", "failure"], False),
        ("heat_map", [str(atlas / "failure_vs_outliers_and_clustering.csv"), "--x", "outlier_ratio", "--y", "clustered_share",
                      "--quantities", "failure", "--estimators", "standard,rcme_rank_aware"], False),
        ("heat_map", [str(atlas / "indoor_like.csv"), "--x", "scene", "--y", "outlier_ratio", "--quantities", "failure",
                      "--estimators", "standard,rcme_rank_aware,rcme_as_printed"], False),
        ("paired_difference", [str(atlas / "failure_vs_outliers_and_clustering_paired.csv"), "--x", "outlier_ratio",
                               "--where", "clustered_share=0.5", "--event", "failure,failure_or_refusal"], False),
        ("time_against_success", [str(peers / f"peers_{name}_1ms.csv") for name in ("uniform", "forward")], False),
        ("reliability", [written("reliability.json", probabilities)], False),
        ("stanford", [written("integrity.json", fake_integrity.content())], False),
        ("gate", [written("gate.json", gate_test.content())], False),
        ("conform", [written("report.json", conform_test.content())], False),
        ("validation", [written("validation.json", validation_test.fake())], False),
        ("failure_rate", [str(peers / "peers_uniform.csv"), "--where", "outlier_ratio=0.4", "--quantities",
                          "failure,nees_coverage,failure_probability"], False),
        ("audit_power", [written("power.csv", POWER)], False),
        ("closure", [written("closure.csv", closure_test.TABLE)], False),
        ("benchmarks", [written("benchmarks.json", benchmarks())], False),
        ("tune", [written("tune.json", fake_tune.tune([fake_tune.option("mu", ("0", "1", "2"), "nats"), fake_tune.option("lambda", ("0.5", "2"))]))], False),
        ("transfer", [written("transfer.json", fake_tune.transfer(3))], False),
        ("crossings", [written("crossings.json", crossings_test.crossings()), "--x", "outlier_ratio"], False),
        ("validity_map", [str(RESULTS / "validity_map")], True),
        ("audit", [str(pathlib.Path(written("audited/audit.json", few_claims())).parent)], True),
        ("failure_rate", [str(atlas / "failure_one_at_a_time.csv"), "--x", "motion", "--quantities",
                          "rotation_error_median_deg,direction_error_median_deg_answered"], False),
        ("failure_rate", [str(peers / "peers_uniform.csv"), "--x", "outlier_ratio", "--where", "outlier_ratio=0.1", "--where",
                          "outlier_ratio=0.2", "--estimators", "poselib,rcme_calibrated"], False)]


@functools.lru_cache(maxsize=None)
def run_script(kind, *arguments):
    """(exit code, standard error, {name: figure}); nothing is written."""
    figures, errors = {}, io.StringIO()

    def keep(figure, path, dpi=None):
        figures[pathlib.Path(path).name] = figure
        return [path]
    with mock.patch.object(style, "save", keep), contextlib.redirect_stderr(errors), contextlib.redirect_stdout(io.StringIO()):
        code = importlib.import_module(kind).main(list(arguments))
    return code, errors.getvalue(), figures


class WithCases(unittest.TestCase):
    """The cases lie in one folder, so that a figure is drawn once for all tests."""

    scratch = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(scratch.cleanup)
    folder = pathlib.Path(scratch.name)
    cases = cases(folder)

    def arguments(self, kind, given, is_folder, *more):
        return [kind, *given, "--out", str(self.folder if is_folder else self.folder / "figure"), *more]


class Paper(WithCases):
    def test_every_kind_of_the_program_is_here(self):
        source = (ROOT / "experiments" / "commands" / "plot_command.cc").read_text()
        known = re.findall(r'\{"(\w+)",\s*"[A-Z]', source)
        self.assertGreater(len(known), 10)
        self.assertEqual(set(known), {kind for kind, *_ in self.cases})

    def test_texts_can_be_read_and_neither_touch_nor_leave_the_paper(self):
        for case in self.cases:
            for width in WIDTHS:
                with self.subTest(kind=case[0], file=pathlib.Path(case[1][0]).name, width=width):
                    code, errors, figures = run_script(*self.arguments(*case, "--width", str(width)))
                    self.assertEqual((code, errors), (0, ""))
                    for name, figure in figures.items():
                        self.assertAlmostEqual(figure.get_figwidth(), width)
                        self.assertEqual(problems_of(figure, sheet.SMALLEST_FONT, sheet.LARGEST_FONT), [], name)

    def test_a_narrow_legend_of_ten_names_has_two_columns_and_ends_above_the_panels(self):
        for case in (self.cases[1], self.cases[7]):
            code, errors, figures = run_script(*self.arguments(*case, "--width", "3.3"))
            self.assertEqual((code, errors), (0, ""))
            figure = figures["figure"]
            figure.draw_without_rendering()
            names = [text.get_window_extent() for text in figure.legends[0].get_texts()]
            self.assertEqual(len(names), 10)
            self.assertEqual(len({round(name.x0) for name in names}), 2)
            self.assertGreater(min(name.y0 for name in names), max(axes.get_tightbbox().y1 for axes in figure.axes))

    def test_the_widths_of_the_guide_are_taken(self):
        page = (ROOT / "docs" / "figures.md").read_text()
        widths = [float(width) for row in re.findall(r"^\| `.*pt.*\|$", page, re.M) for width in re.findall(r"\d\.\d\d(?= \|)", row)]
        self.assertGreater(len(widths), 6)
        for width in widths:
            with self.subTest(width=width):
                code, errors, figures = run_script(*self.arguments(*self.cases[0], "--width", str(width)))
                self.assertEqual((code, errors), (0, ""))
                self.assertEqual(problems_of(figures["figure"], sheet.SMALLEST_FONT, sheet.LARGEST_FONT), [])

    def test_the_caption_can_be_left_out(self):
        for case in {case[0]: case for case in self.cases}.values():
            with self.subTest(kind=case[0]):
                whole, without = (run_script(*self.arguments(*case, "--width", "7.0", *more))[2]
                                  for more in ((), ("--no-caption",)))
                for name, figure in whole.items():
                    dropped = len(figure.texts) - len(without[name].texts)
                    self.assertEqual(dropped, 1, name)
                    self.assertLessEqual(without[name].get_figheight(), figure.get_figheight())

    def test_labels_name_estimators_factors_levels_and_quantities(self):
        case = self.cases[1]
        labels = ["opencv_magsac=MAGSAC++ (OpenCV)", "scene=Type of scene", "room=A room", "failure=Wrong motions"]
        more = [word for label in labels for word in ("--labels", label)]
        code, errors, figures = run_script(*self.arguments(*case, "--width", "3.3", *more))
        self.assertEqual((code, errors), (0, ""))
        texts = " ".join(text for text, _, _ in drawn_texts(figures["figure"]))
        for label in labels:
            self.assertIn(label.split("=")[1], texts)

    def test_narrow_cells_have_the_ends_of_the_interval_above_and_below_the_rate(self):
        code, errors, figures = run_script(*self.arguments(*self.cases[4], "--width", "3.3"))
        self.assertEqual((code, errors), (0, ""))
        cell = sorted((text for text in figures["figure"].axes[0].texts if text.get_position()[0] == 4.5
                       and 4 < text.get_position()[1] < 5), key=lambda text: -text.get_position()[1])
        rows = where(read_summary(self.cases[4][1][0]), ["outlier_ratio=0.5", "clustered_share=0.97", "estimator=standard"]).rows
        row, = rows[rows.quantity == "failure"].to_dict("records")
        self.assertEqual([text.get_text() for text in cell], [f"{100 * float(row[name]):.1f}" for name in ("upper", "value", "lower")])

    def test_what_is_not_possible_is_refused(self):
        case = self.cases[0]
        for more, named in ((("--labels", "rmce=Ours"), ("rmce", "rcme_as_printed")), (("--labels", "rcme"), ("name=text",)),
                            (("--width", "1"), ("--width 1", "between 2.5")), (("--width", "nan"), ("--width nan",)),
                            (("--format", "eps"), ("eps", "tikz")), (("--format", ","), ("at least one",))):
            code, errors, figures = run_script(*self.arguments(*case, *more))
            self.assertEqual((code, figures, errors.count("\n")), (2, {}, 1), more)
            for words in named:
                self.assertIn(words, errors)
        many = self.arguments(*self.cases[4], "--width", "3")
        self.assertIn("inches", run_script(*many)[1])


class Formats(PlotTestCase, WithCases):
    @classmethod
    def setUpClass(cls):
        """{name of a file: its text}, of every kind."""
        cls.tikz = {}
        for kind, case in {case[0]: case for case in cls.cases}.items():
            code, _, figures = run_script(*cls().arguments(*case, "--width", str(WIDTHS[0])))
            assert code == 0, kind
            for name, figure in sorted(figures.items()):
                style.lay_out(figure, style.RC["savefig.dpi"])  # as it is saved
                cls.tikz[f"{kind}_{name}.tikz"] = tikz.tikz_of(figure)

    def test_every_format_is_written_alone_and_twice_alike(self):
        case = self.cases[0]
        for kind, beginning in (("png", b"\x89PNG"), ("pdf", b"%PDF"), ("svg", b"<?xml"), ("tikz", b"% A figure")):
            found = []
            for name in ("a", "b"):
                with contextlib.redirect_stdout(io.StringIO()):
                    importlib.import_module(case[0]).main([*case[1], "--out", str(self.folder / name), "--format", kind])
                found.append((self.folder / f"{name}.{kind}").read_bytes())
            self.assertTrue(found[0].startswith(beginning), kind)
            self.assertEqual(found[0], found[1])
        self.assertEqual(sorted(path.suffix for path in self.folder.glob("a.*")), [".pdf", ".png", ".svg", ".tikz"])

    def test_tikz_is_balanced_and_has_the_figures_texts_and_numbers_that_tex_knows(self):
        for file, text in self.tikz.items():
            with self.subTest(file=file):
                bare = re.sub(r"\\[{}\\%#&$_]", "", text)
                self.assertEqual(bare.count("{"), bare.count("}"))
                for name in ("pgfscope", "tikzpicture"):
                    self.assertEqual(text.count(f"\\begin{{{name}}}"), text.count(f"\\end{{{name}}}"))
                self.assertEqual(re.findall(r"\b(?:nan|inf)(?:in|pt)?\b|\d*e[+-]\d", re.sub(r" at \([^)]*\) \{.*\};", "", text)), [])
                self.assertLess(max(abs(float(inches)) for inches in re.findall(r"\{(-?[\d.]+)in\}", text)), 16000 / 72.27)
                self.assertTrue(all(line.endswith((";", "}", "]", "%")) or line.startswith("%") for line in text.splitlines()))
                self.assertGreater(text.count("\\node"), 5)

    def test_tikz_escapes_what_latex_takes_for_commands(self):
        self.assertEqual(tikz.escaped(r"50 % of $x_i$ \input{a} ~^&#"),
                         r"50 \% of \$x\_i\$ \textbackslash{}input\{a\} \textasciitilde{}\textasciicircum{}\&\#")
        self.assertEqual(tikz.escaped("\u22123\u00b710\u207b\u2075 \u2264 95 \u00b0\n"), "$-$3$\\cdot$10$^{-}$$^{5}$ $\\le$ 95 $^\\circ$ ")
        self.assertEqual([tikz.number(x) for x in (1.0, -0.001, 0.125, -2.5, 1e9, -1e9)],
                         ["1", "0", "0.12", "-2.5", "10000", "-10000"])

    @unittest.skipUnless(LATEX, "no pdflatex on this machine")
    def test_latex_takes_every_kind(self):
        for file, text in self.tikz.items():
            (self.folder / file).write_text(text)
        document = "".join(f"\\begin{{figure}}\\input{{{name}}}\\end{{figure}}\\clearpage\n" for name in self.tikz)
        (self.folder / "paper.tex").write_text("\\documentclass{article}\\usepackage{tikz}\\begin{document}\n" + document +
                                               "\\end{document}\n")
        done = subprocess.run([LATEX, "-interaction=nonstopmode", "-halt-on-error", "paper.tex"], cwd=self.folder,
                              capture_output=True, text=True, errors="replace", check=False, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:])
        self.assertNotIn("Missing character", done.stdout)


class TheMeasure(unittest.TestCase):
    """A test of texts that could not fail would say nothing."""

    def figure(self, *texts):
        figure, _ = style.new_figure(1, 1)
        figure.axes[0].set_axis_off()
        for x, y, text, points in texts:
            figure.text(x, y, text, fontsize=points)
        return figure

    def test_finds_what_touches_leaves_or_cannot_be_read(self):
        self.assertEqual(problems_of(self.figure((0.1, 0.5, "one", 8), (0.3, 0.5, "two", 8)), 7, 9), [])
        for texts, words in ((((0.1, 0.5, "one", 8), (0.12, 0.51, "two", 8)), "overlaps"),
                             (((0.97, 0.5, "a long one", 8),), "leaves"), (((0.1, 0.5, "one", 5),), "5 pt"),
                             (((0.1, 0.5, "one", 12),), "12 pt")):
            problems = problems_of(self.figure(*texts), 7, 9)
            self.assertEqual(len(problems), 1, problems)
            self.assertIn(words, problems[0])

    def test_slanting_texts_overlap_only_where_they_do(self):
        import numpy
        square = numpy.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
        diamond = numpy.array([[1.5, 0.5], [2.0, 1.0], [1.5, 1.5], [1.0, 1.0]], float)
        self.assertFalse(do_overlap(square, diamond + 0.1))
        self.assertTrue(do_overlap(square, diamond - 0.3))


if __name__ == "__main__":
    unittest.main()
