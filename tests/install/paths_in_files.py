"""Names the files of a folder that hold one of these paths, byte by byte; exit code 1 if there is one.

    paths_in_files.py FOLDER PATH...

A compiler puts short strings into its instructions and constants, eight or sixteen bytes at a time: a program holds a
path too if it holds every whole eight bytes of it. What a debugger reads of programs and libraries does not count."""

import pathlib
import re
import subprocess
import sys
import tempfile

WORD = 8
COMPILED = (b"\x7fELF", b"!<arch>\n")


def bytes_of(path):
    content = path.read_bytes()
    if not content.startswith(COMPILED):
        return content
    with tempfile.NamedTemporaryFile() as stripped:
        subprocess.run(["strip", "--strip-debug", "-o", stripped.name, path], check=True)
        return pathlib.Path(stripped.name).read_bytes()


def holds(content, path):
    """Whole, or of a compiled file in pieces. A short path (/rcme) only where it ends no longer one (share/rcme)."""
    name = path.encode()
    if len(name) < WORD:
        return re.search(rb"(?<![\w.])" + re.escape(name) + rb"(?![\w.-])", content) is not None
    if name in content:
        return True
    pieces = [name[i:i + WORD] for i in range(0, len(name) - WORD + 1, WORD)]
    return content.startswith(COMPILED) and all(piece in content for piece in pieces)


def found(folder, paths):
    """[(file, path)]; a file is read once."""
    files = [file for file in sorted(pathlib.Path(folder).rglob("*")) if file.is_file()]
    return [(file, path) for file in files for content in [bytes_of(file)] for path in paths if holds(content, path)]


if __name__ == "__main__":
    everywhere = found(sys.argv[1], dict.fromkeys(sys.argv[2:]))
    for file, path in everywhere:
        print(f"{file} holds {path}")
    sys.exit(bool(everywhere))
