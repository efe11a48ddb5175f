"""The recipes of packaging/ fit the project: dependencies, version, licence, options of the build, named files. Nothing is built."""

import json
import pathlib
import re
import shutil
import tempfile
import unittest

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
LICENSES = {"Apache License": "Apache-2.0"}  # first line of LICENSE -> SPDX identifier
# What cmake/RcmeDependencies.cmake finds -> the packages of conda-forge and of vcpkg that bring it.
PACKAGES = {
    "Boost": (["libboost-devel"], ["boost-math", "boost-multiprecision", "boost-random"]),
    "CLI11": (["cli11"], ["cli11"]),
    "Ceres": (["ceres-solver"], ["ceres"]),
    "Eigen3": (["eigen"], ["eigen3"]),
    "OpenCV": (["libopencv"], ["opencv4"]),
    "SQLite3": (["sqlite"], ["sqlite3"]),
    "SQLiteCpp": (["sqlitecpp"], ["sqlitecpp"]),
    "Threads": ([], []),
    "ZLIB": (["zlib"], ["zlib"]),
    "fmt": (["fmt"], ["fmt"]),
    "hwy": (["libhwy"], ["highway"]),
    "nlohmann_json": (["nlohmann_json"], ["nlohmann-json"]),
    "opengv": (["opengv"], ["opengv"]),
    "yaml-cpp": (["yaml-cpp"], ["yaml-cpp"]),
}
OWN_PACKAGES = {"opengv"}  # with a recipe here, because conda-forge and vcpkg lack them


def files_of_the_build(root):
    """Those of the libraries and the program: tests and examples are not packaged."""
    return [root / "CMakeLists.txt", *sorted((root / "cmake").glob("*.cmake")),
            *(file for file in sorted(root.glob("*/CMakeLists.txt")) if file.parent.name not in ("tests", "examples"))]


def read_project(root):
    """{"version", "license", "options", "dependencies": {name: lowest version or ""}} as CMake and LICENSE state them."""
    cmake = (root / "CMakeLists.txt").read_text(encoding="utf-8")
    required = []
    for file in files_of_the_build(root):
        text = re.sub(r"#[^\n]*", "", file.read_text(encoding="utf-8"))
        for call, name, version, rest in re.findall(r"\b(find_dependency|find_package)\(\s*([\w.+-]+)(?:\s+([\d.]+))?([^)]*)\)", text):
            if call == "find_dependency" or "REQUIRED" in rest:
                required.append((name, version))
        for modules in re.findall(r"\bpkg_(?:check_modules|search_module)\(\s*\w+\s+REQUIRED\b([^)]*)\)", text):
            required += [(name, "") for name in re.findall(r"(?<![\w=<>.-])[a-z][\w.+-]*", modules)]
    first = (root / "LICENSE").read_text(encoding="utf-8").strip().splitlines()[0].strip()
    return {"version": re.search(r"project\(\w+ VERSION ([\d.]+)", cmake)[1], "license": LICENSES[first],
            "options": set(re.findall(r"^option\((\w+)", cmake, re.MULTILINE)), "dependencies": dict(required)}


def read_conda(file):
    recipe = yaml.safe_load(file.read_text(encoding="utf-8"))
    context = recipe["context"]
    version = recipe["package"]["version"]
    recipe["package"]["version"] = re.sub(r"\$\{\{ (\w+) \}\}", lambda match: str(context[match[1]]), version)
    return recipe


def conda_bounds(recipe, section):
    """{package: its lowest version, or ""} of host or run."""
    found = {}
    for entry in recipe["requirements"].get(section, []):
        name, _, bounds = entry.partition(" ")
        lowest = re.search(r">=([\d.]+)", bounds)
        found[name] = lowest[1] if lowest else ""
    return found


def named_files_of_conda(recipe, folder, root):
    """The files of the source tree that a recipe names."""
    source = (folder / recipe["source"]["path"]).resolve()
    yield source / "CMakeLists.txt"
    licenses = recipe["about"]["license_file"]
    yield from (source / file for file in ([licenses] if isinstance(licenses, str) else licenses))
    for test in recipe["tests"]:
        contents = test.get("package_contents", {})
        for file in contents.get("include", []):
            yield root / file.removeprefix("rcme/")
        for file in contents.get("files", []):
            if file.startswith("share/rcme/"):
                yield root / file.removeprefix("share/rcme/")
            elif file.startswith("lib/cmake/rcme/"):
                yield root / "cmake" / (file.removeprefix("lib/cmake/rcme/") + ".in")
            else:
                yield root / file
        for line in test.get("script", []):
            for study in re.findall(r"^rcme run (\w+)", line):
                yield root / f"studies/{study}.yaml"


