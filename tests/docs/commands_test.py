"""Every command of every page runs as it stands there, in the order of the page, but for fewer trials; RCME names the program.
Blocks called `text` are compared with what the command before them prints, line by line and number by number.

    RCME=build/release/bin/rcme python3 tests/docs/commands_test.py [PAGE ...]"""

import difflib
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

import pages
from fixtures import make_fixtures

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ["README.md", "CONTRIBUTING.md", "experiments/README.md", *(f"docs/{path.name}" for path in sorted((ROOT / "docs").glob("*.md"))),
         *(str(path.relative_to(ROOT)) for path in sorted((ROOT / "examples").glob("*/README.md")))]

# What the suite, or a script of its own, runs in another way.
ELSEWHERE = {
    r"scripts/test$": "is what runs this",
    r"scripts/demo$": "its commands are those of the first study; a build from nothing is no test",
    r"scripts/slurm/submit ": "scripts/test-slurm",
    r"scripts/api-docs$": "test docs.api",
    r"scripts/site$|python3 -m http.server ": "test docs.site",
    r"cmake ": "tests install.consumer and install.own_estimator",
    r"pip ": "test python.pip",
    r"PYTHONPATH=": "tests python.*",
    r"python3 examples/any_language/": "test python.any_language",
    r"rcme import ": "test python.any_language",
    r"rcme compare run.sqlite --against opencv_python$": "test python.any_language",
    r"rcme run \S+ --add-estimator opencv.yaml": "test python.any_language",
    r"rcme run studies/any_condition.yaml|rcme surface |rcme run surface/next.yaml": "test SurfaceProgram.*, on a small population",
    r"rcme worst ": "test end_to_end.worst, on a small population: the page's search takes ten minutes",
    r"parallel ": "needs GNU parallel; its command is that of the first line of the page",
}

# Places for the reader's own things, and how a command of minutes becomes one of a second: (pattern, what it becomes).
SHORTER = [
    (r"\bSTUDY --until ci=0.01\b", "STUDY --set outlier_ratio=0.1 --until ci=0.3"),
    (r"^rcme (tune|transfer) (STUDY|studies/tune_acceptance.yaml)",
     r"rcme \1 studies/tune_acceptance.yaml --set outlier_ratio=0.1 --set num_matches=60"),
    (r"^rcme tune (\S+)", r"rcme tune \1 --set scene=room"),
    (r"\bSTUDY\b", "studies/failure_vs_outliers.yaml"),
    (r"\bPAIRS (.*noise\.yaml)", r"one_camera \1"),
    (r"\bPAIRS\b", "pairs"),
    (r"\bpairs/sift pairs/orb\b", "pairs"),
    (r"^rcme run (?!.*--(until|trials) )(?!first.yaml|locked.yaml|regression_gate)(.*)$", r"rcme run \2 --trials 2"),
    (r"^rcme run (.*)--trials 600", r"rcme run \1--trials 2"),
    (r"^rcme run studies/right_calibration.yaml", r"rcme run studies/right_calibration.yaml --set conditions.number=6"),
    (r"regression_gate --trials 250", "regression_gate --trials 40"),
    (r"^rcme gate before.sqlite .* --out", "rcme gate before.sqlite --of failure --margin failure=0.1 --out"),
    (r"^rcme export (.*)--trials \d+", r"rcme export \1--trials 2"),
    (r"^rcme audit --budget full (--shard|--merge)", r"rcme audit --only sample_test.size.joint \1"),
    (r"^rcme audit --out", "rcme audit --only sampson.determinant --out"),
    (r"^rcme audit (\S+yaml) (.*?)(--only estimator )?--out", r"rcme audit \1 \2--only inlier.true_pose.rank_aware --set outlier_ratio=0 --out"),
    (r"^rcme integrity (.*)--trials \d{4,}", r"rcme integrity \1--trials 4"),
    (r"^rcme solve (.*)$", r"rcme solve \1 --set num_matches=60 --trials 100 --estimator standard --estimator rcme_as_printed"),
    (r"^rcme map (.*)$", r"rcme map \1 --trials 4"),
    (r"^rcme transfer (\S*transfer_mu.yaml)", r"rcme transfer \1 --set scene=uniform_volume --set num_matches=60"),
    (r"^rcme (tune|transfer) (.*)$", r"rcme \1 \2 --tune explore=5 --tune calibrate=20 --tune verify=5 --tune at_most=0.9"),
    (r"^rcme rare (.*)$", r"rcme rare \1 --set sigma_px=0.65 --particles 20 --replicates 4 --moves 1"),
    (r"^rcme model-choice (.*)$", r"rcme model-choice \1 --trials 1 --set outlier_ratio=0.2"),
    (r"^rcme budget (.*)$", r"rcme budget \1 --calls 1 --set outlier_ratio=0.3"),
    (r"^rcme validate (.*)--images 10 --loops 10 --trials \d+ --twins 1 ", r"rcme validate \1--images 5 --loops 5 --trials 3 "),
    (r"^rcme (validate|twin) (.*)$", r"rcme \1 \2 --twins 1"),
]

