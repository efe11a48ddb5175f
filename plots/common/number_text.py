"""Numbers as figures print them, and as tables hold them."""

import math

SUPERSCRIPTS = str.maketrans("-0123456789", "\u207b\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079")


def number_text(value, decimals=None):
    """'0.95', '−3.53', '2.1·10⁷'; with a number of decimals: '0.950'."""
    if math.isinf(value):
        return "\u2212\u221e" if value < 0 else "\u221e"
    if value and not 1e-4 <= abs(value) < 1e6:
        return power_text(value)
    text = f"{value:.10g}" if decimals is None else f"{value:.{decimals}f}"
    return text.replace("-", "\u2212")


def power_text(value):
    """'8.3·10⁻⁵', at most three digits before the power, and none if they are a 1."""
    digits, _, exponent = f"{value:.2e}".partition("e")
    digits = digits.rstrip("0").rstrip(".").replace("-", "\u2212")
    factor = digits[:-1] if digits in ("1", "\u22121") else digits + "\u00b7"
    return f"{factor}10{str(int(exponent)).translate(SUPERSCRIPTS)}"


def parse_number(text):
    """NaN: it is a word."""
    try:
        return float(text)
    except ValueError:
        return math.nan


def is_number(text):
    return math.isfinite(parse_number(text))
