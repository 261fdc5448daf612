"""``wspd reproduce``: what it asks the package for; the page itself is tested elsewhere."""

import sys
from types import ModuleType

import pytest


@pytest.fixture
def written(monkeypatch):
    """Write a stand-in for the page."""
    folders = []

    def write_reproduction(folder, progress, *, locomotive):
        progress("Table 10")
        folder.mkdir(exist_ok=True)
        (folder / "index.html").write_text("new")
        folders.append(folder.name if locomotive else f"{folder.name} small")
        return (folder / "index.html",)

    stand_in = ModuleType("wspd_design.reporting.reproduction")
    stand_in.write_reproduction = write_reproduction
    monkeypatch.setitem(sys.modules, stand_in.__name__, stand_in)
    return folders


def test_it_says_where(wspd, written):
    assert wspd("reproduce").code == 0
    outcome = wspd("reproduce", "-o", "paper")
    assert (outcome.code, outcome.err) == (0, "")
    assert written == ["reproduction", "paper"]
    assert wspd("reproduce", "--small", "-o", "other").code == 0
    assert written[-1] == "other small"
    assert "Written: paper/index.html" in outcome.out


@pytest.mark.usefixtures("written")
def test_files_in_the_folder_are_replaced_only_by_force(wspd, tmp_path):
    (tmp_path / "paper").mkdir()
    assert wspd("reproduce", "-o", "paper").code == 0  # it was empty
    (tmp_path / "paper" / "index.html").write_text("old")
    assert wspd("reproduce", "-o", "paper").code == 2
    assert (tmp_path / "paper" / "index.html").read_text() == "old"
    assert wspd("reproduce", "-o", "paper", "--force").code == 0
    assert (tmp_path / "paper" / "index.html").read_text() == "new"
