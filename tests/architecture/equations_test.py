"""docs/equations.md says where the paper's equations are: every file it names exists and cites the equation, a header does so
at code of its own, every test is of a file of its row, every claim is one of the audit's and stands in the file beside it, and
no label is cited in the code that it does not list. Needs nothing but this repository; the claims are those of the program in
the environment variable RCME, without which they are not checked."""

import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/equations.md"
CLAIMS = "experiments/audit/claims/"
ROOMS = ["parameters", "stats", "estimator", "simulator", "experiments", "plots", "tests"]
LABEL = re.compile(r"\beq::?[A-Za-z][A-Za-z0-9_-]*")
NUMBER = re.compile(r"(?<![A-Za-z0-9] )\beq\. (\d+)(?![\d.])")
IN_CODE_STYLE = re.compile(r"`([^`]+)`")
NO_CODE = re.compile(r"//[^\n]*|/\*.*?\*/|^[ \t]*#(?:[^\n]*\\\n)*[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'",
                     re.DOTALL | re.MULTILINE)
HEAD_OF_A_FUNCTION = re.compile(r"\)(?:\s|const|noexcept|override|final|&|->[\w\s:<>,*&]+)*$")
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)


def tables(text):
    """The tables of a page, each a list of rows, each a list of cells; without head and rule."""
    found, rows = [], []
    for line in text.splitlines() + [""]:
        if line.startswith("|"):
            rows.append([cell.strip() for cell in line.strip("|").split("|")])
        elif rows:
            found.append(rows[2:])
            rows = []
    return found


def quoted(cell):
    return IN_CODE_STYLE.findall(cell)


def cited(text):
    """The labels and numbers of equations that a text cites."""
    return set(LABEL.findall(text)) | {f"eq. {number}" for number in NUMBER.findall(text)}


def missing_citations(rows, read):
    """Of the rows of the first table, what does not hold, as sentences; `read` gives a file's text or None."""
    wrong = []
    for number, label, _, reference, fast, *_ in rows:
        files = quoted(reference) + quoted(fast)
        if not quoted(reference) or (not quoted(fast) and fast not in {"same", "—"}):
            wrong.append(f"equation {number}: no file")
        for path in files:
            text = read(path)
            if text is None:
                wrong.append(f"equation {number}: {path} does not exist")
            elif quoted(label)[0] not in cited(text):
                wrong.append(f"equation {number}: {path} does not cite {quoted(label)[0]}")
    return wrong


def functions(text):
    """The functions with a body in the text of a header, each with the comment above it."""
    code = NO_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    found, begin, parentheses, place = [], 0, 0, 0
    while place < len(code):
        parentheses += {"(": 1, ")": -1}.get(code[place], 0)
        is_body = code[place] == "{" and not parentheses and HEAD_OF_A_FUNCTION.search(code[begin:place])
        if is_body and not re.search(r"\bconcept\b", code[begin:place]):
            depth, place = 1, place + 1
            while depth and place < len(code):
                depth += {"{": 1, "}": -1}.get(code[place], 0)
                place += 1
            found.append(text[begin:place])
            begin = place
            continue
        place += 1
        if code[place - 1] in "{};" and not parentheses:
            end = (code + "\n").index("\n", place)
            begin = end if not code[place:end].strip() else place  # what is said behind a member is of the member
    return found


def source_of(header):
    return re.sub(r"\.h$", ".cc", header)


def mere_declarations(files, label, read):
    """The headers of a row whose code is elsewhere: the source beside it, which the row does not name, has it, and no function
    in the header cites the label (without a label: the header has no function)."""
    idle = []
    for header in files:
        source = source_of(header)
        if source == header or source in files or read(source) is None:
            continue
        found = functions(read(header) or "")
        if not (any(label in cited(function) for function in found) if label else found):
            idle.append(header)
    return idle


def reached(test, read):
    """The files that a test is of: those that it includes, and those that the header it is named after, or its source, does."""
    subject = "estimator/" + test.removesuffix("_test.cc") + ".h"
    texts = [read(f"tests/estimator/{test}"), read(subject), read(source_of(subject))]
    return {file for text in texts for file in INCLUDE.findall(text or "")}


