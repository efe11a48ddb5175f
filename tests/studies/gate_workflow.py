"""Runs the steps of examples/gate/github-workflow.yml as a runner of GitHub would: the shell of every step, in a clean
clone of the commit, with a baseline that the program of the clone has made. Prints what each step ended with.

    gate_workflow.py [--program build/release/bin/rcme]      with a program, nothing is built"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(line, folder, environment):
    return subprocess.run(["bash", "-e", "-o", "pipefail", "-c", line], cwd=folder, env=environment).returncode


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program")
    parser.add_argument("--trials", default="250", help="per condition of the baseline")
    arguments = parser.parse_args()
    workflow = yaml.safe_load((ROOT / "examples/gate/github-workflow.yml").read_text())
    job = workflow["jobs"]["gate"]
    with tempfile.TemporaryDirectory() as scratch:
        clone, summary = pathlib.Path(scratch) / "clone", pathlib.Path(scratch) / "summary.md"
        subprocess.run(["git", "clone", "--quiet", str(ROOT), str(clone)], check=True)
        environment = {**os.environ, **job["env"], "GITHUB_STEP_SUMMARY": str(summary)}
        if arguments.program:
            environment["RCME"] = str(pathlib.Path(arguments.program).resolve())
        for step in job["steps"]:
            if "run" not in step or (arguments.program and step["name"] == "Build"):
                continue
            if step["name"] == "Gate":
                (clone / "gate").mkdir()
                made = run(f'"$RCME" run studies/regression_gate.yaml --trials {arguments.trials} --out "$BASELINE"', clone, environment)
                print(f"baseline: {made}, {(clone / job['env']['BASELINE']).stat().st_size} bytes", flush=True)
            code = run(step["run"], clone, environment)
            print(f"step {step['name']}: exit code {code}", flush=True)
            if code != 0:
                sys.exit(code)
        print(summary.read_text())
        print(sorted(path.name for path in (clone / job["env"]["OUT"]).iterdir()))


if __name__ == "__main__":
    main()
