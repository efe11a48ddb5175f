"""What the figures' files have in common with the program's: whole or not at all, and what killed processes leave."""

import os
import pathlib
import signal
import subprocess
import sys
import unittest

from plot_test_case import PLOTS, PlotTestCase

from common import whole_file

WAITS = """
import sys, time
sys.path.insert(0, sys.argv[1])
from common import whole_file
with whole_file.pending_file(sys.argv[2]):
    print("made", flush=True)
    time.sleep(100)
"""


class WholeFileTest(PlotTestCase):
    def names(self):
        return sorted(path.name for path in self.folder.iterdir())

    def test_all_take_their_places_or_none(self):
        first, second = str(self.folder / "first"), str(self.folder / "second")
        whole_file.write_text(first, "old\n")

        def fails(_):
            raise OSError(28, "No space left on device")
        with self.assertRaises(OSError):
            whole_file.write_whole({first: lambda part: pathlib.Path(part).write_text("new"), second: fails})
        self.assertEqual((self.names(), (self.folder / "first").read_text()), (["first"], "old\n"))
        whole_file.write_text(str(self.folder / ("n" * 255)), "a name as long as there can be")
        self.assertEqual(len(self.names()), 2)

    def test_what_a_killed_process_left_goes_and_a_living_ones_stays(self):
        table = str(self.folder / "table")
        with subprocess.Popen([sys.executable, "-c", WAITS, str(PLOTS), table], stdout=subprocess.PIPE) as process:
            process.stdout.readline()
            whole_file.write_text(str(self.folder / "other"), "text")
            self.assertEqual(len(self.names()), 2, "its owner lives")
            process.send_signal(signal.SIGKILL)
        whole_file.write_text(str(self.folder / "other"), "text")
        self.assertEqual(self.names(), ["other"])

    def test_those_of_other_hosts_and_other_files_stay(self):
        for name in ("a.rcme-another-12-0.part", "b.part", f"c.rcme-{whole_file.HOST}-12-0.part.csv"):
            (self.folder / name).write_text("text")
        os.symlink(self.folder / "b.part", self.folder / f"d.rcme-{whole_file.HOST}-12-0.part")
        whole_file.write_text(str(self.folder / "other"), "text")
        self.assertEqual(len(self.names()), 5)


if __name__ == "__main__":
    unittest.main()
