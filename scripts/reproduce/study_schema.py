"""The JSON Schema of study files for editors, from what the program says of its own keys (`rcme list --format json`)."""

import json
import re
import subprocess

NUMBER = re.compile(r"a (whole )?number(?: in \[([^,\]]+), ([^\]]+)\]| >= (\S+))?")
WIDTH = 110
OF_SOME_BUILDS = ["poselib", "poselib_gravity"]  # estimators of a library that not every build finds
CHOICES = ["scene", "cameras", "motion", "noise", "outliers"]
LISTS_OF_CHOICES = dict(zip(CHOICES, ["scenes", "cameras", "motions", "noise", "outliers"]))


def program_lists(program):
    return json.loads(subprocess.run([program, "list", "--format", "json"], check=True, capture_output=True, text=True).stdout)


def word(text):
    """A word of the allowed ones, as YAML reads it."""
    return {"true": True, "false": False}.get(text, text)


def number(text):
    value = float(text)
    return int(value) if value.is_integer() else value


def value_schema(allowed):
    """Of a text such as `a whole number in [1, 1000]`, `one of: a, b`, `a number in [0, 1] or none`; {} for any other."""
    if allowed.startswith("one of: "):
        return {"enum": [word(each) for each in allowed.removeprefix("one of: ").split(", ")]}
    found = NUMBER.match(allowed)
    if found is None:
        return {"type": "string"} if allowed == "text" else {}
    schema = {"type": "integer" if found[1] else "number"}
    least = found[2] or found[4]
    if least:
        schema["minimum"] = number(least)
    if found[3]:
        schema["maximum"] = number(found[3])
    words = re.findall(r" or (\S+)", allowed[found.end():])
    return {"anyOf": [schema, {"enum": [word(each) for each in words]}]} if words else schema


def described(row, schema):
    unit = f", {row['unit']}" if "unit" in row else ""
    default = f" (default: {row['default']}{unit})" if "default" in row else unit
    return {"description": row["what_it_is"] + default, **schema}


def either(schemas):
    """One of several, each once."""
    different = [each for i, each in enumerate(schemas) if each not in schemas[:i]]
    return different[0] if len(different) == 1 else {"anyOf": different}


def closed(properties, **more):
    return {"type": "object", "additionalProperties": False, "properties": properties, **more}


def data_schemas(lists):
    """Of each key of the data; a key that several choices bring may be what any of them allows."""
    rows = {}
    for row in lists["settings"]:
        rows.setdefault(row["data_key"], []).append(row)
    keys = {}
    for choice in CHOICES:
        entries = lists[LISTS_OF_CHOICES[choice]]
        column = next(iter(entries[0]))
        keys[choice] = {"enum": [entry[column] for entry in entries]}
    for key, of_key in rows.items():
        schema = either([value_schema(row.get("allowed", "")) for row in of_key])
        keys.setdefault(key, described(of_key[0], schema))
    return keys


def option_schemas(lists):
    """{estimator: {option: schema}}, without estimators that are not in every build."""
    options = {}
    for row in lists["options"]:
        if row["estimator"] not in OF_SOME_BUILDS:
            options.setdefault(row["estimator"], {})[row["option"]] = described(row, value_schema(row.get("allowed", "")))
    return options


def estimator_schema(lists, blocks):
    names = [row["estimator"] for row in lists["estimators"] if row["estimator"] not in OF_SOME_BUILDS] + OF_SOME_BUILDS
    properties = {**blocks["estimator"], **blocks["estimators"]}
    properties["name"] = {**properties["name"], "enum": names}
    properties["options"] = {**properties["options"], "type": "object"}
    rules = [{"if": {"properties": {"name": {"const": name}}, "required": ["name"]},
              "then": {"properties": {"options": closed(options)}}} for name, options in option_schemas(lists).items()]
    return closed(properties, anyOf=[{"required": [key]} for key in ("name", "process", "answers", "conform", "file")], allOf=rules)


def study_schema(program):
    lists = program_lists(program)
    blocks = {}
    for row in lists["keys"]:
        blocks.setdefault(row["block"], {})[row["key"]] = described(row, value_schema(row.get("allowed", "")))
    data = data_schemas(lists)
    levels = {key: {"type": "array", "minItems": 1, "items": {"$ref": f"#/$defs/data/properties/{key}"}} for key in data}
    study = blocks["study"]

    def holds(key, schema):
        study[key] = {**study[key], **schema}

    holds("ademp", closed(blocks["ademp"], required=list(blocks["ademp"])))
    holds("data", {"$ref": "#/$defs/data"})
    holds("factors", {"type": "object", "additionalProperties": False, "properties": levels,
                      "patternProperties": {r"^[^.]+\..+$": {"type": "array", "minItems": 1}}})
    holds("conditions", closed(blocks["conditions"]))
    holds("estimators", {"type": "array", "minItems": 1, "maxItems": 100, "items": {"$ref": "#/$defs/estimator"}})
    holds("failure", closed(blocks["failure"]))
    holds("hypotheses", {"type": "array", "minItems": 1, "maxItems": 100, "items": closed(blocks["hypothesis"])})
    holds("tune", closed(blocks["tune"]))
    return {"$schema": "https://json-schema.org/draft/2020-12/schema",
            "title": "A study of rcme (docs/reference/study_keys.md); written by scripts/reference",
            **closed(study, required=["estimators"]),
            "$defs": {"data": closed(data), "estimator": estimator_schema(lists, blocks)}}


def json_text(value, depth=0, key=""):
    """JSON with one space a level; a value stands on one line with its key if it fits in WIDTH columns."""
    begin = " " * depth + key
    line = begin + json.dumps(value, ensure_ascii=False)
    if not isinstance(value, (dict, list)) or len(line) < WIDTH:  # a column for the comma
        return line
    if isinstance(value, dict):
        ends, members = "{}", [json_text(each, depth + 1, f"{json.dumps(name, ensure_ascii=False)}: ") for name, each in value.items()]
    else:
        ends, members = "[]", [json_text(each, depth + 1) for each in value]
    return begin + ends[0] + "\n" + ",\n".join(members) + "\n" + " " * depth + ends[1]


def study_schema_text(program):
    return json_text(study_schema(program)) + "\n"
