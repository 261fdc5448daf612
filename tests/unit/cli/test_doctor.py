"""The doctor finds what is missing."""

import os
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import pytest

from wspd_design.cli.app import run
from wspd_design.cli.commands import doctor
from wspd_design.codegen import compiler, prebuilt
from wspd_design.codegen.compiler import find_compiler


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


def test_a_compiler_is_not_needed(monkeypatch, capsys):
    for module in (doctor, compiler):
        monkeypatch.setattr(module, "find_compiler", lambda: None)
    assert run(["doctor"]) == 0
    out = " ".join(capsys.readouterr().out.split())
    assert 'Install gcc or clang, set CC, or: pip install "wspd-design[compiler]"' in out
    assert "- simulation CasADi virtual machine" in out


def test_plants_of_other_code_are_told(monkeypatch, tmp_path):
    best = prebuilt.targets()[0]
    monkeypatch.setattr(prebuilt, "folder", lambda: tmp_path)
    assert doctor._plants().found == "none came with the package"
    (tmp_path / f"{'0' * 32}-{best}{prebuilt.SUFFIX}").write_bytes(b"")
    finding = doctor._plants()
    assert not finding.good
    assert finding.found == f"1 for {best} came with the package, but they are not those of its code"
    assert "install both again" in finding.remedy
    monkeypatch.setattr(prebuilt, "prebuilt_library", lambda _source: object())
    assert doctor._plants().good


@pytest.mark.skipif(find_compiler() is None, reason="this machine has no C compiler")
def test_the_compiler_is_tried():
    finding = doctor._compiler()
    assert finding.good
    assert finding.found.startswith(find_compiler()[0])
    assert "a test program ran" in finding.found


def test_a_compiler_that_fails_is_seen(monkeypatch):
    refusing = (sys.executable, "-c", "raise SystemExit('no licence')")
    for module in (doctor, compiler):
        monkeypatch.setattr(module, "find_compiler", lambda: refusing)
    finding = doctor._compiler()
    assert not finding.good
    assert "no licence" in finding.found


def test_trying_the_compiler_leaves_the_cache_alone(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert doctor._compiler().good == (find_compiler() is not None)
    assert os.environ["XDG_CACHE_HOME"] == str(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_size_of_the_cache(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    folder = tmp_path / "wspd_design"
    folder.mkdir()
    (folder / "a.so").write_bytes(bytes(3_000_000))
    found = doctor._compiled_code()
    assert found.good
    assert f"{folder}, 1 libraries, 3.0 MB" in found.found
    monkeypatch.setenv("XDG_CACHE_HOME", "/proc/no-folder")
    found = doctor._compiled_code()
    assert not found.good
    assert "XDG_CACHE_HOME" in found.remedy


def test_parquet_is_not_needed(monkeypatch):
    assert doctor._parquet().good
    monkeypatch.setattr(doctor, "find_spec", lambda _name: None)
    found = doctor._parquet()
    assert (found.good, found.needed) == (False, False)
    assert 'pip install "wspd-design[parquet]"' in found.remedy
