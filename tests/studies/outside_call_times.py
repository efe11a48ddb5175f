"""What a call of an estimator outside the program costs, by each way in: the same estimator of OpenCV as a function, as a process
and imported, and one that does nothing. Prints a table of docs/estimators_in_any_language.md.

    PYTHONPATH=build/release/python RCME=build/release/bin/rcme /usr/bin/python3 tests/studies/outside_call_times.py
"""

import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
import rcme

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples/any_language/opencv_estimator.py"
NOTHING = """import sys
for line in sys.stdin:
    print('{"id": "%s", "status": "no_candidate"}' % line.split('"id":"', 1)[1].split('"', 1)[0], flush=True)
"""
STUDY = {"name": "outside_call_times", "trials": 200, "data": {"scene": "uniform_volume", "num_matches": 500,
                                                              "outlier_ratio": 0.2, "severity": "skipped"},
         "estimators": [{"name": "standard"}]}
WORDS = {"opencv_function": "OpenCV, function", "opencv_process": "OpenCV, process (what it says of itself)", "opencv_import": "OpenCV, import (what was said, and looking it up)",
         "nothing_function": "nothing, function", "nothing_process": "nothing, process (Python)", "standard": "standard, within"}


def example():
    spec = importlib.util.spec_from_file_location("opencv_estimator", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.estimate


def do_nothing(*arguments):
    return None


def write(path, text):
    path.write_text(text)
    return str(path)


def answers_of(folder):
    """Those of the example, made elsewhere."""
    study = write(folder / "exported.yaml", json.dumps(STUDY))
    subprocess.run([os.environ["RCME"], "export", study, "--out", folder / "problems"], check=True, capture_output=True)
    with open(folder / "problems/problems.jsonl") as problems, open(folder / "answers.jsonl", "w") as out:
        subprocess.run([sys.executable, EXAMPLE], stdin=problems, stdout=out, check=True)
    return str(folder / "answers.jsonl")


def run_seconds(estimators, threads):
    start = time.monotonic()
    rcme.run(STUDY, estimators, threads=threads)
    return time.monotonic() - start


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        nothing = write(folder / "nothing.py", NOTHING)
        estimators = {
            "opencv_function": example(), "nothing_function": do_nothing,
            "opencv_process": write(folder / "a.yaml", f"process: '{sys.executable} {EXAMPLE}'\n"),
            "nothing_process": write(folder / "b.yaml", f"process: '{sys.executable} {nothing}'\n"),
            "opencv_import": write(folder / "c.yaml", f"answers: {answers_of(folder)}\n"),
        }
        frame = rcme.summarize(rcme.run(STUDY, estimators, threads=1, allow_process=True), times=True, pooled=True)
    times = frame[frame.quantity == "time_ms"].set_index("estimator")
    print("| estimator, way | median time of a call (ms) | 95 % | n |\n|---|---|---|---|")
    for label, words in WORDS.items():
        row = times.loc[label]
        print(f"| {words} | {row.value:.3f} | {row.lower:.3f} to {row.upper:.3f} | {row.n} |")
    seconds = [run_seconds({"nothing": do_nothing}, threads) for _ in range(5) for threads in (1, 2)]
    ratios = np.array(seconds[::2]) / np.array(seconds[1::2])
    print(f"nothing, function: a run on two threads is {np.median(ratios):.2f} times as fast as on one "
          f"({min(ratios):.2f} to {max(ratios):.2f} in 5 pairs of runs)")


if __name__ == "__main__":
    main()
