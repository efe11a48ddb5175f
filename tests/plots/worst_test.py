#!/usr/bin/python3
"""The search of `rcme worst` on functions that are known: what it finds, and that its rates are of fresh trials alone."""

import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "studies"))

import numpy as np

import plot_test_case  # noqa: F401  makes plots/ importable
from common.plot_error import PlotError
from planted_regions import PlantedRegion
from worst import split_pool
from worst_search.intervals import clopper_pearson, simultaneous_rate, simultaneous_share
from worst_search.objective import Counts, Tried
from worst_search.report import share_of, sharpness_text
from worst_search.run_trials import TrialsOfRun, event_of, narrowed_conditions, sharpness_of
from worst_search.search import Plan, Region, find_worst
from worst_search.space import Box, Space, overlap

WORDS_BOX = {"a": frozenset(["one"]), "x0": (0.2, 0.45), "x1": (0.5, 0.75)}  # 1/80 of all draws
OTHER_BOX = {"a": frozenset(["four"]), "x2": (0.1, 0.35), "x3": (0.3, 0.55)}


class Recorder(PlantedRegion):
    def __init__(self, *arguments, **more):
        super().__init__(*arguments, **more)
        self.requests = {}

    def try_draws(self, name, *arguments, **more):
        self.requests[name] = super().try_draws(name, *arguments, **more)
        return self.requests[name]

    def try_box(self, name, *arguments):
        self.requests[name] = super().try_box(name, *arguments)
        return self.requests[name]


class KnownFunctions(unittest.TestCase):
    def test_two_regions_are_found_as_two(self):
        objective = PlantedRegion([WORDS_BOX, OTHER_BOX], seed=1, pool_size=5000)
        regions = [r for r in find_worst(objective, Plan(budget=3500, num_regions=2, num_fresh=100)) if r.is_find]
        self.assertEqual(len(regions), 2)
        self.assertLessEqual(overlap(regions[0].box, regions[1].box, objective.space.pool), 0.2)
        for region in regions:
            inside = objective.is_inside(objective.try_box("check", region.box, 1000).table)
            self.assertGreater(inside.mean(), 0.7)

    def test_of_regions_that_overlap_the_rest_of_the_second_is_found(self):
        boxes = [{"x0": (0.1, 0.4)}, {"x1": (0.5, 0.8)}]  # 30 % of each lie in the other
        objective = PlantedRegion(boxes, seed=3, pool_size=5000)
        regions = [r for r in find_worst(objective, Plan(budget=3500, num_regions=2, num_fresh=100)) if r.is_find]
        self.assertEqual(len(regions), 2)
        self.assertLessEqual(overlap(regions[0].box, regions[1].box, objective.space.pool), 0.01)
        for region in regions:
            inside = objective.is_inside(objective.try_box("check", region.box, 1000).table)
            self.assertGreater(inside.mean(), 0.7)

    def test_where_events_are_frequent_everywhere_the_box_is_cut_from_all_draws(self):
        """Rates of .85 in 6 % of the draws, .4 elsewhere. Of six walks from the worst draw, only four end in a find, and two
        of these in a box with a quarter or more of its draws outside of the region."""
        box = {"x0": (0.0, 0.3), "x1": (0.0, 0.5), "a": frozenset(["one", "two"])}
        for seed in range(3):
            objective = PlantedRegion([box], seed=seed, inside=0.85, outside=0.4)
            regions = find_worst(objective, Plan(budget=6000, num_regions=1, claim=0.5))
            self.assertTrue(regions and regions[0].is_find, seed)
            inside = objective.is_inside(objective.try_box("check", regions[0].box, 1000).table)
            self.assertGreater(inside.mean(), 0.9, seed)

    def test_rates_are_of_fresh_trials_alone(self):
        objective = Recorder([WORDS_BOX, OTHER_BOX], seed=2, pool_size=5000)
        regions = find_worst(objective, Plan(budget=3000, num_fresh=100))
        self.assertGreater(len(regions), 0)
        for region in regions:
            fresh = objective.requests[region.name].total(False)
            self.assertEqual((region.fresh.events, region.fresh.trials), (fresh.events, fresh.trials))
            self.assertEqual(region.rate.estimate, fresh.events / fresh.trials)
            each = 1 - 0.05 / (2 * len(regions))  # rates and shares
            self.assertEqual((region.rate.lower, region.rate.upper), clopper_pearson(fresh.events, fresh.trials, each))
        last = list(objective.requests)[-len(regions):]
        self.assertEqual(set(last), {region.name for region in regions})  # nothing is chosen after they were seen

    def test_the_same_search_twice_asks_the_same(self):
        ends = [Recorder([WORDS_BOX], seed=3, pool_size=2000) for _ in range(2)]
        for objective in ends:
            find_worst(objective, Plan(budget=1500, num_fresh=50))
        self.assertEqual(list(ends[0].requests), list(ends[1].requests))

    def test_a_budget_beyond_the_population_tries_every_draw_once(self):
        objective = Recorder([WORDS_BOX], seed=4, pool_size=400)
        regions = find_worst(objective, Plan(budget=20_000, num_regions=1, num_fresh=50, num_raced=40))
        explored = [request.table.size for name, request in objective.requests.items() if name.startswith("explore")]
        self.assertEqual(sum(explored), 400)
        self.assertEqual([r.fresh.trials for r in regions], [50] * len(regions))

    def test_nothing_is_claimed_where_every_draw_is_alike(self):
        # The claim is the rate itself. A search has a false find with probability .0125 at most; of 20, four or more with .0002.
        finds = 0
        for seed in range(20):
            objective = PlantedRegion([], seed, outside=0.3, pool_size=1000)
            finds += any(r.is_find for r in find_worst(objective, Plan(budget=700, num_fresh=60, claim=0.3, num_raced=40,
                                                                       num_looks=2, box_draws=40, seed=seed)))
        self.assertLess(finds, 4)

    def test_a_search_ends_where_nothing_counts(self):
        objective = Recorder([WORDS_BOX], seed=5, pool_size=400)
        objective.tried = lambda name, table, trials: Tried(table, *np.zeros((3, table.size), dtype=int))
        with self.assertRaisesRegex(PlotError, "none of the .* trials so far counts"):
            find_worst(objective, Plan(budget=1500, num_fresh=50))


