#!/usr/bin/env python3
"""Random SIGKILLs over `rcme run`, `merge`, `tune`, `audit` and `map` in shards: is anything lost or doubled?

    tests/studies/random_kills.py PATH_OF_RCME [--kills 640] [--seed 1] [--keep counts]

Eight shards of a run, of a tuning, of an audit and of a map are killed at random times again and again: after every kill the part has
to be sound, with no fewer trials or pieces than before. Then merges are killed: what they make is there whole or not at all,
and what is left behind hinders nobody. At the end what the parts give has to have the bytes of one call that was left in
peace. A fifth of the kills goes to each of the five; those of tune are half its shards', half its merge's, those of audit half
of its first round, half of its second."""

import argparse
import json
import pathlib
import random
import re
import resource
import subprocess
import tempfile
import time

STUDY = """name: kills
seed: 9
trials: {trials}
data: {{scene: uniform_volume, num_matches: 60, sigma_px: 0.5}}
factors:
  outlier_ratio: [0.1, 0.4]
estimators:
  - {{name: standard, options: {{num_iterations: 20}}}}
  - {{name: rcme, options: {{num_iterations: 20, reading: rank_aware}}}}
tune:
  estimator: rcme
  target: failure
  at_most: 0.3
  max_refusal: 0.9
  explore: 100
  calibrate: 205
  verify: 150
  options: {{mu: [1, 2, 3, 6]}}
"""
CLAIMS = "sample_test,inlier.own_point"
NUM_SHARDS = 8
WORKS = ["run", "tune", "audit", "map"]
QUIET = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


def killed_after(command, seconds):
    """Starts a program and kills it; true if the kill came before its end."""
    process = subprocess.Popen(command, **QUIET)
    time.sleep(seconds)
    process.kill()
    return process.wait() == -9


def whole_call(command, codes=(0,)):
    ended = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    assert ended.returncode in codes, ended.stderr
    return ended.returncode


