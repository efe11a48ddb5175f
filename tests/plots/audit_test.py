#!/usr/bin/python3
"""Tests of plots/audit.py: files, words, refusals and the page; run as: /usr/bin/python3 tests/plots/audit_test.py"""

import contextlib
import copy
import functools
import io
import itertools
import json
import math
import pathlib
import subprocess
import tempfile
import unittest
from unittest import mock

from plot_test_case import PLOTS

import audit
from browser import BROWSER, SKIP_REASON, Browser
from fake_report import EVIL
from page_structure import Structure
from audit_figures.audit_file import CLAIM_VERDICTS, TARGET_VERDICTS
from audit_figures.look import LOOKS
from fake_audit import SIGMAS, claim, coverage, evidence, fake_audit, target
from common import style
from audit_drawn import Written, caption_of, fake_figure, file_with, shown_texts, texts_of


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
        def disk_full(figure, kind, path, dpi):
            pathlib.Path(path).write_bytes(b"half")
            raise OSError(28, "No space left on device")
        with mock.patch.object(style, "written_as", disk_full):
            self.assert_refused(self.run_main(), "cannot write", "No space left on device")

    def test_help_teaches_with_an_example(self):
        self.assert_help_shows("rcme audit --out audit\n  rcme plot audit audit")


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
        self.assert_refused(self.run_script(self.folder), "audit.json", "cannot be read", "No such file")

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
                (("claims", 0, "verdict"), "true", "'does not hold'"), (("claims", 0, "side"), "left", "'too narrow', 'too wide'"),
                ((*first, "side"), "left", "'too narrow', 'too wide'"),
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
                  dict(claim("sigma_p.order", [
                      evidence([target(EVIL, "rate", 0.7, 0.95, 0.93, 0.97, half=0.01, side="too narrow")], scene=EVIL),
                      dict(evidence([]), not_possible=EVIL)], "does not hold"), side="too narrow and too wide")]
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
                      f"not possible: {EVIL}", f"\u201c{EVIL}.\u201d", "\u2717 does not hold: too narrow and too wide"):
            self.assertIn(words, text)
        self.assertIn("\u2717 does not hold: too narrow", structure.text)
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
