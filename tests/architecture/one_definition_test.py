"""No two files define types of one name in one namespace: the linker would take a default member value of the one for that
of the other, without a word (the one-definition rule)."""

import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ["parameters", "stats", "estimator", "robot", "simulator", "peers", "experiments", "python", "tests"]
OPENED = re.compile(r"^namespace\s*([\w:]*)\s*\{")
ALTERNATIVE = re.compile(r"_without_\w+(?=\.cc$)")  # a_without_library.cc is compiled in place of a.cc
CLOSED = re.compile(r"^\}\s*// namespace")
TYPE = re.compile(r"^(?:template <.*> )?(?:struct|class|enum class|enum) (?:alignas\(\w+\) )?([\w:]+(?:<[^{;]*?>)?)[^;]*\{")


def types_in(text):
    """Names, with their namespaces, of the types that other files could see: those of unnamed namespaces are left out."""
    spaces, names = [], []
    for line in text.splitlines():
        if opened := OPENED.match(line):
            spaces.append(opened.group(1))
        elif CLOSED.match(line):
            spaces.pop()
        elif (found := TYPE.match(line)) and "" not in spaces:
            names.append("::".join([*spaces, found.group(1)]))
    return names


def check_itself():
    text = "namespace rcme {\nstruct Pair;\nstruct Pair {\n};\nnamespace {\nstruct Own {};\n}  // namespace\nclass Late final : A {\n"
    assert types_in(text) == ["rcme::Pair", "rcme::Late"], types_in(text)
    assert types_in("struct alignas(64) Block {") == ["Block"], "an aligned type is not seen"


def main():
    check_itself()
    places = collections.defaultdict(list)
    for path in (path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".cc", ".h")):
        for name in types_in(path.read_text(encoding="utf-8")):
            places[name].append(ALTERNATIVE.sub("", str(path.relative_to(ROOT))))
    faults = [f"{name}: defined in {', '.join(files)}; rename all but one" for name, files in sorted(places.items())
              if len(set(files)) > 1]
    print("\n".join(faults) or "none")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
