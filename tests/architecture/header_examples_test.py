"""An example in the head of the loop's header is code of the tree: a line of the comment that ends with a file in
parentheses and a colon is followed by lines of that file, indented by three spaces."""

import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADERS = ["estimator/ransac_loop.h"]
INTRODUCTION = re.compile(r"\((\S+\.(?:h|cc))\):$")
INDENTED = "//   "


def examples(text):
    """The examples of a header's text, (file, code without indentation) each."""
    lines = text.splitlines()
    for k, line in enumerate(lines):
        named = INTRODUCTION.search(line) if line.startswith("// ") else None
        if named:
            code = []
            for quoted in lines[k + 2:]:
                if not quoted.startswith(INDENTED):
                    break
                code.append(quoted[len(INDENTED):])
            yield named.group(1), code


def stands_in(code, text):
    """Whether the lines of code stand in a text one after the other, indented by any number of spaces."""
    lines = [line.strip() for line in text.splitlines()]
    wanted = [line.strip() for line in code]
    return bool(wanted) and any(lines[k:k + len(wanted)] == wanted for k in range(len(lines)))


class HeaderExamples(unittest.TestCase):
    def test_examples_are_code_of_the_tree(self):
        for header in HEADERS:
            found = list(examples((ROOT / header).read_text(encoding="utf-8")))
            self.assertTrue(found, header)
            for path, code in found:
                self.assertTrue(stands_in(code, (ROOT / path).read_text(encoding="utf-8")), f"{header}: {path}: {code}")

    def test_an_example_that_differs_is_seen(self):
        header = "// Shown (a/b.h):\n//\n//   int a;\n//   int b;\n//\n// Not shown (c.h).\n"
        self.assertEqual(list(examples(header)), [("a/b.h", ["int a;", "int b;"])])
        self.assertTrue(stands_in(["int a;", "int b;"], "x\n  int a;\n  int b;\n"))
        self.assertFalse(stands_in(["int a;", "int b;"], "int a;\nint c;\nint b;\n"))
        self.assertFalse(stands_in([], "int a;"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
