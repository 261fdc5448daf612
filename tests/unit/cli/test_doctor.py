"""The doctor finds what is missing."""

import tomllib
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import pytest

from wspd_design.cli.app import run
from wspd_design.cli.commands import doctor


def test_all_declared_packages_are_examined():
    project = tomllib.loads((Path(__file__).parents[3] / "pyproject.toml").read_text())["project"]
    names = doctor.required_packages()
    assert len(names) == len(project["dependencies"])
    assert all(
        text.startswith(name)
        for text, name in zip(sorted(project["dependencies"]), sorted(names), strict=True)
    )


def test_healthy_machine(capsys):
    assert run(["doctor"]) == 0
    assert "All that is needed is there." in capsys.readouterr().out


def test_missing_package(monkeypatch, capsys):
    def without_scipy(name):
        if name == "scipy":
            raise PackageNotFoundError(name)
        return version(name)

    monkeypatch.setattr(doctor, "version", without_scipy)
    assert run(["doctor"]) == 1
    out = capsys.readouterr().out
    assert "pip install scipy" in out
    assert "Missing: scipy." in out


def test_temporary_folder_that_cannot_be_written(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(doctor.tempfile, "gettempdir", lambda: str(tmp_path / "missing"))
    assert run(["doctor"]) == 1
    assert "Set TMPDIR" in capsys.readouterr().out


def test_typesetting_that_fails(monkeypatch, capsys):
    def broken(_source):
        raise RuntimeError("no fonts")

    monkeypatch.setattr("typst.compile", broken)
    assert run(["doctor"]) == 1
    assert "no fonts" in capsys.readouterr().out


@pytest.mark.parametrize("found", [None, "/usr/bin/cc"])
def test_a_compiler_is_not_needed(found, monkeypatch, capsys):
    monkeypatch.setattr(doctor.shutil, "which", lambda _name: found)
    assert run(["doctor"]) == 0
    assert (found or "none") in capsys.readouterr().out