def num_trials(rcme, path):
    """How many trials a part of a run holds; it has to be sound."""
    said = subprocess.run([rcme, "check", str(path)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    found = re.search(r"sound: (?:the counts of )?(\d+) trials", said.stdout)
    if found:
        return int(found.group(1))
    assert "is not an rcme result file" in said.stdout, said.stdout  # killed before its tables were made
    return 0


def num_pieces(_, path):
    """How many pieces a part of a tuning or an audit holds."""
    first, *pieces = path.read_text(encoding="utf-8").splitlines()
    assert json.loads(first)["num_pieces"] == len(pieces)
    return len(pieces)


def summary(rcme, path, keep):
    forms = [["--format", "csv"], ["--format", "json"]] + ([["--raw", "csv"]] if keep == "all" else [])
    return [subprocess.run([rcme, "summarize", str(path), *form], check=True, stdout=subprocess.PIPE).stdout
            for form in forms]


def same_files(folder, other, *names):
    return all((folder / name).read_bytes() == (other / name).read_bytes() for name in names)


class Killer:
    """Kills calls at random times and keeps the account."""

    def __init__(self, rcme, seed):
        self.rcme, self.chance = rcme, random.Random(seed)

    def kill_shards(self, what, kills, parts, command, held_by, longest=60.0):
        """`command(i)` computes the shard i; `held_by` says how much its part holds."""
        begin = time.monotonic()
        whole_call(command(0), (0, 75))
        longest = min(longest, 1.5 * (time.monotonic() - begin))  # some calls are to end, so that there is something to lose
        held, killed, ended = [held_by(self.rcme, parts[0])] + [0] * (len(parts) - 1), 0, 0
        while killed < kills:
            i = self.chance.randrange(len(parts))
            if not killed_after(command(i), self.chance.uniform(0.0, longest)):
                ended += 1
                if ended % 5 == 0:  # before all are whole: begin one again
                    parts[self.chance.randrange(len(parts))].unlink(missing_ok=True)
                held = [held_by(self.rcme, part) if part.exists() else 0 for part in parts]
                continue
            killed += 1
            now = held_by(self.rcme, parts[i]) if parts[i].exists() else 0
            assert now >= held[i], f"{what}, shard {i + 1}: held {held[i]} before the kill, {now} after it"
            held[i] = now
        print(f"| {what} | {killed} | {ended} | no part that was not sound, none with less than before |", flush=True)
        assert any(held), f"{what}: no part ever held anything: the kills proved nothing"

    def kill_merges(self, what, kills, merge, merged, is_whole):
        begin = time.monotonic()
        whole_call(merge)
        duration = time.monotonic() - begin
        merged.unlink()
        killed, ended = 0, 0
        while killed < kills:
            was_killed = killed_after(merge, self.chance.uniform(0.0, duration))
            killed, ended = killed + was_killed, ended + (not was_killed)
            if merged.exists():  # whole, although the kill may have come between the renaming and the end
                assert is_whole(merged)
                merged.unlink()
        whole_call(merge)
        print(f"| {what} | {killed} | {ended} | what it makes was whole or not there |", flush=True)


def run_and_merge(killer, folder, study, kills, arguments):
    rcme = killer.rcme
    parts = [folder / f"part_{number}.sqlite" for number in range(1, NUM_SHARDS + 1)]

    def command(i):
        return [rcme, "run", str(study), "--shard", f"{i + 1}/{NUM_SHARDS}", "--threads", "1", "--keep", arguments.keep,
                "--out", str(parts[i])]
    killer.kill_shards("run", kills, parts, command, num_trials, 0.8)
    for i in range(NUM_SHARDS):
        whole_call(command(i))
    merged, whole = folder / "run.sqlite", folder / "whole.sqlite"
    killer.kill_merges("merge", kills, [rcme, "merge", *map(str, parts), "--out", str(merged)], merged,
                       lambda path: num_trials(rcme, path) == 2 * arguments.trials)
    whole_call([rcme, "run", str(study), "--out", str(whole), "--keep", arguments.keep])
    return summary(rcme, merged, arguments.keep) == summary(rcme, whole, arguments.keep)


def tune(killer, folder, study, kills):
    parts = [folder / f"tuning_{number}.json" for number in range(1, NUM_SHARDS + 1)]
    base = [killer.rcme, "tune", str(study), "--threads", "1"]

    def command(i, more=("--max-time", "0.15s")):  # so that the part grows from call to call
        there = [str(part) for part in parts if part.exists()]
        return [*base, "--shard", f"{i + 1}/{NUM_SHARDS}", "--out", str(parts[i]), *more,
                *(["--merged", *there] if there else [])]
    killer.kill_shards("tune --shard", kills - kills // 2, parts, command, num_pieces)
    for _ in range(2):  # both rounds
        for i in range(NUM_SHARDS):
            whole_call(command(i, ()), (0, 75))
    merged, whole = folder / "merged.yaml", folder / "whole.yaml"
    whole_call([*base, "--out", str(whole)])
    killer.kill_merges("tune --merge", kills // 2, [*base, "--merge", *map(str, parts), "--out", str(merged)], merged,
                       lambda path: path.read_bytes() == whole.read_bytes())
    return merged.read_bytes() == whole.read_bytes()


def audit(killer, folder, kills):
    parts = [folder / f"audit_{number}.json" for number in range(1, NUM_SHARDS + 1)]
    base = [killer.rcme, "audit", "--only", CLAIMS, "--threads", "1"]
    merged, whole, later = folder / "merged", folder / "whole", folder / "round.json"
    merge = [*base, "--merge", *map(str, parts), "--out", str(merged), "--round", str(later)]

    def command(i, more=("--max-time", "0.3s")):
        return [*base, "--shard", f"{i + 1}/{NUM_SHARDS}", "--out", str(parts[i]), *more,
                *(["--round", str(later)] if later.exists() else [])]
    for number in range(1, 16):
        if number <= 2:
            killer.kill_shards(f"audit --shard, round {number}", kills // 2, parts, command, num_pieces, 0.8)
        for i in range(NUM_SHARDS):
            whole_call(command(i, ()))
        if whole_call(merge, (0, 75)) == 0:
            break
    whole_call([*base, "--out", str(whole)])
    return number > 2 and same_files(merged, whole, "audit.json", "audit.md")


def map_of_validity(killer, folder, kills):
    parts = [folder / f"map_{number}.json" for number in range(1, NUM_SHARDS + 1)]
    base = [killer.rcme, "map", "--trials", "300", "--threads", "1"]
    merged, whole = folder / "merged_map", folder / "whole_map"

    def command(i, more=("--max-time", "0.3s")):
        return [*base, "--shard", f"{i + 1}/{NUM_SHARDS}", "--out", str(parts[i]), *more]
    killer.kill_shards("map --shard", kills, parts, command, num_pieces, 0.8)
    for i in range(NUM_SHARDS):
        whole_call(command(i, ()))
    whole_call([*base, "--out", str(whole)])
    whole_call([*base, "--merge", *map(str, parts), "--out", str(merged)])
    return same_files(merged, whole, "validity_map.csv", "validity_reference.csv")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rcme")
    parser.add_argument("--of", nargs="+", choices=WORKS, default=WORKS)
    parser.add_argument("--kills", type=int, default=640)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--trials", type=int, default=20000)
    parser.add_argument("--keep", choices=["all", "counts"], default="all")
    arguments = parser.parse_args()
    killer, kills = Killer(arguments.rcme, arguments.seed), arguments.kills // 5
    print("| what was killed | kills | calls that ended before theirs | after each |\n|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory(prefix="rcme_kills_") as name:
        folder = pathlib.Path(name)
        study = folder / "study.yaml"
        study.write_text(STUDY.format(trials=arguments.trials))
        works = {"run": lambda: run_and_merge(killer, folder, study, kills, arguments),
                 "tune": lambda: tune(killer, folder, study, kills), "audit": lambda: audit(killer, folder, kills),
                 "map": lambda: map_of_validity(killer, folder, kills)}
        same = {of: works[of]() for of in arguments.of}
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"\nthe bytes of one call: {same}; processor time {spent.ru_utime + spent.ru_stime:.0f} s")
    assert all(same.values())


if __name__ == "__main__":
    main()
