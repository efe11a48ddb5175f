"""What the figures of plots/audit.py hold, and the tests' common ground."""

import functools
import json
import pathlib
import tempfile

from plot_test_case import PlotTestCase

import audit
from audit_figures.audit_file import read_audit
from fake_audit import SIGMAS, claim, coverage, evidence, fake_audit, target
from matplotlib.collections import LineCollection
from matplotlib.patches import Polygon


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


class Written(PlotTestCase):
    script, given = audit, ["audit.json"]

    def setUp(self):
        super().setUp()
        self.file = self.folder / "audit.json"
        self.small = file_with(claim("flag.kappa", [evidence([target("flag rate", "rate", 0.02, None, None, 0.05)])]),
                               claim("z_test.size", [evidence(coverage(0), sigma_px=s) for s in SIGMAS],
                                     figure_x="sigma_px"))

    def run_main(self, *arguments, content=None, text=None):
        """(exit code, stdout, stderr) of the script on a file with that content or text."""
        self.write(content or self.small if text is None else text)
        return self.run_script(self.folder, *arguments)
