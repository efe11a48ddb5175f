"""What the figures of plots/tune.py hold, and the tests' common ground."""

import contextlib
import io
import json
import pathlib
import tempfile
import unittest
import warnings

import fake_tune as fake
import tune as script
from matplotlib.colors import to_rgb
from tuning_figures.tune_file import read_tune

GRID = [fake.option("mu", ("0", "1", "2"), "nats"), fake.option("lambda", ("2", "0.5"))]  # levels in any order
FURTHER = [*GRID, fake.option("rank_aware", ("no", "yes"))]
MANY = [*GRID, fake.option("batch", tuple("abcdefg"))]  # more panels than fit
warnings.simplefilter("error")  # a layout that was given up is a fault


def points_of(axes, label):
    """The places of all lines with that label, in their order."""
    return [tuple(map(float, point)) for line in axes.lines if line.get_label() == label for point in line.get_xydata()]


def bars_of(axes, color):
    """The ends of the bars of that colour."""
    return {tuple(tuple(round(float(value), 9) for value in end) for end in segment)
            for bars in axes.collections if hasattr(bars, "get_segments") for segment in bars.get_segments()
            if len(segment) == 2 and tuple(bars.get_color()[0][:3]) == to_rgb(color)}


def legend_of(figure):
    legends = figure.legends + [axes.get_legend() for axes in figure.axes if axes.get_legend()]
    return [text.get_text().replace("\n", " ") for legend in legends for text in legend.get_texts()]


def caption_of(figure):
    return figure.texts[0].get_text().replace("\n", " ")


def panels_of(figure):
    return [axes for axes in figure.axes if axes.get_title("left")]


class TuneTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def write(self, value):
        path = self.folder / "tune.json"
        path.write_text(value if isinstance(value, str) else json.dumps(value))
        return str(path)

    def read(self, value):
        return read_tune(self.write(value))

    def run_main(self, value, *arguments, out="figure"):
        stdout, stderr = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(stdout), contextlib.redirect_stderr(stderr):
            code = script.main([self.write(value), "--out", str(self.folder / out), *arguments])
        return code, stdout.getvalue(), stderr.getvalue()

    def assert_refused(self, result, *named):
        code, out, err = result
        self.assertEqual((code, out), (2, ""))
        self.assertEqual(err.count("\n"), 1, err)
        for name in named:
            self.assertIn(name, err)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["tune.json"])
