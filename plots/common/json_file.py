"""Reads the program's JSON files key by key: each complaint names the file, the place in it, the key and what is
needed."""

import json
import math

from common.command_line import PlotError
from common.regular_file import read_bytes


class Node:
    """One object of the file and its place there, so that every complaint can say where. `origin`: the command that
    writes such files."""

    def __init__(self, path, place, value, origin):
        self.path, self.place, self.value, self.origin = path, place, value, origin
        if not isinstance(value, dict):
            raise self.error(f"must be an object, not {shown(value)}")

    def error(self, complaint):
        return PlotError(f"{self.path}: {self.place} {complaint}.")

    def get(self, key, is_right, expected):
        if key not in self.value:
            raise self.error(f"has no key '{key}'; expected the output of '{self.origin}'")
        value = self.value[key]
        if not is_right(value):
            raise self.error(f"has '{key}': {shown(value)}; expected {expected}")
        return value

    def text(self, key):
        return self.get(key, lambda value: isinstance(value, str), "a text")

    def texts(self, key):
        return tuple(self.get(key, is_texts, "a list of texts"))

    def texts_or_none(self, key):
        value = self.get(key, lambda value: value is None or is_texts(value), "a list of texts or null")
        return None if value is None else tuple(value)

    def boolean(self, key):
        return self.get(key, lambda value: isinstance(value, bool), "true or false")

    def one_of(self, key, allowed):
        return self.get(key, lambda value: isinstance(value, str) and value in allowed,
                        "one of " + ", ".join(f"'{name}'" for name in allowed))

    def whole_number(self, key):
        return self.get(key, lambda value: type(value) is int, "a whole number")

    def fraction(self, key):
        return float(self.get(key, lambda value: is_finite(value) and 0 <= value <= 1, "a number in 0..1"))

    def fraction_or(self, key, if_null):
        value = self.get(key, lambda value: value is None or is_finite(value) and 0 <= value <= 1,
                         "a number in 0..1 or null")
        return if_null if value is None else float(value)

    def number_or(self, key, if_null):
        value = self.get(key, lambda value: value is None or is_finite(value), "a finite number or null")
        return if_null if value is None else float(value)

    def count(self, key):
        return self.get(key, lambda value: isinstance(value, int) and not isinstance(value, bool) and value >= 0,
                        "a whole number from 0")

    def nodes(self, key, name):
        values = self.get(key, lambda value: isinstance(value, list), "a list")
        return [Node(self.path, self.inside(f"{name} {number}"), value, self.origin)
                for number, value in enumerate(values, 1)]

    def node(self, key):
        return Node(self.path, self.inside(f"'{key}'"), self.get(key, lambda value: True, ""), self.origin)

    def node_or_none(self, key):
        return None if self.get(key, lambda value: True, "") is None else self.node(key)

    def inside(self, place):
        return place if self.place == "the file" else f"{self.place}, {place}"


def shown(value):
    text = json.dumps(value)
    return text if len(text) <= 40 else text[:37] + "..."


def is_texts(value):
    return isinstance(value, list) and all(isinstance(text, str) for text in value)


def is_finite(value):
    try:
        return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
    except OverflowError:  # a whole number beyond all floating-point numbers
        return False


def refuse_constant(name):
    raise ValueError(f"{name} is not a number of JSON")


def read_object(path, origin, stamp):
    """The Node of the whole file `path`, which the command `origin` wrote in the format `stamp`; a cut-off or foreign
    file is an error, and so is one of another format."""
    content = read_bytes(path)
    try:
        value = json.loads(content.decode("utf-8-sig"), parse_constant=refuse_constant)
    except (ValueError, RecursionError) as error:
        raise PlotError(f"{path}: is not a whole JSON file ({error}); is it cut off?")
    file = Node(path, "the file", value, origin)
    if file.text("format") != stamp:
        raise file.error(f"has 'format': {shown(value['format'])}, which is not known here; expected '{stamp}', the output "
                         f"of '{origin}' of the same version")
    return file
