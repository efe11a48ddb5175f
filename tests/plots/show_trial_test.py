#!/usr/bin/python3
"""Tests of plots/show_trial.py; run as: /usr/bin/python3 tests/plots/show_trial_test.py"""

import json
import pathlib
import unittest

from plot_test_case import PlotTestCase

import numpy as np
import show_trial
from common.text_size import fill, width_of
from trial_sheet.images import LOOKS, clip, groups_of, kept_apart
from trial_sheet.scene import limits_of_scene, num_outside
from trial_sheet.trial_file import trial_of

SIZES = ((640, 480), (320, 480))
HORIZONTAL = [0, 0, 0, 0, 0, -1, 0, 1, 0]  # F of a translation along x: a point's line has its own height
VERTICAL = [0, 0, 1, 0, 0, 0, -1, 0, 0]


def estimator(label, outcome="success", inliers=(0, 1), **changes):
    """Every number is different."""
    motion = dict(R=[1, 0, 0, 0, 1, 0, 0, 0, 1], t=[1, 0, 0], F=VERTICAL, centre2_in_cam1_m=[-0.2, 0.1, 0.45])
    if outcome == "refusal":
        motion = dict.fromkeys(motion)
    return {"label": label, "status": "no_candidate" if outcome == "refusal" else "ok", "message": "nothing passed the test",
            "outcome": outcome, "rotation_error_deg": 1.234, "direction_error_deg": 23.45, "inlier_precision": 0.567,
            "inlier_recall": 0.789, "inliers": [] if outcome == "refusal" else list(inliers), **motion, **changes}


def trial(**changes):
    """Six matches: three true, two wrong, one wrong on its true line; the last point lies far away."""
    cameras = [dict(fx=500, fy=500, cx=width / 2, cy=height / 2, width=width, height=height) for width, height in SIZES]
    return {"format": "rcme trial 2", "study": "demo", "seed": 7, "condition": 2, "trial": 17, "trials_planned": 10,
            "factors": [["sigma_px", "0.5"], ["motion", "forward"]], "parts": [["scene", "corridor"], ["cameras", "kitti"]],
            "origin": "simulated", "sigma_px": 0.5,
            "bounds": {"max_rotation_error_deg": 3, "max_direction_error_deg": 15},
            "severity": {"image_coverage": 0.876, "parallax_median_deg": 4.321, "chance_inlier_share": 0.0345,
                         "crb_rotation_deg": 0.0123, "crb_direction_deg": 0.456},
            "cameras": cameras,
            "matches": [[100, 50, 30, 60], [200, 150, 130, 150], [300, 400, 310, 390], [10, 10, 300, 470],
                        [630, 20, 200, 20], [50, 300, 20, 100]],
            "kinds": ["inlier", "inlier", "inlier", "outlier", "undetectable", "outlier"],
            "points_in_cam1_m": [[-1, 0, 4], [0, 0, 5], [1, 1, 6], [0.5, 0, 4.5], [0.2, 0, 5.5], [0, 0, 1e5]],
            "views": [{"centre_in_cam1_m": centre, "edges_in_cam1": [[-0.6, 0, 1], [0.6, 0, 1], [0, -0.5, 1], [0, 0.5, 1]]}
                      for centre in ([0, 0, 0], [0.5, 0, 0])],
            "truth": {"R": [1, 0, 0, 0, 1, 0, 0, 0, 1], "t": [-1, 0, 0], "baseline_m": 0.5, "F": HORIZONTAL},
            "selected": [0, 2], "drawn": [1],
            "estimators": [estimator("standard", inliers=(0, 1, 2)), estimator("mine", "failure", inliers=(0, 3, 4))],
            **changes}


def drawn(**changes):
    return show_trial.draw(trial_of(trial(**changes)))


def panels_of(figure):
    """{what stands under or over a panel: the panel}."""
    return {axes.get_title("left") or axes.get_xlabel().split(",")[0]: axes for axes in figure.axes}


def words_of(figure):
    return " ".join(text.get_text() for text in figure.texts)


