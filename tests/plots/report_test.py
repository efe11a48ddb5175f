#!/usr/bin/python3
"""Tests of plots/report.py; run as: /usr/bin/python3 tests/plots/report_test.py"""

import csv
import io
import json
import re
import unittest
from unittest import mock

from fake_report import EVIL, ReportTest, comparison, facts, quoted, summary

import fake_reliability
from browser import BROWSER, SKIP_REASON, Browser
import report
from page_structure import Structure
from report_page import figures as report_figures
from page import html as html_of


class Page(ReportTest):
    def test_tags_are_balanced_ids_single_and_links_lead_somewhere(self):
        self.add_run()
        self.add_run(2)
        structure = Structure(self.page())
        self.assertEqual(structure.open, [])
        self.assertEqual(len(set(structure.ids)), len(structure.ids))
        inside = [link[1:] for link in structure.attributes("href") if link.startswith("#")]
        self.assertGreater(len(inside), 10)
        self.assertLessEqual(set(inside), set(structure.ids))

    def test_it_needs_nothing_from_outside(self):
        self.add_run()
        page = self.page()
        self.assertNotRegex(page, "https?://")
        structure = Structure(page)
        self.assertEqual(structure.of("script"), [{}])  # one, inline, and the only one that the policy allows
        policy = next(meta["content"] for meta in structure.of("meta") if "http-equiv" in meta)
        self.assertTrue(policy.startswith("default-src 'none'; img-src data:; style-src 'sha256-"), policy)
        for tag in ("script", "style"):
            inside = re.search(f"<{tag}>(.*?)</{tag}>", page, re.DOTALL).group(1)
            self.assertIn(f"{tag}-src {html_of.hash_of(inside)}", policy)
        self.assertNotIn("unsafe", policy)
        self.assertNotIn("link", [tag for tag, _ in structure.elements])
        for address in structure.attributes("src") + structure.attributes("srcset") + structure.attributes("href"):
            self.assertTrue(address.startswith(("data:", "#")), address)
        self.assertNotIn("url(", report.CSS)

    def test_the_worst_regimes_of_a_population_come_first(self):
        self.add_run()
        self.assertNotIn("Where it is not what it claims", self.page())
        (self.data / "run_0001" / "marginals.csv").write_text(
            "estimator,regime,quantity,value,lower,upper,claimed,sd_over_crb,excess,num_conditions,n\n"
            "mine,noise = laplace,coverage,0.4,0.31,0.52,0.95,1.4321,3.2,17,93\n"
            "standard,all,failure,0.2,0.1,0.3,,,0,40,400\n"
            "standard,noise = laplace,failure,0.2,0.1,0.3,,,0,17,93\n")
        page = self.page()
        section = page[page.index("Where it is not what it claims</h3>"):page.index("Findings</h3>")]
        self.assertIn("40.00 %", section)
        self.assertIn("[31.00, 52.00]", section)
        self.assertIn("sd 1.43 times the bound", section)
        self.assertIn("17 (93)", section)
        self.assertNotIn("[10.00, 30.00]", section)  # nothing is claimed of failures
        self.assertIn("The 1 of 1 regimes", section)

    def test_every_number_of_the_summary_is_there(self):
        self.add_run()
        page = Structure(self.page())
        cells = "\n".join(page.text)
        for row in csv.DictReader(io.StringIO(summary())):
            for column in ("value", "lower", "upper", "standard_error", "n"):
                self.assertIn(row[column], page.text if row[column] else [""], row)
            if row["quantity"] == "failure":
                self.assertIn(f"{100 * float(row['value']):.2f} %", cells)
                self.assertIn(f"[{100 * float(row['lower']):.2f}, {100 * float(row['upper']):.2f}]", cells)

    def test_comparisons_show_interval_and_both_p_values(self):
        self.add_run()
        text = Structure(self.page()).text
        for part in ("-10.00", "[-40.00, +20.00]", "0.0045", "0.0123 *", "0.0789"):
            self.assertIn(part, text)
        self.assertIn("<strong>0.0123 *</strong>", self.page())
        self.assertNotIn("<strong>0.0789", self.page())

    def test_coverage_auc_and_probability_have_a_figure_where_they_have_numbers(self):
        more = "".join(f"demo,{condition},{level},mine,nees_coverage,rate,0.8,0.7,0.9,,{n}\n"
                       for condition, (level, n) in enumerate((("gaussian", 10), ("laplace", 0))))
        self.add_run(summary_csv=summary() + more.replace("0.8,0.7,0.9,,0", ",0,1,,0"))
        page = self.page()
        self.assertIn("NEES coverage against noise.", page)
        self.assertNotIn("AUC@10", page)
        self.assertIn("--quantities nees_coverage", page)

    def test_coverage_is_drawn_with_its_sharpness_and_areas_are_in_the_table(self):
        more = "".join(f"demo,{condition},{level},mine,{row}\n" for condition, level in enumerate(("gaussian", "laplace"))
                       for row in ("nees_coverage,rate,0.8,0.7,0.9,,10", "sd_over_crb,median,1.5,1.2,1.9,,10",
                                   "rotation_ause,area,0.1234,0.0456,0.2012,0.03,10"))
        self.add_run(summary_csv=summary() + more)
        page = self.page()
        self.assertIn("--quantities nees_coverage,sd_over_crb", page)
        text = "".join(Structure(page).text)
        self.assertIn("0.123[0.0456, 0.201]", text)

    def test_prose_is_as_wide_as_a_small_screen_and_paper_is_upright(self):
        self.assertRegex(report.CSS, r"\ncaption \{[^}]*max-width: min\(60rem, calc\(100vw")
        self.assertIn("A4 portrait", report.CSS)

    def test_commands_can_be_pasted(self):
        self.add_run()
        text = "".join(Structure(self.page()).text)
        for command in ("rcme replay 'runs/a b.sqlite' --condition 1 --trial T",
                        "rcme run demo.yaml --trials 10 --out demo.sqlite",
                        "rcme replay 'runs/a b.sqlite' --condition 1 --trial 0",
                        "rcme summarize 'runs/a b.sqlite' --format csv",
                        "rcme compare 'runs/a b.sqlite' --against standard --format csv",
                        "--against standard --format csv --out comparison.csv && rcme plot paired_difference"):
            self.assertIn(command, text)
        self.assertIn("3first failuremine", text)  # in the first column

    def again(self, numbers, until="", interval="exact"):
        """(the command that runs the study again, whether it gives fewer trials, whether other intervals); `numbers`:
        trials done, end and planned of each condition."""
        keys = ("trials_done", "trials_end", "trials_planned")
        conditions = [condition | dict(zip(keys, of)) for condition, of in zip(facts()["conditions"], numbers)]
        header, *rows = summary().splitlines()
        self.add_run(run_json=facts(conditions=conditions, until=until),
                     summary_csv="\n".join([f"{header},interval", *(f"{row},{interval}" for row in rows)]))
        text = "".join(Structure(self.page()).text)
        return (re.search("rcme run demo.yaml (.*) --out", text).group(1), "But this page has fewer trials" in text,
                "those of the commands are exact" in text)

    def test_the_recipe_gives_the_trials_of_the_page_or_says_that_it_does_not(self):
        exactly = [((60, 60, 60), (60, 60, 60)), ((60, 60, 100), (60, 60, 100)),
                   ((60, 60, 60), (40, 40, 40))]  # the last: a folder has no more pairs
        for numbers in exactly:
            self.assertEqual(self.again(numbers), ("--trials 60", False, False))
        for numbers in (((60, 60, 60), (40, 40, 60)), ((59, 60, 60), (60, 60, 60))):  # cut off; with a gap
            self.assertEqual(self.again(numbers), ("--trials 60", True, False))
        stopped = ((100, 100, 100), (225, 225, 225))
        self.assertEqual(self.again(stopped, "--until ci=0.1", "anytime_valid"), ("--until ci=0.1", False, False))
        self.assertEqual(self.again(stopped, "", "anytime_valid"), ("--trials 225", True, True))
        self.assertEqual(self.again(((9, 9, 9), (9, 9, 9)), "", "anytime_valid"), ("--trials 9", False, True))

    def test_infinite_means_are_shown_and_other_infinite_numbers_refused(self):
        scene = "demo,0,gaussian,scene,crb_rotation_deg,mean,inf,,,,10\n"
        self.add_run(summary_csv=summary() + scene)
        self.assertGreater(Structure(self.page()).text.count("inf"), 1)
        self.out.unlink()
        for old, new in (("mean,inf,,,,10", "mean,inf,,,,inf"), ("mean,inf,,,", "mean,1,,,inf"), ("mean,", "rate,"),
                         ("inf", "nan"), ("inf", "")):
            self.add_run(summary_csv=summary() + scene.replace(old, new))
            self.assert_refused(self.run_main(), "summary.csv: line 18: column")

    def test_tables_have_captions_and_scopes_and_pictures_words(self):
        self.add_run()
        structure = Structure(self.page())
        self.assertEqual(len(structure.of("table")), len(structure.of("caption")))
        self.assertTrue(all(header.get("scope") in ("col", "row", "rowgroup") for header in structure.of("th")))
        self.assertEqual(len(structure.of("img")), 2)
        self.assertTrue(all(len(picture["alt"]) > 40 for picture in structure.of("img")))
        self.assertEqual(structure.of("html")[0]["lang"], "en")

    def test_names_out_of_files_are_only_text(self):
        names = dict(name=EVIL, description=EVIL, run=EVIL, study_yaml=f"name: {EVIL}\x00\x1b", reference=EVIL,
                     factors=[EVIL], estimators=[EVIL, "mine"], ademp=[[EVIL, EVIL]])
        self.add_run(run_json=facts(**names),
                     summary_csv=summary(EVIL, ((EVIL,), ("b",)), (EVIL, "mine"), (quoted(EVIL),)),
                     comparison_csv=comparison(EVIL, ((EVIL,), ("b",)), factors=(quoted(EVIL),)))
        page = self.page()
        self.assertEqual(page.count("<script"), 1)
        self.assertNotIn("\x00", page)
        structure = Structure(page)
        self.assertEqual(structure.open, [])
        self.assertIn(f"Run 1: {EVIL}", structure.headings)
        self.assertEqual({key for _, attributes in structure.elements for key in attributes if key.startswith("on")}, set())

    def test_two_runs_of_one_study_both_show(self):
        self.add_run()
        self.add_run(2, run_json=facts(run="other.sqlite"))
        structure = Structure(self.page())
        self.assertIn("Run 1: demo", structure.headings)
        self.assertIn("Run 2: demo", structure.headings)
        self.assertIn("other.sqlite", structure.text)

    def test_the_same_input_gives_the_same_bytes(self):
        self.add_run()
        first = self.page()
        with mock.patch("time.time", return_value=2e9):
            self.assertEqual(self.page(), first)

    def test_ademp_and_severity_are_shown_where_there_are_any(self):
        self.add_run()
        self.assertNotIn("Severity of the problems", self.page())
        scene = 'demo,0,gaussian,scene,parallax_deg,mean,4.321,,,0.0567,10\n'
        self.add_run(run_json=facts(ademp=[["aims", "to see what noise does"]]), summary_csv=summary() + scene)
        structure = Structure(self.page())
        self.assertIn("Severity of the problems", structure.headings)
        self.assertLessEqual({"aims", "to see what noise does", "4.32", "\u00b1 0.057"}, set(structure.text))
        self.add_run(run_json=facts(estimators=["standard", "mine", "scene"], conditions=[
            {**condition, "first": [{"failure": None, "refusal": None}] * 3} for condition in facts()["conditions"]]),
            summary_csv=summary() + scene)
        self.assertNotIn("Severity of the problems", self.page())  # an estimator may be called so

    def test_what_was_decided_before_comes_first(self):
        hypothesis = {"hypothesis": "failure of rcme is at most 0.1", "value": 0.05, "interval": [0.01, 0.09], "n": 1200,
                      "verdict": "holds", "why_open": ""}
        unfinished = hypothesis | {"hypothesis": f"another {EVIL}", "n": 0, "value": None, "interval": [0, 1], "verdict": "open",
                                   "why_open": "5 of 10 trials are done"}
        of_coverage = hypothesis | {"hypothesis": "nees_coverage of rcme is at least 0.9", "estimator": "rcme", "against": "",
                                    "sharpness": {"sd_over_crb": 1.3, "rotation_sd_deg": 0.2, "direction_sd_deg": 1.1}}
        decided = {"locked": True, "locked_at": "2026-01-31T12:00:00Z", "program": "rcme 0.1.0", "sha256": "ab12" * 16,
                   "confidence": 0.95, "confidence_each": 0.975, "deviations": ["estimator mine: was added"],
                   "reasons": ["a reader asked"], "hypotheses": [hypothesis, unfinished, of_coverage]}
        self.add_run(run_json=facts(preregistration=decided))
        page = self.page()
        text = "".join(Structure(page).text)
        for part in ("Decided before the run", "ab12" * 16, "failure of rcme is at most 0.1", "5.00 %[1.00, 9.00]", "1,200", "holds",
                     "rcme: stated sd 1.3 times the least possible", "5 of 10 trials are done", "each with 97.50 %",
                     "estimator mine: was added", "Reason: a reader asked",
                     "Decided after"):
            self.assertIn(part, text)
        self.assertNotIn(EVIL, page)
        self.assertLess(page.index('id="run-1-decided"'), page.index('id="run-1-findings"'))
        without = mock.Mock(facts={"preregistration": decided | {"locked": False, "deviations": [], "reasons": []}})
        self.assertIn("has no lock", report.decided_section(without))

    def test_probabilities_of_failure_have_a_table_and_a_figure(self):
        self.add_run()
        self.assertNotIn("Probability of failure", self.page())
        (self.data / "run_0001" / "reliability.json").write_text(json.dumps(
            fake_reliability.content(fake_reliability.entry(), fake_reliability.entry("mine", source="inlier_share"))))
        page = self.page()
        for words in ("Probability of failure", "RCME, calibrated", "inlier share", "0.0310", "[0.0200, 0.0500]", "1.25 %",
                      "75.00 %", "if right: 0.0130", "rcme plot reliability", "rcme reliability"):
            self.assertIn(words, page)

    def test_one_estimator_has_no_comparison(self):
        self.add_run(run_json=facts(estimators=["standard"]), summary_csv=summary(estimators=["standard"]),
                     comparison_csv="")
        structure = Structure(self.page())
        self.assertIn("The study has one estimator: there is nothing to compare.", structure.text)
        self.assertEqual(len(structure.of("img")), 1)


