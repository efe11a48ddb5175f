"""The examples of the contributor's paths do what CONTRIBUTING.md says, and still fit the sources. That they build and pass
their tests is seen by hand: tests/contributor/paths.py."""

import dataclasses
import sys
import unittest

from examples import CONTRIBUTING, LISTS, ROOT, Edit, disagreements, edited_text, read_examples, table_rows

PATHS = {"estimator", "minimal_solver", "scene", "noise_law", "statistic", "quantity", "claim", "command", "plot"}


class Examples(unittest.TestCase):
    def setUp(self):
        self.page = (ROOT / CONTRIBUTING).read_text(encoding="utf-8")
        self.examples = read_examples()

    def test_every_path_has_an_example(self):
        self.assertEqual(set(self.examples), PATHS)

    def test_every_example_does_what_its_row_says(self):
        for example in self.examples.values():
            with self.subTest(path=example.path):
                self.assertEqual(disagreements(example, self.page), [])

    def test_every_example_fits_the_sources(self):
        for example in self.examples.values():
            with self.subTest(path=example.path):
                self.assertTrue(example.written or example.edits)
                for file in example.written:
                    self.assertFalse((ROOT / file).exists(), file)
                for file in example.models:
                    self.assertTrue((ROOT / file).is_file(), file)
                for edit in example.edits:
                    edited_text((ROOT / edit.file).read_text(encoding="utf-8"), edit)

    def test_what_is_in_a_list_is_said_above_the_table(self):
        above = self.page[self.page.index("## How to add"):self.page.index("| to add |")]
        for words in ("scripts/reference", "ctest --preset release", *LISTS):
            self.assertIn(words, above)

    def test_a_new_command_is_three_files(self):
        command = self.examples["command"]
        self.assertLessEqual(len({*command.written, *command.edited}), 3)
        written, = command.written
        size = len((ROOT / "tests/contributor/command" / written).read_text(encoding="utf-8").splitlines())
        model, = command.models
        self.assertGreaterEqual(size, len((ROOT / model).read_text(encoding="utf-8").splitlines()))


class TheComparison(unittest.TestCase):
    """A comparison that could not fail would say nothing."""

    def setUp(self):
        self.page = (ROOT / CONTRIBUTING).read_text(encoding="utf-8")
        self.scene = read_examples()["scene"]

    def test_a_missing_row_is_seen(self):
        self.assertIn("no row", disagreements(self.scene, self.page.replace("| a scene |", "| a place |"))[0])

    def test_a_file_that_the_row_does_not_name_is_seen(self):
        for name in ("`simulator/scenes/x.cc`", "`scenes/scenes.h`", "`simulator/scene_registry.cc`"):
            self.assertEqual(self.page.count(name), 1, name)
            self.assertIn("does not name", disagreements(self.scene, self.page.replace(name, "a file"))[0], name)

    def test_a_file_that_the_example_leaves_out_is_seen(self):
        without = dataclasses.replace(self.scene, edits=self.scene.edits[1:])
        self.assertEqual(disagreements(without, self.page),
                         ["scene: the row names scenes/scenes.h, which the example does not touch"])
        header = read_examples()["estimator"]
        without = dataclasses.replace(header, written=header.written[:1])
        self.assertIn("x.{h,cc}", disagreements(without, self.page)[0])

    def test_an_edit_that_no_longer_fits_is_seen(self):
        self.assertEqual(edited_text("a b c", Edit("f", "b", "x")), "a bx c")
        for text in ("a c", "b b"):
            with self.assertRaises(ValueError):
                edited_text(text, Edit("f", "b", "x"))

    def test_rows_are_those_of_the_table(self):
        rows = table_rows(self.page)
        self.assertGreater(len(rows), 20)
        self.assertNotIn("room", rows)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
