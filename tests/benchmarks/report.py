#!/usr/bin/python3
"""Prints the ratios of build/benchmarks.json and compares them with a committed baseline.

A regression is flagged (exit code 1) only where the whole interval of now lies beyond the baseline's interval by more
than a margin; what the margin is for is said at MARGIN. Ratios are compared, never times. They belong to a processor as
well: OpenCV's RANSAC over rcme was 18.5 on one and 28.5 on another with the same instruction set and the same programs.
So there is a baseline for each, and a processor without one is told so.
"""

import argparse
import json
import os
import pathlib
import re
import sys

# A median's interval covers the scatter of one run's rounds, not what differs between runs: neighbours in the shared
# cache, the clock's frequency under wide vectors, where the program lies in memory. Six runs of the same program, load
# average 0.7 to 4.3 on two cores, gave medians up to 21 % apart (rcme_vs_reference 64 to 78; the ratios to OpenCV 14 %,
# shares of the peak 12 %). Each compared with each, 30 times all ratios but that of threads: 3 false alarms with no
# margin, 1 with 5 %, none from 10 % on. An rcme with twice the hypotheses (1.5 times the time) was flagged.
MARGIN = 0.25
# Absolute: exponents of those runs differed by up to 0.04.
EXPONENT_MARGIN = 0.1
# Two threads need two idle cores; above this load at the start their ratio says something of the machine's other work.
MAX_LOAD_FOR_THREADS = 0.5

# What a result must hold. Others (PoseLib's, where it is installed) are printed, and compared where both sides have them.
REQUIRED = (
    "rcme_vs_opencv_ransac_200", "rcme_vs_opencv_usac_magsac", "rcme_vs_reference", "standard_vs_opencv_ransac_200",
    "trial_vs_rcme_call", "two_threads_vs_one", "printed_score_fma_peak", "rank_aware_score_fma_peak",
    "exponent_n", "exponent_iterations", "exponent_trials",
)


class ReportError(Exception):
    """Something the user can put right; its text is one sentence that names the file, the thing and what is allowed."""


def is_exponent(name):
    return name.startswith("exponent_")


def smaller_is_better(name):
    return is_exponent(name) or name == "trial_vs_rcme_call"


def read(path):
    """The JSON object of a file with every required ratio, each with a finite interval around it."""
    try:
        with open(path, encoding="utf-8") as file:
            content = json.load(file)
    except (OSError, ValueError) as error:
        raise ReportError(f"{path}: cannot be read as JSON ({error}).") from error
    ratios, intervals = content.get("ratios", {}), content.get("intervals", {})
    missing = [name for name in REQUIRED if name not in ratios]
    if missing:
        raise ReportError(f"{path}: ratios lacks {', '.join(missing)}; run scripts/benchmark.")
    for name, value in ratios.items():
        bounds = intervals.get(name, {})
        numbers = (bounds.get("lower"), value, bounds.get("upper"))
        if not all(isinstance(number, (int, float)) for number in numbers) or sorted(numbers) != list(numbers):
            raise ReportError(f"{path}: {name} must be a number within intervals.{name}, lower to upper.")
    for key in ("processor", "instruction_set", "load_average_at_start"):
        if key not in content.get("run", {}):
            raise ReportError(f"{path}: run lacks {key}; run scripts/benchmark.")
    return content


def baseline_path(folder, now):
    """The baseline of the processor and the instruction set of a result."""
    run = now["run"]
    return folder / (re.sub(r"[^A-Za-z0-9]+", "_", f"{run['processor']}_{run['instruction_set']}") + ".json")


def limit_of(name, baseline):
    """The value beyond which an interval as a whole is a regression."""
    bounds = baseline["intervals"][name]
    if is_exponent(name):
        return bounds["upper"] + EXPONENT_MARGIN
    return bounds["upper"] * (1 + MARGIN) if smaller_is_better(name) else bounds["lower"] / (1 + MARGIN)


def is_beyond(name, bounds, limit):
    return bounds["lower"] > limit if smaller_is_better(name) else bounds["upper"] < limit