class Sides(unittest.TestCase):
    def test_a_box_beside_another_holds_the_draw_and_nothing_of_the_other(self):
        levels = [[repr(x), repr(y), word] for x in range(4) for y in range(4) for word in ("a", "b", "c")]
        space = Space(["x", "y", "word"], levels)
        box = Box.of(space, {"x": (1, 2), "y": (0, 2), "word": frozenset("ab")})
        inside = box.contains(space.pool)
        for i in range(space.pool.size):
            levels = space.pool.row(i)
            sides = list(box.sides(space, levels))
            self.assertEqual(len(sides), sum([levels["x"] in (0, 3), levels["y"] == 3, levels["word"] == "c"]))
            self.assertEqual(bool(sides), not inside[i])
            for side in sides:
                self.assertTrue(side.contains(space.pool)[i])
                self.assertFalse((side.contains(space.pool) & inside).any())

    def test_ends_beyond_which_hardly_any_draw_lies_are_no_limits(self):
        space = Space(["x", "y"], [[repr(i), repr(-i)] for i in range(1000)])
        box = Box.of(space, {"x": (9, 980), "y": (-995, -11)})
        self.assertEqual(box.without_idle_ends(space).limits, (("x", (-np.inf, 980)), ("y", (-np.inf, -11))))

    def test_boxes_meet_in_the_draws_of_both(self):
        space = Space(["x", "word"], [[repr(x), word] for x in range(6) for word in ("a", "b", "c")])
        one = Box.of(space, {"x": (0, 3), "word": frozenset("ab")})
        other = Box.of(space, {"x": (2, 5), "word": frozenset("bc")})
        both = one.contains(space.pool) & other.contains(space.pool)
        self.assertEqual(both.sum(), 2)
        np.testing.assert_array_equal(one.meet(space, other).contains(space.pool), both)


class Shares(unittest.TestCase):
    def test_the_search_does_not_see_what_is_held_out(self):
        space, held_out = split_pool(["scene"], [["room"]] * 6 + [["plane"]] * 2)
        self.assertEqual((space.pool.size, held_out.size), (6, 2))
        self.assertEqual(space.words["scene"], ["room"])
        region = Region(Box((("scene", frozenset(["plane"])),)), 0, 0.5)
        share = share_of(region, 3, held_out)
        self.assertEqual((share.estimate, share.lower, share.upper), (1.0, *clopper_pearson(2, 2, 1 - 0.05 / 6)))

    def test_shares_of_chosen_regions_hold_together(self):
        """150 pools of 1000 uniform draws; of 40 boxes of share 1/40 the three that seem largest are reported. Their shares fail
        together in at most 2.5 %, so more than ten times with probability .002. Intervals of 95 % on the draws that chose fail
        in 57 of 150 pools."""
        random, num_wrong = np.random.default_rng(1), {"held out": 0, "same pool": 0}
        boxes = [Box((("x", (i / 40, (i + 1) / 40)),)) for i in range(40)]
        for _ in range(150):
            space, held_out = split_pool(["x"], [[repr(x)] for x in random.random(1000)])
            largest = sorted(boxes, key=lambda box: -box.share(space.pool))[:3]
            shares = [share_of(Region(box, 0, 0.5), 3, held_out) for box in largest]
            naive = [clopper_pearson(int(box.contains(space.pool).sum()), space.pool.size, 0.95) for box in largest]
            num_wrong["held out"] += not all(share.lower <= 1 / 40 <= share.upper for share in shares)
            num_wrong["same pool"] += not all(lower <= 1 / 40 <= upper for lower, upper in naive)
        self.assertLessEqual(num_wrong["held out"], 10)
        self.assertGreater(num_wrong["same pool"], 30)


