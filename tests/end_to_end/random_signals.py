#!/usr/bin/env python3
"""Random signals over every command that writes files: is there ever half a file under a final name?

    tests/end_to_end/random_signals.py PATH_OF_RCME [--signals 300] [--seed 1] [--of run merge ...] [--without plot ...]
                                       [--long]

SIGKILL, SIGTERM or SIGINT comes at a random moment, half of them in the last fifth of the time a call takes, when files are
written. After it every file that is there has the bytes that a call left in peace gives, or those it had before; a result
file of `rcme run` and `import`, which grows under its name, is sound to `rcme check`, or has not begun. A command that keeps unfinished work goes
on with it: what the checkpoint held is in the next one, with the time that it took, so that nothing kept is computed twice. At the end of a command's
share it is called once more: then everything is there and nothing temporary is left.

--long: the commands that keep unfinished work alone, each with work of several seconds, of which a call gets so little that most signals cut one
that goes on with kept work. Whenever a command comes to its end, what it has written is compared with what a call left in peace wrote; of result
files what `rcme summarize` tells of them."""

import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

STUDY = {
    "name": "signals", "seed": 9, "trials": 30,
    "data": {"scene": "uniform_volume", "num_matches": 60, "sigma_px": 0.5},
    "factors": {"outlier_ratio": [0.1, 0.4]},
    "estimators": [{"name": "standard", "options": {"num_iterations": 20}},
                   {"name": "rcme", "options": {"num_iterations": 20, "reading": "rank_aware"}}],
    "tune": {"estimator": "rcme", "target": "failure", "at_most": 0.3, "max_refusal": 0.9, "explore": 25, "calibrate": 47,
             "verify": 33, "options": {"mu": [1, 2, 3, 6]}},
}
SIGNALS = [signal.SIGKILL, signal.SIGTERM, signal.SIGINT]
CHECKPOINT = "unfinished.part"
TEMPORARY = re.compile(r"\.rcme-[^/]*\.part$|-journal$|\.journal$|unfinished\.part$")
OLD = b"what was there before\n"


