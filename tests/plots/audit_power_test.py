#!/usr/bin/python3
"""Tests of plots/audit_power.py; run as: /usr/bin/python3 tests/plots/audit_power_test.py"""

import unittest

from plot_test_case import PlotTestCase

import audit_power

TABLE = ",".join(audit_power.COLUMNS) + """
estimator,drawn,quick,-0.05,40,36,0.76,0.97,0,0,0.09
estimator,drawn,quick,0,40,0,0,0.09,38,0.83,0.99
estimator,run,quick,0,10,0,0,0.31,9,0.55,0.99
"""


class AuditPowerTest(PlotTestCase):
    script, given = audit_power, ["sigma.csv"]

    def options(self, text):
        return audit_power.parse([self.write(text), "--out", str(self.folder / "power")])

    def test_shares_are_drawn_over_the_error(self):
        axes = audit_power.draw(self.options(TABLE)).axes[0]
        points = [list(zip(*line.get_data())) for line in axes.lines]
        self.assertEqual(points, [[(-5.0, 90.0), (0.0, 0.0)], [(0.0, 0.0)], [(-5.0, 0.0), (0.0, 95.0)], [(0.0, 90.0)]])

    def test_a_foreign_table_is_refused(self):
        self.assert_refused(self.run_script(self.write("a,b\n1,2\n"), "--out", self.folder / "power"), "rcme_audit_power sigma")


if __name__ == "__main__":
    unittest.main()