def tests_without_their_subject(rows, read):
    """Of the rows of the first table, the tests that do not exist or are of no file that the row names, as sentences."""
    wrong = []
    for number, _, _, reference, fast, tests, *_ in rows:
        headers = [re.sub(r"\.cc$", ".h", path) for path in quoted(reference) + quoted(fast)]
        if not quoted(tests):
            wrong.append(f"equation {number}: no test")
        for test in quoted(tests):
            if read(f"tests/estimator/{test}") is None or reached(test, read).isdisjoint(headers):
                wrong.append(f"equation {number}: {test} does not exist or includes none of {headers}")
    return wrong


def misplaced_claims(rows, read):
    """Claims (a row's last cell but one) whose name none of the files of its last cell holds, and files that hold none."""
    wrong = []
    for row in rows:
        idle = set(quoted(row[-1]))
        for claim in quoted(row[-2]):
            words = [f'"{claim}"', f'"{claim.split(".")[0]}.']
            holders = {file for file in quoted(row[-1]) if any(word in (read(CLAIMS + file) or "") for word in words)}
            idle -= holders
            if not holders:
                wrong.append(f"{claim} is in none of {quoted(row[-1])}")
        wrong += [f"{row[0]}: {file} holds none of its claims" for file in sorted(idle)]
    return wrong


def read_source(path):
    file = ROOT / path
    return file.read_text(encoding="utf-8") if file.is_file() else None


def claims_of_the_program(program):
    """The claims with their labels, {id: label}."""
    listed = subprocess.run([program, "list", "claims", "--format", "json"], check=True, capture_output=True, text=True)
    return {claim["claim"]: claim["label"] for claim in json.loads(listed.stdout)["claims"]}


