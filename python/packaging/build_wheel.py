"""The build backend of pip (PEP 517): CMake builds, this file packs the module, the program and what the program reads. It
needs nothing beyond Python's own library, so that `pip install .` asks no network for a build tool.

    pip install .                                    builds in build/release if that has a module for this Python, else in
                                                     build/python-cp311
    pip install . --config-settings build-dir=FOLDER builds there
    pip install . --config-settings cmake-args=-DCMAKE_PREFIX_PATH=/opt/poselib
"""

import base64
import hashlib
import pathlib
import re
import shlex
import stat
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKED = (".py", ".pyi", ".so", "py.typed")
SHARED = {"studies": "*.yaml", "estimator_files": "*.yaml", "populations": "*.yaml", "plots": "*.py"}  # what the program reads


def get_requires_for_build_wheel(config_settings=None):
    return []


def get_requires_for_build_sdist(config_settings=None):
    return []


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Without building."""
    project = read_project()
    for name, content in information(project).items():
        path = pathlib.Path(metadata_directory) / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)
    return info_folder(project)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    settings = config_settings or {}
    folder = build(ROOT / settings.get("build-dir", usual_folder()), shlex.split(settings.get("cmake-args", "")))
    files = {f"rcme/{file.name}": file.read_bytes() for file in sorted((folder / "python/rcme").iterdir())
             if file.name.endswith(PACKED)}
    files["rcme/bin/rcme"] = (folder / "bin/rcme").read_bytes()
    files |= {f"rcme/share/rcme/{file.relative_to(ROOT)}": file.read_bytes()
              for shared, pattern in SHARED.items() for file in sorted((ROOT / shared).rglob(pattern))}
    project = read_project()
    name = f"{project['name']}-{project['version']}-{tag()}.whl"
    write_wheel(pathlib.Path(wheel_directory) / name, files, project)
    return name


def build_sdist(sdist_directory, config_settings=None):
    """Everything that git knows of, but for results."""
    project = read_project()
    base = f"{project['name']}-{project['version']}"
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.splitlines()
    path = pathlib.Path(sdist_directory) / f"{base}.tar.gz"
    with tarfile.open(path, "w:gz") as archive:
        for file in listed:
            if not file.startswith("results/"):
                archive.add(ROOT / file, f"{base}/{file}")
        info = ROOT / "build" / "PKG-INFO"
        info.parent.mkdir(exist_ok=True)
        info.write_text(metadata(project), encoding="utf-8")
        archive.add(info, f"{base}/PKG-INFO")
    return path.name


def module_in(folder):
    return folder / "python/rcme" / ("_rcme" + sysconfig.get_config_var("EXT_SUFFIX"))


def usual_folder():
    """Within the project."""
    return "build/release" if module_in(ROOT / "build/release").exists() else f"build/python-{python_tag()}"


def build(folder, cmake_arguments):
    """Builds the module and the program, in a folder that is there already as it is configured, else for this very interpreter; returns the
    folder."""
    if not (folder / "CMakeCache.txt").exists():
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                        f"-DPython_EXECUTABLE={sys._base_executable}", "-DRCME_BUILD_PYTHON=ON", "-DRCME_BUILD_TESTS=OFF",
                        "-DRCME_BUILD_BENCHMARKS=OFF", *cmake_arguments], check=True, stdout=sys.stderr)
    result = subprocess.run(["cmake", "--build", folder, "--target", "rcme_python", "rcme"], stdout=sys.stderr, check=False)
    module = module_in(folder)
    if result.returncode != 0 or not module.exists():
        raise SystemExit(f"rcme: {module} was not built. It needs pybind11 and Python's headers (Debian: pybind11-dev, "
                         "python3-dev) and the packages of scripts/packages.txt; scripts/install-deps installs them. A folder "
                         "that was configured for another Python builds for that one.")
    return folder


def read_project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    cmake = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return {**project, "version": re.search(r"project\(rcme VERSION ([\d.]+)", cmake).group(1)}


def python_tag():
    return f"cp{sys.version_info.major}{sys.version_info.minor}"


def tag():
    """Of this interpreter on this system: the module links to its libraries (cibuildwheel's repair step packs them in)."""
    python = python_tag()
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"{python}-{python}-{platform}"


def metadata(project):
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {project['version']}",
             f"Summary: {project['description']}", f"License: {project['license']['text']}",
             f"Requires-Python: {project['requires-python']}", "Description-Content-Type: text/markdown",
             *(f"Requires-Dist: {dependency}" for dependency in project["dependencies"])]
    for extra, dependencies in project.get("optional-dependencies", {}).items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f"Requires-Dist: {dependency} ; extra == '{extra}'" for dependency in dependencies]
    return "\n".join(lines) + "\n\n" + (ROOT / "docs/python.md").read_text(encoding="utf-8")


def info_folder(project):
    return f"{project['name']}-{project['version']}.dist-info"


def information(project):
    """The files of the folder dist-info, but for its list of all files."""
    info = info_folder(project)
    scripts = "".join(f"{name} = {function}\n" for name, function in project["scripts"].items())
    return {f"{info}/METADATA": metadata(project).encode(), f"{info}/entry_points.txt": f"[console_scripts]\n{scripts}".encode(),
            f"{info}/WHEEL": (f"Wheel-Version: 1.0\nGenerator: rcme\nRoot-Is-Purelib: false\nTag: {tag()}\n").encode(),
            f"{info}/LICENSE": (ROOT / "LICENSE").read_bytes(), f"{info}/NOTICE": (ROOT / "NOTICE").read_bytes()}


def write_wheel(path, files, project):
    info = info_folder(project)
    files = {**files, **information(project)}
    record = "".join(f"{name},sha256={hash_of(content)},{len(content)}\n" for name, content in files.items())
    files[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr = (stat.S_IFREG | (0o755 if name.endswith((".so", "bin/rcme")) else 0o644)) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)


def hash_of(content):
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
