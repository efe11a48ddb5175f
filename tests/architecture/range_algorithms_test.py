"""No source that scripts/fuzz compiles uses a range algorithm that gives a subrange, or a view: clang 14 does not compile those of
g++ 12's library. The classic algorithm of the same name does the same."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ["parameters", "stats", "estimator", "robot", "simulator", "peers", "experiments", "tests/fuzz", "tests/test_support"]
REFUSED = re.compile(r"\bstd::(?:ranges::(?:unique|partition|stable_partition|rotate|shift_left|shift_right|remove|remove_if|search|"
                     r"search_n|find_end|equal_range|subrange|views)\b|views::)")


def find_refused(text):
    return [(number, found.group()) for number, line in enumerate(text.splitlines(), 1)
            for found in REFUSED.finditer(line.split("//")[0])]


def main():
    assert find_refused("std::ranges::unique(x)") and find_refused("a | std::views::keys"), "the pattern finds nothing"
    assert not find_refused("std::ranges::unique_copy(x, y); std::ranges::sort(x)  // std::ranges::unique"), "it finds too much"
    faults = []
    for path in (path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".cc", ".h")):
        faults += [f"{path.relative_to(ROOT)}:{number}: {word}: clang 14 does not compile it; use the algorithm without ranges"
                   for number, word in find_refused(path.read_text(encoding="utf-8"))]
    print("\n".join(faults) or "none")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
