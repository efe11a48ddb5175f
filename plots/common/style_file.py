"""The file of `--style`: settings that the figures of one paper share.

    width = 3.48
    caption = false
    formats = ["pdf", "tikz"]
    highlight = ["rcme_calibrated", "poselib"]
    [labels]
    rcme_calibrated = "Ours"
    [colors]
    rcme_calibrated = "#0072B2"
"""

import re
import tomllib

from common.plot_error import PlotError
from common.regular_file import MIB, read_bytes


def is_texts(value):
    return isinstance(value, list) and all(isinstance(text, str) for text in value)


def is_texts_by_name(value):
    return isinstance(value, dict) and all(isinstance(text, str) for text in value.values())


def is_colors(value):
    colors = list(value.values()) if is_texts_by_name(value) else [None]
    return all(color and re.fullmatch("#[0-9A-Fa-f]{6}", color) for color in colors) and len(
        set(map(str.lower, colors))) == len(colors)


# key: (whether a value is right, what is)
KEYS = {
    "width": (lambda value: isinstance(value, (int, float)) and not isinstance(value, bool), "a number of inches"),
    "caption": (lambda value: isinstance(value, bool), "true or false"),
    "formats": (is_texts, "a list of texts"),
    "highlight": (is_texts, "a list of estimators"),
    "labels": (is_texts_by_name, "texts by name"),
    "colors": (is_colors, "colours such as \"#0072B2\" by name, no two alike"),
}


def read_style(path):
    """{key: value} of the file; none without a path."""
    if path is None:
        return {}
    content = read_bytes(path, MIB)
    try:
        settings = tomllib.loads(content.decode())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise PlotError(f"--style {path}: is no TOML: {error}.") from error
    for key, value in settings.items():
        if key not in KEYS:
            raise PlotError(f"--style {path}: has no setting '{key}'; allowed: {', '.join(KEYS)}.")
        is_right, expected = KEYS[key]
        if not is_right(value):
            raise PlotError(f"--style {path}: {key}: expected {expected}.")
    return settings
