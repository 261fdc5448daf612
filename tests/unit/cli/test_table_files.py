"""Tables in files: the same numbers in CSV and in Parquet, whole or not at all."""

import csv
import errno
import os

import numpy as np
import pytest

from wspd_design.cli.tables import check_table, write_table
from wspd_design.parameters.errors import UserError
from wspd_design.simulation import parquet

TABLE = np.array(
    [(0, 0.1 + 0.2, True), (1, float("nan"), False)],
    dtype=[("run", "i8"), ("vehicle.mass", "f8"), ("stopped", "?")],
)


def test_csv_keeps_all_digits(tmp_path):
    write_table(tmp_path / "a.csv", [TABLE[:1], TABLE[1:]], force=False)
    with (tmp_path / "a.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert list(rows[0]) == ["run", "vehicle.mass_kg", "stopped"]
    assert float(rows[0]["vehicle.mass_kg"]) == 0.1 + 0.2
    assert [row["stopped"] for row in rows] == ["True", "False"]


def test_parquet_keeps_all_digits(tmp_path):
    duckdb = pytest.importorskip("duckdb")
    path = tmp_path / "it's.parquet"
    write_table(path, [TABLE[:1], TABLE[1:]], force=False)
    with duckdb.connect() as database:
        found = database.from_parquet(str(path)).fetchnumpy()
    assert list(found) == ["run", "vehicle.mass_kg", "stopped"]
    assert found["vehicle.mass_kg"][0] == 0.1 + 0.2
    assert found["stopped"].tolist() == [True, False]
    assert list(tmp_path.iterdir()) == [path]


def test_parquet_that_fails_leaves_nothing_behind(tmp_path, monkeypatch):
    def full(*_arguments):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(parquet, "_arrow", full)
    with pytest.raises(UserError, match=r"No space left on device\); free some space"):
        write_table(tmp_path / "a.parquet", [TABLE], force=False)
    assert list(tmp_path.iterdir()) == []


def test_parquet_without_pyarrow_says_how_to_install_it(tmp_path, monkeypatch):
    monkeypatch.setattr(parquet, "find_spec", lambda _name: None)
    with pytest.raises(UserError, match=r'pip install "wspd-design\[parquet\]"'):
        check_table(tmp_path / "a.parquet", force=False)
    check_table(tmp_path / "a.csv", force=False)
