"""Tables of results in files: CSV, or Parquet by the optional pyarrow."""

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wspd_design.cli.output import check_output, write_file
from wspd_design.parameters.errors import UserError
from wspd_design.simulation.parquet import check_parquet, write_rows

if TYPE_CHECKING:
    from numpy.typing import NDArray

FORMATS = (".csv", ".parquet")
_BLOCK = 1000  # rows that are Python objects at a time


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
    ending = path.suffix.lower()
    if ending not in FORMATS:
        raise UserError(f"{path} must end in {' or '.join(FORMATS)}, which chooses the format")
    if ending == ".parquet":
        check_parquet(f"{path}: Parquet")


def write_table(path: Path, blocks: "Iterable[NDArray[Any]]", *, force: bool) -> None:
    """Write structured arrays of the same columns below each other, whole or not at all.

    Numbers keep all their digits. Blocks may be made while they are written, so that no table of all has to be there.
    """
    write = _write_parquet if path.suffix.lower() == ".parquet" else _write_csv
    write_file(path, lambda target: write(target, blocks), force=force)


def _write_csv(path: Path, blocks: "Iterable[NDArray[Any]]") -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        for number, block in enumerate(blocks):
            if number == 0:
                writer.writerow(block.dtype.names or ())
            for start in range(0, len(block), _BLOCK):
                writer.writerows(block[start : start + _BLOCK].tolist())


def _write_parquet(path: Path, blocks: "Iterable[NDArray[Any]]") -> None:
    with path.open("wb") as stream:
        write_rows(blocks, stream, {})
