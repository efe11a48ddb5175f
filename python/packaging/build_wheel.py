"""The build backend of pip (PEP 517): CMake builds, this file packs. It needs nothing beyond Python's own library, so that
`pip install .` asks no network for a build tool.

    pip install .                                              builds in build/python-cp311
    pip install . --config-settings build-dir=build/release    takes what is built there already
    pip install . --config-settings cmake-args=-DCMAKE_PREFIX_PATH=/opt/poselib
"""

import base64
import hashlib
import pathlib
import re
import shlex
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKED = (".py", ".pyi", ".so", "py.typed")


def get_requires_for_build_wheel(config_settings=None):
    return []


def get_requires_for_build_sdist(config_settings=None):
    return []


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    settings = config_settings or {}
    folder = build(ROOT / settings.get("build-dir", f"build/python-{python_tag()}"), shlex.split(settings.get("cmake-args", "")))
    files = {f"rcme/{file.name}": file.read_bytes() for file in sorted((folder / "python/rcme").iterdir())
             if file.name.endswith(PACKED)}
    files |= {f"rcme/share/{file.relative_to(ROOT)}": file.read_bytes()
              for folder in ("studies", "estimator_files", "populations") for file in sorted((ROOT / folder).rglob("*.yaml"))}
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


def build(folder, cmake_arguments):
    """Builds the module, in a folder that is there already as it is configured, else for this very interpreter; returns the
    folder."""
    if not (folder / "CMakeCache.txt").exists():
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                        f"-DPython_EXECUTABLE={sys._base_executable}", "-DRCME_BUILD_PYTHON=ON", "-DRCME_BUILD_TESTS=OFF",
                        "-DRCME_BUILD_BENCHMARKS=OFF", *cmake_arguments], check=True, stdout=sys.stderr)
    result = subprocess.run(["cmake", "--build", folder, "--target", "rcme_python"], stdout=sys.stderr, check=False)
    module = folder / "python/rcme" / ("_rcme" + sysconfig.get_config_var("EXT_SUFFIX"))
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


def write_wheel(path, files, project):
    info = f"{project['name']}-{project['version']}.dist-info"
    files = {**files, f"{info}/METADATA": metadata(project).encode(),
             f"{info}/WHEEL": (f"Wheel-Version: 1.0\nGenerator: rcme\nRoot-Is-Purelib: false\nTag: {tag()}\n").encode(),
             f"{info}/LICENSE": (ROOT / "LICENSE").read_bytes(), f"{info}/NOTICE": (ROOT / "NOTICE").read_bytes()}
    record = "".join(f"{name},sha256={hash_of(content)},{len(content)}\n" for name, content in files.items())
    files[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)


def hash_of(content):
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