def regressions(now, baseline):
    """A sentence for each ratio that has become worse by more than the margin."""
    found = []
    for name, value in now["ratios"].items():
        if name not in baseline["ratios"] or reason_not_to_compare(name, now, baseline):
            continue
        bounds, limit = now["intervals"][name], limit_of(name, baseline)
        if is_beyond(name, bounds, limit):
            side = "above" if smaller_is_better(name) else "below"
            found.append(f"regression: {name} is {value:.3g} [{bounds['lower']:.3g}, {bounds['upper']:.3g}], wholly {side} "
                         f"{limit:.3g}; the baseline is {baseline['ratios'][name]:.3g}.")
    return found


def reason_not_to_compare(name, now, baseline):
    """Why a ratio cannot be compared; empty if it can."""
    load = max(now["run"]["load_average_at_start"], baseline["run"]["load_average_at_start"])
    if name == "two_threads_vs_one" and load > MAX_LOAD_FOR_THREADS:
        return (f"Not compared: two_threads_vs_one, because the load average was {load:.2f} before a run; "
                f"it needs two idle cores (at most {MAX_LOAD_FOR_THREADS:g}).")
    return ""


def ratio_lines(now, baseline):
    yield f"{'ratio':<32} {'median':>8}   {'95 % interval':<20} {'baseline':>8}"
    for name, value in now["ratios"].items():
        bounds = now["intervals"][name]
        interval = f"[{bounds['lower']:.3g}, {bounds['upper']:.3g}]"
        before = f"{baseline['ratios'][name]:8.3g}" if baseline and name in baseline["ratios"] else f"{'-':>8}"
        yield f"{name:<32} {value:8.3g}   {interval:<20} {before}"


def arm_lines(now):
    yield f"{'case':<42} {'us':>9}   {'95 % interval':<20} {'reference / fast':>16}"
    for case in now["cases"]:
        time = case["microseconds"]
        stage, _, variant = case["name"].partition("/")
        speedup = f"{now['speedups'][stage]['median']:16.3g}" if variant == "fast" else ""
        interval = f"[{time['lower']:.4g}, {time['upper']:.4g}]"
        yield f"{case['name']:<42} {time['median']:9.4g}   {interval:<20} {speedup}".rstrip()


def report(now, baseline):
    """All lines to print for a result."""
    run = now["run"]
    yield (f"{run['problem']}; {run['rounds']} interleaved rounds; {run['clock']}; {run['processor']}, {run['instruction_set']}, "
           f"{run['cores']} cores, load average {run['load_average_at_start']:.2f} before.")
    yield f"PoseLib: {run['poselib']}."
    yield ""
    yield from arm_lines(now)
    yield ""
    yield from ratio_lines(now, baseline)
    yield ""


def verdict(now, baseline):
    """The lines of the comparison, and whether there is a regression."""
    if baseline is None:
        run = now["run"]
        return [f"No baseline for {run['processor']} with {run['instruction_set']}: nothing is compared. "
                "On an idle machine, scripts/benchmark --update-baseline makes one."], False
    found = regressions(now, baseline)
    notes = [note for note in [reason_not_to_compare("two_threads_vs_one", now, baseline)] if note]
    return [*notes, *(found or [f"No regression against the baseline (margin {MARGIN:.0%})."])], bool(found)


def write_baseline(now, path):
    """Ratios and what they hold for; no times."""
    kept = {"run": {key: now["run"][key] for key in ("processor", "instruction_set", "cores", "rounds", "load_average_at_start")},
            "ratios": now["ratios"], "intervals": now["intervals"]}
    temporary = f"{path}.{os.getpid()}.tmp"
    with open(temporary, "w", encoding="utf-8") as file:
        file.write(json.dumps(kept, indent=1) + "\n")
    os.replace(temporary, path)


def run(arguments):
    now = read(arguments.result)
    path = baseline_path(arguments.baselines, now)
    if arguments.update_baseline:
        print("\n".join(report(now, None)))
        write_baseline(now, path)
        print(f"baseline: {path}")
        return 0
    baseline = read(path) if path.exists() else None
    print("\n".join(report(now, baseline)))
    lines, is_worse = verdict(now, baseline)
    print("\n".join(lines))
    return 1 if is_worse else 0


def main(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("result", help="what rcme_ratios wrote")
    parser.add_argument("--baselines", required=True, type=pathlib.Path, help="folder of baselines, a JSON file per processor")
    parser.add_argument("--update-baseline", action="store_true", help="write the ratios as this processor's; compare nothing")
    try:
        return run(parser.parse_args(argv))
    except ReportError as error:
        print(f"report: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
