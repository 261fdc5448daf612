"""Paths as Tab completes them."""

import os
from collections.abc import Sequence
from pathlib import Path


def paths(written: str, ending: str) -> list[str]:
    """Return the paths of folders and files of an ending that begin as written, sorted; folders end in a slash."""
    folder, _, start = written.rpartition("/")
    where = Path(f"{folder}/" if folder or written.startswith("/") else ".").expanduser()
    before = written[: len(written) - len(start)]
    try:
        entries = sorted(where.iterdir())
    except OSError:
        return []
    return [
        f"{before}{each.name}{'/' * each.is_dir()}"
        for each in entries
        if each.name.startswith(start)
        and (start.startswith(".") or not each.name.startswith("."))
        and (each.is_dir() or each.name.endswith(ending))
    ]


def common_start(found: Sequence[str]) -> str:
    """Return what all paths begin with, character by character."""
    return os.path.commonprefix(found)  # noqa: RUF071 - a part of a name is completed, too


def last_part(path: str) -> str:
    """Return the name of a file or folder, as a list of offers shows it."""
    return path.rstrip("/").rpartition("/")[2] + "/" * path.endswith("/")