class Figures(ReportTest):
    def drawn(self, factors, levels):
        """The captions of the figures, and the notes, of a run with these factors."""
        conditions = [{"index": index, "levels": list(level), "trials_done": 10, "trials_end": 10,
                       "trials_planned": 10, "first": [{"failure": 0, "refusal": 0}] * 2}
                      for index, level in enumerate(levels)]
        self.add_run(run_json=facts(factors=list(factors), conditions=conditions),
                     summary_csv=summary(levels=levels, factors=factors),
                     comparison_csv=comparison(levels=levels, factors=factors))
        structure = Structure(self.page())
        return [picture["alt"] for picture in structure.of("img")], "".join(structure.text)

    def test_of_one_condition_each_estimator_has_a_mark(self):
        alts, text = self.drawn([], [()])
        self.assertEqual(len(alts), 1)
        self.assertIn("A mark per estimator with its 95 % interval", alts[0])
        self.assertIn("rcme plot failure_rate summary.csv --quantities failure,no_candidate", text)

    def test_two_factors_give_a_heat_map(self):
        alts, text = self.drawn(["noise", "sigma_px"], [(a, b) for a in ("gaussian", "laplace") for b in ("1", "2", "3")])
        self.assertRegex(alts[0], "over noise and sigma .px.*heat map")
        self.assertRegex(alts[1], "Difference to Standard on the same trials, against sigma")
        self.assertIn("rcme plot heat_map summary.csv --x noise --y sigma_px", text)

    def test_one_factor_at_a_time_gives_a_line_figure_for_each(self):
        levels = [("0", "1"), ("0.2", "1"), ("0.4", "1"), ("0", "2"), ("0", "3")]
        alts, text = self.drawn(["outlier_ratio", "sigma_px"], levels)
        self.assertEqual([alt.split(".")[0] for alt in alts], [
            "Failure rate and no-candidate rate against outlier ratio",
            "Failure rate and no-candidate rate against sigma (px)",
            "Difference to Standard on the same trials, against outlier ratio",
            "Difference to Standard on the same trials, against sigma (px)"])
        self.assertNotIn("Not drawn", text)

    def test_three_factors_give_a_heat_map_for_each_level_of_the_third_up_to_a_limit(self):
        levels = [(a, b, c) for a in "01" for b in "01" for c in ("u", "v")]
        alts, text = self.drawn(["a", "b", "c"], levels)
        self.assertEqual([alt for alt in alts if "heat map" in alt.lower()], alts[:2])
        self.assertIn("c = u", alts[0])
        self.assertIn("--where c=v", text)
        with mock.patch.object(report_figures, "MAX_SLICES", 1):
            alts, text = self.drawn(["a", "b", "c"], levels)
        self.assertIn("Drawn are 1 of 2 combinations of c", text)

    def test_what_cannot_be_drawn_says_why(self):
        levels = [(a, b, c) for a in "0123" for b in "012" for c in "012"]
        _, text = self.drawn(["a", "b", "c"], levels)
        self.assertIn("Not drawn: comparison.csv: 9 combinations of b, c", text)


