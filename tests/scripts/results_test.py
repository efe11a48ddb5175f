"""What counts as the same result: see scripts/results --check."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/reproduce"))

from recipes import is_same  # noqa: E402

OLD = 'study,estimator,quantity,value\ns,"a, b",failure,0.1\ns,c,failure,0.2\n'


class TheSame(unittest.TestCase):
    def same(self, new, name="summary.csv", old=OLD):
        with tempfile.TemporaryDirectory() as folder:
            made, committed = pathlib.Path(folder, "made"), pathlib.Path(folder, name)
            made.write_text(new)
            committed.write_text(old)
            return is_same(made, committed, None)

    def test_a_quantity_that_is_new_is_no_difference(self):
        self.assertTrue(self.same(OLD))
        self.assertTrue(self.same(OLD.replace("s,c,", "s,c,refusal,0.5\ns,c,")))

    def test_anything_else_is(self):
        for new in (OLD.replace("0.2", "0.3"), OLD.replace("s,c,failure,0.2\n", ""), OLD + "s,d,failure,0.2\n",
                    OLD.replace("value", "rate"), OLD.replace("failure", "refusal"), "", "study\n"):
            self.assertFalse(self.same(new), new)

    def test_other_tables_are_compared_whole(self):
        self.assertFalse(self.same("a,b\n1,2\n3,4\n", old="a,b\n1,2\n"))
        self.assertFalse(self.same(OLD.replace("s,c,", "s,c,refusal,0.5\ns,c,"), name="summary.txt"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
