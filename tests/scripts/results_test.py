"""What counts as the same result (scripts/results --check), where its data are, and how its words are filled."""

import os
import pathlib
import re
import sqlite3
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/reproduce"))

from audit_table import fifths_csv  # noqa: E402
from blocks import Spec, render  # noqa: E402
from digests import difference, hash_of, trials_of  # noqa: E402
from recipes import data, is_same, read_recipes, with_data  # noqa: E402
from tables import filled  # noqa: E402

OLD = 'study,estimator,quantity,value\ns,"a, b",failure,0.1\ns,c,failure,0.2\n'


class TheSame(unittest.TestCase):
    def same(self, new, name="summary.csv", old=OLD):
        with tempfile.TemporaryDirectory() as folder:
            made, committed = pathlib.Path(folder, "made"), pathlib.Path(folder, name)
            made.write_text(new)
            committed.write_text(old)
            return is_same(made, committed, None)

    def test_a_quantity_that_is_new_is_no_difference(self):
        self.assertTrue(self.same(OLD))
        self.assertTrue(self.same(OLD.replace("s,c,", "s,c,refusal,0.5\ns,c,")))

    def test_a_column_that_is_new_is_no_difference(self):
        old, new = 'a,b\n"1, x",2\n', 'a,c,b\n"1, x",7,2\n'
        self.assertTrue(self.same(new, old=old))
        self.assertFalse(self.same(new.replace(",2", ",3"), old=old))
        self.assertFalse(self.same(old, old=new))

    def test_anything_else_is(self):
        for new in (OLD.replace("0.2", "0.3"), OLD.replace("s,c,failure,0.2\n", ""), OLD + "s,d,failure,0.2\n",
                    OLD.replace("value", "rate"), OLD.replace("failure", "refusal"), "", "study\n"):
            self.assertFalse(self.same(new), new)

    def test_other_tables_are_compared_whole(self):
        self.assertFalse(self.same("a,b\n1,2\n3,4\n", old="a,b\n1,2\n"))
        self.assertFalse(self.same(OLD.replace("s,c,", "s,c,refusal,0.5\ns,c,"), name="summary.txt"))


class TheDigests(unittest.TestCase):
    """Columns that came later have parts of their own: what was stored without them stays a proof."""

    def digests(self, columns):
        """Of a file with these columns in the table trials, {name: value}."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "run.sqlite")
            database = sqlite3.connect(path)
            database.execute("CREATE TABLE estimators (estimator, label)")
            database.execute("INSERT INTO estimators VALUES (0, 'a, b')")
            database.execute("CREATE TABLE problems (condition, trial, weight, checksum)")
            database.execute("INSERT INTO problems VALUES (0, 0, 1.0, 77)")
            fields = {"condition": 0, "trial": 0, "estimator": 0, **columns}
            database.execute(f"CREATE TABLE trials ({', '.join(fields)})")
            database.execute(f"INSERT INTO trials VALUES ({', '.join('?' * len(fields))})", list(fields.values()))
            database.commit()
            database.close()
            return {f"run.sqlite: {part}": hash_of(text) for part, text in trials_of(path).items()}

    OLD = {"status": "ok", "nees": 4.5, "seconds": 0.1}
    NEW = {"status": "ok", "nees": 4.5, "log_score": 2.5, "seconds": 0.2}

    def test_a_column_of_a_later_group_leaves_the_old_hashes(self):
        old, new = self.digests(self.OLD), self.digests(self.NEW)
        self.assertEqual(len(new), len(old) + 1)
        self.assertEqual({part: new[part] for part in old}, old)
        self.assertIsNone(difference("name", old, new))

    def test_the_old_columns_are_compared_all_the_same(self):
        for change in ({"nees": 4.6}, {"status": "too_few_matches"}):
            self.assertIn("1 of 3 parts differ", difference("name", self.digests(self.OLD), self.digests(self.NEW | change)))

    def test_the_later_ones_are_once_they_are_stored(self):
        stored = self.digests(self.NEW)
        self.assertIsNone(difference("name", stored, self.digests(self.NEW)))
        self.assertIn("density", difference("name", stored, self.digests(self.NEW | {"log_score": 2.6})))
        self.assertIn("density", difference("name", stored, self.digests(self.OLD)))

    def test_a_column_without_a_group_is_a_difference(self):
        self.assertIsNotNone(difference("name", self.digests(self.OLD), self.digests(self.OLD | {"other": 1})))


class TheData(unittest.TestCase):
    def test_every_word_in_braces_is_known(self):
        for recipe in read_recipes().values():
            for text in recipe.commands + recipe.digest + recipe.needs:
                self.assertLessEqual(set(re.findall(r"{(\w+)}", text)), {"out", *data()}, text)
                self.assertNotIn("..", text, "a path outside of the repository has a name in [data]")

    def test_the_environment_says_where_they_are(self):
        before = os.environ.pop("RCME_PAIRS", None)
        self.addCleanup(lambda: os.environ.update({} if before is None else {"RCME_PAIRS": before}))
        self.assertEqual(with_data("rcme twin {PAIRS} --out {out}"), f"rcme twin {data()['PAIRS']['path']} --out {{out}}")
        os.environ["RCME_PAIRS"] = "mine"
        self.addCleanup(os.environ.pop, "RCME_PAIRS", None)
        self.assertEqual(with_data("rcme twin {PAIRS} --out {out}"), "rcme twin mine --out {out}")


class TheAudit(unittest.TestCase):
    def test_the_coverage_by_difficulty_has_a_row_a_fifth(self):
        fifth = {"bound_deg": [0.20711, 0.32849], "measured": 0.954821, "interval": [0.910449, 0.98188], "n": 930}
        evidence = [{"conditions": {"sigma_px": "0.5", "num_matches": "100"}, "fifths_of_difficulty": [fifth, fifth]}, {"conditions": {}}]
        lines = fifths_csv({"claims": [{"id": "a", "evidence": evidence}]}).splitlines()
        self.assertEqual(lines[1:], [f"a,sigma_px 0.5; num_matches 100,{n},0.207,0.328,0.9548,0.9104,0.9819,930" for n in (1, 2)])


class TheWords(unittest.TestCase):
    def test_prose_is_filled_and_rows_are_not(self):
        text = "one two\nthree\n\n- four five\n  six\n- seven\n| a | b c d e f |"
        self.assertEqual(filled(text, width=9), "one two\nthree\n\n- four\n  five\n  six\n- seven\n| a | b c d e f |")
        self.assertEqual(filled("a rate of 5 [1, 9] %", width=14), "a rate of 5\n[1, 9] %")

    def test_a_page_may_show_the_block_of_another_page(self):
        shown = render(Spec("same results/audit/README.md audit_verdict_counts"))
        self.assertEqual(shown, render(Spec("verdict_counts audit/audit")))


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
