"""docs/architecture.md is the tree as it is: every path exists, every package is on the map, every answer is true."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "wspd_design"
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
TREE = PAGE.split("```text\n")[1].split("```")[0]


def mapped():
    """Folders of the tree on the page, relative to the repository, from the indentation of its lines."""
    found, above = set(), []
    for line in TREE.splitlines():
        name = re.match(r"( *)([a-z_]+)/ ", line)
        if name and len(name[1]) % 4 == 0 and len(name[1]) < 20:
            depth = len(name[1]) // 4
            above = [*above[:depth], name[2]]
            found.add("/".join(above))
        elif line == "wspd_design/":
            above = ["wspd_design"]
            found.add("wspd_design")
    return found


def test_every_room_on_the_map_exists():
    assert [room for room in sorted(mapped()) if not (ROOT / room).is_dir()] == []


def test_every_package_is_on_the_map():
    packages = {path.parent.relative_to(ROOT).as_posix() for path in PACKAGE.rglob("__init__.py")}
    assert packages - mapped() == set()


def test_a_room_that_is_missing_would_be_seen():
    assert "wspd_design/certificates/checks/valve" in mapped()
    assert "wspd_design/certificates/theorems/shortest_stop" in mapped()
    assert "wspd_design/certificates/checks/nothing" not in mapped()


def paths():
    """Paths in backquotes, as the page writes them."""
    named = re.findall(r"`([a-z_0-9./-]+(?:\.py|\.toml|/))`", PAGE)
    return sorted(set(named) - {"round_trip.py"})


@pytest.mark.parametrize("path", paths())
def test_every_path_that_is_named_exists(path):
    places = (ROOT, PACKAGE, PACKAGE / "certificates", PACKAGE / "certificates" / "kernel")
    assert any((place / path).exists() for place in places)


ANSWERS = {
    "certificates/theorems/valve.py": "NO_GO = Theorem(",
    "certificates/checks/valve/no_go.py": "def widest_interval",
    "certificates/kernel/checker.py": "def decide",
    "controllers/torque_feedback.py": "class TorqueFeedback",
    "design/torque_feedback_gains.py": "def torque_feedback_gains",
    "reporting/figures/poles.py": "def pole_map",
    "cli/options.py": "--effort",
    "data/rails/polach-wet.toml": "[mu0]",
    "plants/planar.py": "transfer",
    "exchange/stop_forms.py": '"distance_m"',
}


def test_the_ten_answers_are_true():
    rows = re.findall(r"^\| the .* \| `(.+)` \|$", PAGE, re.MULTILINE)
    assert rows == list(ANSWERS)
    for path, content in ANSWERS.items():
        assert content in (PACKAGE / path).read_text(encoding="utf-8"), path


def test_the_page_is_short_and_the_readme_leads_to_it():
    assert len(PAGE.splitlines()) < 250
    assert "docs/architecture.md" in (ROOT / "README.md").read_text(encoding="utf-8")


def same_names(folder):
    """Names that several test files share, outside of packages: pytest would refuse all but the first one."""
    files = [path for path in folder.rglob("test_*.py") if not (path.parent / "__init__.py").exists()]
    names = [path.name for path in files]
    return sorted({name for name in names if names.count(name) > 1})


def test_every_test_file_has_a_name_of_its_own(tmp_path):
    assert same_names(ROOT / "tests") == []
    for room in ("certificates", "interface"):
        (tmp_path / room).mkdir()
        (tmp_path / room / "test_replay.py").touch()
    assert same_names(tmp_path) == ["test_replay.py"]
