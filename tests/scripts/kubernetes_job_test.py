"""The Kubernetes manifest: against the fields of the API that it may use, and its command as a pod would run it.

The fields, their types and which are required are those of batch/v1 Job (kubernetes.io/docs/reference/kubernetes-api/workload-resources/
job-v1 and pod-v1), as far as a manifest of ours has a use for them: a field that is not here is a mistake in the manifest, or
belongs into this list."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAME = re.compile(r"[a-z0-9]([-a-z0-9]{0,61}[a-z0-9])?")
QUANTITY = re.compile(r"[0-9]+(\.[0-9]+)?(m|Ki|Mi|Gi|k|M|G)?")


class Fields(dict):
    """An object: its fields, of which those that end in "!" are required."""


def one_of(*values):
    return lambda value: value in values


def text(pattern):
    return lambda value: isinstance(value, str) and re.fullmatch(pattern, value) is not None


def whole(least):
    return lambda value: isinstance(value, int) and not isinstance(value, bool) and value >= least


RESOURCES = Fields({"cpu": text(QUANTITY), "memory": text(QUANTITY)})
CONTAINER = Fields({
    "name!": text(NAME), "image!": text(r"\S+"), "command": [text(r"(?s).+")], "args": [text(r"(?s).+")],
    "resources": Fields({"requests": RESOURCES, "limits": RESOURCES}),
    "volumeMounts": [Fields({"name!": text(NAME), "mountPath!": text(r"/.*")})],
})
POD = Fields({
    "restartPolicy!": one_of("OnFailure", "Never"),  # of a Job: not Always
    "containers!": [CONTAINER],
    "volumes": [Fields({"name!": text(NAME), "persistentVolumeClaim!": Fields({"claimName!": text(NAME)})})],
})
JOB = Fields({
    "apiVersion!": one_of("batch/v1"), "kind!": one_of("Job"),
    "metadata!": Fields({"name!": text(NAME)}),
    "spec!": Fields({
        "completionMode": one_of("Indexed", "NonIndexed"), "completions": whole(1), "parallelism": whole(0),
        "backoffLimit": whole(0), "activeDeadlineSeconds": whole(1),
        "template!": Fields({"spec!": POD}),
    }),
})


def problems(value, schema, where="manifest"):
    """What is wrong with a value, as sentences."""
    if isinstance(schema, Fields):
        if not isinstance(value, dict):
            return [f"{where} is not an object"]
        known = {name.rstrip("!"): name for name in schema}
        found = [f"{where} lacks {name[:-1]}" for name in schema if name.endswith("!") and name[:-1] not in value]
        found += [f"{where} has {name}, which the API does not know" for name in value if name not in known]
        for name in value:
            if name in known:
                found += problems(value[name], schema[known[name]], f"{where}.{name}")
        return found
    if isinstance(schema, list):
        if not isinstance(value, list) or not value:
            return [f"{where} is not a list"]
        return [problem for i, entry in enumerate(value) for problem in problems(entry, schema[0], f"{where}[{i}]")]
    return [] if schema(value) else [f"{where}: {value!r} is not allowed"]


def manifest():
    return yaml.safe_load((ROOT / "scripts/kubernetes/job.yaml").read_text(encoding="utf-8"))


class KubernetesJob(unittest.TestCase):
    def test_fits_the_api(self):
        self.assertEqual(problems(manifest(), JOB), [])

    def test_what_does_not_fit_is_seen(self):
        def changed(change):
            job = manifest()
            change(job)
            return problems(job, JOB)
        self.assertTrue(changed(lambda job: job.pop("kind")))
        self.assertTrue(changed(lambda job: job["spec"].update(completion=64)))
        self.assertTrue(changed(lambda job: job["spec"].update(completions="64")))
        self.assertTrue(changed(lambda job: job["spec"].update(parallelism=True)))
        self.assertTrue(changed(lambda job: job["metadata"].update(name="Rcme_Run")))
        self.assertTrue(changed(lambda job: job["spec"]["template"]["spec"].update(restartPolicy="Always")))
        self.assertTrue(changed(lambda job: job["spec"]["template"]["spec"].update(containers=[])))
        container = lambda job: job["spec"]["template"]["spec"]["containers"][0]
        self.assertTrue(changed(lambda job: container(job)["resources"]["limits"].update(memory="much")))

    def test_indices_volumes_and_shards_agree(self):
        job = manifest()["spec"]
        self.assertEqual(job["completionMode"], "Indexed")
        pod = job["template"]["spec"]
        for container in pod["containers"]:
            self.assertIn(f"--shard auto/{job['completions']} ", container["args"][0])
            self.assertEqual([mount["name"] for mount in container["volumeMounts"]], [v["name"] for v in pod["volumes"]])

    def test_a_pod_computes_its_shard(self):
        if "RCME" not in os.environ:
            self.skipTest("RCME is not set")
        container = manifest()["spec"]["template"]["spec"]["containers"][0]
        with tempfile.TemporaryDirectory() as folder:
            data = pathlib.Path(folder)
            (data / "parts").mkdir()
            (data / "study.yaml").write_text(
                "name: pod\ntrials: 64\ndata: {scene: uniform_volume, num_matches: 40, sigma_px: 0.5}\n"
                "factors: {outlier_ratio: [0.1]}\nestimators: [{name: standard, options: {num_iterations: 5}}]\n")
            (data / "rcme").symlink_to(os.environ["RCME"])
            command = container["command"] + [container["args"][0].replace("/data/", f"{folder}/")]
            environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "JOB_COMPLETION_INDEX": "3"}
            subprocess.run(command, check=True, env=environment, stderr=subprocess.DEVNULL)
            found = subprocess.run([os.environ["RCME"], "merge", str(data / "parts/3.sqlite"), "--check"],
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
            self.assertEqual((found.returncode, found.stdout), (75, "1-3,5-64\n"))


if __name__ == "__main__":
    unittest.main()
