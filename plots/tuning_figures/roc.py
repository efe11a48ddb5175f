"""How well the score that `rcme tune` thresholds tells good models from bad ones: a ROC curve per estimator and kind of
model, with the thresholds that the file names as numbered points."""

import math

from common import style
from rates.rate_bands import per_cent
from tuning_figures.marks import add_legend_and_caption, figure_with_legend_beside, handle, plot_points, study_in_words
from tuning_figures.tune_file import SAMPLES, WINNERS

DASHES = {SAMPLES: style.SOLID, WINNERS: style.DASHED}
CHANCE = dict(color="0.6", linewidth=0.8, linestyle=style.DOTTED)
PANEL, NUMBER_SIZE = 3.0, 11  # inches of the panel's sides; points between the middles of what must not touch
RING = dict(linestyle="none", marker="o", markersize=5, color="white", markeredgewidth=1.4)
MARK_EVERY = 0.14  # of the panel's diagonal, between an estimator's marks on its curve


def looks_of(rocs):
    return style.equal_looks_of(list(dict.fromkeys(roc.estimator for roc in rocs)))


def line_of(roc, look):
    return {**look.line(), "linestyle": DASHES[roc.population], "linewidth": 1.3, "markersize": 0.9 * look.marker_size}


def name_of(roc):
    return f"{style.label_of(roc.estimator)}, {roc.population}"


def auc_in_words(roc):
    auc = roc.auc
    value = "not defined" if math.isnan(auc.value) else f"{auc.value:.3f} [{auc.lower:.3f}, {auc.upper:.3f}]"
    return f"{name_of(roc)}\nAUC {value}\n{roc.score}; {roc.num_good} good, {roc.num_bad} bad"


def marks_of(rocs):
    """[(number, roc, mark)] of those with a place."""
    marks = [(roc, mark) for roc in rocs for mark in roc.marks
             if not math.isnan(mark.false_accept_rate + mark.true_accept_rate)]
    return [(number, *pair) for number, pair in enumerate(marks, 1)]


def kept_apart(places):
    """For each place (inches) the shift of its number in points: towards the empty side below the curves, as far as the
    places and the other numbers need."""
    taken, shifts = [(72 * x, 72 * y) for x, y in places], []
    for x, y in list(taken):
        steps = ((dx, dy) for distance in range(11, 400, 3) for dx, dy in ((distance, -0.7 * distance), (distance, 0),
                                                                          (0.3 * distance, -distance)))
        shifts.append(next(step for step in steps if all(
            math.hypot(x + step[0] - u, y + step[1] - v) >= NUMBER_SIZE for u, v in taken)))
        taken.append((x + shifts[-1][0], y + shifts[-1][1]))
    return shifts


def draw_marks(axes, marks, looks):
    """A dot on the curve at each named threshold, and beside it its number in a ring."""
    shifts = kept_apart([(PANEL * mark.false_accept_rate, PANEL * mark.true_accept_rate) for _, _, mark in marks])
    for (number, roc, mark), shift in zip(marks, shifts):
        place, color = (mark.false_accept_rate, mark.true_accept_rate), looks[roc.estimator].color
        axes.plot(*[[rate] for rate in place], **{**RING, "markeredgecolor": color}, zorder=5, clip_on=False,
                  label="_mark")
        ring = dict(boxstyle="circle,pad=0.18", facecolor="white", edgecolor=color, linewidth=0.8)
        axes.annotate(str(number), place, xytext=shift, textcoords="offset points", fontsize=style.font_size(6.5), ha="center",
                      va="center", zorder=6, bbox=ring,
                      arrowprops=dict(arrowstyle="-", color=color, linewidth=0.6, shrinkA=0, shrinkB=2))


def legend_of(rocs, looks, marks):
    """A line per curve, below them the numbers in words."""
    handles = [handle(auc_in_words(roc), **line_of(roc, looks[roc.estimator])) for roc in rocs]
    handles.append(handle("chance", **CHANCE))
    return handles + [handle(f"{number}: {name_of(roc)}\n{mark.words}", **{**RING, "markeredgecolor":
                                                                        looks[roc.estimator].color})
                      for number, roc, mark in marks]


def prepare(axes):
    for direction, name in (("x", "Bad models accepted (%)"), ("y", "Good models accepted (%)")):
        getattr(axes, f"set_{direction}lim")(-0.01, 1.01)
        getattr(axes, f"{direction}axis").set_major_formatter(per_cent)
        getattr(axes, f"set_{direction}label")(name)


def draw_roc(tune):
    looks, marks = looks_of(tune.rocs), marks_of(tune.rocs)
    figure, axes, handles = figure_with_legend_beside(legend_of(tune.rocs, looks, marks), width=2.35, height=4.2)
    axes.plot([0, 1], [0, 1], **CHANCE, zorder=1, label="_chance")
    for roc in tune.rocs:
        if roc.curve:
            look = {**line_of(roc, looks[roc.estimator]), "label": f"_{name_of(roc)}"}
            plot_points(axes, *zip(*roc.curve), **look, markevery=MARK_EVERY, zorder=3)
    draw_marks(axes, marks, looks)
    prepare(axes)
    add_legend_and_caption(figure, handles, "; ".join(
        [study_in_words(tune), "AUC: area under the curve with its 95 % interval"] +
        (["rings: thresholds with the numbers beside them"] if marks else [])) + ".")
    return figure
