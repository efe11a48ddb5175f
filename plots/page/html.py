"""HTML as nested calls. What is not Html already is text and is escaped, so that no name out of a file can become markup:

    element("p", "a < b, ", element("code", name), class_="note")
"""

import base64
import hashlib
import html
import re

VOID = {"img", "meta", "source"}  # elements without an end tag
NOT_TEXT = re.compile("[^\t\n\r\x20-\x7e\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # no place in a page


class Html(str):
    """Markup that is safe as it is; so is a sum of such."""

    def __add__(self, other):
        return Html(str.__add__(self, escaped(other)))


def escaped(child):
    return child if isinstance(child, Html) else Html(html.escape(NOT_TEXT.sub("\ufffd", str(child))))


def joined(children):
    return Html("".join(map(escaped, children)))


def element(name, /, *children, **attributes):
    """<name ...>children</name>; `class_` is class and `aria_label` is aria-label; True is a bare attribute, None is none."""
    text = "".join(f" {key.rstrip('_').replace('_', '-')}" + ("" if value is True else f'="{escaped(value)}"')
                   for key, value in attributes.items() if value is not None)
    return Html(f"<{name}{text}>" if name in VOID else f"<{name}{text}>{joined(children)}</{name}>")


def code(text):
    return element("code", text)


def listed(*items):
    return element("ul", *(element("li", item) for item in items))


def definitions(pairs, **attributes):
    """A list of terms and what they are."""
    return element("dl", *(element("dt", term) + element("dd", meaning) for term, meaning in pairs), **attributes)


def details(summary, *children, is_open=False, class_=None):
    return element("details", element("summary", summary), *children, class_=class_, open=True if is_open else None)


def table(caption, header, groups, num_names=1, class_=None):
    """A table in a box of its own that scrolls where it is too wide. `groups`: [(heading or None, rows)]; the first
    `num_names` cells of a row name it."""
    columns = element("tr", *(element("th", cell, scope="col", class_="name" if position < num_names else None)
                              for position, cell in enumerate(header)))
    bodies = [table_body(heading, rows, num_names, len(header)) for heading, rows in groups]
    return element("div", element("table", element("caption", caption), element("thead", columns), "\n", *bodies,
                                  class_=class_), class_="scroll", role="region", tabindex="0", aria_label="table") + "\n"


def table_body(heading, rows, num_names, num_columns):
    lines = [] if heading is None else [element("tr", element("th", heading, scope="rowgroup", colspan=num_columns))]
    for row in rows:
        lines.append(element("tr", *(element("th", cell, scope="row", class_="name") if position < num_names
                                     else element("td", cell) for position, cell in enumerate(row))))
    return element("tbody", *(line + "\n" for line in lines))


def hash_of(text):
    """As a policy names the one style or script that it allows."""
    return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"


def page(title, style, script, body):
    """A whole page. Its policy forbids what it does not need: any other file, style or script, forms, the network."""
    policy = (f"default-src 'none'; img-src data:; style-src {hash_of(style)}; script-src {hash_of(script)}; base-uri 'none'; "
              "form-action 'none'")
    head = element("head", element("meta", charset="utf-8"),
                   element("meta", name="viewport", content="width=device-width, initial-scale=1"),
                   element("meta", name="color-scheme", content="light dark"),
                   element("meta", http_equiv="Content-Security-Policy", content=policy),
                   element("title", title), element("style", Html(style)))
    return Html("<!DOCTYPE html>\n") + element("html", head, Html("\n"), element("body", body, element("script", Html(script))), lang="en") + "\n"