class Requests(unittest.TestCase):
    def test_many_draws_are_asked_for_in_parts(self):
        rows = [["room", str(i)] for i in range(10)]
        asked = []

        class Asked(TrialsOfRun):
            def ask(self, name, study, first):
                draws = study["conditions"]["draws"]
                asked.append((name, draws))
                return {"draws": draws, **{key: [10 * draw for draw in draws] for key in ("events", "trials", "reverse")}}

        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "study.yaml").write_text("conditions: {}\n")
            objective = Asked(folder, "rcme", Space(["scene", "sigma_px"], rows), list(range(100, 110)), "failure", ["a"], 1)
            with mock.patch("worst_search.run_trials.MOST_DRAWS", 3):
                tried = objective.try_draws("explore", [9, 0, 1, 2, 3, 4, 5], 1)
        self.assertEqual(asked, [("explore", [109, 100, 101]), ("explore_3", [102, 103, 104]), ("explore_6", [105])])
        self.assertEqual(list(tried.events), [1090, 1000, 1010, 1020, 1030, 1040, 1050])
        self.assertEqual(list(tried.table.columns["sigma_px"]), [9, 0, 1, 2, 3, 4, 5])


    def test_an_estimator_that_never_states_what_is_asked_for_ends_the_search(self):
        def check(quantity, *counts):
            objective = TrialsOfRun(folder, "rcme", Space(["sigma_px"], [["1"], ["2"]]), [0, 1], quantity, ["mine"], 1)
            for answers, stating in counts:
                objective.check_statements({"answers": answers, "stating": stating})

        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "study.yaml").write_text("conditions: {}\n")
            with self.assertRaisesRegex(PlotError, "no answer of mine states a probability of failure; sure_failure needs"):
                check("sure_failure", (0, 0), (5, 0))
            with self.assertRaisesRegex(PlotError, "states a covariance; miscoverage"):
                check("miscoverage", (5, 0))
            check("sure_failure", (5, 1), (5, 0))
            check("failure", (0, 0))


class Intervals(unittest.TestCase):
    def test_known_answers(self):
        # R: binom.test(7, 50)$conf.int
        self.assertAlmostEqual(clopper_pearson(7, 50, 0.95)[0], 0.0581917, places=6)
        self.assertAlmostEqual(clopper_pearson(7, 50, 0.95)[1], 0.2673960, places=6)

    def test_several_regions_widen_them(self):
        one, three = (simultaneous_rate(Counts(30, 100), k) for k in (1, 3))
        self.assertLess(three.lower, one.lower)
        self.assertGreater(three.upper, one.upper)

    def test_shares_are_those_of_clopper_and_pearson_at_their_part_of_the_error(self):
        share = simultaneous_share(7, 50, 2)
        self.assertEqual((share.lower, share.upper), clopper_pearson(7, 50, 0.975))

    def test_a_difference_holds_both_parts(self):
        rate = simultaneous_rate(Counts(30, 100, 5, True), 1)
        self.assertAlmostEqual(rate.estimate, 0.25)
        self.assertAlmostEqual(rate.lower, clopper_pearson(30, 100, 0.975)[0] - clopper_pearson(5, 100, 0.975)[1])

    def test_no_trials_claim_nothing(self):
        self.assertEqual(simultaneous_rate(Counts(0, 0), 3).lower, 0.0)


