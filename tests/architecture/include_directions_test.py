"""Who may include whom: parameters and stats know nothing of ours, the estimator never the truth, the simulator never
the epipolar constraint. A file that includes against these directions fails the test."""

import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Rooms, or single headers, that the files of a room may include.
ALLOWED = {
    "parameters": ["parameters/"],
    "stats": ["stats/"],
    "estimator": ["estimator/", "stats/", "parameters/"],
    "simulator": [
        "simulator/", "stats/", "parameters/",
        "estimator/geometry/pose.h", "estimator/geometry/camera.h", "estimator/geometry/correspondence.h",
    ],
    "experiments": ["experiments/", "simulator/", "estimator/", "stats/", "parameters/"],
}
OUR_INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def violations(room, path_in_room, text):
    """The includes of a file's text that its room does not allow, as sentences."""
    return [
        f"{path_in_room}: {room} may not include {included}"
        for included in OUR_INCLUDE.findall(text)
        if not any(included.startswith(allowed) for allowed in ALLOWED[room])
    ]


class IncludeDirections(unittest.TestCase):
    def test_every_file_keeps_to_the_directions(self):
        found, num_files = [], 0
        for room in ALLOWED:
            for path in sorted((ROOT / room).rglob("*")):
                if path.suffix in {".h", ".cc"}:
                    num_files += 1
                    found += violations(room, path.relative_to(ROOT), path.read_text(encoding="utf-8"))
        self.assertGreater(num_files, 40)
        self.assertEqual(found, [])

    def test_a_wrong_direction_is_seen(self):
        self.assertTrue(violations("simulator", "x.cc", '#include "estimator/geometry/sampson.h"\n'))
        self.assertTrue(violations("estimator", "x.cc", '#include "simulator/scene.h"\n'))
        self.assertTrue(violations("stats", "x.cc", '#include "estimator/geometry/pose.h"\n'))
        self.assertFalse(violations("simulator", "x.cc", '#include "estimator/geometry/pose.h"\n'))

    def test_only_simulator_experiments_and_tests_speak_of_the_truth(self):
        for room in ["parameters", "stats", "estimator"]:
            for path in sorted((ROOT / room).rglob("*")):
                if path.suffix in {".h", ".cc"}:
                    self.assertNotRegex(path.read_text(encoding="utf-8"), r"\w_true\b", str(path))


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
