#!/usr/bin/python3
"""Tests of plots/audit.py; run as: /usr/bin/python3 tests/plots/audit_test.py"""

import contextlib
import copy
import functools
import io
import itertools
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

HERE = pathlib.Path(__file__).resolve().parent
PLOTS = HERE.parents[1] / "plots"
sys.path[:0] = [str(PLOTS), str(HERE)]

import audit  # noqa: E402
from browser import BROWSER, SKIP_REASON, Browser  # noqa: E402
from report_test import EVIL, Structure  # noqa: E402
from audit_figures.audit_file import CLAIM_VERDICTS, TARGET_VERDICTS, read_audit  # noqa: E402
from audit_figures.look import LOOKS, series_look  # noqa: E402
from fake_audit import SIGMAS, claim, coverage, evidence, fake_audit, target  # noqa: E402
from matplotlib.collections import LineCollection, PolyCollection  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.patches import Polygon  # noqa: E402


def file_with(*claims):
    return dict(fake_audit(), claims=list(claims))


def draw(content, family=None):
    """The figure of a family, or of the only one, drawn from a file with this content."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "audit.json")
        path.write_text(json.dumps(content))
        read = read_audit(str(path))
    families = read.families()
    family = family or next(iter(families))
    return audit.draw_family(read, family, families[family])


@functools.lru_cache(maxsize=None)
def fake_figure(family):
    return draw(fake_audit(), family)


def lines_of(axes, label):
    """The points (x, y) of every line with that label, gaps left out."""
    return [[(x, y) for x, y in zip(*line.get_data()) if y == y] for line in axes.lines if line.get_label() == label]


def marks_of(axes, label):
    return [points[0] for points in lines_of(axes, label)]


def bars_of(axes, label="_interval"):
    """The ends [[x, y], [x, y]] of the bars with that label."""
    return [segment.tolist() for lines in axes.collections
            if isinstance(lines, LineCollection) and lines.get_label() == label for segment in lines.get_segments()]


def bands_of(axes):
    """(lowest, highest) y of every band over the whole panel."""
    return [(min(y for _, y in patch.get_xy()), max(y for _, y in patch.get_xy())) for patch in axes.patches
            if isinstance(patch, Polygon)]


def texts_of(figure):
    return [text.get_text() for text in figure.texts]


def caption_of(figure):
    return " ".join(texts_of(figure)[-1].split())


def shown_texts(figure):
    """(text, its box) of all that is written: words, axis names, drawn tick labels, legends."""
    figure.canvas.draw()
    texts = figure.texts + [text for legend in figure.legends for text in legend.get_texts()]
    for axes in figure.axes:
        texts += axes.texts
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            labels = zip(axis.get_majorticklocs(), axis.get_ticklabels())
            texts += [axis.label] + [label for place, label in labels if low <= place <= high] if axis.get_visible() else []
    return [(text.get_text(), text.get_window_extent()) for text in texts if text.get_text()]


class Written(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.file = self.folder / "audit.json"
        self.small = file_with(claim("flag.kappa", [evidence([target("flag rate", "rate", 0.02, None, None, 0.05)])]),
                               claim("z_test.size", [evidence(coverage(0), sigma_px=s) for s in SIGMAS],
                                     figure_x="sigma_px"))

    def run_main(self, *arguments, content=None, text=None):
        """(exit code, stdout, stderr) of the script on a file with that content or text."""
        self.file.write_text(json.dumps(content or self.small) if text is None else text)
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = audit.main([str(self.folder), *arguments])
        return code, out.getvalue(), err.getvalue()

    def assert_refused(self, result, *named):
        code, out, err = result
        self.assertEqual((code, out), (2, ""), err)
        self.assertEqual(err.count("\n"), 1, err)
        for name in named:
            self.assertIn(name, err)
        self.assertEqual([path.name for path in self.folder.iterdir() if path.name != "audit.json"], [])


class WrittenFiles(Written):
    def test_the_command_writes_two_files_per_family_and_prints_their_paths(self):
        self.file.write_text(json.dumps(self.small))
        done = subprocess.run(["/usr/bin/python3", str(PLOTS / "audit.py"), str(self.folder)], capture_output=True,
                              text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout.split(), [f"{self.folder}/audit_{name}" for name in
                                               ("flag.png", "flag.pdf", "z_test.png", "z_test.pdf")])
        png, pdf = (pathlib.Path(path).read_bytes() for path in done.stdout.split()[2:])
        self.assertTrue(png.startswith(b"\x89PNG") and len(png) > 15_000)
        self.assertTrue(pdf.startswith(b"%PDF") and pdf.rstrip().endswith(b"%%EOF") and len(pdf) > 8_000)

    def test_out_chooses_another_folder_that_exists(self):
        other = self.folder / "figures"
        self.assert_refused(self.run_main("--out", str(other)), "--out", "figures", "no such folder")
        other.mkdir()
        self.assertEqual(self.run_main("--out", str(other))[0], 0)
        self.assertEqual(sorted(path.name for path in other.iterdir())[:2], ["audit_flag.pdf", "audit_flag.png"])

    def test_same_input_gives_same_bytes(self):
        def run():
            self.assertEqual(self.run_main()[0], 0)
            return {path.name: path.read_bytes() for path in self.folder.iterdir()}
        first = run()
        with mock.patch("time.time", return_value=2e9):
            self.assertEqual(run(), first)

    def test_a_failed_write_says_so_and_leaves_nothing_half_written(self):
        def disk_full(figure, path, **options):
            pathlib.Path(path).write_bytes(b"half")
            raise OSError(28, "No space left on device")
        with mock.patch.object(Figure, "savefig", disk_full):
            self.assert_refused(self.run_main(), "cannot write", "No space left on device")

    def test_help_teaches_with_an_example(self):
        out = io.StringIO()
        with contextlib.redirect_stdout(out), self.assertRaises(SystemExit) as end:
            audit.main(["--help"])
        self.assertEqual(end.exception.code, 0)
        self.assertIn("rcme audit --out audit\n  rcme plot audit audit", out.getvalue())


class Curves(unittest.TestCase):
    def test_values_intervals_range_and_nominal_are_those_of_the_file(self):
        rows = [evidence([target("bias", "mean", value, 1, 0.9, 1.2, half)], num_points=n)
                for n, value, half in ((8, 1.0, 0.05), (30, 1.5, 0.1), (20, 1.15, 0.2))]  # not in order of x
        axes, = draw(file_with(claim("mle.bias", rows, figure_x="num_points"))).axes
        self.assertEqual(lines_of(axes, "_series"), [[(8, 1.0), (20, 1.15), (30, 1.5)]])
        self.assertEqual(bars_of(axes), [[[8, 0.95], [8, 1.05]], [[20, 1.15 - 0.2], [20, 1.15 + 0.2]],
                                         [[30, 1.4], [30, 1.6]]])
        self.assertEqual(bands_of(axes), [(0.9, 1.2)])
        self.assertEqual([ys for _, ys in lines_of(axes, "_nominal")[0]], [1, 1])
        self.assertEqual([marks_of(axes, "_" + verdict) for verdict in ("holds", "undecided", "does not hold")],
                         [[(8, 1.0)], [(20, 1.15)], [(30, 1.5)]])
        self.assertEqual((axes.get_xscale(), axes.get_xlabel(), axes.get_ylabel()), ("linear", "Num points", "Bias"))

    def test_of_a_coverage_row_alpha_005_is_strong_and_the_others_pale(self):
        rows = [evidence(coverage(0.1), sigma_px=s, num_points=8) for s in SIGMAS]
        figure = draw(file_with(claim("inlier.x", rows, figure_x="sigma_px")))
        axes, = figure.axes
        by_alpha = {one["quantity"]: one["measured"] for one in rows[0]["targets"]}
        self.assertEqual({y for _, y in lines_of(axes, "_series")[0]}, {by_alpha["coverage at alpha 0.05"]})
        self.assertEqual([points[0][1] for points in lines_of(axes, "_pale")],
                         [by_alpha[f"coverage at alpha {alpha}"] for alpha in ("0.5", "0.2", "0.1", "0.01")])
        self.assertEqual(sorted(points[0][1] for points in lines_of(axes, "_nominal")), [0.5, 0.8, 0.9, 0.95, 0.99])
        self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("log", "logit"))
        figure.canvas.draw()
        self.assertLessEqual({"50", "80", "90", "95", "99"}, {label.get_text() for label in axes.get_yticklabels()})
        self.assertIn("pale: the other significance levels", caption_of(figure))

    def test_another_condition_gives_series_that_differ_without_colour(self):
        axes = fake_figure("inlier").axes[2]
        series = [line for line in axes.lines if not line.get_label().startswith("_")]
        self.assertEqual([line.get_label() for line in series], ["num points = 8", "num points = 20", "num points = 100"])
        self.assertEqual(len({repr(series_look(position)[1]) for position in range(5)}), 5)
        self.assertEqual(axes.figure.legends[1].get_texts()[1].get_text(), "20")

    def test_a_condition_that_x_determines_makes_no_series(self):
        rows = [evidence([target("bias", "mean", 1, 1, 0.9, 1.1)], sigma_px=s, sigma_rad=f"{s}e-3") for s in SIGMAS]
        axes, = draw(file_with(claim("mle.bias", rows, figure_x="sigma_px"))).axes
        self.assertEqual(len(lines_of(axes, "_series")), 1)

    def test_too_many_series_become_panels(self):
        figure = fake_figure("mle")
        self.assertEqual(len(figure.axes), 4)
        self.assertIn("outlier ratio = 0.3", texts_of(figure))

    def test_quantities_of_different_size_have_panels_of_their_own(self):
        first, second = fake_figure("sigma_p").axes[:2]
        self.assertEqual(second.get_ylabel(), "Condition number of\nSigma_p")
        self.assertLess(first.get_ylim()[1], 2)
        self.assertIn("standard deviation, rotation about x, scene = cube", [line.get_label() for line in first.lines])

    def test_a_range_that_follows_x_is_a_band_that_follows_x(self):
        band, = [one for one in fake_figure("mle").axes[3].collections if isinstance(one, PolyCollection)]
        corners = {tuple(corner) for path in band.get_paths() for corner in path.vertices}
        self.assertLessEqual({(8, 0.97 * 3), (8, 1.03 * 3), (1000, 0.97 * 995), (1000, 1.03 * 995)}, corners)

    def test_words_stand_side_by_side_without_a_line(self):
        axes = fake_figure("sigma_p").axes[2]
        self.assertEqual([label.get_text() for label in axes.get_xticklabels()],
                         ["cube", "random_\npoints", "wall", "corridor"])
        line, = [line for line in axes.lines if line.get_label() == "_series"]
        self.assertEqual((list(line.get_xdata()), line.get_linestyle()), ([0, 1, 2, 3], "None"))

    def test_a_zero_has_a_place_on_a_logarithmic_axis_and_0_and_1_on_a_logit_axis(self):
        axes = fake_figure("inlier").axes[3]
        x = [axes.transData.transform((float(s), 0.5))[0] for s in ("0", *SIGMAS)]
        self.assertEqual(x, sorted(x))
        self.assertTrue(all(math.isfinite(one) for one in x))
        self.assertGreater(x[1] - x[0], 10)
        self.assertEqual(lines_of(axes, "_series")[0][-1], (5.0, axes.get_ylim()[1]))
        self.assertEqual([axes.yaxis.get_major_formatter()(end) for end in axes.get_ylim()], ["0", "100"])

    def test_gaps_crosses_and_arrows_stand_for_what_is_not_finite(self):
        figure = fake_figure("failure")
        axes = figure.axes[0]
        self.assertEqual([x for x, _ in lines_of(axes, "_series")[0]], [0, 0.2, 0.6, 0.8])
        self.assertEqual(marks_of(axes, "_missing"), [(0.4, 0)])
        top = axes.get_ylim()[1]
        self.assertEqual(marks_of(axes, "_cut"), [(0.6, top), (0.8, top)])
        self.assertLess(top, 10)  # an interval up to 9e9 does not flatten the rest
        self.assertIn("arrow at a frame: the interval goes on; cross at a frame", caption_of(figure))

    def test_the_noise_up_to_which_the_claim_holds_is_marked(self):
        figure = fake_figure("inlier")
        self.assertEqual([{x for x, _ in points} for points in lines_of(figure.axes[2], "_limit")], [{0.5}])
        self.assertEqual(lines_of(figure.axes[0], "_limit"), [])
        self.assertIn("\u25d0 holds in the small-noise limit only: sigma \u2264 0.5 px", texts_of(figure))

    def test_one_level_only_is_drawn_as_a_list(self):
        axes, = draw(file_with(claim("inlier.x", [evidence(coverage(0), sigma_px="1")], figure_x="sigma_px"))).axes
        self.assertFalse(axes.yaxis.get_visible())
        self.assertEqual(len(bars_of(axes)), 5)

    def test_values_far_apart_are_on_a_logarithmic_axis_if_all_are_positive(self):
        far, jumps = fake_figure("entropy").axes[4:6]
        self.assertEqual((far.get_yscale(), jumps.get_yscale()), ("log", "linear"))


class Forests(unittest.TestCase):
    def test_each_target_is_a_line_with_its_words_and_numbers(self):
        row = evidence([target("exponent", "mean", 1.02, 1, 0.9, 1.1, 0.04), target("slope", "mean", 2, 1, 0.9, 1.1, 0.1)],
                       sigma_px="1")
        figure = draw(file_with(claim("complexity.x", [row], "does not hold")))
        axes, = figure.axes
        (first, y), = marks_of(axes, "_holds")
        (second, lower_y), = marks_of(axes, "_does not hold")
        self.assertEqual((first, second), (1.02, 2))
        self.assertLess(y, lower_y)  # y runs downwards
        self.assertEqual(bars_of(axes), [[[0.98, y], [1.02 + 0.04, y]], [[1.9, lower_y], [2.1, lower_y]]])
        self.assertEqual([bar[0][0] for bar in bars_of(axes, "_bound")], [0.9, 1.1, 0.9, 1.1])
        self.assertEqual([bar[0][0] for bar in bars_of(axes, "_nominal")], [1, 1])
        for text in ("exponent", "slope", "1.020 [0.980, 1.060]", "2.00 [1.90, 2.10]", "sigma = 1 px", "\u2713", "\u2717"):
            self.assertIn(text, texts_of(figure))

    def test_rates_and_sizes_have_axes_of_their_own_and_zeros_fit_with_small_ones(self):
        figure = fake_figure("complexity")
        self.assertEqual([axes.get_xlabel() for axes in figure.axes], ["Num points", "", "Rate (%)", "", ""])
        for heading in ("exponent of the time in N", "share of the refinement", "estimator = rcme", "0 [0, 0]"):
            self.assertIn(heading, texts_of(figure))

    def test_only_conditions_that_vary_are_written_and_the_others_once(self):
        figure = fake_figure("mu")
        self.assertEqual(texts_of(figure).count("sigma = 1 px"), 2)

    def test_the_bound_that_decides_is_in_the_panel_however_far(self):
        axes = fake_figure("mu").axes[2]
        self.assertEqual([bar[0][0] for bar in bars_of(axes, "_bound")], [0.9])
        self.assertLess(axes.get_xlim()[0], 0.63)
        self.assertGreater(axes.get_xlim()[1], 0.9)

    def test_missing_values_and_open_ends_are_said(self):
        figure = fake_figure("failure")
        self.assertIn("\u2013", texts_of(figure))
        self.assertIn("3.2 [1.1, \u221e)", texts_of(figure))
        self.assertIn("no value", [text.get_text() for axes in figure.axes for text in axes.texts])
        self.assertEqual(texts_of(figure).count("no evidence in the file"), 2)


class Roc(unittest.TestCase):
    def test_the_curve_joins_rates_at_equal_mu_and_marks_the_default(self):
        def models(name, *rates):
            return evidence([target(f"accepted at {mu}", "rate", rate, half=0.01, threshold=mu) for mu, rate in rates],
                            models=name)
        rows = [models("contaminated", (-3, 0.4), (-3.5, 0.2), (-6, 0.01)), models("good", (-6, 0.3), (-3, 0.95), (-3.5, 0.9))]
        figure = draw(file_with(claim("mu.x.roc", rows, "measured")))
        axes, = figure.axes
        self.assertEqual(lines_of(axes, "_roc"), [[(0.01, 0.3), (0.2, 0.9), (0.4, 0.95)]])
        self.assertEqual(marks_of(axes, "_default mu"), [(0.2, 0.9)])
        self.assertEqual(axes.texts[0].get_text(), "mu = \u22123.5")
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()),
                         ("Contaminated models accepted (%)", "Good models accepted (%)"))
        self.assertIn("nearest to the default of its reading", caption_of(figure))

    def test_further_conditions_give_several_curves(self):
        labels = [line.get_label() for line in fake_figure("mu").axes[1].lines]
        self.assertLessEqual({"scene = cube", "scene = wall"}, set(labels))


class Words(unittest.TestCase):
    def test_title_verdict_and_caption(self):
        figure = fake_figure("new_family")
        self.assertEqual(texts_of(figure)[:2], ["new_family.alone (rank-aware)", "\u2713 holds"])
        self.assertEqual(caption_of(figure),
                         "Audit of family new_family; seed 1; budget quick; n = 20000 per target; intervals hold at all "
                         "sample sizes at once, confidence 1 \u2212 8\u00b710\u207b\u2075 each; pale: the other significance "
                         "levels, each around its own nominal value.")
        self.assertIn("n = 500\u201320000 per target", caption_of(fake_figure("inlier")))

    def test_verdicts_differ_without_colour(self):
        self.assertEqual(set(LOOKS), set(CLAIM_VERDICTS))
        self.assertEqual(len({look.glyph for look in LOOKS.values()}), len(LOOKS))
        points = [LOOKS[verdict] for verdict in TARGET_VERDICTS]
        self.assertEqual(len({(look.marker, look.filled) for look in points}), len(points))

    def test_no_text_touches_another_or_leaves_the_paper(self):
        for family in dict.fromkeys(one["family"] for one in fake_audit()["claims"]):
            figure = fake_figure(family)
            texts = shown_texts(figure)
            self.assertGreater(len(texts), 8)
            for text, box in texts:
                inside = min(box.x0, box.y0, figure.bbox.width - box.x1, figure.bbox.height - box.y1)
                self.assertGreaterEqual(inside, -0.5, f"{family}: '{text}' leaves the paper")
            for (one, box), (other, other_box) in itertools.combinations(texts, 2):
                across = min(box.x1, other_box.x1) - max(box.x0, other_box.x0)
                along = min(box.y1, other_box.y1) - max(box.y0, other_box.y0)
                self.assertFalse(across > 0.5 and along > 1.5, f"{family}: '{one}' and '{other}' overlap")


    def test_labels_and_numbers_stand_beside_the_axes_not_on_them(self):
        for family in ("complexity", "estimator", "failure", "mu"):
            figure = fake_figure(family)
            beside = [text for text in figure.texts if text.get_fontweight() != "bold"]  # a heading may cross the axes
            for axes, text in itertools.product(figure.axes, beside):
                self.assertFalse(axes.bbox.overlaps(text.get_window_extent()), f"{family}: '{text.get_text()}'")


class Refusals(Written):
    def changed(self, *path_and_value):
        """The small file with one value changed, or without the key if the value is `...`."""
        *path, key, value = path_and_value
        content = copy.deepcopy(self.small)
        place = functools.reduce(lambda node, step: node[step], path, content)
        if value is ...:
            del place[key]
        else:
            place[key] = value
        return content

    def test_files_that_are_not_an_audit(self):
        self.assert_refused(self.run_main(text=""), "audit.json", "not a whole JSON file", "cut off")
        self.assert_refused(self.run_main(text=json.dumps(self.small)[:-40]), "audit.json", "cut off")
        self.assert_refused(self.run_main(text="[1, 2]"), "audit.json", "the file must be an object")
        self.assert_refused(self.run_main(text="[" * 100_000), "audit.json", "not a whole JSON file")
        self.assert_refused(self.run_main(text="\x00\xff"), "audit.json")
        self.assert_refused(self.run_main(content=self.changed("format", "rcme audit 2")), "'format'", "'rcme audit 1'")
        self.assert_refused(self.run_main(content=self.changed("claims", [])), "no claims", "nothing to draw")
        self.file.unlink()
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = audit.main([str(self.folder)])
        self.assert_refused((code, out.getvalue(), err.getvalue()), "audit.json", "cannot be read", "No such file")

    def test_every_key_that_is_drawn_is_missed_by_name_and_place(self):
        places = [((), "the file", ("format", "seed", "budget", "confidence_per_target", "claims")),
                  (("claims", 1), "claim 2", ("id", "family", "reading", "verdict", "holds_up_to_sigma_px", "figure_x",
                                              "evidence")),
                  (("claims", 1, "evidence", 2), "claim 2 ('z_test.size'), evidence 3", ("conditions", "targets")),
                  (("claims", 1, "evidence", 2, "targets", 3), "claim 2 ('z_test.size'), evidence 3, target 4",
                   ("quantity", "kind", "nominal", "low", "high", "threshold", "measured", "interval", "n", "verdict"))]
        for path, place, keys in places:
            for key in keys:
                self.assert_refused(self.run_main(content=self.changed(*path, key, ...)), "audit.json",
                                    f"{place} ", f"has no key '{key}'")

    def test_values_of_the_wrong_kind(self):
        first = ("claims", 0, "evidence", 0, "targets", 0)
        for path, value, named in [
                (("seed",), "1", "whole number"), (("confidence_per_target",), 1.2, "0..1"),
                (("claims", 0, "verdict"), "true", "'does not hold'"),
                (("claims", 0, "family"), "../up", "file's name"), (("claims", 0), 7, "claim 1 must be an object"),
                (("claims", 0, "evidence"), None, "'evidence': null; expected a list"),
                (("claims", 0, "evidence", 0, "conditions"), {"sigma_px": 1}, "an object of texts"),
                ((*first, "kind"), "slope", "'rate', 'mean'"), ((*first, "verdict"), "holds in the small-noise limit only",
                                                               "'undecided'"),
                ((*first, "measured"), "0.5", "finite number or null"), ((*first, "measured"), True, "'measured': true"),
                ((*first, "measured"), 1.5, "0..1"), ((*first, "measured"), 10 ** 400, "finite number"),
                ((*first, "interval"), [1], "[lower, upper]"), ((*first, "interval"), [0.9, 0.1], "[lower, upper]"),
                ((*first, "low"), 0.9, "'low' 0.9 above 'high' 0.05"), ((*first, "n"), 2.5, "whole number from 0"),
                ((*first, "n"), -1, "'n': -1")]:
            self.assert_refused(self.run_main(content=self.changed(*path, value)), "audit.json", named)
        self.assert_refused(self.run_main(text=json.dumps(self.changed(*first, "measured", math.nan))), "NaN", "audit.json")
        self.assert_refused(self.run_main(text=json.dumps(self.small).replace("0.02,", "1e999,")), "'measured'", "finite")

    def test_evidence_that_the_figure_cannot_tell_apart(self):
        self.assert_refused(self.run_main(content=self.changed("claims", 1, "figure_x", "parallax")), "z_test.size",
                            "'figure_x': 'parallax'", "evidence 1", "'conditions'")
        twice = self.changed("claims", 1, "evidence", 2, self.small["claims"][1]["evidence"][1])
        self.assert_refused(self.run_main(content=twice), "z_test.size", "more than once", "sigma_px")

    def test_roc_curves_without_their_two_sides(self):
        roc = [one for one in fake_audit()["claims"] if one["id"] == "mu.as_printed.roc"][0]
        half = dict(roc, evidence=roc["evidence"][:1])
        self.assert_refused(self.run_main(content=file_with(half)), "mu.as_printed.roc", "'threshold'", "good models")
        other = copy.deepcopy(roc)
        other["evidence"][0]["conditions"] = {"models": "bad"}
        self.assert_refused(self.run_main(content=file_with(other)), "'models'", "'contaminated'")

    def test_command_lines(self):
        self.assert_refused(self.run_main("--colour", "red"), "--colour", "--help")


class Page(unittest.TestCase):
    """audit.html, of claims whose every text is malicious."""

    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        claims = [dict(claim(f"inlier.{EVIL}", [evidence(coverage(0.0), sigma_px=s) for s in SIGMAS], "holds", EVIL, "sigma_px"),
                       sentence=EVIL, statistic=EVIL, label=EVIL),
                  claim("sigma_p.order", [evidence([target(EVIL, "rate", 0.7, 0.95, 0.93, 0.97, half=0.01)], scene=EVIL),
                                          dict(evidence([]), not_possible=EVIL)], "does not hold")]
        cls.content = dict(file_with(*claims), study=EVIL)
        (cls.folder / "audit.json").write_text(json.dumps(cls.content))
        with contextlib.redirect_stdout(io.StringIO()) as out:
            assert audit.main([str(cls.folder), "--page"]) == 0
        cls.written, cls.page = out.getvalue().split(), (cls.folder / "audit.html").read_text()

    def test_the_verdicts_come_first_and_every_number_is_there(self):
        structure = Structure(self.page)
        self.assertEqual((structure.open, self.page.count("<script")), ([], 1))
        self.assertIn(str(self.folder / "audit.html"), self.written)
        self.assertEqual(structure.headings, [f"Audit of the paper's claims on study {EVIL}", "Findings", "Figures and numbers",
                                              "inlier", "sigma_p"])
        text = "".join(structure.text)
        for words in ("\u2717 does not hold (1 of 2): ", "\u2713 holds (1 of 2): ", "70.0 [69.0, 71.0] %", "0.95 in [0.93, 0.97]",
                      f"not possible: {EVIL}", f"\u201c{EVIL}.\u201d"):
            self.assertIn(words, text)
        for one in self.content["claims"]:
            for row in one["evidence"]:
                for measured in row["targets"]:
                    self.assertIn(str(measured["n"]), structure.text)
        inside = [link[1:] for link in structure.attributes("href") if link.startswith("#")]
        self.assertLessEqual(set(inside), set(structure.ids))
        self.assertEqual(len(set(structure.ids)), len(structure.ids))
        self.assertTrue(all(len(picture["alt"]) > 40 for picture in structure.of("img")))

    def test_without_the_option_there_is_none(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(audit.main([str(self.folder), "--out", folder]), 0)
            self.assertFalse(pathlib.Path(folder, "audit.html").exists())

    @unittest.skipUnless(BROWSER, SKIP_REASON)
    def test_in_a_browser(self):
        with Browser() as browser:
            for width, is_dark in ((400, False), (1200, True)):
                browser.open(self.folder / "audit.html", width, is_dark)
                self.assertEqual(browser.value_of("document.documentElement.scrollWidth"), width)
                link = "document.querySelector('ul.findings a')"
                self.assertFalse(browser.value_of("document.querySelector('main section details').open"))
                browser.value_of(f"{link}.click()")
                self.assertTrue(browser.value_of(f"""new Promise(done => setTimeout(() => done(document.getElementById(decodeURIComponent(
                    {link}.hash.slice(1))).querySelector("details").open), 50))"""), "a link opens what is folded")
                self.assertEqual((browser.complaints(), browser.requests()), ([], []))


if __name__ == "__main__":
    unittest.main()