class Boxes(unittest.TestCase):
    def setUp(self):
        rows = [[word, repr(i / 10), "-" if word == "plane" else str(i)] for word in ("room", "plane") for i in range(11)]
        self.space = Space(["scene", "sigma_px", "num_boxes"], rows)

    def test_a_draw_without_the_key_is_not_restricted(self):
        box = Box.of(self.space, {"num_boxes": (0.0, 3.0)})
        self.assertEqual(box.contains(self.space.pool).sum(), 4 + 11)

    def test_limits_that_all_draws_meet_are_left_out(self):
        self.assertEqual(Box.of(self.space, {"sigma_px": (0.0, 1.0), "scene": frozenset(["room", "plane"])}).limits, ())

    def test_ranges_are_narrowed_where_they_stand(self):
        conditions = {"ranges": {"scene": {"room": {"num_boxes": ["0", "10"]}, "plane": {}}, "sigma_px": ["0", "1"]}}
        box = Box.of(self.space, {"scene": frozenset(["room"]), "num_boxes": (2.4, 7.7), "sigma_px": (0.2, 0.2)})
        narrowed = narrowed_conditions(conditions, self.space, box, 50, "random")
        self.assertEqual(narrowed["ranges"], {"scene": {"room": {"num_boxes": ["3", "7"]}}, "sigma_px": "0.2"})
        self.assertIn("num_boxes >= 2.4", narrowed["given"])

    def test_draws_that_lack_a_key_are_not_excluded_by_its_default(self):
        conditions = {"ranges": {"scene": {"room": {"num_boxes": ["0", "10"]}, "plane": {}}, "sigma_px": ["0", "1"]}}
        box = Box.of(self.space, {"num_boxes": (2.4, 7.7), "sigma_px": (0.2, 0.9)})
        narrowed = narrowed_conditions(conditions, self.space, box, 50, "random")
        self.assertEqual(narrowed["ranges"]["scene"]["room"], {"num_boxes": ["3", "7"]})
        self.assertEqual(narrowed["given"], ["sigma_px >= 0.2", "sigma_px <= 0.9"])

    def test_keys_of_words_that_are_left_out_are_not_drawn(self):
        """num_boxes stands beside the scenes, and is drawn with a room alone: with a plane it is no key."""
        conditions = {"ranges": {"scene": {"any": ["room", "plane"]}, "num_boxes": ["0", "10"], "sigma_px": ["0", "1"]}}
        box = Box.of(self.space, {"scene": frozenset(["plane"]), "num_boxes": (2.4, 7.7), "sigma_px": (0.2, 0.2)})
        narrowed = narrowed_conditions(conditions, self.space, box, 50, "random")
        self.assertEqual(narrowed["ranges"], {"scene": "plane", "sigma_px": "0.2"})
        self.assertNotIn("num_boxes >= 2.4", narrowed.get("given", []))

    def test_keys_of_words_without_a_place_in_the_box_are_not_drawn(self):
        """No room has so much noise: planes are left, although the box has no limit of the scene."""
        conditions = {"ranges": {"scene": {"room": {"sigma_px": ["0", "0.1"]}, "plane": {}}, "num_boxes": ["0", "10"],
                                 "sigma_px": ["0", "1"]}}
        narrowed = narrowed_conditions(conditions, self.space, Box.of(self.space, {"sigma_px": (0.5, 0.9)}), 50, "random")
        self.assertEqual(set(narrowed["ranges"]), {"scene", "sigma_px"})

    def test_words_as_often_as_they_stand(self):
        conditions = {"ranges": {"scene": {"any": ["room", "room", "plane"]}}}
        box = Box.of(self.space, {"scene": frozenset(["room"])})
        self.assertEqual(narrowed_conditions(conditions, self.space, box, 5, "sobol")["ranges"], {"scene": {"any": ["room",
                                                                                                               "room"]}})


class Events(unittest.TestCase):
    def test_each_quantity(self):
        sure_failure = {"outcome": "failure", "status": "ok", "direction_error_deg": "20", "nees": "40", "failure_probability": "0.005"}
        doubtful = {**sure_failure, "failure_probability": "0.4"}
        silent = {**sure_failure, "failure_probability": ""}
        absent = {**silent, "outcome": "not_scored"}
        self.assertEqual([event_of("failure", row) for row in (sure_failure, doubtful, silent, absent)], [1, 1, 1, -1])
        self.assertEqual([event_of("sure_failure", row) for row in (sure_failure, doubtful, silent, absent)], [1, -1, -1, -1])
        rotation_alone, invalid = ({**sure_failure, "direction_error_deg": "", "status": status} for status in ("ok", "invalid_motion"))
        self.assertEqual([event_of("sure_failure", row) for row in (rotation_alone, invalid)], [-1, 1])
        self.assertEqual([event_of("miscoverage", row) for row in (sure_failure, doubtful, silent)], [1, -1, -1])
        self.assertEqual(event_of("miscoverage", {**silent, "outcome": "success", "nees": "5"}), 0)

    def test_a_miscoverage_comes_with_its_sharpness(self):
        rows = [{"sd_over_crb": bound, "rotation_sd_deg": "0.5", "direction_sd_deg": sd} for bound, sd in
                (("1", "2"), ("1.5", "4"), ("", "3"), ("9", ""))]
        known = sharpness_of(rows)
        self.assertEqual(known, {"sd_over_crb": 1.5, "rotation_sd_deg": 0.5, "direction_sd_deg": 3.0})
        self.assertEqual(sharpness_text(known), ["  stated sd (median): 1.5 times the least possible"])
        self.assertEqual(sharpness_text({**known, "sd_over_crb": None}),
                         ["  stated sd (median): 0.5 deg of rotation, 3 deg of direction"])
        self.assertEqual(sharpness_text(sharpness_of([])), [])


if __name__ == "__main__":
    unittest.main()