def marks_of(axes, marker):
    """The points drawn with a marker, as a set."""
    lines = [line for line in axes.lines if line.get_marker() == marker and line.get_linestyle() == "None"]
    return {tuple(map(float, point)) for line in lines for point in line.get_xydata()}


def straight_lines_of(axes, dashed):
    return [line.get_xydata() for line in axes.lines if line.get_marker() == "None" and line.is_dashed() == dashed]


class Images(unittest.TestCase):
    def test_every_match_is_drawn_by_what_it_is_and_what_it_was_taken_for(self):
        groups = groups_of(trial_of(trial()), trial_of(trial()).drawn[0])
        self.assertEqual({key: list(members) for key, members in groups.items()},
                         {("inlier", True): [0], ("inlier", False): [1, 2], ("outlier", True): [3], ("outlier", False): [5],
                          ("undetectable", True): [4]})
        panels = panels_of(drawn())
        self.assertEqual(marks_of(panels["Image 1"], "X"), {(10, 10)})
        self.assertEqual(marks_of(panels["Image 2"], "X"), {(300, 470)})
        self.assertEqual(marks_of(panels["Image 1"], "x"), {(50, 300)})
        self.assertEqual(marks_of(panels["Image 2"], "D"), {(200, 20)})

    def test_images_stand_at_one_scale_with_y_downwards(self):
        figure = drawn()
        panels = panels_of(figure)
        for axes, (width, height) in zip((panels["Image 1"], panels["Image 2"]), SIZES):
            self.assertEqual((axes.get_xlim(), axes.get_ylim()), ((-0.5, width - 0.5), (height - 0.5, -0.5)))
        boxes = [panels[f"Image {number}"].get_window_extent() for number in (1, 2)]
        self.assertAlmostEqual(boxes[0].width / 640, boxes[1].width / 320, places=6)
        self.assertAlmostEqual(boxes[0].width / 640, boxes[0].height / 480, places=6)
        self.assertLess(boxes[0].x1, boxes[1].x0)
        self.assertLessEqual(boxes[1].x1, figure.bbox.width)

    def test_wide_images_stand_one_above_the_other(self):
        cameras = [dict(camera, width=1241, height=376) for camera in trial()["cameras"]]
        boxes = [panels_of(drawn(cameras=cameras))[f"Image {number}"].get_window_extent() for number in (1, 2)]
        self.assertEqual(boxes[0].x0, boxes[1].x0)
        self.assertGreater(boxes[0].y0, boxes[1].y1)

    def test_marks_shrink_where_there_are_many(self):
        def size(count):
            figure = drawn(matches=[[1, 1, 1, 1]] * count, kinds=["inlier"] * count, points_in_cam1_m=[[0, 0, 1]] * count)
            return max(line.get_markersize() for line in panels_of(figure)["Image 1"].lines[:1])
        self.assertEqual(size(6), size(60))
        self.assertLess(size(2000), 0.75 * size(6))

    def test_lines_are_those_of_the_matrices_in_the_file(self):
        panel = panels_of(drawn())["Image 2"]
        across_image_2 = [sorted(map(tuple, ends)) for ends in straight_lines_of(panel, dashed=False)]
        self.assertEqual(across_image_2, [[(-0.5, y), (319.5, y)] for y in (50, 400)])
        vertical = [sorted(ends[:, 0]) for ends in straight_lines_of(panel, dashed=True)]
        self.assertEqual(vertical, [[100, 100], [300, 300]])
        self.assertEqual(straight_lines_of(panels_of(drawn())["Image 1"], dashed=True), [])

    def test_a_line_ends_at_the_border_of_the_image(self):
        self.assertEqual(sorted(map(tuple, clip((0, 1, -100), (640, 480)))), [(-0.5, 100), (639.5, 100)])
        self.assertEqual(sorted(map(tuple, clip((1, 1, -10), (640, 480)))), [(-0.5, 10.5), (10.5, -0.5)])
        diagonal = clip((480, -640, -80), (640, 480))  # through two corners
        self.assertTrue(np.allclose(sorted(map(tuple, diagonal)), [(-0.5, -0.5), (639.5, 479.5)]))
        self.assertIsNone(clip((0, 1, 100), (640, 480)))
        self.assertIsNone(clip((0, 0, 1), (640, 480)))

    def test_selected_matches_have_one_number_in_both_images(self):
        for panel in ("Image 1", "Image 2"):
            texts = [text for text in panels_of(drawn())[panel].texts if hasattr(text, "xy")]
            self.assertEqual([text.get_text() for text in texts], ["1", "2"])
            columns = slice(0, 2) if panel == "Image 1" else slice(2, 4)
            for text, index in zip(texts, (0, 2)):
                self.assertEqual(list(text.xy), trial()["matches"][index][columns])

    def test_names_at_the_border_do_not_cover_each_other(self):
        moved = kept_apart({1: 10.0, 2: 11.0, 3: 300.0, 4: 10.5}, 8)
        self.assertEqual(moved[3], 300)
        places = sorted(moved.values())
        self.assertTrue(all(after - before >= 8 - 1e-9 for before, after in zip(places, places[1:])))
        self.assertEqual(sorted(moved, key=moved.get), [1, 4, 2, 3])

    def test_a_row_per_estimator_with_its_outcome(self):
        figure = drawn(drawn=[1, 0])
        self.assertEqual(sum(axes.get_xlabel().startswith("Image 1") for axes in figure.axes), 2)
        self.assertIn("mine: failure; rotation 1.23\u00b0 off, direction 23.4\u00b0 off; 3 of 6 matches accepted",
                      words_of(figure))
        self.assertIn("Standard: within the bounds", words_of(figure))


