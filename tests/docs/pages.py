"""The commands and files that a page of the documents shows."""

import dataclasses
import re

FENCE = re.compile(r"^\s*```(\w*)\s*$")
FILE_BEFORE = re.compile(r"`([\w./-]+)`:\s*$")  # "..., in `first.yaml`:" before a block: the file it shows
GENERATED = re.compile(r"<!-- begin generated: .*?<!-- end generated: ", re.DOTALL)  # of committed results, not of the commands beside it
COMMENT = re.compile(r"\s+# .*$|\s{2,}#.*$")
FIRST_WORDS = ("rcme", "build/release/bin/rcme", "scripts/", "python3", "pip", "cmake", "sbatch", "sacct", "parallel",
               "kubectl", "mkdir ", "PYTHONPATH=")


@dataclasses.dataclass(frozen=True)
class Command:
    line: int  # of the page, from 1
    text: str


@dataclasses.dataclass(frozen=True)
class ShownFile:
    line: int
    name: str
    text: str


@dataclasses.dataclass(frozen=True)
class ShownOutput:
    """What the command before it prints; "..." stands for lines that are left out."""

    line: int
    text: str


def code_blocks(text):
    """(number of the first line, language or "", lines without the indentation, the line of text before) of each block."""
    lines = text.splitlines()
    blocks, number, before = [], 0, ""
    while number < len(lines):
        fence = FENCE.match(lines[number])
        if fence:
            end = next(i for i in range(number + 1, len(lines)) if FENCE.match(lines[i]))
            blocks.append((number + 2, fence[1], lines[number + 1:end], before))
            number = end + 1
        elif lines[number].startswith("    ") and not before.lstrip().startswith(("-", "1.")):
            end = number
            while end < len(lines) and (lines[end].startswith("    ") or not lines[end].strip()):
                end += 1
            blocks.append((number + 1, "", [line[4:] for line in lines[number:end]], before))
            number = end
        else:
            before = lines[number] if lines[number].strip() else before
            number += 1
    return blocks


def contents(text):
    """What a page shows, in its order: files, commands and (blocks called `text`) their output."""
    shown = []
    text = GENERATED.sub(lambda block: "\n" * block[0].count("\n"), text)
    for begin, language, lines, before in code_blocks(text):
        name = FILE_BEFORE.search(before)
        if name and language in ("yaml", "json", "csv"):
            shown.append(ShownFile(begin, name[1], "\n".join(lines) + "\n"))
            continue
        if language == "text":
            shown.append(ShownOutput(begin, "\n".join(lines)))
        if language not in ("", "sh", "bash"):
            continue
        number = 0
        while number < len(lines):
            first, line = number, lines[number]
            while line.endswith("\\") and number + 1 < len(lines):
                number += 1
                line = line[:-1].rstrip() + " " + lines[number].strip()
            number += 1
            line = COMMENT.sub("", line).strip()
            if line.startswith(FIRST_WORDS):
                shown.append(Command(begin + first, line))
    return shown
