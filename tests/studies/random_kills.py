#!/usr/bin/env python3
"""Random SIGKILLs over `rcme run --shard` and `rcme merge`: is anything lost or doubled?

    tests/studies/random_kills.py PATH_OF_RCME [--kills 500] [--seed 1] [--keep counts]

Eight shards are run, each killed at random times again and again: after every kill its file has to be sound, with no fewer
trials than before. Then merges are killed at random times: the merged file is there whole or not at all, and what is left
behind hinders nobody. At the end the merged run has to have the bytes of one that was left in peace. Half of the kills go to
runs, half to merges."""

import argparse
import pathlib
import random
import re
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
"""
NUM_SHARDS = 8


def killed_after(command, seconds):
    """Starts a program and kills it; true if the kill came before its end."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(seconds)
    process.kill()
    return process.wait() == -9


def num_trials(rcme, path):
    """How many trials a part holds; it has to be sound."""
    said = subprocess.run([rcme, "check", str(path)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    found = re.search(r"sound: (?:the counts of )?(\d+) trials", said.stdout)
    if found:
        return int(found.group(1))
    assert "is not an rcme result file" in said.stdout, said.stdout  # killed before its tables were made
    return 0


def summary(rcme, path, keep):
    forms = [["--format", "csv"], ["--format", "json"]] + ([["--raw", "csv"]] if keep == "all" else [])
    return [subprocess.run([rcme, "summarize", str(path), *form], check=True, stdout=subprocess.PIPE).stdout
            for form in forms]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rcme")
    parser.add_argument("--kills", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--trials", type=int, default=20000)
    parser.add_argument("--keep", choices=["all", "counts"], default="all")
    arguments = parser.parse_args()
    rcme, chance = arguments.rcme, random.Random(arguments.seed)
    with tempfile.TemporaryDirectory(prefix="rcme_kills_") as name:
        folder = pathlib.Path(name)
        study = folder / "study.yaml"
        study.write_text(STUDY.format(trials=arguments.trials))
        parts = [folder / f"part_{number}.sqlite" for number in range(1, NUM_SHARDS + 1)]
        run = [[rcme, "run", str(study), "--shard", f"{i + 1}/{NUM_SHARDS}", "--threads", "1", "--keep", arguments.keep,
                "--out", str(part)]
               for i, part in enumerate(parts)]
        held, killed, ended = [0] * NUM_SHARDS, 0, 0
        while killed < arguments.kills // 2:
            i = chance.randrange(NUM_SHARDS)
            if not killed_after(run[i], chance.uniform(0.0, 1.2)):
                ended += 1
                if ended % 20 == 0:  # all are whole: begin again
                    parts[chance.randrange(NUM_SHARDS)].unlink(missing_ok=True)
                    held = [num_trials(rcme, part) if part.exists() else 0 for part in parts]
                continue
            killed += 1
            now = num_trials(rcme, parts[i]) if parts[i].exists() else 0
            assert now >= held[i], f"shard {i + 1}: {held[i]} trials before the kill, {now} after it"
            held[i] = now
        print(f"run: {killed} kills, {ended} calls ended before theirs; no committed trial was lost", flush=True)
        for command in run:
            subprocess.run(command, check=True, stderr=subprocess.DEVNULL)

        merged, killed, ended = folder / "run.sqlite", 0, 0
        merge = [rcme, "merge", *map(str, parts), "--out", str(merged)]
        begin = time.monotonic()
        subprocess.run(merge, check=True, stderr=subprocess.DEVNULL)
        duration = time.monotonic() - begin
        merged.unlink()
        while killed < arguments.kills - arguments.kills // 2:
            was_killed = killed_after(merge, chance.uniform(0.0, duration))
            killed, ended = killed + was_killed, ended + (not was_killed)
            if merged.exists():  # whole, although the kill may have come between the renaming and the end
                assert num_trials(rcme, merged) == 2 * arguments.trials
                merged.unlink()
        subprocess.run(merge, check=True, stderr=subprocess.DEVNULL)
        print(f"merge: {killed} kills, {ended} calls ended before theirs; the file was whole or not there", flush=True)
        whole = folder / "whole.sqlite"
        subprocess.run([rcme, "run", str(study), "--out", str(whole), "--keep", arguments.keep], check=True, stderr=subprocess.DEVNULL)
        same = summary(rcme, merged, arguments.keep) == summary(rcme, whole, arguments.keep)
        print(f"the merged run has the bytes of one run: {same}")
        assert same


if __name__ == "__main__":
    main()