class Scene(unittest.TestCase):
    def test_scene_points_lie_at_x_and_z(self):
        panel = panels_of(drawn())["The scene from above"]
        self.assertEqual(marks_of(panel, "o"), {(-1, 4), (0, 5), (1, 6)})
        self.assertEqual(marks_of(panel, "x"), {(0.5, 4.5), (0, 1e5)})

    def test_a_long_view_is_in_kilometres(self):
        for far_m, unit in ((1000, "m"), (4000, "km")):
            points = [[-1, 0, 4], [0, 0, 5], [1, 1, 6], [0.5, 0, 4.5], [0.2, 0, far_m], [0, 0, far_m]]
            panel = panels_of(drawn(points_in_cam1_m=points))["The scene from above"]
            self.assertEqual((panel.get_xlabel(), panel.get_ylabel()), (f"x ({unit})", f"z ({unit})"))
        self.assertEqual([panel.yaxis.get_major_formatter()(metres, 0) for metres in (-500, 3000)], ["\N{MINUS SIGN}0.5", "3"])

    def test_one_metre_is_as_long_ahead_as_sideways(self):
        for name in ("The scene from above", "The cameras from above", "The cameras from the right"):
            panel = panels_of(drawn())[name]
            box = panel.get_window_extent()
            self.assertAlmostEqual(box.width / np.ptp(panel.get_xlim()), box.height / np.ptp(panel.get_ylim()), places=6)

    def test_a_few_far_points_do_not_stretch_the_view_and_are_counted(self):
        many = trial(points_in_cam1_m=[[i % 7 - 3, 0, 4 + i % 5] for i in range(200)] + [[0, 0, 1e5]],
                     matches=[[1, 1, 1, 1]] * 201, kinds=["inlier"] * 201)
        limits = limits_of_scene(trial_of(many), (2, 2))
        self.assertLess(limits[1][1], 15)
        self.assertLessEqual(limits[1][0], 0)
        self.assertEqual(num_outside(trial_of(many), limits), 1)
        self.assertIn("1 of 201 points lie outside the view", words_of(show_trial.draw(trial_of(many))))

    def test_arrows_point_where_the_drawn_estimators_put_camera_2(self):
        for name, end in (("from above", (-0.2, 0.45)), ("from the right", (0.45, 0.1))):
            panel = panels_of(drawn())[f"The cameras {name}"]
            arrows = [text for text in panel.texts if getattr(text, "arrow_patch", None)]
            self.assertEqual([tuple(arrow.xy) for arrow in arrows], [end])
            for ends in (sorted(panel.get_xlim()), sorted(panel.get_ylim())):
                self.assertTrue(ends[0] < -0.5 and ends[1] > 0.5)  # every direction has its place
        self.assertTrue(panel.yaxis_inverted())  # y points down


