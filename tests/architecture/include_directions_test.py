"""Who may include whom: parameters and stats know nothing of ours, the estimator never the truth, the simulator never
the epipolar constraint, and the reference implementation none of the kernels that it is there to check. A file that
includes against these directions, or against the order of the folders of its room, fails the test. With --arrows it
prints the includes between folders instead."""

import collections
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
    "robot": ["robot/", "estimator/", "stats/", "parameters/"],
    "simulator": [
        "simulator/", "stats/", "parameters/",
        "estimator/geometry/pose.h", "estimator/geometry/camera.h", "estimator/geometry/correspondence.h",
        "estimator/geometry/lens.h",
    ],
    "peers": ["peers/", "estimator/", "stats/", "parameters/"],
    "experiments": ["experiments/", "simulator/", "peers/", "estimator/", "stats/", "parameters/"],
    "python": ["python/", "experiments/", "simulator/", "peers/", "estimator/", "stats/", "parameters/"],
}
# The folders of a room from below: a file includes files of its own folder and of those before it. "." is the room
# itself, where the program begins.
FOLDERS = {
    "experiments": ["core", "data", "study", "trial", "run", "statistics", "ask", "gate", "conform", "integrity", "audit", "tuning", "rare", "search", "real", "commands", "."],
    "plots": ["common", "page", "rates", "audit_figures", "tuning_figures", "reliability_figure", "stanford_figure", "gate_figure", "conform_figure", "report_page", "surface", "worst_search", "trial_sheet", "."],
}
PYTHON_IMPORT = re.compile(r"^\s*(?:from|import)\s+(\w+)", re.MULTILINE)
OUR_INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def violations(room, path_in_room, text):
    """The includes of a file's text that its room does not allow, as sentences."""
    return [
        f"{path_in_room}: {room} may not include {included}"
        for included in OUR_INCLUDE.findall(text)
        if not any(included.startswith(allowed) for allowed in ALLOWED[room])
    ]


def folder_of(path_in_room):
    """The folder of a path relative to its room."""
    head, slash, _ = path_in_room.partition("/")
    return head if slash else "."


def folders_used_by(room, path, text):
    """The folder of each of the room's own files that a file includes or, in Python, imports."""
    if not path.endswith(".py"):
        return [folder_of(included.removeprefix(room + "/")) for included in OUR_INCLUDE.findall(text)
                if included.startswith(room + "/")]
    modules = {file.stem for file in (ROOT / room).glob("*.py")}
    return [name if name in FOLDERS[room] else "." for name in PYTHON_IMPORT.findall(text)
            if name in FOLDERS[room] or name in modules]


def arrows(room, files):
    """Includes from folder to folder within a room: {(from, to): how many}; `files` are (path in room, text)."""
    return collections.Counter((folder_of(path), used) for path, text in files
                               for used in folders_used_by(room, path, text) if used != folder_of(path))


def upward(room, counts):
    """Those arrows that run against the order of the folders."""
    level = FOLDERS[room].index
    return [(start, end) for start, end in counts if level(end) > level(start)]


def files_of(room):
    return [(str(path.relative_to(ROOT / room)), path.read_text(encoding="utf-8"))
            for path in sorted((ROOT / room).rglob("*")) if path.suffix in {".h", ".cc", ".py"}]


# What `implementation: reference` runs, but for the choice between the two implementations (estimators/).
REFERENCE = ["estimator/reference_engine.h", "estimator/ransac_estimate.h"]


def reached_from(roots, read):
    """The files that the roots include directly or not, with the source file beside each header; every file with the
    one it was reached from. `read` gives a file's text, or None if there is no such file."""
    reached, waiting = {}, [(root, None) for root in roots]
    while waiting:
        path, origin = waiting.pop()
        text = None if path in reached else read(path)
        if text is None:
            continue
        reached[path] = origin
        waiting += [(included, path) for included in OUR_INCLUDE.findall(text)]
        if path.endswith(".h"):
            waiting.append((path[:-2] + ".cc", path))
    return reached


def kernels_reached_from(roots, read):
    """The kernels among them, as sentences."""
    return [f"{origin}: the reference may not include {path}"
            for path, origin in sorted(reached_from(roots, read).items()) if path.startswith("estimator/kernels/")]


def read_source(path):
    file = ROOT / path
    return file.read_text(encoding="utf-8") if file.is_file() else None


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

    def test_includes_run_down_the_folders(self):
        for room in FOLDERS:
            files = files_of(room)
            self.assertEqual({folder_of(path) for path, _ in files}, set(FOLDERS[room]))
            self.assertEqual(upward(room, arrows(room, files)), [])

    def test_an_upward_include_is_seen(self):
        below = [("core/x.h", '#include "experiments/study/study.h"\n')]
        above = [("study/x.h", '#include "experiments/core/text/message.h"\n#include "experiments/study/y.h"\n')]
        self.assertEqual(upward("experiments", arrows("experiments", below)), [("core", "study")])
        self.assertEqual(arrows("experiments", above), {("study", "core"): 1})
        self.assertEqual(upward("experiments", arrows("experiments", above)), [])
        of_a_script = [("rates/x.py", "from common import style\nimport heat_map\n")]
        self.assertEqual(upward("plots", arrows("plots", of_a_script)), [("rates", ".")])

    def test_the_reference_reaches_no_kernel(self):
        reached = reached_from(REFERENCE, read_source)
        for path in ["reference_matches.cc", "refinement/sampson_equations.cc", "observability.cc",
                     "motion_tests.cc", "hypothesis.cc", "uncertainty/motion_covariance.cc"]:
            self.assertIn("estimator/" + path, reached)
        self.assertEqual(kernels_reached_from(REFERENCE, read_source), [])

    def test_a_kernel_behind_a_source_file_is_seen(self):
        files = {"a.h": '#include "b.h"\n', "b.h": "", "b.cc": '#include "estimator/kernels/score.h"\n',
                 "estimator/kernels/score.h": ""}
        self.assertEqual(kernels_reached_from(["a.h"], files.get),
                         ["b.cc: the reference may not include estimator/kernels/score.h"])
        self.assertTrue(kernels_reached_from(["estimator/estimators/loop_estimator.h"], read_source))

    def test_only_simulator_experiments_and_tests_speak_of_the_truth(self):
        for room in ["parameters", "stats", "estimator", "robot", "peers"]:
            for path in sorted((ROOT / room).rglob("*")):
                if path.suffix in {".h", ".cc"}:
                    self.assertNotRegex(path.read_text(encoding="utf-8"), r"\w_true\b", str(path))


def print_arrows():
    for room, folders in FOLDERS.items():
        files = files_of(room)
        counts = arrows(room, files)
        print(f"{room}: {len(files)} files in {len(folders)} folders; {sum(counts.values())} includes between folders, "
              f"{len(counts)} arrows, {len(upward(room, counts))} upwards")
        for (start, end), count in sorted(counts.items()):
            print(f"  {start} -> {end}: {count}")


if __name__ == "__main__":
    if sys.argv[1:] == ["--arrows"]:
        print_arrows()
    else:
        unittest.main(argv=sys.argv)
