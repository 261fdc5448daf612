"""Files that the commands write: checked before the work starts, and whole or not at all."""

import os
import tempfile
from pathlib import Path

from wspd_design.parameters.errors import UserError


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
    if not os.access(path.parent, os.W_OK):
        raise UserError(f"folder {path.parent} cannot be written; choose another one or mend its permissions")
    if path.exists() and not force:
        raise UserError(f"{path} exists; choose another name with -o or replace it with --force")


def write_text(path: Path, text: str, *, force: bool) -> None:
    """Write a text file, which appears when it is complete; ``force`` replaces an existing one."""
    check_output(path, force=force)
    try:
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", text=True)
        try:
            with os.fdopen(handle, "w", encoding="utf-8") as stream:
                stream.write(text)
            os.chmod(temporary, 0o644)
            os.replace(temporary, path)
        except BaseException:
            os.unlink(temporary)
            raise
    except OSError as error:
        raise UserError(
            f"cannot write {path} ({error.strerror}); choose a folder that exists and can be written"
        ) from None
