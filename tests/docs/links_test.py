"""Every relative link of a page leads to a file, and to a heading of it where the link names one. Needs nothing but this repository."""

import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LEFT_OUT = {"build", ".git", ".cache"}
LINK = re.compile(r"\]\(<?([^()\s>]+)>?\)")
FENCE = re.compile(r"^\s*```.*?^\s*```\s*$", re.DOTALL | re.MULTILINE)
CODE = re.compile(r"`[^`\n]*`")


def anchors(text):
    """The names that GitHub gives to the headings of a page."""
    found = []
    for heading in re.findall(r"^#+ (.*)$", FENCE.sub("", text), re.MULTILINE):
        shown = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
        name = re.sub(r"[^\w\- ]", "", shown).replace(" ", "-")
        found.append(name if name not in found else f"{name}-{found.count(name)}")
    return set(found)


def broken_links(page):
    """The links of a page that lead nowhere, as (link, why)."""
    text = CODE.sub("", FENCE.sub("", page.read_text(encoding="utf-8")))
    broken = []
    for link in LINK.findall(text):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        if not target.exists():
            broken.append((link, "no such file"))
        elif anchor and target.suffix == ".md" and anchor not in anchors(target.read_text(encoding="utf-8")):
            broken.append((link, "no such heading"))
    return broken


def pages():
    return [page for page in sorted(ROOT.rglob("*.md")) if not LEFT_OUT & set(page.relative_to(ROOT).parts)]


def pages_of_the_site():
    """The pages that the site's menu leads to, as paths from the root."""
    return set(re.findall(r"^ +- [^\n]*: ([\w/]+\.md)$", (ROOT / "docs/site/mkdocs.yml").read_text(encoding="utf-8"), re.MULTILINE))


class Links(unittest.TestCase):
    def test_every_link_leads_somewhere(self):
        self.assertGreater(len(pages()), 40)
        broken = [f"{page.relative_to(ROOT)}: {link}: {why}" for page in pages() for link, why in broken_links(page)]
        self.assertEqual(broken, [])

    def test_every_document_has_a_place_in_the_list_and_in_the_menu_of_the_site(self):
        documents = {f"docs/{page.name}" for page in (ROOT / "docs").glob("*.md")} - {"docs/README.md"}
        listed = {f"docs/{link}" for link in LINK.findall((ROOT / "docs/README.md").read_text(encoding="utf-8"))}
        self.assertGreater(len(documents), 20)
        self.assertEqual(documents - listed, set())
        self.assertEqual(documents - pages_of_the_site(), set())

    def test_a_broken_link_is_seen(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.md"
            page.write_text("# A `b` page\n[x](#a-b-page) [y](page.md#none) ![z](none.png) `[q](gone)` [w](https://a.b)\n")
            self.assertEqual(broken_links(page), [("page.md#none", "no such heading"), ("none.png", "no such file")])


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
