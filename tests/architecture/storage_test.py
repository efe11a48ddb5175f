"""Where files are written and lines are read: files that stay are made by base/pending_file.h and plots/common/whole_file.py
alone, whole or not at all, and std::getline, which takes a failed allocation for the end of a text, is not used."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# (what is looked for, who may); the journal of pairs grows a line at a time under its name.
RULES = {
    "C++": (("parameters", "stats", "estimator", "simulator", "peers", "experiments", "python", "robot"), {".h", ".cc"}, [
        (r"\bofstream\b", []),
        (r"\bstd::getline\(", []),
        (r"\bfopen\(", ["experiments/core/files/file_output.cc", "experiments/real/sequences/pair_index.cc"]),
        (r"\bO_CREAT\b", ["experiments/core/files/pending_file.cc"]),
        (r"\brename\(", ["experiments/core/files/pending_file.cc"]),
    ]),
    "Python": (("plots", "python/rcme"), {".py"}, [
        (r"\bopen\([^)]*[\"'][wax]b?[\"']", ["plots/common/whole_file.py", "plots/common/style.py"]),  # the second at a path of the first
        (r"\.write_(text|bytes)\(|\.to_csv\(", []),
        (r"\bos\.(replace|rename)\(", ["plots/common/whole_file.py"]),
    ]),
}


def found(language):
    folders, suffixes, rules = RULES[language]
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in suffixes:
                text, name = path.read_text(encoding="utf-8"), str(path.relative_to(ROOT))
                code = re.sub(r"//[^\n]*", "", text) if language == "C++" else text
                yield from (f"{name}: {pattern}" for pattern, allowed in rules if name not in allowed and re.search(pattern, code))


class Storage(unittest.TestCase):
    def test_files_are_written_whole_and_lines_read_to_their_end(self):
        for language in RULES:
            self.assertEqual(list(found(language)), [])


if __name__ == "__main__":
    unittest.main()
