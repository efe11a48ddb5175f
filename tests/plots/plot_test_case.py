"""The common ground of this room's tests. Import it first: it makes plots/ importable.

    class HeatMapTest(PlotTestCase):
        script, given = heat_map, ["summary.csv"]

        def test_a_foreign_file_is_refused(self):
            self.assert_refused(self.run_script(self.write("a,b"), "--out", self.folder / "map"), "summary.csv")
"""

import contextlib
import gc
import io
import json
import pathlib
import sys
import tempfile
import unittest
import warnings

PLOTS = pathlib.Path(__file__).resolve().parents[2] / "plots"
sys.path.insert(0, str(PLOTS))
gc.set_threshold(100_000, 50, 1000)  # as plots/common/command_line.py, for what the tests draw themselves
warnings.simplefilter("error")  # a layout that was given up is a fault


class PlotTestCase(unittest.TestCase):
    script = None  # the module whose command line is tested
    given = []  # the names of the files that a test writes for it

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def write(self, content, name=None):
        """Writes a text, or a value as JSON, to the first of the given files or to that of this name; returns the path."""
        path = self.folder / (name or self.given[0])
        path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
        return str(path)

    def run_script(self, *arguments):
        """(exit code, standard output, standard error)."""
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
            code = self.script.main(list(map(str, arguments)))
        return code, out.getvalue(), err.getvalue()

    def assert_refused(self, result, *named):
        """What run_script returned is one line that names these, and nothing was written."""
        code, out, err = result
        self.assertEqual((code, out), (2, ""), err)
        self.assertEqual(err.count("\n"), 1, err)
        for name in named:
            self.assertIn(name, err)
        self.assertLessEqual({path.name for path in self.folder.iterdir()}, set(self.given))

    def assert_help_shows(self, *examples):
        with contextlib.redirect_stdout(io.StringIO()) as out, self.assertRaises(SystemExit) as end:
            self.script.main(["--help"])
        self.assertEqual(end.exception.code, 0)
        for example in examples:
            self.assertIn(example, out.getvalue())
