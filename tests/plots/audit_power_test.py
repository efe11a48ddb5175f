#!/usr/bin/python3
"""Tests of plots/audit_power.py; run as: /usr/bin/python3 tests/plots/audit_power_test.py"""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

PLOTS = pathlib.Path(__file__).resolve().parents[2] / "plots"
sys.path.insert(0, str(PLOTS))

import audit_power  # noqa: E402

TABLE = ",".join(audit_power.COLUMNS) + """
estimator,drawn,quick,-0.05,40,36,0.76,0.97,0,0,0.09
estimator,drawn,quick,0,40,0,0,0.09,38,0.83,0.99
estimator,run,quick,0,10,0,0,0.31,9,0.55,0.99
"""


class AuditPowerTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.table = pathlib.Path(folder.name) / "sigma.csv"
        self.out = pathlib.Path(folder.name) / "power"

    def options(self, text):
        self.table.write_text(text)
        return audit_power.parse([str(self.table), "--out", str(self.out)])

    def test_shares_are_drawn_over_the_error(self):
        axes = audit_power.draw(self.options(TABLE)).axes[0]
        points = [list(zip(*line.get_data())) for line in axes.lines]
        self.assertEqual(points, [[(-5.0, 90.0), (0.0, 0.0)], [(0.0, 0.0)], [(-5.0, 0.0), (0.0, 95.0)], [(0.0, 90.0)]])

    def test_a_foreign_table_is_refused(self):
        self.table.write_text("a,b\n1,2\n")
        with contextlib.redirect_stderr(io.StringIO()) as errors, contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(audit_power.main([str(self.table), "--out", str(self.out)]), 2)
        self.assertIn("rcme_audit_power sigma", errors.getvalue())


if __name__ == "__main__":
    unittest.main()
