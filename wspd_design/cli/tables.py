"""Tables of results in files: CSV, Parquet by the optional pyarrow, or MATLAB."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from wspd_design.cli.output import check_output, write_file
from wspd_design.exchange.table_files import check_format, write_blocks

if TYPE_CHECKING:
    from numpy.typing import NDArray


def check_table(path: Path, *, force: bool) -> None:
    """Refuse a file that could not be written later: wrong place, unknown format, no Parquet here.

    Parameters
    ----------
    path : Path
        The file to be; its ending chooses the format.
    force : bool
        Whether an existing file may be replaced.
    """
    check_output(path, force=force)
    check_format(path)


def write_table(
    path: Path,
    blocks: "Iterable[NDArray[Any]]",
    *,
    force: bool,
    about: Mapping[str, str] = MappingProxyType({}),
) -> None:
    """Write structured arrays of the same columns below each other, whole or not at all.

    Numbers keep all their digits. Blocks may be made while they are written, so that no table of all has to be there.
    ``about`` says what was simulated, where the format has a place for it.
    """
    ending = path.suffix.lower()
    write_file(path, lambda target: write_blocks(target, blocks, about, ending), force=force)
