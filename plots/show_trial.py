#!/usr/bin/python3
"""Draws one trial: both images with every match and some epipolar lines, a row per estimator; the scene from above; how
hard the problem is and how each estimator fared.

It draws what the file says and computes nothing but where a line leaves an image and what a view shows.
"""

import argparse
import sys

from common import style
from common.command_line import Parser, check_figure_path, draw_figure
from common.text_size import fill, height_of, width_of
from trial_sheet.images import draw_image_pair, legend_handles
from trial_sheet.scene import FROM_ABOVE, FROM_THE_RIGHT, draw_close_up, draw_scene, limits_of_scene, num_outside
from trial_sheet.sheet import WIDTH, sheet_of
from trial_sheet.trial_file import read_trial
from trial_sheet.words import facts_of, levels_of, notes_of, outcome_of, table_of, title_of

GAP = 0.14  # inches, as all lengths here
MIN_IMAGE_HEIGHT, MAX_IMAGE_HEIGHT, LABEL = 1.6, 4.2, 0.28  # LABEL: room for what stands under an image
VIEW_SIZE, CLOSE_UP = (3.1, 2.8), 1.28  # panels of the scene and of the cameras, without their labels
TITLE, TEXT, SMALL = 9, 7.5, 6.5  # points
SWATCH = 0.16  # room for the square in an estimator's colour

EXAMPLE = """
example:
  rcme show run.sqlite --condition 6 --trial 17 --json trial.json
  plots/show_trial.py trial.json --out trial
draws trial.png and trial.pdf, as `rcme show` does itself.
"""


def text_block(lines, size, **look):
    """(height, paint) of lines over the whole width."""
    lines = [part for line in lines for part in fill(line, WIDTH, size, look.get("fontweight") == "bold")]

    def paint(sheet, top):
        for number, line in enumerate(lines):
            sheet.text(0, top + height_of(number, size), line, fontsize=size, **look)
    return height_of(len(lines), size) + 0.06, paint


