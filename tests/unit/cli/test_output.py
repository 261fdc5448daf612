"""Files are written whole or not at all."""

import os

import pytest

from wspd_design.cli.output import check_output, write_text
from wspd_design.parameters.errors import UserError


def test_written_and_replaced(tmp_path):
    path = tmp_path / "a.csv"
    write_text(path, "1\n", force=False)
    with pytest.raises(UserError, match="--force"):
        write_text(path, "2\n", force=False)
    assert path.read_text() == "1\n"
    write_text(path, "2\n", force=True)
    assert path.read_text() == "2\n"
    assert list(tmp_path.iterdir()) == [path]


def test_nothing_is_left_behind(tmp_path, monkeypatch):
    def full(_source, _target):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(UserError, match="No space left"):
        write_text(tmp_path / "a.csv", "1\n", force=False)
    assert list(tmp_path.iterdir()) == []


def test_folder_that_cannot_be_written(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda _path, _mode: False)
    with pytest.raises(UserError, match="cannot be written"):
        check_output(tmp_path / "a.csv", force=False)


def test_the_mask_of_the_user_holds(tmp_path):
    path, before = tmp_path / "a.csv", os.umask(0o027)
    try:
        write_text(path, "1\n", force=False)
    finally:
        os.umask(before)
    assert path.stat().st_mode & 0o777 == 0o640


def test_a_replaced_file_keeps_its_permissions_behind_a_link(tmp_path):
    (tmp_path / "store").mkdir()
    path, link = tmp_path / "store" / "a.csv", tmp_path / "a.csv"
    path.write_text("1\n")
    path.chmod(0o600)
    link.symlink_to("store/a.csv")
    write_text(link, "2\n", force=True)
    assert link.is_symlink()
    assert path.read_text() == "2\n"
    assert path.stat().st_mode & 0o777 == 0o600
    assert list((tmp_path / "store").iterdir()) == [path]
