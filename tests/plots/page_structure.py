"""What a page of HTML holds, for tests."""

from html.parser import HTMLParser

from page.html import VOID


class Structure(HTMLParser):
    """What a page holds; an end tag without its start is an error."""

    def __init__(self, page):
        super().__init__()
        self.open, self.elements, self.text, self.headings, self.ids = [], [], [], [], []
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        self.ids += [value for key, value in attributes if key == "id"]
        if tag not in VOID | {"br", "wbr"}:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            raise AssertionError(f"</{tag}> ends nothing")

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("style", "script"):
            self.text.append(data)
            if self.open[-1] in ("h1", "h2", "h3"):
                self.headings.append(data)

    def attributes(self, name):
        return [attributes[name] for _, attributes in self.elements if name in attributes]

    def of(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]
