"""Builds the wheel for `pip install .`: the program and its Python module as CMake installs them (PEP 517, called by pip alone).

The wheel is for the machine that builds it: it takes libraries, and NumPy, from Debian. The build is that of OSCULATE_BUILD, default
build/release.
"""
import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BUILD = ROOT / os.environ.get("OSCULATE_BUILD", "build/release")
MODULES = "lib/python3/dist-packages/"  # where CMake puts them


def project():
    """(version, description) of CMakeLists.txt"""
    return re.search(r'project\(osculate VERSION ([\d.]+) DESCRIPTION "([^"]*)"', (ROOT / "CMakeLists.txt").read_text()).groups()


def tag():
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{platform}"


def described():
    """Files of the wheel's dist-info, without their record."""
    version, description = project()
    metadata = f"Metadata-Version: 2.1\nName: osculate\nVersion: {version}\nSummary: {description}\nRequires-Python: >=3.11\nRequires-Dist: numpy\n"
    return {"METADATA": metadata, "WHEEL": f"Wheel-Version: 1.0\nGenerator: osculate\nRoot-Is-Purelib: false\nTag: {tag()}\n"}


def get_requires_for_build_wheel(config_settings=None):
    return []


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    folder = Path(metadata_directory) / f"osculate-{project()[0]}.dist-info"
    folder.mkdir()
    for name, text in described().items():
        (folder / name).write_text(text)
    return folder.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    subprocess.run([ROOT / "scripts/install", "--no-install"], check=True)
    # no tests where nothing is built yet
    fresh = {} if (BUILD / "build.ninja").exists() else {"OSCULATE_CMAKE": "-DBUILD_TESTING=OFF"}
    targets = ["osculate", "osculate_gmsh", "osculate_python"]
    subprocess.run([ROOT / "scripts/build", *targets], check=True, env={**os.environ, **fresh})
    version = project()[0]
    info, data = f"osculate-{version}.dist-info", f"osculate-{version}.data/data"
    name = f"osculate-{version}-{tag()}.whl"
    record = []
    with tempfile.TemporaryDirectory() as prefix, zipfile.ZipFile(Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        def add(path, content, mode=0o644):
            entry = zipfile.ZipInfo(path)
            entry.external_attr = (0o100000 | mode) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, content)
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record.append(f"{path},sha256={digest},{len(content)}")

        for component in ("program", "python"):
            subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix, "--component", component], check=True, stdout=subprocess.DEVNULL)
        for path in sorted(p for p in Path(prefix).rglob("*") if p.is_file()):
            inside = path.relative_to(prefix).as_posix()
            module = inside.startswith(MODULES)
            add(inside.removeprefix(MODULES) if module else f"{data}/{inside}", path.read_bytes(), path.stat().st_mode & 0o777)
        for inside, text in described().items():
            add(f"{info}/{inside}", text.encode())
        wheel.writestr(f"{info}/RECORD", "\n".join([*record, f"{info}/RECORD,,"]) + "\n")
    return name


def build_sdist(sdist_directory, config_settings=None):
    raise NotImplementedError("the sources are those of the repository")
