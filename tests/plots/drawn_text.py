"""Every text that a figure really draws, with its size and its place on the paper: for tests of legibility."""

import math
from unittest import mock

import numpy
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg

DOTS_PER_INCH = 200


def drawn_texts(figure):
    """[(text, points, corners)]; corners: 4 x 2, inches from the upper left corner of the figure."""
    found = []

    def record(renderer, gc, x, y, s, prop, angle, ismath=False, mtext=None):
        width, height, descent = renderer.get_text_width_height_descent(s, prop, ismath)
        along = numpy.array([math.cos(math.radians(angle)), -math.sin(math.radians(angle))])
        up = numpy.array([-math.sin(math.radians(angle)), -math.cos(math.radians(angle))])
        base = numpy.array([x, y]) - descent * up
        corners = numpy.array([base, base + width * along, base + width * along + height * up, base + height * up])
        if s.strip() and gc.get_alpha() != 0:
            found.append((s, prop.get_size_in_points(), corners / DOTS_PER_INCH))

    figure.set_dpi(DOTS_PER_INCH)
    with mock.patch.object(RendererAgg, "draw_text", record):
        FigureCanvasAgg(figure).draw()  # once for the layout, which draws nothing of its own
    return found


def do_overlap(a, b, tolerance=0.005):
    """Whether two rectangles share more than a hair: along no side of either are they apart."""
    for corners in (a, b):
        for side in (corners[1] - corners[0], corners[3] - corners[0]):
            length = numpy.linalg.norm(side)
            if length == 0:
                return False
            on_a, on_b = (places @ (side / length) for places in (a, b))
            if min(on_a.max(), on_b.max()) - max(on_a.min(), on_b.min()) <= tolerance:
                return False
    return True


def problems_of(figure, least, most):
    """What is wrong with the texts of a figure, in words."""
    texts, (width, height) = drawn_texts(figure), figure.get_size_inches()
    problems = [f"{text!r} has {points:g} pt" for text, points, _ in texts if not least <= points <= most]
    problems += [f"{text!r} leaves the figure: {corners.min(axis=0)}..{corners.max(axis=0)} of {width:g} x {height:g}"
                 for text, _, corners in texts
                 if corners.min() < -0.005 or (corners.max(axis=0) > numpy.array([width, height]) + 0.005).any()]
    problems += [f"{texts[i][0]!r} overlaps {texts[j][0]!r}" for i, j in near_pairs([corners for *_, corners in texts])
                 if do_overlap(texts[i][2], texts[j][2])]
    return problems


def near_pairs(places):
    """[(i, j)] of those whose upright boxes share a place: the others need no closer look."""
    if not places:
        return []
    low, high = (numpy.array([function(corners, axis=0) for corners in places]) for function in (numpy.min, numpy.max))
    meet = ((low[:, None] < high[None]) & (low[None] < high[:, None])).all(axis=2)
    return [(i, j) for i, j in zip(*numpy.nonzero(meet)) if i < j]
