"""Files that appear when they are complete, or not at all."""

import errno
import os
import secrets
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from wspd_design.parameters.errors import UserError

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)  # no space, quota, limit of the size of files


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Fill a temporary file beside the target and rename it, which is one step for every reader.

    Parameters
    ----------
    path : Path
        The file to be; one of the same name is replaced and keeps its permissions, behind a link as well.
    write : callable
        Fills the file of the path that it is given.

    Raises
    ------
    UserError
        If the folder does not exist or cannot be written, or there is no space.
    """
    try:
        target = Path(os.path.realpath(path))
        part = target.with_name(f".{target.name}.{secrets.token_hex(4)}.part")
        os.close(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))  # the user's mask holds
        try:
            if target.exists():
                part.chmod(target.stat().st_mode)
            write(part)
            os.replace(part, target)
        except BaseException:
            with suppress(OSError):
                part.unlink()
            raise
    except OSError as error:
        remedy = "free some space" if error.errno in _FULL else "choose a folder that exists and is writable"
        raise UserError(f"{path} cannot be written ({error.strerror}); {remedy}") from None