def legend_block(trial, looks):
    handles = legend_handles(trial, looks)
    if not handles:
        return 0, lambda sheet, top: None
    columns = max(1, min(len(handles), int(WIDTH / (0.5 + max(width_of(name, TEXT) for name in handles)))))
    rows = -(-len(handles) // columns)

    def paint(sheet, top):
        sheet.legend(top, handles, columns)
    return 0.16 * rows + 0.1, paint


def placed_images(sizes):
    """(left, top, width, height) of both images at one scale, and the height of all: side by side, or one above the
    other if that would leave them low."""
    (width1, height1), (width2, height2) = sizes
    scale = min((WIDTH - GAP) / (width1 + width2), MAX_IMAGE_HEIGHT / max(height1, height2))
    if scale * max(height1, height2) >= MIN_IMAGE_HEIGHT:
        boxes = (0, 0, scale * width1, scale * height1), (scale * width1 + GAP, 0, scale * width2, scale * height2)
        return boxes, scale * max(height1, height2) + LABEL
    scale = WIDTH / max(width1, width2)
    boxes = (0, 0, scale * width1, scale * height1), (0, scale * height1 + LABEL, scale * width2, scale * height2)
    return boxes, scale * (height1 + height2) + 2 * LABEL


def images_block(trial, estimate, look):
    """Both images under a line about the estimator."""
    boxes, height = placed_images(trial.sizes)
    lines = fill(f"{look.label}: {outcome_of(trial, estimate)}", WIDTH - SWATCH, TEXT, bold=True)
    header = height_of(len(lines), TEXT) + 0.05

    def paint(sheet, top):
        for number, line in enumerate(lines):
            sheet.text(SWATCH, top + height_of(number, TEXT), line, fontsize=TEXT, fontweight="bold")
        sheet.text(0, top, "\u25a0", fontsize=TEXT, color=look.color)
        panels = [sheet.axes(left, top + header + below, *size) for left, below, *size in boxes]
        draw_image_pair(panels, trial, estimate, look)
        for axes, number, size in zip(panels, "12", trial.sizes):
            axes.set_xlabel(f"Image {number}, {size[0]} \u00d7 {size[1]} px", fontsize=SMALL, labelpad=2)
    return header + height, paint


def scene_block(trial, looks):
    """The scene from above, the cameras close up, and beside them how hard the problem is."""
    left_of_close_ups = 0.42 + VIEW_SIZE[0] + 0.25
    left_of_text = left_of_close_ups + (CLOSE_UP + 0.32 if trial.baseline_m else 0)
    facts = [fill(fact, WIDTH - left_of_text, TEXT) for fact in facts_of(trial)]
    text_height = sum(height_of(len(lines), TEXT) + 0.05 for lines in facts)

    def paint(sheet, top):
        draw_scene(sheet.axes(0.42, top + 0.22, *VIEW_SIZE), trial, looks, limits_of_scene(trial, VIEW_SIZE))
        if trial.baseline_m:
            for number, (side, name) in enumerate(((FROM_ABOVE, "from above"), (FROM_THE_RIGHT, "from the right"))):
                axes = sheet.axes(left_of_close_ups, top + 0.22 + number * (CLOSE_UP + 0.26), CLOSE_UP, CLOSE_UP)
                draw_close_up(axes, trial, looks, side, f"The cameras {name}")
        top += 0.22
        for lines in facts:
            for line in lines:
                sheet.text(left_of_text, top, line, fontsize=TEXT)
                top += height_of(1, TEXT)
            top += 0.05
    return max(0.22 + VIEW_SIZE[1] + 0.48, 0.32 + text_height), paint


def table_block(trial, looks):
    """A row per estimator of the study; those drawn have a square of their colour."""
    header, rows = table_of(trial, looks)
    lefts = (SWATCH, 2.0, 3.45, 4.45, 5.5, 6.4, 7.15)
    drawn = {estimate.label for estimate in trial.drawn}

    def paint(sheet, top):
        for left, name in zip(lefts, header):
            sheet.text(left, top, name, fontsize=TEXT, fontweight="bold")
        for number, (estimate, row) in enumerate(zip(trial.estimates, rows), 1):
            of_row = top + height_of(number, TEXT) + 0.03
            for left, cell in zip(lefts, row):
                sheet.text(left, of_row, cell, fontsize=TEXT)
            if estimate.label in drawn:
                sheet.text(0, of_row, "\u25a0", fontsize=TEXT, color=looks[estimate.label].color)
    return height_of(len(rows) + 1, TEXT) + 0.12, paint


def draw(trial):
    looks = style.equal_looks_of([estimate.label for estimate in trial.estimates])
    blocks = [text_block([title_of(trial)], TITLE, fontweight="bold")]
    if levels := levels_of(trial):
        blocks.append(text_block([levels + "."], SMALL, color="0.3"))
    blocks.append(legend_block(trial, looks))
    blocks += [images_block(trial, estimate, looks[estimate.label]) for estimate in trial.drawn]
    outside = None
    if trial.views:
        blocks.append(scene_block(trial, looks))
        outside = num_outside(trial, limits_of_scene(trial, VIEW_SIZE))
    else:
        blocks.append(text_block(facts_of(trial), TEXT))
    blocks += [table_block(trial, looks), text_block([" ".join(notes_of(trial, outside))], SMALL, color="0.3")]
    return sheet_of(blocks)


def parse(arguments):
    parser = Parser(prog="show_trial.py", description=__doc__, epilog=EXAMPLE,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trial", metavar="TRIAL.json", help="file that 'rcme show --json' wrote")
    parser.add_argument("--out", required=True, metavar="PATH", help="where to write, without suffix")
    options = parser.parse_args(arguments)
    check_figure_path(options.out)
    return options


def main(arguments=None):
    return draw_figure("show_trial.py", parse, lambda options: draw(read_trial(options.trial)), arguments)


if __name__ == "__main__":
    sys.exit(main())
