"""What the figures of plots/tune.py hold, and the tests' common ground."""

from plot_test_case import PlotTestCase

import fake_tune as fake
import tune as script
from matplotlib.colors import to_rgb
from tuning_figures.tune_file import read_tune

GRID = [fake.option("mu", ("0", "1", "2"), "nats"), fake.option("lambda", ("2", "0.5"))]  # levels in any order
FURTHER = [*GRID, fake.option("rank_aware", ("no", "yes"))]
MANY = [*GRID, fake.option("batch", tuple("abcdefg"))]  # more panels than fit


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


class TuneTest(PlotTestCase):
    script, given = script, ["tune.json"]

    def read(self, value):
        return read_tune(self.write(value))

    def run_main(self, value, *arguments, out="figure"):
        return self.run_script(self.write(value), "--out", self.folder / out, *arguments)