class Words(unittest.TestCase):
    def test_what_trial_it_is_and_how_hard(self):
        words = words_of(drawn())
        for part in ("demo, condition 2, trial 17, seed 7", "sigma = 0.5 px, motion = forward.", "6 matches: 3 true, 3 wrong",
                     "87.6 %", "4.32\u00b0", "3.5 %", "Scene corridor, cameras kitti.",
                     "Baseline: 0.5 m", "Gaussian bound: 0.0123\u00b0 in"):
            self.assertIn(part, words)

    def test_the_table_has_every_estimator(self):
        words = words_of(drawn())
        for part in ("Standard", "mine", "1.23\u00b0", "23.4\u00b0", "56.7 %", "78.9 %"):
            self.assertIn(part, words)

    def test_a_refusal_shows_its_reason_and_neither_rings_nor_lines(self):
        figure = drawn(estimators=[estimator("standard", "refusal", rotation_error_deg=None, direction_error_deg=None)],
                       drawn=[0])
        self.assertIn("refusal (no_candidate): nothing passed the test", words_of(figure))
        panel = panels_of(figure)["Image 2"]
        self.assertEqual(straight_lines_of(panel, dashed=True), [])
        self.assertEqual(marks_of(panel, "X"), set())
        self.assertEqual(marks_of(panel, "x"), {(300, 470), (20, 100)})
        self.assertNotIn("accepted", " ".join(text.get_text() for text in figure.legends[0].get_texts()))

    def test_an_invalid_answer_is_a_failure_with_its_reason_and_no_motion(self):
        nothing = dict(R=None, t=None, F=None, centre2_in_cam1_m=None, rotation_error_deg=None, direction_error_deg=None,
                       inliers=[])
        figure = drawn(estimators=[estimator("mine", "failure", status="invalid_motion", message="|t| = 0", **nothing)],
                       drawn=[0])
        self.assertIn("failure (invalid_motion): |t| = 0", words_of(figure))
        panel = panels_of(figure)["Image 2"]
        self.assertEqual(straight_lines_of(panel, dashed=True), [])
        self.assertNotIn("rejected", " ".join(text.get_text() for text in figure.legends[0].get_texts()))

    def test_a_pure_rotation_has_no_true_lines_and_says_so(self):
        rotation = trial()
        rotation["truth"].update(t=None, F=None, baseline_m=0)
        figure = show_trial.draw(trial_of(rotation))
        self.assertEqual(straight_lines_of(panels_of(figure)["Image 2"], dashed=False), [])
        self.assertIn("A pure rotation", words_of(figure))
        self.assertNotIn("The cameras from above", panels_of(figure))

    def test_real_pairs_have_no_view_from_above(self):
        figure = drawn(kinds=None, points_in_cam1_m=None, views=None, truth=None, severity={}, origin="pair.csv",
                       estimators=[estimator("mine", "not_scored", rotation_error_deg=None)], drawn=[0])
        self.assertEqual(sorted(panels_of(figure)), ["Image 1", "Image 2"])
        self.assertIn("which of them are true is not known", words_of(figure))
        self.assertIn("The true motion is not known", words_of(figure))

    def test_a_trial_without_matches_is_drawn_empty(self):
        none = dict(matches=[], selected=[], drawn=[0], estimators=[estimator("mine", "refusal", status="too_few_matches")])
        for changes in (dict(kinds=None, points_in_cam1_m=None, views=None, truth=None, severity={}, origin="pair.csv"),
                        dict(kinds=[], points_in_cam1_m=[])):
            figure = drawn(**none, **changes)
            self.assertIn("0 matches", words_of(figure))
            self.assertIn("refusal (too_few_matches)", words_of(figure))
            self.assertTrue({"Image 1", "Image 2"} <= set(panels_of(figure)))

    def test_the_title_is_short_and_levels_are_small_rounded_and_those_that_say_something(self):
        figure = drawn(factors=[["baseline_m", "0.0447245"], ["parallax_deg", "none"], ["draw", "146"], ["num_matches", "12345"],
                                ["assumed_sigma_px", "true"], ["motion", "forward"], ["rest", "-"]])
        title, levels = figure.texts[:2]
        self.assertEqual((title.get_text(), title.get_fontweight()), ("demo, condition 2, trial 17, seed 7", "bold"))
        self.assertEqual(levels.get_text(), "baseline = 0.0447 m, draw = 146, num matches = 12345, assumed sigma = true, "
                                            "motion = forward.")
        self.assertLess(levels.get_fontsize(), 7)
        self.assertNotIn("()", words_of(drawn(factors=[])))

    def test_names_are_only_text_and_long_ones_are_broken(self):
        figure = drawn(study="$x_{1}$ " + "very_long_name" * 20)
        self.assertIn("$x_{1}$", words_of(figure))
        for text in figure.texts:
            self.assertLessEqual(text.get_window_extent().x1, figure.bbox.width, text.get_text())
        for line in fill("a bc " * 30 + "d" * 200, 1.5, 8):
            self.assertLessEqual(width_of(line, 8), 1.5)

    def test_nothing_stands_on_anything_else(self):
        for figure in (drawn(drawn=[0, 1]), drawn(factors=[[f"factor_{i}", f"level {i}"] for i in range(20)])):
            texts = [text for text in figure.texts if text.get_text()]
            boxes = [text.get_window_extent() for text in texts]
            for i, one in enumerate(boxes):
                for text, other in zip(texts[i + 1:], boxes[i + 1:]):
                    shared = (min(one.x1, other.x1) - max(one.x0, other.x0), min(one.y1, other.y1) - max(one.y0, other.y0))
                    self.assertFalse(min(shared) > 2, f"{texts[i].get_text()} / {text.get_text()}")

    def test_kinds_differ_in_shape_so_that_a_grey_print_says_the_same(self):
        for is_accepted in (None, False, True):
            looks = [look["marker"] for (kind, accepted), (_, look) in LOOKS.items()
                     if accepted is is_accepted and kind != "unknown"]
            self.assertEqual(len(set(looks)), len(looks))