# What a machine decides, and what it is compared as: durations (and which call took longest), and the time of a lock.
# In a block with durations line breaks are not compared, because they move with the width of a number.
DURATIONS = [(r"slowest call \S+ ms \([^)]*\)", "slowest call # ms"), (r"\s+[\d.]+\s+ms\b", " # ms")]
TIMES = [(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", "#")]

# Output that the test cannot make, by page and first line: the command that makes it.
MADE_ELSEWHERE = {
    ("docs/validate.md", "kittiraw0928_stereo: "): "rcme validate PAIRS --out validation, on real pairs that are not in the repository",
}

# Commands that draw figures beside their result: of those that many pages have, the figures are drawn on one page alone.
DRAWS_ALSO, DRAWN = r"rcme (audit|tune) ", "examples/gallery/README.md"


def is_elsewhere(command):
    return any(re.match(pattern, command) for pattern in ELSEWHERE)


def as_run(command):
    """The commands that are run for one of a page: a share of 64 machines is both of two."""
    for pattern, replacement in SHORTER:
        command = re.sub(pattern, replacement, command)
    if re.search(r"--shard 3/64", command):
        return [re.sub(r"parts/3\.", f"parts/{i}.", re.sub(r"--shard 3/64", f"--shard {i}/2", command)) for i in (1, 2)]
    return [command]


def cpu_seconds():
    times = os.times()
    return times.children_user + times.children_system


def is_made_elsewhere(page, shown):
    return any(page == each and shown.text.startswith(first) for each, first in MADE_ELSEWHERE)


def substitute(rules, text):
    for pattern, replacement in rules:
        text = re.sub(pattern, replacement, text)
    return text


def comparable(text, has_durations):
    """The lines of a text; its words if there are durations."""
    text = substitute(DURATIONS + TIMES, text)
    return text.split() if has_durations else [line.rstrip() for line in text.strip("\n").splitlines()]


class Commands(unittest.TestCase):
    def sandbox(self, commands):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        folder = pathlib.Path(scratch.name)
        for name in ("experiments", "studies", "estimator_files", "results", "examples", "scripts", "docs"):
            (folder / name).symlink_to(ROOT / name)
        (folder / "bin").mkdir()
        (folder / "bin/rcme").symlink_to(pathlib.Path(os.environ["RCME"]).resolve())
        make_fixtures(folder, folder / "bin/rcme", commands)
        return folder

    def run_page(self, page):
        shown = pages.contents((ROOT / page).read_text())
        commands = [command for one in shown if isinstance(one, pages.Command) and not is_elsewhere(one.text)
                    for command in as_run(one.text)]
        if not commands:
            return
        folder = self.sandbox(commands)
        environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}", "GLOG_minloglevel": "3"}
        without_figures = {**environment, "PYTHONHOME": "/nowhere"}  # finds no Python that starts
        output = ""
        for one in shown:
            if isinstance(one, pages.ShownFile):
                (folder / one.name).write_text(one.text)
            elif isinstance(one, pages.ShownOutput):
                if not is_made_elsewhere(page, one):
                    self.check_output(f"{page}:{one.line}", one.text, output)
            elif not is_elsewhere(one.text):
                for command in as_run(one.text):
                    draws = page == DRAWN or not re.match(DRAWS_ALSO, command)
                    output = self.run_one(f"{page}:{one.line}", command, folder, environment if draws else without_figures)

    def run_one(self, where, command, folder, environment):
        start = cpu_seconds()
        done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, capture_output=True, text=True)
        print(f"{cpu_seconds() - start:6.1f} CPU s  {where}: {command}", flush=True)
        # 75: a share, or a merge that still lacks trials, as the page says.
        self.assertIn(done.returncode, (0, 75) if re.search("--shard|--round", command) else (0, 3) if command.startswith("rcme integrity") else (0,), f"{where}: {command}\n{done.stdout}{done.stderr}")
        return done.stdout

    def check_output(self, where, shown, output):
        """Finds each part of the block between its "..." in the output, in this order."""
        has_durations = substitute(DURATIONS, shown) != shown
        whole, begin = comparable(output, has_durations), 0
        for part in re.split(r"^\s*\.\.\.$", shown, flags=re.MULTILINE):
            part = comparable(part, has_durations)
            found = [i for i in range(begin, len(whole) - len(part) + 1) if whole[i:i + len(part)] == part]
            if not found:
                self.fail(f"{where}: the page shows (-) what the command does not print (+)\n" + "\n".join(difflib.unified_diff(part, whole, lineterm="")))
            begin = found[0] + len(part)

    def test_every_rule_is_needed(self):
        texts = [one.text for page in PAGES for one in pages.contents((ROOT / page).read_text())
                 if isinstance(one, pages.Command)]
        for pattern in ELSEWHERE:
            self.assertTrue(any(re.match(pattern, text) for text in texts), pattern)
        outputs = [(page, one) for page in PAGES for one in pages.contents((ROOT / page).read_text()) if isinstance(one, pages.ShownOutput)]
        for pattern, _ in DURATIONS + TIMES:
            self.assertTrue(any(re.search(pattern, one.text) for _, one in outputs), pattern)
        self.assertEqual(len(MADE_ELSEWHERE), sum(is_made_elsewhere(page, one) for page, one in outputs))

    def test_every_table_is_called_text(self):
        for page in PAGES:
            for line, language, lines, _ in pages.code_blocks(pages.GENERATED.sub("", (ROOT / page).read_text())):
                if language != "text":
                    self.assertFalse(any(re.fullmatch(r"\s*-{3,}(\s+-{3,})+\s*", each) for each in lines), f"{page}: {lines}")


def add_test(page):
    name = "test_" + re.sub(r"\W", "_", page)
    setattr(Commands, name, lambda self: self.run_page(page))


asked = [word for word in sys.argv[1:] if not word.startswith("-")]
for each in asked or PAGES:
    add_test(each)

if __name__ == "__main__":
    unittest.main(argv=[word for word in sys.argv if word not in asked], verbosity=2)
