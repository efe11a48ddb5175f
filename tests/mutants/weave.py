"""All mutants of a source file in one text (mutant schemata: Untch, Offutt & Harrold 1993): an environment variable
chooses at run time which one is on, so that one build serves them all."""

import os
import pathlib
import re
import subprocess

from entries import EntryError

INCLUDE = '#include "tests/mutants/selected_mutant.h"\n'


def choice(mutant, number, original):
    is_on = f"::rcme::mutants::IsOn({number})"
    if mutant.was.endswith(";"):
        return f"{{ if ({is_on}) {{ {mutant.now} }} else {{ {original} }} }}"
    return f"({is_on} ? ({mutant.now}) : ({original}))"


def weave_span(source, begin, end, numbered):
    """source[begin:end] with the mutants in it, which are `numbered` = [(mutant, number)]."""
    text, at = "", begin
    # Outer ones first; of equal spans the first is the outermost.
    rest = sorted(numbered, key=lambda pair: (pair[0].begin, -pair[0].end))
    while rest:
        mutant, number = rest.pop(0)
        inner = [pair for pair in rest if pair[0].begin < mutant.end]
        rest = rest[len(inner):]
        for other, _ in inner:
            if other.end > mutant.end:
                raise EntryError(f"{mutant.file}: {mutant.name} and {other.name} overlap")
        text += source[at:mutant.begin] + choice(mutant, number,
                                                 weave_span(source, mutant.begin, mutant.end, inner))
        at = mutant.end
    return text + source[at:end]


def weave(source, numbered):
    """The whole text of a C++ source file with its mutants."""
    woven = weave_span(source, 0, len(source), numbered)
    # Behind the guard of a header, so that none of what follows stands outside it.
    guard = re.search(r"^(#pragma once|#define RCME_\w+_INL_H_\n#endif)\n", woven, re.MULTILINE)
    at = guard.end() if guard else 0
    return woven[:at] + INCLUDE + woven[at:]


def write_if_other(path, content):
    """Leaves a file alone that is as it should be: what depends on it need not be built again."""
    if path.exists() and path.read_bytes() == content:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)


def write_tree(source_folder, tree, numbers):
    """A copy of the source tree with all mutants woven in; numbers: {mutant: number}."""
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=source_folder, check=True,
                            capture_output=True, text=True).stdout.splitlines()
    wanted = {file for file in listed if (source_folder / file).is_file()}
    for file in wanted:
        numbered = [(mutant, number) for mutant, number in numbers.items() if mutant.file == file]
        content = (source_folder / file).read_bytes()
        if numbered and file.endswith((".cc", ".h")):
            content = weave(content.decode(), numbered).encode()
        write_if_other(tree / file, content)
        os.chmod(tree / file, (source_folder / file).stat().st_mode)
    for path in list(tree.rglob("*")):
        file = path.relative_to(tree)
        if file.parts[0] != "build" and path.is_file() and str(file) not in wanted:
            path.unlink()
    return pathlib.Path(tree)
