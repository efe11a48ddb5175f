"""Lines and bands of several estimators that lie on each other: many rates are exactly zero."""

import collections
import math

LONG = 2.2  # of one dash, in line widths


def steps_of(points, columns):
    """From each point to the next, but for those that lack a value: ((x, ...), (x, ...))."""
    rows = list(points[["x", *columns]].itertuples(index=False, name=None))
    return [step for step in zip(rows, rows[1:]) if not any(math.isnan(value) for row in step for value in row)]


def groups_of(points, looks, columns):
    """{step: estimators that have it}, of the steps that two or more have; the grey ones, which lie below, on their own."""
    having = collections.defaultdict(list)
    for name, look in looks.items():
        for step in steps_of(points[points.estimator == name], columns):
            having[look.is_rest, step].append(name)
    return {step: names for (_, step), names in having.items() if len(names) > 1}


def joined(steps):
    """The columns of a path through these steps, with a gap where one does not begin at the end of the last."""
    path = []
    for begin, end in steps:
        if not path or path[-1] != begin:
            path += [(math.nan,) * len(begin)] * bool(path) + [begin]
        path.append(end)
    return list(zip(*path))


def turns_of(points, groups):
    """{(x, estimator)} of the marks that are drawn where lines coincide (one a point, of each estimator about as often), and
    of all that were there."""
    at = collections.defaultdict(dict)  # dicts keep the order
    for step, names in groups.items():
        for point in step:
            at[point].update(dict.fromkeys(names))
    drawn, turns = collections.Counter(), set()
    for (x, _), names in sorted(at.items(), key=lambda entry: entry[0]):
        name = min(names, key=lambda each: drawn[each])
        drawn[name] += 1
        turns.add((x, name))
    return turns, {(x, name) for (x, _), names in at.items() for name in names}


def draw_in_turns(axes, groups, looks):
    """Dashes of the estimators of each group, one after the other."""
    of_names = collections.defaultdict(list)
    for step, names in groups.items():
        of_names[tuple(names)].append(step)
    for names, steps in of_names.items():
        x, y = joined(sorted(steps))
        for turn, name in enumerate(names):
            look, count = looks[name], len(names)
            dashes = ((count - turn) % count * LONG, (LONG, (count - 1) * LONG))
            line, = axes.plot(x, y, color=look.color, linewidth=look.line_width, linestyle=dashes, dash_capstyle="butt",
                              clip_on=False, label="_shared", zorder=look.zorder)
            line.set_in_layout(False)
