"""The part of JSON Schema that docs/study.schema.json uses: what is wrong with a value, as (path, reason)."""

import re

TYPES = {"object": dict, "array": list, "string": str, "number": (int, float), "integer": int}
KEYWORDS = {"$schema", "$defs", "$ref", "title", "description", "type", "enum", "const", "minimum", "maximum", "minItems", "maxItems", "items",
            "properties", "patternProperties", "additionalProperties", "required", "anyOf", "allOf", "if", "then"}


def faults(value, schema, root, path=""):
    unknown = set(schema) - KEYWORDS
    assert not unknown, f"{path}: keywords that this reader does not know: {unknown}"
    if "$ref" in schema:
        target = root
        for part in schema["$ref"].removeprefix("#/").split("/"):
            target = target[part]
        yield from faults(value, target, root, path)
    yield from faults_of_value(value, schema, path)
    if isinstance(value, dict):
        yield from faults_of_object(value, schema, root, path)
    if isinstance(value, list):
        for i, item in enumerate(value):
            yield from faults(item, schema.get("items", {}), root, f"{path}[{i}]")
    for each in schema.get("allOf", []):
        yield from faults(value, each, root, path)
    if "anyOf" in schema and all(any(True for _ in faults(value, each, root, path)) for each in schema["anyOf"]):
        yield path, "none of anyOf"
    if "if" in schema and not any(True for _ in faults(value, schema["if"], root, path)):
        yield from faults(value, schema["then"], root, path)


def faults_of_value(value, schema, path):
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if "type" in schema and (not isinstance(value, TYPES[schema["type"]]) or isinstance(value, bool)):
        yield path, f"not of type {schema['type']}"
    if "enum" in schema and not any(value == each and type(value) is type(each) for each in schema["enum"]):
        yield path, "not in enum"
    if "const" in schema and value != schema["const"]:
        yield path, "not const"
    if is_number and not schema.get("minimum", value) <= value <= schema.get("maximum", value):
        yield path, "out of range"
    if isinstance(value, list) and not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)):
        yield path, "number of items"


def faults_of_object(value, schema, root, path):
    for key in schema.get("required", []):
        if key not in value:
            yield path, f"{key} is missing"
    for key, each in value.items():
        of_key = [schema["properties"][key]] if key in schema.get("properties", {}) else []
        of_key += [one for pattern, one in schema.get("patternProperties", {}).items() if re.search(pattern, key)]
        if not of_key and schema.get("additionalProperties") is False:
            yield path, f"{key} is not allowed"
        for one in of_key:
            yield from faults(each, one, root, f"{path}.{key}")
