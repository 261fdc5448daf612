"""Files that the commands write: checked before the work starts, and whole or not at all."""

import os
from collections.abc import Callable
from pathlib import Path

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.writing import write_whole


def check_output(path: Path, *, force: bool) -> None:
    """Refuse a path that cannot be written, before anything is computed for it.

    Parameters
    ----------
    path : Path
        The file to be.
    force : bool
        Whether an existing file may be replaced.
    """
    if path.is_dir():
        raise UserError(f"{path} is a folder; add the name of a file in it")
    if not path.parent.is_dir():
        raise UserError(f"folder {path.parent} does not exist; create it or choose another one")
    _check_writable(path.parent)
    if path.exists() and not force:
        raise UserError(f"{path} exists; choose another name with -o or replace it with --force")


def check_folder(path: Path, *, force: bool) -> None:
    """Refuse a folder that cannot be written, before anything is computed for it.

    Parameters
    ----------
    path : Path
        The folder; it may be missing, not its parent.
    force : bool
        Whether files in it may be replaced.
    """
    if path.is_dir():
        _check_writable(path)
        if not force and any(path.iterdir()):
            raise UserError(f"folder {path} is not empty; choose another one with -o or replace with --force")
    elif path.exists():
        raise UserError(f"{path} is a file; name a folder with -o")
    elif not path.parent.is_dir():
        raise UserError(f"folder {path.parent} does not exist; create it or choose another one")
    else:
        _check_writable(path.parent)


def _check_writable(folder: Path) -> None:
    if not os.access(folder, os.W_OK):
        raise UserError(f"folder {folder} cannot be written; choose another one or mend its permissions")


def write_text(path: Path, text: str, *, force: bool) -> None:
    """Write a text file, which appears when it is complete; ``force`` replaces an existing one."""
    write_file(path, lambda target: target.write_text(text, encoding="utf-8"), force=force)


def write_file(path: Path, write: Callable[[Path], object], *, force: bool) -> None:
    """Write a file aside and put it in its place when it is complete.

    Parameters
    ----------
    path : Path
        The file to be.
    write : callable
        Fills the file of the path that it is given.
    force : bool
        Whether an existing file may be replaced.
    """
    check_output(path, force=force)
    write_whole(path, write)