class Refusals(ReportTest):
    def test_folders_that_are_no_report(self):
        self.assert_refused(self.run_main(), "holds no folder run_0001")
        self.data.rmdir()
        self.assertEqual(self.run_main()[0], 2)

    def test_files_that_are_missing_or_damaged(self):
        self.add_run()
        for name, text, message in (("run.json", "{", "not a whole JSON file"), ("run.json", "{}", "has no key 'format'"),
                                    ("summary.csv", "a,b\n", "has no column study"),
                                    ("summary.csv", summary().replace(",10\n", ",\n", 1), "column n must be a number"),
                                    ("comparison.csv", comparison().replace("-0.1,", ",", 1), "risk_difference is empty")):
            path = self.data / "run_0001" / name
            whole = path.read_text()
            path.write_text(text)
            self.assert_refused(self.run_main(), name, message)
            path.write_text(whole)
        (self.data / "run_0001" / "summary.csv").unlink()
        self.assert_refused(self.run_main(), "summary.csv", "cannot be read")

    def test_a_failed_write_leaves_the_old_page(self):
        self.add_run()
        self.out.write_text("old")
        with mock.patch("os.replace", side_effect=OSError(28, "No space left on device")):
            code, _, err = self.run_main()
        self.assertEqual(code, 2)
        self.assertIn("No space left on device", err)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["data", "report.html"])
        self.assertEqual(self.out.read_text(), "old")

    def test_places_that_cannot_be_written(self):
        self.add_run()
        self.out = self.folder / "no" / "report.html"
        self.assert_refused(self.run_main(), "there is no folder")