class Equations(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.text = PAGE.read_text(encoding="utf-8")
        _, self.equations, self.parts, _ = tables(self.text)

    def test_the_list_is_complete(self):
        count = int(re.search(r"(\d+) equations", self.text).group(1))
        self.assertEqual([int(row[0]) for row in self.equations], list(range(1, count + 1)))
        labels = [quoted(row[1])[0] for row in self.equations]
        self.assertEqual(len(set(labels)), count)
        for number, label in enumerate(labels, 1):
            self.assertTrue(label.startswith("eq:") or label == f"eq. {number}", label)

    def test_every_file_named_cites_its_equation(self):
        self.assertEqual(missing_citations(self.equations, read_source), [])
        for row in self.parts:
            for path in quoted(row[2]):
                self.assertIsNotNone(read_source(path), path)

    def test_no_header_is_named_that_only_declares(self):
        wrong = []
        for row in self.equations:
            for files in (quoted(row[3]), quoted(row[4])):
                wrong += [f"equation {row[0]}: {header}" for header in mere_declarations(files, quoted(row[1])[0], read_source)]
        for row in self.parts:
            wrong += [f"{row[0]}: {header}" for header in mere_declarations(quoted(row[2]), None, read_source)]
        self.assertEqual(wrong, [])

    def test_every_test_is_of_a_file_of_its_row(self):
        self.assertEqual(tests_without_their_subject(self.equations, read_source), [])

    def test_every_claim_is_in_the_file_beside_it(self):
        self.assertEqual(misplaced_claims(self.equations + self.parts, read_source), [])

    def test_a_header_that_only_declares_is_seen(self):
        declares = """// Of a file (eq::cov_p).
            #define BODY(x) (x) { return x; }
            namespace n {
            struct Model {
              double p = 0.0;  // a member (eq::cov_p)
              double twice() const { return 2.0 * p; }
            };
            template <typename T>
            concept Motion = requires(T motion) { { motion.p(std::array<int, 2>{}) } -> Same; };  // (eq::cov_p)
            // A function (eq::cov_p).
            Matrix Covariance(const Model& model, Options options = {});
            }"""
        declared = "Matrix Covariance(const Model& model, Options options = {});"
        texts = {"a.h": declares, "a.cc": "", "b.h": declares}
        self.assertEqual(mere_declarations(["a.h", "b.h", "c.cc"], "eq::cov_p", texts.get), ["a.h"])
        self.assertEqual(mere_declarations(["a.h", "a.cc"], "eq::cov_p", texts.get), [])
        self.assertEqual(mere_declarations(["a.h"], None, texts.get), [], "it has a function, though not of this equation")
        texts["a.h"] = declares.replace("double twice() const { return 2.0 * p; }", "double twice() const;")
        self.assertEqual(mere_declarations(["a.h"], None, texts.get), ["a.h"])
        for body in ["inline " + declared[:-1] + " { return {}; }",
                     "template <int m>\nMatrix Covariance(const Model& model) noexcept {\n  for (;;) { }\n}",
                     "struct Root {\n  // (eq::cov_p)\n  explicit Root(int n) : L_(n), text_(\"{\") {}\n};",
                     "auto Covariance() -> Matrix<3, 3> { return {}; /* (eq::cov_p) } */ }"]:
            texts["a.h"] = declares.replace(declared, body)
            self.assertNotEqual(texts["a.h"], declares)
            self.assertEqual(mere_declarations(["a.h"], "eq::cov_p", texts.get), [], body)

    def test_a_test_is_of_what_its_subject_includes(self):
        row = ["7", "`eq::cov_p`", "", "`estimator/k/x-inl.h`", "—", "`k/a_test.cc`, `k/b_test.cc`", "", ""]
        of_a = '#include "estimator/k/a.h"'
        texts = {"tests/estimator/k/a_test.cc": of_a, "tests/estimator/k/b_test.cc": of_a,
                 "estimator/k/a.h": "", "estimator/k/a.cc": '#include "estimator/k/x-inl.h"'}
        self.assertEqual(tests_without_their_subject([row], texts.get),
                         ["equation 7: k/b_test.cc does not exist or includes none of ['estimator/k/x-inl.h']"])

    def test_a_wrong_test_or_file_of_a_claim_is_seen(self):
        row = ["7", "`eq::cov_p`", "", "`a.cc`", "—", "`a_test.cc`, `b_test.cc`", "`f.x`, `g.y`", "`f.cc`, `h.cc`"]
        texts = {"tests/estimator/a_test.cc": '#include "a.h"', "tests/estimator/b_test.cc": "", CLAIMS + "f.cc": '"f.x"'}
        self.assertEqual(tests_without_their_subject([row], texts.get),
                         ["equation 7: b_test.cc does not exist or includes none of ['a.h']"])
        self.assertEqual(misplaced_claims([row], texts.get),
                         ["g.y is in none of ['f.cc', 'h.cc']", "7: h.cc holds none of its claims"])

    def test_a_missing_file_or_citation_is_seen(self):
        row = ["7", "`eq::cov_p`", "", "`a.h`", "`b.h`", "—"]
        texts = {"a.h": "// (eq::cov_p)", "b.h": "// (eq::cov_p_other), eq. 7"}
        self.assertEqual(missing_citations([row], texts.get), ["equation 7: b.h does not cite eq::cov_p"])
        self.assertEqual(missing_citations([row[:4] + ["`c.h`", "—"]], texts.get), ["equation 7: c.h does not exist"])
        self.assertEqual(cited("(eq. 12, eq::a-b), (Doe 1952, eq. 4.35)"), {"eq. 12", "eq::a-b"})

    def test_no_other_equation_is_cited(self):
        listed = {quoted(row[1])[0] for row in self.equations}
        for room in ROOMS:
            for path in sorted((ROOT / room).rglob("*")):
                if path.suffix in {".h", ".cc", ".py"} and path != pathlib.Path(__file__).resolve():
                    self.assertLessEqual(cited(path.read_text(encoding="utf-8")), listed, str(path))

    @unittest.skipUnless(os.environ.get("RCME"), "RCME, the program, is not set")
    def test_claims_are_those_of_the_audit(self):
        claims = claims_of_the_program(os.environ["RCME"])
        self.assertGreater(len(claims), 40)
        named = {claim for row in self.equations + self.parts for claim in quoted(row[-2])}
        self.assertEqual(named, set(claims), "the claims that the page names, and those that there are")
        for row in self.equations:  # a claim that cites an equation stands in its row
            label = quoted(row[1])[0]
            self.assertLessEqual({name for name, cites in claims.items() if cites == label}, set(quoted(row[6])), label)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