class Inputs:
    """What the commands read, made once."""

    def __init__(self, rcme, folder):
        self.rcme, self.folder = rcme, folder
        self.study, self.run_file = folder / "study.yaml", folder / "run.sqlite"
        self.study.write_text(json.dumps(STUDY))
        self.call("run", self.study, "--out", self.run_file, "--threads", "1")
        self.parts = [folder / f"part_{number}.sqlite" for number in (1, 2)]
        for number, part in enumerate(self.parts, 1):
            self.call("run", self.study, "--shard", f"{number}/2", "--out", part, "--threads", "1")
        self.pieces = [folder / f"piece_{number}.json" for number in (1, 2)]
        for number, part in enumerate(self.pieces, 1):
            self.call("map", "--trials", "3", "--shard", f"{number}/2", "--out", part, "--threads", "1")
        self.damaged = folder / "damaged.sqlite"
        self.call("run", self.study, "--out", self.damaged, "--threads", "1", "--trials", "1500")
        bytes_ = bytearray(self.damaged.read_bytes())
        bytes_[-100] ^= 1
        self.damaged.write_bytes(bytes_)
        self.summary = folder / "summary.csv"
        self.call("summarize", self.run_file, "--format", "csv", "--out", self.summary)
        self.exported = folder / "exported"
        self.call("export", self.study, "--trials", "6", "--out", self.exported)
        self.answers = folder / "answers.jsonl"
        ids = [json.loads(line)["id"] for line in (self.exported / "problems.jsonl").read_text().splitlines()]
        self.answers.write_text("".join(json.dumps({"id": one, "status": "too_uncertain"}) + "\n" for one in ids))
        self.pairs = folder / "pairs"
        shutil.copytree(self.exported / "matches", self.pairs)

        begin = time.monotonic()
        self.call("list", "scenes")
        self.start_seconds = time.monotonic() - begin  # until a call begins its work, about

    def call(self, *arguments):
        subprocess.run([self.rcme, *map(str, arguments)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)


class Command:
    """A command with an output in a folder of its own."""

    def __init__(self, name, arguments, grows=False, codes=(0,), may_differ=False, is_new=False, resumes=False, longer=()):
        self.name, self.arguments, self.codes = name, arguments, codes
        self.grows = grows  # a result file, sound at every moment
        self.may_differ = may_differ  # times are in it: other bytes from call to call, but as many lines
        self.is_new = is_new  # it replaces nothing
        self.resumes = resumes  # it keeps unfinished work in a checkpoint
        self.longer = longer  # options that make it a work of several seconds


def commands(inputs):
    study, run, base = inputs.study, inputs.run_file, ["--threads", "1"]
    tuning = ["tune", study, *base]
    trials_to_tune = ["--tune", "explore=250", "--tune", "calibrate=470", "--tune", "verify=330"]
    return [
        Command("run", lambda out: ["run", study, "--out", out / "run.sqlite", *base], grows=True, longer=["--trials", "2000"]),
        Command("run_until", lambda out: ["run", study, "--until", "ci=0.1", "--max-trials", "150", "--out", out / "run.sqlite", *base],
                grows=True, longer=["--until", "ci=0.015", "--max-trials", "4000"]),
        Command("run_counts", lambda out: ["run", study, "--keep", "counts", "--out", out / "run.sqlite", *base], grows=True,
                longer=["--trials", "2000"]),
        Command("import", lambda out: ["import", inputs.answers, "--study", inputs.exported / "study.yaml", "--label", "mine",
                                       "--out", out / "run.sqlite", *base], grows=True),
        Command("save_good", lambda out: ["check", inputs.damaged, "--save-good", out / "saved.sqlite"], is_new=True),
        Command("merge", lambda out: ["merge", *inputs.parts, "--out", out / "merged.sqlite"], is_new=True),
        Command("merge_pieces", lambda out: ["merge", *inputs.pieces, "--partial", "--out", out / "merged.json"]),
        Command("summarize", lambda out: ["summarize", run, "--format", "csv", "--out", out / "summary.csv"]),
        Command("summarize_raw", lambda out: ["summarize", run, "--raw", "csv", "--out", out / "raw.csv"]),
        Command("failures", lambda out: ["failures", run, "--limit", "0", "--format", "csv", "--out", out / "failures.csv"]),
        Command("replay", lambda out: ["replay", run, "--condition", "0", "--trial", "1", "--emit-cpp", out / "trial.cc"]),
        Command("ask", lambda out: ["ask", "--image", "640x480", "--focal", "500", "--noise", "0.5", "--scene", "plane", "--wrong", "0.2",
                                    "--matches", "60", "--trials", "10", *base, "--out", out], grows=True),
        Command("compare", lambda out: ["compare", run, "--format", "json", "--out", out / "comparison.json"]),
        Command("reliability", lambda out: ["reliability", run, "--out", out / "reliability.txt"], codes=(0, 2)),
        Command("report", lambda out: ["report", run, "--out", out / "report.html"]),
        Command("plot", lambda out: ["plot", "failure_rate", inputs.summary, "--x", "outlier_ratio", "--out", out / "figure"]),
        Command("show", lambda out: ["show", run, "--condition", "0", "--trial", "1", "--out", out / "trial", "--json",
                                     out / "trial.json"]),
        Command("audit", lambda out: ["audit", "--only", "sample_test.power", *base, "--out", out], resumes=True,
                longer=["--only", "sample_test"]),
        Command("audit_shard", lambda out: ["audit", "--only", "sample_test.power", *base, "--shard", "1/2", "--out",
                                            out / "part.json"], may_differ=True, is_new=True),
        Command("tune", lambda out: [*tuning, "--out", out / "tuned.yaml"], resumes=True, longer=trials_to_tune),
        Command("tune_repeat", lambda out: [*tuning, "--repeat", "3", "--out", out / "repeated.txt"], resumes=True,
                longer=["--repeat", "30"]),
        Command("tune_shard", lambda out: [*tuning, "--shard", "1/2", "--out", out / "part.json"], codes=(75,),
                may_differ=True, is_new=True),
        Command("transfer", lambda out: ["transfer", study, *base, "--out", out], resumes=True, longer=trials_to_tune),
        Command("map", lambda out: ["map", "--trials", "2", *base, "--out", out], resumes=True, longer=["--trials", "10"]),
        Command("map_shard", lambda out: ["map", "--trials", "2", *base, "--shard", "1/2", "--out", out / "part.json"],
                may_differ=True, is_new=True),
        Command("rare", lambda out: ["rare", study, "--set", "outlier_ratio=0.4", "--replicates", "4", "--particles", "20", "--moves", "2",
                                     *base, "--out", out], resumes=True, longer=["--replicates", "1500"]),
        Command("rare_stratified", lambda out: ["rare", study, "--method", "stratified", "--trials", "1000", *base, "--out", out],
                resumes=True, longer=["--trials", "10000"]),
        Command("budget", lambda out: ["budget", study, "--time-ms", "0.2", "--calls", "1", "--out", out / "study.yaml"],
                may_differ=True),
        Command("solve", lambda out: ["solve", study, "--over", "outlier_ratio", "--trials", "300", *base, "--out", out], resumes=True,
                longer=["--trials", "6000"]),
        Command("integrity", lambda out: ["integrity", study, "--estimator", "standard", "--risk", "0.4", "--trials", "150", *base,
                                          "--out", out], codes=(0, 1, 3), resumes=True, longer=["--trials", "6000"]),
        Command("model_choice", lambda out: ["model-choice", "model_choice", "--trials", "1", *base, "--out", out], resumes=True,
                longer=["--trials", "10"]),
        Command("paper_table", lambda out: ["paper-table", run, "--out", out], codes=(0, 2)),
        Command("export", lambda out: ["export", study, "--trials", "20", "--out", out]),
        Command("pairs", lambda out: ["pairs", inputs.pairs, "--layout", "matches", "--gate", "off", "--out", out], is_new=True),
        Command("twin", lambda out: ["twin", inputs.pairs, "--twins", "1", "--out", out], codes=(0, 2), resumes=True,
                longer=["--twins", "4"]),
        Command("validate", lambda out: ["validate", inputs.pairs, "--twins", "1", "--no-figure", "--out", out],
                codes=(0, 1, 2), resumes=True, longer=["--twins", "4"]),
        Command("man", lambda out: ["man", "--out", out]),
    ]


def with_options(call, options):
    """The call with these options in place of its own of the same names; all of a name if it is there more than once."""
    call = list(map(str, call))
    for name in dict.fromkeys(options[::2]):
        while name in call:
            at = call.index(name)
            del call[at:at + 2]
    return call + list(options)


def files_in(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*"))
            if path.is_file() and not TEMPORARY.search(path.name)}


def kept_in(folder):
    """What the checkpoint holds: the whole line of every item, its time in it, without the checksum."""
    kept = {}
    for path in folder.rglob("*" + CHECKPOINT):
        for line in path.read_text().splitlines()[1:]:
            item = json.loads(line)
            kept[item["group"], item["piece"]] = item["seconds"], item["result"]
    return kept


class Victim:
    """One command, called in peace first, then killed again and again in another folder."""

    def __init__(self, inputs, command, is_long):
        self.rcme, self.command, self.is_long = inputs.rcme, command, is_long
        self.start_seconds = inputs.start_seconds
        self.share = 0.2  # of a long command, that a call gets at most: adapted to what the machine does
        self.whole, self.cut = (inputs.folder / f"{command.name}_{which}" for which in ("whole", "cut"))
        begin = time.monotonic()
        ended = self.call(self.whole)
        self.duration = time.monotonic() - begin
        assert ended.returncode in command.codes, f"{command.name}: {ended.returncode}: {ended.stderr}"
        self.expected, self.told = files_in(self.whole), self.tell(self.whole)
        self.num_cut = self.num_ended = self.num_resumed = 0
        self.begin_again()

    def start(self, out):
        out.mkdir(exist_ok=True)
        call = with_options(self.command.arguments(out), self.command.longer if self.is_long else [])
        return subprocess.Popen([self.rcme, *call], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def call(self, out):
        process = self.start(out)
        _, err = process.communicate()
        return subprocess.CompletedProcess([], process.returncode, err, err)

    def begin_again(self):
        self.kept = {}
        shutil.rmtree(self.cut, ignore_errors=True)
        self.cut.mkdir()
        if self.command.grows or self.command.is_new:
            return
        for name in self.expected:  # to be replaced
            (self.cut / name).parent.mkdir(parents=True, exist_ok=True)
            (self.cut / name).write_bytes(OLD)

    def halves(self):
        """What is under a final name, neither whole nor as it was before."""
        found = files_in(self.cut)
        if self.command.grows:
            return [name for name in found if not self.is_sound(self.cut / name)]
        return [name for name, bytes_ in found.items() if bytes_ != OLD and not self.is_whole(name, bytes_)]

    def is_whole(self, name, bytes_):
        expected = self.expected.get(name)
        if expected is None:
            return False
        if not self.command.may_differ:
            return bytes_ == expected
        lines = bytes_.split(b"\n")
        if lines[0].startswith(b'{"format": "rcme part'):  # a part grows from one whole file to the next
            return lines[-1] == b"" and json.loads(lines[0])["num_pieces"] == len(lines) - 2
        return len(lines) == len(expected.split(b"\n")) and lines[-1] == expected.split(b"\n")[-1]

    def tell(self, folder):
        """What a result file says, without times; nothing of other commands."""
        path = folder / "run.sqlite"
        if not self.command.grows or not path.exists():
            return ""
        return subprocess.run([self.rcme, "summarize", str(path), "--format", "csv"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, check=False).stdout

    def is_sound(self, path):
        checked = self.check(path)
        return ": sound: " in checked or "is not an rcme result file" in checked

    def check(self, path):
        return subprocess.run([self.rcme, "check", str(path)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              check=False).stdout

    def moment(self, chance):
        if self.is_long:
            return self.start_seconds + chance.uniform(0.0, self.share) * max(self.duration - self.start_seconds, 0.1)
        return self.duration * (chance.uniform(0.8, 1.1) if chance.random() < 0.5 else chance.random())

    def send(self, chance):
        """One signal; the halves that it left."""
        moment = self.moment(chance)
        process = self.start(self.cut)
        time.sleep(moment)
        sent = chance.choice(SIGNALS)
        process.send_signal(sent)
        process.communicate()
        was_cut = process.returncode not in self.command.codes
        self.num_cut, self.num_ended = self.num_cut + was_cut, self.num_ended + (not was_cut)
        halves = [f"{self.command.name}: {sent.name} after {moment:.3f} s: {name}" for name in self.halves()]
        if was_cut and (self.command.resumes or self.command.grows) and not halves:
            return self.go_on(f"{self.command.name}: {sent.name} after {moment:.3f} s", sent)
        if not was_cut and self.is_long:
            self.share *= 0.6
            halves += self.missing()
        if not was_cut or halves or not self.command.grows:
            leftover = [path for path in self.cut.rglob("*") if path.is_file() and TEMPORARY.search(path.name)]
            self.begin_again()
            for path in leftover:  # so that the last call has something to clean up
                if path.name.endswith(".part"):
                    path.parent.mkdir(parents=True, exist_ok=True)
                    path.write_bytes(b"half of it")
        return halves

    def go_on(self, when, sent):
        """What the checkpoint has lost, or computed once more."""
        kept = self.trials_in() if self.command.grows else kept_in(self.cut)
        lost = [item for item, result in self.kept.items() if kept.get(item) != result]
        self.num_resumed += bool(self.kept)
        if sent != signal.SIGKILL and len(kept) == len(self.kept):  # it did not come to its work
            self.share = min(1.5 * self.share, 1.0)
        self.kept = kept
        return [f"{when}: {len(lost)} items that were kept are lost or were computed again"] if lost else []

    def trials_in(self):
        """The trials of a result file, by number."""
        path = self.cut / "run.sqlite"
        found = re.search(r": sound: (?:the counts of )?(\d+) trials", self.check(path)) if path.exists() else None
        return {number: True for number in range(int(found[1]))} if found else {}

    def missing(self):
        """Of a command that came to its end."""
        wrong = [f"{name} is missing" for name in sorted(set(self.expected) - set(files_in(self.cut)))]
        if self.tell(self.cut) != self.told:
            wrong.append("the result file tells something else than that of one call")
        return [f"{self.command.name}: {what}" for what in wrong]

    def finish(self):
        """What is wrong after one more call that is left in peace."""
        ended = self.call(self.cut)
        wrong = [] if ended.returncode in self.command.codes else [f"ends with {ended.returncode}: {ended.stderr}"]
        left = [path.name for path in self.cut.rglob("*") if path.name.endswith(".part")]
        wrong += [f"{name} was left behind" for name in left]
        wrong += [*self.missing(), *(f"{name} is half" for name in self.halves())]
        return [f"{self.command.name}: after a last call: {what}" for what in wrong]


def signal_in_turn(victims, number, seed):
    """Every victim has its own folder and its own chances: they are signalled side by side, the results do not depend on it."""
    def all_of(index):
        chance, wrong = random.Random(f"{seed} {victims[index].command.name}"), []
        for _ in range(index, number, len(victims)):
            wrong += victims[index].send(chance)
        return wrong, victims[index].finish()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(all_of, range(len(victims))))
    return [one for halves, _ in results for one in halves], [one for _, wrong in results for one in wrong]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rcme")
    parser.add_argument("--signals", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--of", nargs="+")
    parser.add_argument("--without", nargs="+", default=[])
    parser.add_argument("--long", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="rcme_signals_") as name:
        inputs = Inputs(str(pathlib.Path(arguments.rcme).resolve()), pathlib.Path(name))
        chosen = [command for command in commands(inputs) if (not arguments.of or command.name in arguments.of)
                  and command.name not in arguments.without and (not arguments.long or command.longer)]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            victims = list(pool.map(lambda command: Victim(inputs, command, arguments.long), chosen))
        halves, wrong = signal_in_turn(victims, arguments.signals, arguments.seed)
    print("| command | signals that cut it | that cut a call with kept work | that came after its end |\n|---|---|---|---|")
    for victim in victims:
        print(f"| {victim.command.name} | {victim.num_cut} | {victim.num_resumed} | {victim.num_ended} |")
    sums = [sum(getattr(victim, name) for victim in victims) for name in ("num_cut", "num_resumed", "num_ended")]
    print("| all | {} | {} | {} |".format(*sums))
    if sums[0] == 0:
        wrong.append("no signal cut a command: all came after its end")
    print("\n".join(halves + wrong))
    print(f"{arguments.signals} signals: {len(halves)} half files, losses or repetitions; {len(wrong)} things wrong after a last call")
    sys.exit(bool(halves or wrong))


if __name__ == "__main__":
    main()
