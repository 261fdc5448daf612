"""Files and names of older versions: which are still read, until when, and what is said about the others.

A file names its schema with a version, such as ``wspd-design/2``. The version rises when a key changes its meaning or
disappears. The one before it is read, with a notice, up to the release that the notice names.
"""

import re
import warnings
from dataclasses import dataclass

from wspd_design.parameters.errors import UserError

_SCHEMA = re.compile(r"(?P<name>[a-z-]+)/(?P<version>\d{1,6})")


class OutdatedWarning(UserWarning):
    """Something is in use that a coming release will not know."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outdated:
    """Something older that still works."""

    what: str  # the older form
    instead: str  # what to do, as an instruction
    until: str  # release in which it stops working


DESIGN_1 = Outdated(
    what="a design file of wspd-design/1, which does not say on which numbers of vehicle and rail it was made,",
    instead="write it anew with wspd design",
    until="0.3.0",
)
OUTDATED = (DESIGN_1,)
"""All that is still taken; a test fails in the release that one of them names."""


def tell_outdated(outdated: Outdated, where: str, *, stacklevel: int = 3) -> None:
    """Warn that something outdated is in use.

    Parameters
    ----------
    outdated : Outdated
        One of the table.
    where : str
        File or name in which it stands.
    stacklevel : int
        Of :func:`warnings.warn`, as from here.
    """
    sentence = f"{where}: {outdated.what} is taken until {outdated.until}; {outdated.instead}"
    warnings.warn(sentence, OutdatedWarning, stacklevel=stacklevel)


def check_schema(
    found: object, schema: str, where: str, *, what: str, remedy: str, older: tuple[str, ...] = ()
) -> None:
    """Refuse a file of another kind or of a version that is not read.

    Parameters
    ----------
    found : object
        What the file states.
    schema : str
        The present one, such as ``wspd-design/2``.
    where : str
        The file, in sentences.
    what : str
        What it should be, with its article.
    remedy : str
        For what is not read any more.
    older : tuple of str
        Schemas that are read as well.

    Raises
    ------
    UserError
        Also for a file of a newer program, which is told as such.
    """
    if found == schema or found in older:
        return
    begin = f'{where} is not {what} of this version: schema = "{"" if found is None else found}"'
    theirs, ours = _SCHEMA.fullmatch(str(found)), _SCHEMA.fullmatch(schema)
    assert ours is not None
    if theirs and theirs["name"] == ours["name"] and int(theirs["version"]) > int(ours["version"]):
        raise UserError(f'{begin} is of a newer program, this one reads "{schema}"; update wspd-design')
    raise UserError(f'{begin} must be "{schema}"; {remedy}')
