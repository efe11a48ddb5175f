"""A page's links to files that are no pages, such as sources, become their text: the site holds pages and pictures."""

import posixpath
import re

LINK = re.compile(r"(?<!!)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s#]+)(#[^)\s]*)?\)")


def on_page_markdown(markdown, page, config, files):
    here = posixpath.dirname(page.file.src_uri)

    def linked(match):
        text, target, _ = match.groups()
        if re.match(r"[a-z]+:", target):
            return match[0]
        place = posixpath.normpath(posixpath.join(here, target))
        if files.get_file_from_path(place):
            return match[0]
        readme = posixpath.join(place, "README.md")
        return f"[{text}]({target.rstrip('/')}/README.md)" if files.get_file_from_path(readme) else text

    return LINK.sub(linked, markdown)