@unittest.skipUnless(BROWSER, SKIP_REASON)
class InABrowser(ReportTest):
    """The page with a malicious name everywhere, and with severity and enough rows to sort."""

    def test_both_widths_light_and_dark_sorting_and_silence(self):
        scene = "".join(f"{quoted(EVIL)},{condition},{quoted(level)},scene,{quantity},mean,{value},,,0.05,10\n"
                        for condition, level in enumerate(("gaussian", "laplace"))
                        for quantity, value in (("parallax_median_deg", 4.3 - condition), ("crb_direction_deg", 0.5 + condition)))
        self.add_run(run_json=facts(name=EVIL, findings=[EVIL, "Failure rate of mine: 2 % [1, 3] throughout."],
                                    ademp=[[EVIL, EVIL]], description=EVIL), summary_csv=summary(EVIL) + scene,
                     comparison_csv=comparison(EVIL))
        self.page()
        with Browser() as browser:
            for width in (400, 1200):
                for is_dark in (False, True):
                    with self.subTest(width=width, is_dark=is_dark):
                        browser.open(self.out, width, is_dark)
                        self.check_page(browser, width, is_dark)
            self.check_sorting(browser)
            self.check_folding(browser)
            self.assertEqual((browser.complaints(), browser.requests()), ([], []))

    def check_page(self, browser, width, is_dark):
        self.assertEqual(browser.value_of("document.documentElement.scrollWidth"), width, "the page scrolls sideways")
        self.assertEqual((browser.complaints(), browser.requests()), ([], []))
        self.assertIn(f"Run 1: {EVIL}", browser.value_of("[...document.querySelectorAll('h2')].map(h => h.textContent)"))
        paper = browser.value_of("getComputedStyle(document.body).backgroundColor")
        self.assertEqual(sum(map(int, re.findall(r"\d+", paper))) < 150, is_dark, paper)
        order = browser.value_of("""[...document.querySelectorAll("h1, h2, h3, h4")].map(h => Number(h.tagName[1]))""")
        self.assertEqual(order[0], 1)
        self.assertLessEqual(max(b - a for a, b in zip(order, order[1:])), 1)
        self.assertEqual(browser.value_of("""[...document.querySelectorAll("h3")].slice(0, 3).map(h => h.textContent)"""),
                         ["Findings", "Figures", "Severity of the problems"])
        beside = browser.value_of("""(() => { const [a, b] = document.querySelector(".beside").children;
            return b.getBoundingClientRect().left >= a.getBoundingClientRect().right; })()""")
        self.assertEqual(beside, width == 1200)
        shown = browser.value_of("[...document.images].map(i => [i.naturalWidth, i.getBoundingClientRect().width])")
        self.assertTrue(all(natural > 0 and 250 < drawn <= width for natural, drawn in shown), shown)
        picture = self.folder / f"{width}_{is_dark}.png"
        browser.picture(picture)
        self.assertGreater(picture.stat().st_size, 20000)

    def check_sorting(self, browser):
        """With the keyboard alone: two presses of a heading turn the rows of each condition round."""
        rows = """[...document.querySelectorAll("table.results tbody")].map(
            body => [...body.rows].slice(1).map(row => row.cells[2].textContent.split(" ")[0]))"""
        before = browser.value_of(rows)
        browser.value_of("""document.querySelector("table.results thead th:nth-child(3) button").focus()""")
        found = []
        for _ in range(2):
            browser.press("Enter", 13)
            found.append((browser.value_of("document.activeElement.parentElement.getAttribute('aria-sort')"), browser.value_of(rows)))
        self.assertEqual([order for order, _ in found], ["ascending", "descending"])
        for of_condition, rising, falling in zip(before, found[0][1], found[1][1]):
            self.assertEqual(rising, sorted(of_condition, key=float))
            self.assertEqual(falling, sorted(of_condition, key=float, reverse=True))
        headings = browser.value_of("""[...document.querySelectorAll("table.results tbody")].map(b => b.rows[0].cells.length)""")
        self.assertEqual(set(headings), {1}, "a condition's heading stays above its rows")

    def check_folding(self, browser):
        counts = browser.value_of("[document.querySelectorAll('details').length, document.querySelectorAll('details[open]').length]")
        self.assertGreater(counts[0], 5)
        self.assertLess(counts[1], counts[0])
        unfolded = """(() => { const folded = document.querySelector('details:not([open])'); folded.querySelector('summary').click();
            return folded.open; })()"""
        self.assertTrue(browser.value_of(unfolded))


if __name__ == "__main__":
    unittest.main()
