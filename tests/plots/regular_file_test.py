"""What the figures read: regular files up to a size, and no whole content that can be taken apart."""

import os
import unittest

from plot_test_case import PlotTestCase

from common.plot_error import PlotError
from common.json_file import read_object
from common.regular_file import read_bytes
from common.style_file import read_style
from common.summary_csv import read_summary
from report_page.tables import median_cell
from surface.surface_data import FORMAT, read_surface_data


class RegularFile(PlotTestCase):
    def assert_raises(self, words, read, *arguments):
        with self.assertRaisesRegex(PlotError, words):
            read(*arguments)

    def test_pipes_devices_and_folders_are_refused_at_once(self):
        pipe = str(self.folder / "pipe")
        os.mkfifo(pipe)
        for read in (read_bytes, read_summary, read_style, read_surface_data, lambda path: read_object(path, "x", "y")):
            self.assert_raises("is a pipe", read, pipe)
            self.assert_raises("is a device", read, "/dev/zero")
            self.assert_raises("irectory", read, str(self.folder))
            self.assert_raises("No such file", read, str(self.folder / "none"))

    def test_a_file_may_be_as_large_as_allowed(self):
        path = self.folder / "file"
        path.write_bytes(b"x" * (1 << 20))
        self.assertEqual(len(read_bytes(path, 1 << 20)), 1 << 20)
        path.write_bytes(b"x" * ((1 << 20) + 1))
        self.assert_raises("larger than 1 MiB", read_bytes, path, 1 << 20)

    def test_deep_nesting_is_an_error_of_the_file(self):
        path = self.folder / "deep"
        path.write_text("a=" + "[" * 5000 + "]" * 5000)
        self.assert_raises("is no TOML", read_style, str(path))
        path.write_text("[" * 100_000 + "]" * 100_000)
        self.assert_raises("cannot be read", read_surface_data, str(path))

    def test_a_surface_without_its_parts_is_an_error_of_the_file(self):
        path = self.folder / "surface.json"
        path.write_text('{"format": "%s", "factors": 3}' % FORMAT)
        self.assert_raises("not a whole file of `rcme surface`", read_surface_data, str(path))


class MedianCell(unittest.TestCase):
    def test_an_interval_without_an_upper_end_is_shown(self):
        row = {"value": "80.661", "lower": "49.2966", "upper": ""}
        self.assertIn("[49.3, \u221e]", str(median_cell(row)))
        self.assertNotIn("[", str(median_cell(row | {"lower": ""})))


if __name__ == "__main__":
    unittest.main()
