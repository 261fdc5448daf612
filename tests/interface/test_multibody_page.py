"""The wagon of docs/multibody.md stands and is what the page says; the table of vehicles is complete."""

import re
from pathlib import Path

import pytest

from wspd_design.plants.multibody.loading import available_multibodies, load_multibody
from wspd_design.plants.multibody.schema import ITEM_KEYS, JOINTS

PAGE = (Path(__file__).parents[2] / "docs" / "multibody.md").read_text(encoding="utf-8")


def test_the_wagon_stands(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (file,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    Path("wagon.toml").write_text(file, encoding="utf-8")
    names = {}
    exec(example, names)
    assert names["coordinates"] == 18
    assert names["load"] == pytest.approx(20e3 * 9.81 / 4)


def test_all_vehicles_stand_in_the_table():
    rows = dict(re.findall(r"^\| `([\w-]+)` \|[^|]*\| (\d+) \|", PAGE, re.MULTILINE))
    counts = {name: str(len(load_multibody(name).coordinates)) for name in available_multibodies()}
    assert rows == counts


def test_all_joints_and_tables_are_told():
    for word in (*JOINTS, *ITEM_KEYS):
        assert f"`{word}`" in PAGE or f"[{word}" in PAGE, word
