"""docs/study.schema.json takes every study that comes with rcme, and finds planted faults."""

import copy
import json
import pathlib
import re
import unittest

import yaml
from json_schema import faults

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCHEMA = json.loads((ROOT / "docs/study.schema.json").read_text())


def read_study(text):
    """As YAML 1.2 has it, which the program and editors read: `off` is a text."""
    def typed(node):
        if isinstance(node, dict):
            return {key: typed(each) for key, each in node.items()}
        if isinstance(node, list):
            return [typed(each) for each in node]
        if node in ("true", "false"):
            return node == "true"
        if re.fullmatch(r"[-+]?\d+", node):
            return int(node)
        return float(node) if re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", node) else node

    return typed(yaml.load(text, yaml.BaseLoader))


STUDIES = sorted((ROOT / "studies").rglob("*.yaml"))
STUDY = read_study((ROOT / "studies/own_camera.yaml").read_text())


class Schema(unittest.TestCase):
    def found(self, study):
        return list(faults(study, SCHEMA, SCHEMA))

    def test_takes_every_study(self):
        self.assertGreater(len(STUDIES), 50)
        for path in STUDIES:
            with self.subTest(path.name):
                self.assertEqual(self.found(read_study(path.read_text())), [])

    def planted(self, changes):
        """Of the study with other values: {"data__scene": ...}."""
        study = copy.deepcopy(STUDY)
        for place, value in changes.items():
            *blocks, key = (int(part) if part.isdigit() else part for part in place.split("__"))
            block = study
            for each in blocks:
                block = block[each]
            block[key] = value
        return self.found(study)

    def test_finds_planted_faults(self):
        self.assertEqual(self.planted({}), [])
        faults_and_places = [
            ({"trails": 3}, ("", "trails is not allowed")),
            ({"trials": 0}, (".trials", "out of range")),
            ({"trials": 1.5}, (".trials", "not of type integer")),
            ({"seed": "one"}, (".seed", "not of type integer")),
            ({"data__scene": "corridoor"}, (".data.scene", "not in enum")),
            ({"data__sigma_pix": 1}, (".data", "sigma_pix is not allowed")),
            ({"data__sigma_px": -1}, (".data.sigma_px", "out of range")),
            ({"data__outlier_ratio": 30}, (".data.outlier_ratio", "out of range")),
            ({"data__parallax_deg": "nought"}, (".data.parallax_deg", "none of anyOf")),
            ({"design": "all"}, (".design", "not in enum")),
            ({"factors__outlier_ratio": [0.1, 2]}, (".factors.outlier_ratio[1]", "out of range")),
            ({"factors__outlier_ratio": 0.1}, (".factors.outlier_ratio", "not of type array")),
            ({"factors__outliers_ratio": [0.1]}, (".factors", "outliers_ratio is not allowed")),
            ({"estimators": []}, (".estimators", "number of items")),
            ({"estimators__0__name": "standrad"}, (".estimators[0].name", "not in enum")),
            ({"estimators__0__option": {}}, (".estimators[0]", "option is not allowed")),
            ({"estimators__1__options": {"mue": 1}}, (".estimators[1].options", "mue is not allowed")),
            ({"estimators__1__options": {"reading": "as_print"}}, (".estimators[1].options.reading", "not in enum")),
            ({"estimators__0": {"label": "nobody"}}, (".estimators[0]", "none of anyOf")),
            ({"failure__max_rotation_error_deg": 181}, (".failure.max_rotation_error_deg", "out of range")),
            ({"ademp": {"aims": "none"}}, (".ademp", "data is missing")),
            ({"hypotheses": [{"quantity": "failures"}]}, (".hypotheses[0].quantity", "not in enum")),
            ({"tune": {"at_most": 2}}, (".tune.at_most", "out of range")),
            ({"conditions": {"number": 0}}, (".conditions.number", "out of range")),
        ]
        for changes, fault in faults_and_places:
            with self.subTest(changes):
                self.assertIn(fault, self.planted(changes))


if __name__ == "__main__":
    unittest.main(verbosity=2)