def named_files_of_vcpkg(portfile, folder):
    """The files of the source tree and of the port that a portfile names."""
    source, = re.findall(r'get_filename_component\(SOURCE_PATH "\$\{CMAKE_CURRENT_LIST_DIR\}/([./]+)" ABSOLUTE\)', portfile)
    source = (folder / source).resolve()
    yield source / "CMakeLists.txt"
    yield from (source / file for file in re.findall(r"\$\{SOURCE_PATH\}/([\w./-]+)", portfile))
    yield from (folder / file for file in re.findall(r"\$\{(?:CMAKE_CURRENT_LIST_DIR|CURRENT_PORT_DIR)\}/(\w[\w./-]*)", portfile))
    for patches in re.findall(r"PATCHES((?:\s+[\w./-]+\.(?:patch|diff))+)", portfile):
        yield from (folder / file for file in patches.split())


def numbers(version):
    return tuple(int(part) for part in version.split("."))


def find_faults(root):
    """What does not fit, a sentence each."""
    project, faults = read_project(root), []
    conda_folder, vcpkg_folder = root / "packaging/conda", root / "packaging/vcpkg"
    conda = read_conda(conda_folder / "recipe.yaml")
    vcpkg = json.loads((vcpkg_folder / "vcpkg.json").read_text(encoding="utf-8"))
    portfile = (vcpkg_folder / "portfile.cmake").read_text(encoding="utf-8")
    host = conda_bounds(conda, "host")
    ports = {entry if isinstance(entry, str) else entry["name"] for entry in vcpkg["dependencies"]}

    for name, lowest in project["dependencies"].items():
        if name not in PACKAGES:
            faults.append(f"{name}: add its packages to PACKAGES and to the recipes")
            continue
        for package in PACKAGES[name][0]:
            if package not in host:
                faults.append(f"recipe.yaml: {package} is missing, which brings {name}")
            elif host[package] != lowest:
                faults.append(f"recipe.yaml: {package} >={host[package]}, but CMake asks for {name} {lowest}")
        faults += [f"vcpkg.json: {port} is missing, which brings {name}" for port in PACKAGES[name][1] if port not in ports]
    for name, stated in (("recipe.yaml", conda["package"]["version"]), ("vcpkg.json", vcpkg["version"])):
        if stated != project["version"]:
            faults.append(f"{name}: version {stated}, but the project is {project['version']}")
    for name, stated in (("recipe.yaml", conda["about"]["license"]), ("vcpkg.json", vcpkg["license"])):
        if stated != project["license"]:
            faults.append(f"{name}: licence {stated}, but LICENSE is {project['license']}")
    build = "\n".join(conda["build"]["script"])
    for name, text in (("recipe.yaml", build), ("portfile.cmake", portfile)):
        known = project["options"] | {"RCME_HDF5_LIBRARY"}
        faults += [f"{name}: -D{option} is no option of CMakeLists.txt" for option in re.findall(r"-D(RCME_\w+)=", text) if option not in known]
    files = [*named_files_of_conda(conda, conda_folder, root), *named_files_of_vcpkg(portfile, vcpkg_folder)]
    faults += [f"{file.relative_to(root)}: named in a recipe, but does not exist" for file in files if not file.is_file()]
    for package in sorted(OWN_PACKAGES):
        for file in (f"packaging/conda/{package}/recipe.yaml", f"packaging/vcpkg/{package}/vcpkg.json", f"packaging/vcpkg/{package}/portfile.cmake"):
            if not (root / file).is_file():
                faults.append(f"{file}: does not exist, but the recipes need {package}")
    return faults


class Recipes(unittest.TestCase):
    def test_they_fit_the_project(self):
        self.assertEqual(find_faults(ROOT), [])

    def test_all_dependencies_of_cmake_are_read(self):
        dependencies = read_project(ROOT)["dependencies"]
        self.assertEqual(set(dependencies), set(PACKAGES))
        self.assertEqual((dependencies["Eigen3"], dependencies["OpenCV"], dependencies["ZLIB"]), ("3.4", "4.6", ""))

    def test_the_recipes_of_a_dependency_build_one_commit(self):
        recipe = read_conda(ROOT / "packaging/conda/opengv/recipe.yaml")
        port = json.loads((ROOT / "packaging/vcpkg/opengv/vcpkg.json").read_text(encoding="utf-8"))
        ref, = re.findall(r"REF (\w+)", (ROOT / "packaging/vcpkg/opengv/portfile.cmake").read_text(encoding="utf-8"))
        self.assertEqual(recipe["context"]["commit"], ref)
        self.assertEqual(recipe["package"]["version"], port["version"])
        self.assertGreaterEqual(numbers(port["version"]), numbers(read_project(ROOT)["dependencies"]["opengv"]))


