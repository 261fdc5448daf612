"""The identity of the program: git's own, that of sha256sum, and the same in a clone and in a wheel."""

import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from tests.unit.reporting.sample_dossier import SAMPLE_PROVENANCE
from wspd_design.reporting.made_by import made_by
from wspd_design.reporting.text import CodeSpan
from wspd_design.studies import package as package_module
from wspd_design.studies.package import identity, is_changed, package

ROOT = Path(__file__).parents[3]


def _git(folder, *words):
    options = ("-c", "user.name=test", "-c", "user.email=test@localhost")
    made = subprocess.run(["git", "-C", folder, *options, *words], capture_output=True, text=True, check=True)
    return made.stdout.strip()


@pytest.fixture
def clone(tmp_path):
    """A small package in a clone of its own."""
    folder = tmp_path / "clone" / "small"
    (folder / "data" / "a").mkdir(parents=True)
    for name in ("b.py", "a.py", "data.toml", "data/x.toml", "data/a/y.toml"):
        (folder / name).write_text(name)
    _git(folder.parent, "init", "--quiet")
    _git(folder.parent, "add", ".")
    _git(folder.parent, "commit", "--quiet", "-m", "All")
    return folder


def test_the_identity_is_what_git_and_sha256sum_say(clone):
    found = identity(clone)
    assert found.tree == _git(clone.parent, "rev-parse", "HEAD:small")
    command = "git ls-files small | LC_ALL=C sort | xargs sha256sum | sha256sum"
    told = subprocess.run(command, shell=True, cwd=clone.parent, capture_output=True, text=True, check=True)
    assert found.sha256 == told.stdout.split()[0]


def _commits(clone):
    """Run the command that a report prints, and return the first lines of the commits that it names."""
    made = replace(SAMPLE_PROVENANCE, package_tree=identity(clone).tree)
    program = next(each.text for each in made_by(made) if each.term == "Program")
    (command,) = (each.text for each in program if isinstance(each, CodeSpan) and " log " in each.text)
    return _git(clone.parent, *command.split()[1:], "--format=%s").splitlines()


def _commit(clone, name):
    (clone / f"{name}.py").write_text(name)
    _git(clone.parent, "add", ".")
    _git(clone.parent, "commit", "--quiet", "-m", name)


def test_the_tree_leads_to_the_commit_also_where_that_is_a_merge(clone):
    assert _commits(clone) == ["All"]
    _git(clone.parent, "checkout", "--quiet", "-b", "side")
    _commit(clone, "Side")
    _git(clone.parent, "checkout", "--quiet", "-")
    _commit(clone, "Main")
    _git(clone.parent, "merge", "--quiet", "side", "-m", "Merge")
    assert set(_commits(clone)) == {"Merge"}


def test_every_byte_and_every_name_counts_and_what_machines_make_does_not(clone):
    before = identity(clone)
    for name in (
        "__pycache__/a.pyc",
        "prebuilt/plant.so",
        "data/law.so",
        "empty/__pycache__/b.pyc",
        ".hidden",
    ):
        (clone / name).parent.mkdir(parents=True, exist_ok=True)
        (clone / name).write_text("made")
    assert identity(clone) == before
    (clone / "data" / "x.toml").write_text("data/x.tomL")
    changed = identity(clone)
    assert (changed.sha256 != before.sha256, changed.tree != before.tree) == (True, True)
    (clone / "data" / "x.toml").write_text("data/x.toml")
    (clone / "a.py").rename(clone / "c.py")
    assert identity(clone).sha256 not in (before.sha256, changed.sha256)


def test_a_clone_knows_whether_it_is_that_of_its_commit(clone, monkeypatch):
    monkeypatch.setattr(package_module, "_root", lambda: clone)
    for each in (package, is_changed):
        each.cache_clear()
    try:
        assert not is_changed()
        (clone / "a.py").write_text("planted")
        for each in (package, is_changed):
            each.cache_clear()
        assert is_changed()
        shutil.rmtree(clone.parent / ".git")  # as installed: nobody can tell
        is_changed.cache_clear()
        assert not is_changed()
    finally:
        for each in (package, is_changed):
            each.cache_clear()


@pytest.mark.slow
def test_a_wheel_has_the_identity_of_the_clone(tmp_path):
    source = tmp_path / "source"
    shutil.copytree(
        ROOT / "wspd_design", source / "wspd_design", ignore=shutil.ignore_patterns("__pycache__")
    )
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    build = "from setuptools import setup; setup(script_args=['--quiet', 'build_py', '--build-lib', 'built'])"
    subprocess.run([sys.executable, "-c", build], cwd=source, capture_output=True, check=True)
    assert identity(source / "built" / "wspd_design") == package()
    assert package() == identity(ROOT / "wspd_design")