class Command(PlotTestCase):
    script, given = show_trial, ["trial.json"]

    def run_main(self, content, out="figure"):
        return self.run_script(self.write(content), "--out", self.folder / out)


    def test_it_writes_both_files_the_same_each_time(self):
        def run():
            code, out, err = self.run_main(json.dumps(trial()))
            self.assertEqual((code, err), (0, ""))
            return [pathlib.Path(path).read_bytes() for path in out.split()]
        first = run()
        self.assertTrue(first[0].startswith(b"\x89PNG") and first[1].startswith(b"%PDF"))
        self.assertEqual(run(), first)

    def test_files_that_are_no_trial(self):
        self.assert_refused(self.run_main(json.dumps(trial())[:300]), "trial.json", "not a whole file")
        self.assert_refused(self.run_main("{}"), "trial.json", "'format'", "rcme show --json")
        self.assert_refused(self.run_main("[]"), "trial.json")
        self.assert_refused(self.run_main(json.dumps(trial(format="rcme audit 1"))), "rcme audit 1", "rcme trial 2")
        self.assert_refused(self.run_main(json.dumps(trial(kinds=["inlier"]))), "kinds", "undetectable")
        self.assert_refused(self.run_main(json.dumps(trial()), "figure.png"), "without .png")
        self.assert_refused(self.run_main(json.dumps(trial()), "none/figure"), "no folder")

    def test_help_teaches_with_an_example(self):
        self.assert_help_shows("plots/show_trial.py trial.json --out trial")


if __name__ == "__main__":
    unittest.main()
