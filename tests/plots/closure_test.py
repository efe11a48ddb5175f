#!/usr/bin/python3
"""Tests of plots/closure.py; run as: /usr/bin/python3 tests/plots/closure_test.py"""

import unittest

from plot_test_case import PlotTestCase

import closure as script
from common import style

TABLE = """set,estimator,images,shared_errors,of,loops,apart,covered,covered_lower,covered_upper,rms_over_sd,rms_over_sd_lower,rms_over_sd_upper
hall,ours,3,allowed for,pairs,9,3,0.9,0.5,1,1.1,0.6,1.5
hall,ours,3,ignored,pairs,9,3,0.8,0.4,1,1.4,0.7,1.9
hall,ours,3,ignored,twins,27,9,0.95,0.7,1,1,0.8,1.2
hall,ours,4,allowed for,pairs,8,1,0.5,0,1,3,,
hall,ours,4,ignored,pairs,8,1,0.25,0,1,12,0,
"""


class Closure(PlotTestCase):
    script, given = script, ["closure.csv"]

    def drawn(self, *more, table=TABLE):
        return script.draw(script.parse([self.write(table), *more, "--out", str(self.folder / "figure")]))

    def points(self, axes):
        return {line.get_label(): list(zip([round(x) for x in line.get_xdata()], map(float, line.get_ydata()))) for line in axes.lines
                if line.get_marker() not in ("None", None)}

    def test_draws_png_and_pdf(self):
        code, _, errors = self.run_script(self.write(TABLE), "--out", self.folder / "figure")
        self.assertEqual((code, errors), (0, ""))
        for suffix in ("png", "pdf"):
            self.assertGreater((self.folder / f"figure.{suffix}").stat().st_size, 1000)

    def test_lines_are_those_of_the_pairs(self):
        shares, ratios = self.drawn().axes
        self.assertEqual(list(self.points(shares).values()), [[(3, 90.0), (4, 50.0)], [(3, 80.0), (4, 25.0)]])
        self.assertEqual(list(self.points(ratios).values()), [[(3, 1.1), (4, 3.0)], [(3, 1.4), (4, 12.0)]])
        self.assertEqual([text.get_text() for text in self.drawn().legends[0].get_texts()],
                         ["shared errors allowed for", "shared errors ignored"])

    def test_what_is_right_is_a_line(self):
        shares, ratios = self.drawn().axes
        self.assertEqual([axes.lines[0].get_ydata()[0] for axes in (shares, ratios)], [95, 1])

    def test_ends_that_are_not_bounded_lie_at_the_edge(self):
        ratios = self.drawn().axes[1]
        ends = [tuple(path.vertices[:, 1]) for collection in ratios.collections for path in collection.get_paths()]
        self.assertIn(ratios.get_ylim(), ends)

    def test_where_chooses_lines(self):
        shares = self.drawn("--where", "of=twins").axes[0]
        self.assertEqual(list(self.points(shares).values()), [[(3, 95.0)]])
        self.assertEqual(len(self.points(self.drawn("--where", "shared_errors=ignored").axes[0])), 1)
        self.assert_refused(self.run_script(self.write(TABLE), "--where", "set=yard", "--out", self.folder / "figure"), "hall")

    def test_two_files_are_told_apart(self):
        other = self.folder / "other.csv"
        other.write_text(TABLE.replace("hall", "yard"))
        lines = script.read_lines(script.parse([self.write(TABLE), str(other), "--out", "x", "--where", "shared_errors=ignored"]))
        self.assertEqual(list(lines), ["hall", "yard"])

    def test_an_estimator_has_its_colour_and_its_second_line_open_marks(self):
        other = self.folder / "other.csv"
        other.write_text(TABLE.replace("ours", "standard"))
        lines = script.read_lines(script.parse([self.write(TABLE.replace("ours", "rcme_calibrated")), str(other), "--out", "x"]))
        looks = script.looks_of(lines)
        self.assertEqual(len(lines), 4)
        known = style.looks_of(["rcme_calibrated", "standard"])
        for name, rows in lines.items():
            self.assertEqual(looks[name][0].color, known[rows.estimator.iloc[0]].color)
        self.assertEqual([bool(more) for _, more in looks.values()].count(True), 2)
        many = {f"set {number}": rows for number in range(3) for rows in [next(iter(lines.values()))]}
        self.assertEqual(len({look.color for look, _ in script.looks_of(many).values()}), 3)

    def test_two_rows_of_one_place_are_refused(self):
        self.assert_refused(self.run_script(self.write(TABLE), self.write(TABLE), "--out", self.folder / "figure"), "the same set")

    def test_what_is_no_such_file_is_refused(self):
        for content, named in (("a,b\n1,2\n", "rcme validate"), (TABLE.replace("1.1", "x"), "must be a number"),
                               (TABLE.splitlines()[0] + "\n", "no rows")):
            with self.subTest(named=named):
                self.assert_refused(self.run_script(self.write(content), "--out", self.folder / "figure"), named)


if __name__ == "__main__":
    unittest.main()
