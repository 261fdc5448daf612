"""Source distribution and wheel, built and installed as a stranger does it, and what a type checker finds."""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from importlib.util import find_spec
from pathlib import Path

import pytest

from wspd_design.exchange.version import program_version
from wspd_design.studies.package import package

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
FILES = ("pyproject.toml", "README.md", "LICENSE", "CHANGELOG.md")
FOLDERS = ("wspd_design", "docs")
SDIST = "from setuptools.build_meta import build_sdist; print(build_sdist('.'))"
IDENTITY = "from wspd_design.studies.package import package; print(package().sha256)"


def call(*words, **options):
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def tools(tmp_path_factory):
    """An environment with the newest tools that build, as pip makes one for itself."""
    if find_spec("pip") is None:
        pytest.skip("pip, which builds the wheel, is not in this environment")
    folder = tmp_path_factory.mktemp("tools")
    pip = (sys.executable, "-m", "pip", "install", "--quiet", "--target", folder, "setuptools", "wheel")
    if subprocess.run(list(map(str, pip)), capture_output=True, check=False).returncode != 0:
        pytest.skip("no package index: setuptools and wheel cannot be had")
    return os.environ | {"PYTHONPATH": str(folder)}


@pytest.fixture(scope="module")
def source(tmp_path_factory, tools):
    """The source distribution, from the files of the repository alone."""
    copy = tmp_path_factory.mktemp("source")
    for name in FILES:
        shutil.copy(ROOT / name, copy)
    for name in FOLDERS:
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__", "prebuilt"))
    name = call(sys.executable, "-c", SDIST, cwd=copy, env=tools).splitlines()[-1]
    return copy / name


@pytest.fixture(scope="module")
def wheel(tmp_path_factory, source, tools):
    """The wheel, from the source distribution and nothing else."""
    folder = tmp_path_factory.mktemp("wheel")
    options = ("--no-deps", "--no-build-isolation", "--quiet", "--wheel-dir", folder)
    call(sys.executable, "-m", "pip", "wheel", *options, source, env=tools)
    (made,) = folder.glob("*.whl")
    return made


@pytest.fixture(scope="module")
def environment(tmp_path_factory, wheel):
    """A clean environment with the wheel; the packages that it needs are lent by this one."""
    folder = tmp_path_factory.mktemp("clean")
    call(sys.executable, "-m", "venv", "--without-pip", folder)
    python = folder / "bin" / "python"
    call(sys.executable, "-m", "pip", "--python", python, "install", "--no-deps", "--quiet", wheel)
    (lent,) = folder.glob("lib/python*/site-packages")
    # A folder that is named so is searched, but paths of editable installations in it are not followed.
    (lent / "lent.pth").write_text(f"{sysconfig.get_path('purelib')}\n")
    return folder / "bin"


def own_files():
    root = ROOT / "wspd_design"
    found = (path for path in root.rglob("*") if path.is_file() and "prebuilt" not in path.parts)
    return {path.relative_to(ROOT).as_posix() for path in found if path.suffix not in (".pyc", ".so")}


def test_both_hold_every_file_of_the_package_and_the_pages(source, wheel):
    pages = {*(path.name for path in (ROOT / "docs").glob("*.md")), "CHANGELOG.md"}
    with tarfile.open(source) as archive:
        held = {name.partition("/")[2] for name in archive.getnames()}
    assert own_files() | {name if name in FILES else f"docs/{name}" for name in pages} <= held
    with zipfile.ZipFile(wheel) as archive:
        held = set(archive.namelist())
    assert own_files() <= held
    assert pages == {name.rpartition("/")[2] for name in held if "/share/doc/wspd-design/" in name}


def test_the_installed_program_is_this_one_and_works(environment, tmp_path):
    plain = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    here = {"cwd": tmp_path, "env": plain}
    assert call(environment / "wspd", "--version", **here) == f"wspd {program_version()}\n"
    assert call(environment / "python", "-c", IDENTITY, **here).strip() == package().sha256
    assert call(environment / "wspd", "docs", "own-controller", **here).startswith("# Your own controller")
    stop = json.loads(call(environment / "wspd", "simulate", "none", "--speed", "10 km/h", "--json", **here))
    assert stop["schema"].startswith("wspd-stop/")


def test_a_type_checker_finds_the_installed_package(environment, tmp_path):
    """A user's own code is checked against the types of the package, also of an editable installation."""
    (tmp_path / "own.py").write_text(
        "from wspd_design.parameters.errors import UserError\nreveal_type(UserError('no').args)\n"
    )
    editable = Path(sysconfig.get_path("purelib")).glob("__editable__.wspd_design*.pth")
    plain = any(Path(path.read_text().strip()).is_dir() for path in editable)
    python = sys.executable if plain else environment / "python"
    out = call(sys.executable, "-m", "mypy", "--python-executable", python, "own.py", cwd=tmp_path)
    assert 'Revealed type is "tuple[' in out.replace("builtins.", "")
