"""NOTICE names what the program links and what is compiled into it; RCME names the program."""

import os
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOTICE = (ROOT / "NOTICE").read_text()

# Packages of scripts/packages.txt from which nothing gets into a binary, or only through a library that NOTICE names.
NOT_IN_BINARIES = {"libbenchmark-dev", "libgmock-dev", "libgtest-dev"}
NAMES = {"libopencv-dev": "libopencv-", "libfmt-dev": "libfmt9", "libhdf5-dev": "libhdf5-", "libhwy-dev": "libhwy1",
         "libopengv-dev": "libopengv1", "libsqlite3-dev": "libsqlite3-0", "libyaml-cpp-dev": "libyaml-cpp0", "zlib1g-dev": "zlib1g"}


def linked_by(program):
    """Names as `libfmt`, of the libraries that a program or library asks for itself."""
    listed = subprocess.run(["readelf", "-d", program], check=True, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"})
    return re.findall(r"\(NEEDED\)\s+Shared library: \[([\w+-]+)[\w.+-]*\]", listed.stdout)


def is_named(library):
    """As a word of NOTICE."""
    return re.search(rf"(?<![\w-]){re.escape(library)}(?![\w+-])", NOTICE) is not None


class Notice(unittest.TestCase):
    def test_every_linked_library_is_named(self):
        libraries = linked_by(os.environ["RCME"])
        self.assertGreater(len(libraries), 10)
        self.assertEqual([library for library in libraries if not is_named(library)], [])

    def test_the_module_of_python_links_nothing_else(self):
        modules = list((pathlib.Path(os.environ["RCME"]).resolve().parents[1]).glob("**/_rcme*.so"))
        for module in modules:
            self.assertEqual([library for library in linked_by(module) if not is_named(library)], [], module)

    def test_a_library_that_is_not_there_is_not_named(self):
        self.assertFalse(is_named("libavcodec"))
        self.assertFalse(is_named("libopencv_videoio"))
        self.assertTrue(is_named("libopencv_core"))

    def test_every_package_of_the_build_is_named(self):
        packages = [line for line in (ROOT / "scripts/packages.txt").read_text().split("\n") if re.fullmatch(r"(lib|zlib|nlohmann|pybind)\S*-dev", line)]
        self.assertGreater(len(packages), 15)
        for package in packages:
            if package not in NOT_IN_BINARIES:
                self.assertIn(NAMES.get(package, package), NOTICE)

    def test_cholmod_is_said_to_be_under_the_gpl(self):
        """Where the program links it: the one library whose licence decides about the whole binary."""
        if "libcholmod" in linked_by(os.environ["RCME"]):
            self.assertRegex(NOTICE, r"libcholmod[^\n]*\n?[^\n]*Supernodal, MatrixOps, Modify:\s+GPL-2.0-or-later")


if __name__ == "__main__":
    unittest.main()