class TheComparison(unittest.TestCase):
    """Plants a fault in a copy of the files that the test reads."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name).resolve()
        for folder in ("packaging", "cmake"):
            shutil.copytree(ROOT / folder, self.root / folder)
        for file in ("CMakeLists.txt", "LICENSE", "NOTICE", "estimator/motion_estimator.h", "robot/two_view.h",
                     "studies/failure_vs_outliers.yaml", "plots/failure_rate.py"):
            (self.root / file).parent.mkdir(exist_ok=True)
            shutil.copy(ROOT / file, self.root / file)
        self.assertEqual(find_faults(self.root), [])

    def faults_with(self, file, old, new):
        path = self.root / file
        text = path.read_text(encoding="utf-8")
        self.assertEqual(text.count(old), 1, old)
        path.write_text(text.replace(old, new), encoding="utf-8")
        return find_faults(self.root)

    def test_a_removed_dependency_is_seen(self):
        self.assertEqual(self.faults_with("packaging/conda/recipe.yaml", "    - sqlitecpp >=3.2\n", ""),
                         ["recipe.yaml: sqlitecpp is missing, which brings SQLiteCpp"])

    def test_a_removed_port_is_seen(self):
        self.assertEqual(self.faults_with("packaging/vcpkg/vcpkg.json", '    "highway",\n', ""),
                         ["vcpkg.json: highway is missing, which brings hwy"])

    def test_a_new_dependency_of_cmake_is_seen(self):
        lines = {"find_dependency(TBB 2021)": "TBB", "find_package(LAPACK REQUIRED)": "LAPACK", "find_package(\n  GTest 1.12 CONFIG REQUIRED)": "GTest",
                 "pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd>=1.5)": "libzstd"}
        for line, name in lines.items():
            with self.subTest(line=line):
                self.assertEqual(self.faults_with("cmake/RcmeDependencies.cmake", "find_dependency(ZLIB)", f"find_dependency(ZLIB)\n{line}"),
                                 [f"{name}: add its packages to PACKAGES and to the recipes"])
            shutil.copy(ROOT / "cmake/RcmeDependencies.cmake", self.root / "cmake")

    def test_an_optional_package_may_be_left_out(self):
        self.assertEqual(self.faults_with("cmake/RcmeDependencies.cmake", "find_dependency(ZLIB)", "find_dependency(ZLIB)\nfind_package(TBB QUIET)"), [])

    def test_another_lower_bound_is_seen(self):
        self.assertEqual(self.faults_with("cmake/RcmeDependencies.cmake", "(Ceres 2.1)", "(Ceres 2.2)"),
                         ["recipe.yaml: ceres-solver >=2.1, but CMake asks for Ceres 2.2"])

    def test_a_wrong_version_is_seen(self):
        self.assertEqual(self.faults_with("packaging/conda/recipe.yaml", 'version: "0.1.0"', 'version: "0.2.0"'),
                         ["recipe.yaml: version 0.2.0, but the project is 0.1.0"])
        self.assertEqual(len(self.faults_with("CMakeLists.txt", "VERSION 0.1.0", "VERSION 0.3.0")), 2)

    def test_another_licence_is_seen(self):
        self.assertEqual(self.faults_with("packaging/vcpkg/vcpkg.json", '"Apache-2.0"', '"MIT"'),
                         ["vcpkg.json: licence MIT, but LICENSE is Apache-2.0"])

    def test_a_file_that_does_not_exist_is_seen(self):
        (self.root / "NOTICE").unlink()
        self.assertEqual(find_faults(self.root), 2 * ["NOTICE: named in a recipe, but does not exist"])

    def test_an_unknown_option_of_the_build_is_seen(self):
        self.assertEqual(self.faults_with("packaging/vcpkg/portfile.cmake", "-DRCME_BUILD_TESTS=OFF", "-DRCME_TESTS=OFF"),
                         ["portfile.cmake: -DRCME_TESTS is no option of CMakeLists.txt"])

    def test_a_missing_recipe_of_a_dependency_is_seen(self):
        shutil.rmtree(self.root / "packaging/conda/opengv")
        self.assertEqual(find_faults(self.root), ["packaging/conda/opengv/recipe.yaml: does not exist, but the recipes need opengv"])


if __name__ == "__main__":
    unittest.main()
